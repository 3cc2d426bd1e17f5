"""Remarks on inputs that are not errors."""

from typing import NamedTuple


class Remark(NamedTuple):
    """A note on an input that was read, or a `warning`, which is told first."""

    text: str
    warning: bool = False


def as_warnings(texts: list[str]) -> tuple[Remark, ...]:
    """Warnings of these texts."""
    return tuple(Remark(text, warning=True) for text in texts)
