"""Errors in input files: path of each mistake, what was expected and what was found."""

import reprlib
from collections.abc import Iterable
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from jaxhydro.choices import nearest

MAX_PRINTED_PROBLEMS = 20  # problems printed before the rest is only counted


@dataclass(frozen=True)
class Problem:
    """One mistake in a file.

    Attributes:
        where: Dotted path in the file, such as `members[2].d`.
        expected: What belongs there.
        found: What is there.
        hint: How to mend it, or "".
    """

    where: str
    expected: str
    found: str
    hint: str = ""

    def __str__(self) -> str:
        line = f"{self.where}: " if self.where else ""
        line += f"expected {self.expected}, found {self.found}"
        return " ".join((f"{line}. {self.hint}" if self.hint else line).split())


class PrintedWarning(UserWarning):
    """A warning that commands print as they print their messages."""


class WaveOrderWarning(PrintedWarning):
    """Wave records that lack the second-order waves that a model is driven with."""


class CheckpointWarning(PrintedWarning):
    """A checkpoint that cannot be resumed: it has other inputs or another program, or is damaged."""


class InputError(Exception):
    """An input file that cannot be used.

    Attributes:
        source: Name of the file.
        problems: Every mistake in it.
    """

    def __init__(self, source: str, problems: Iterable[Problem]) -> None:
        self.source = source
        self.problems = tuple(problems)
        super().__init__(source, self.problems)

    def __str__(self) -> str:
        if len(self.problems) == 1:
            return f"{self.source}: {self.problems[0]}"
        lines = [f"  {problem}" for problem in self.problems[:MAX_PRINTED_PROBLEMS]]
        if len(self.problems) > MAX_PRINTED_PROBLEMS:
            lines.append(f"  and {len(self.problems) - MAX_PRINTED_PROBLEMS} more")
        return "\n".join([f"{self.source}: {len(self.problems)} problems", *lines])


class Faults(ValueError):
    """Several mistakes found by a validator; each `where` is relative to what it validates."""

    def __init__(self, *problems: Problem) -> None:
        self.problems = problems
        super().__init__("; ".join(map(str, problems)))


def suggest(word: object, names: Iterable[str]) -> str:
    """Hint for a misspelt word, such as `Did you mean 'heading'?`; empty where no known word is near."""
    near = nearest(word, names)
    return f"Did you mean '{near}'?" if near else ""


def suggest_path(path: str | PathLike[str]) -> str:
    """Hint for a path that does not exist; empty where no name is near."""
    missing = path = Path(path)
    try:
        while not missing.parent.exists():
            missing = missing.parent
        # compare names without endings; among equal names, prefer the same ending
        entries = sorted(missing.parent.iterdir(), key=lambda entry: (entry.suffix == missing.suffix, entry.name))
        stems = {entry.stem: entry for entry in entries}
        near = nearest(missing.stem, stems)
        suggestion = missing.with_name(stems[near].name) / path.relative_to(missing) if near else missing
        return f"Did you mean '{suggestion}'?" if near and suggestion.exists() else ""
    except (OSError, ValueError):  # a folder that cannot be read, a name that no file can have
        return ""


_repr = reprlib.Repr()
_repr.maxlevel, _repr.maxlist, _repr.maxdict, _repr.maxstring, _repr.maxother = 3, 6, 3, 50, 50


def shown(value: object) -> str:
    """Value in a message: short, and in the words of the file (true, nothing)."""
    if value is None:
        return "nothing"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        value = list(value)
    if isinstance(value, str | int | float | list | dict):
        try:
            return _repr.repr(value)
        except ValueError:  # an integer of more digits than Python prints
            return "a number too long to print"
    return _repr.repr(str(value))
