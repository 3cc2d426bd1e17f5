"""Remarks on inputs that are not errors."""

from typing import NamedTuple


class Remark(NamedTuple):
    """Remark on an input; a `warning` is printed first."""

    text: str
    warning: bool = False


def as_warnings(texts: list[str]) -> tuple[Remark, ...]:
    """Warnings from texts."""
    return tuple(Remark(text, warning=True) for text in texts)
