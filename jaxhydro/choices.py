"""Checks of options that are one of a few words, with the nearest word as a hint."""

import difflib
from collections.abc import Iterable
from typing import Any

import numpy as np

MIN_SIMILARITY = 0.6  # `difflib`'s ratio from which words are alike
MAX_LISTED_WORDS = 40  # known words that a message lists at most


class UnknownName(KeyError, ValueError):
    """An unknown name or option; the message lists the known ones and suggests the nearest."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


def nearest(word: object, names: Iterable[str]) -> str:
    """Name nearest to `word`, ignoring case; empty where none is near, or where `word` is no text."""
    if not isinstance(word, str):
        return ""
    by_lower = {name.lower(): name for name in names}
    near = difflib.get_close_matches(word[:80].lower(), by_lower, n=1, cutoff=MIN_SIMILARITY)
    return by_lower[near[0]] if near else ""


def unknown(kind: str, word: object, names: Iterable[str], hint: str = "") -> UnknownName:
    """Error of an unknown name, such as `no degree of freedom 'pich'; ... Did you mean 'pitch'?`.

    Args:
        kind: Kind of thing that the name is of, such as `degree of freedom`.
        word: The name.
        names: Known names.
        hint: Hint in place of the nearest name.
    """
    names = list(names)
    listed = ", ".join(names[:MAX_LISTED_WORDS]) + (", ..." if len(names) > MAX_LISTED_WORDS else "") or "none"
    near = nearest(word, names)
    hint = hint or (f"Did you mean {near!r}?" if near else "")
    return UnknownName(f"no {kind} {word!r}; there are: {listed}" + (f". {hint}" if hint else ""))


def _same(value: Any, choice: Any) -> bool:
    """Whether a value is one of those allowed; True is not 1."""
    plain = value is None or isinstance(value, str | bool | int | float | np.generic)
    return plain and isinstance(value, bool | np.bool_) == isinstance(choice, bool) and bool(value == choice)


def check(**chosen: tuple[Any, Iterable[Any]]) -> None:
    """Raise UnknownName for the first option whose value is not allowed.

    Args:
        **chosen: Value and allowed values of each option. A flag is a bool; a number is no flag.
    """
    for name, (value, allowed) in chosen.items():
        allowed = tuple(allowed)
        if any(_same(value, choice) for choice in allowed):
            continue
        listed = " or ".join(filter(None, (", ".join(map(repr, allowed[:-1])), repr(allowed[-1]))))
        near = nearest(value, [choice for choice in allowed if isinstance(choice, str)])
        raise UnknownName(f"{name}: expected {listed}, found {value!r}" + (f". Did you mean {near!r}?" if near else ""))
