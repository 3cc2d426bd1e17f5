"""What a user should know of an input, beside what is wrong in it."""

from typing import NamedTuple


class Remark(NamedTuple):
    """A note on an input that was read, or a `warning`, which is told first."""

    text: str
    warning: bool = False


def as_warnings(texts: list[str]) -> tuple[Remark, ...]:
    """Warnings of these texts."""
    return tuple(Remark(text, warning=True) for text in texts)
