"""Warnings about records, each said once: equal messages on the same channel are grouped over tests."""

from collections.abc import Iterable
from typing import NamedTuple

from calibration.checks import Finding
from calibration.formatting import counted
from calibration.statements import listed

NAMED = 3  # tests that are named; of more the number is given


class GroupedFinding(NamedTuple):
    """One message on one channel, and the tests and files it is about."""

    tests: tuple[str, ...]
    files: tuple[str, ...]
    channel: str
    message: str

    @property
    def where(self) -> str:
        """The tests by name while they are few, else how many."""
        return listed(self.tests) if len(self.tests) <= NAMED else f"{len(self.tests)} tests"

    @property
    def source(self) -> str:
        """The file, or how many files."""
        return self.files[0] if len(self.files) == 1 else counted(len(self.files), "file")

    def __str__(self) -> str:
        channel = f", channel {self.channel}" if self.channel else ""
        if len(self.tests) == 1:
            return f"{self.files[0]}, test {self.tests[0]}{channel}: {self.message}"
        names = f" ({listed(self.tests)})" if len(self.tests) > NAMED else ""
        return f"{'' if names else 'tests '}{self.where}{names}{channel}: {self.message}"


def grouped(findings: Iterable[Finding]) -> list[GroupedFinding]:
    """Findings in their order, equal messages of one channel together."""
    groups: dict[tuple[str, str], list[Finding]] = {}
    for one in findings:
        groups.setdefault((one.channel, one.message), []).append(one)
    return [
        GroupedFinding(_unique(one.test for one in some), _unique(one.file for one in some), channel, message)
        for (channel, message), some in groups.items()
    ]


def _unique(names: Iterable[str]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(names))
