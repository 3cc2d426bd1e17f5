"""Findings about records, equal ones grouped over tests.

Messages on whole records are equal when they differ by their numbers alone: "its mean drifts by -0.149 to -0.0885 m".
"""

import re
from collections.abc import Iterable
from typing import NamedTuple

from calibration.campaign.finding import Finding
from calibration.formatting import counted, listed

NUMBER = re.compile(r"(?<![\w.-])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?(?![\w])")
MAX_NAMED_TESTS = 3  # tests that are named; of more the number is given


class GroupedFinding(NamedTuple):
    """One message on one channel, and the tests and files it is about."""

    tests: tuple[str, ...]
    files: tuple[str, ...]
    channel: str
    message: str

    @property
    def where(self) -> str:
        """The tests by name while they are few, else how many."""
        return listed(self.tests) if len(self.tests) <= MAX_NAMED_TESTS else f"{len(self.tests)} tests"

    @property
    def source(self) -> str:
        """The file, or how many files."""
        return self.files[0] if len(self.files) == 1 else counted(len(self.files), "file")

    def __str__(self) -> str:
        channel = f", channel {self.channel}" if self.channel else ""
        if len(self.tests) == 1:
            return f"{self.files[0]}, test {self.tests[0]}{channel}: {self.message}"
        names = f" ({listed(self.tests)})" if len(self.tests) > MAX_NAMED_TESTS else ""
        return f"{'' if names else 'tests '}{self.where}{names}{channel}: {self.message}"


def group_findings(findings: Iterable[Finding]) -> list[GroupedFinding]:
    """Findings in their order, equal messages of one channel together."""
    groups: dict[tuple[str, str], list[Finding]] = {}
    for finding in findings:
        alike = NUMBER.sub("#", finding.message) if finding.time is None else finding.message
        groups.setdefault((finding.channel, alike), []).append(finding)
    grouped = []
    for (channel, _), group in groups.items():
        tests, files = _unique(finding.test for finding in group), _unique(finding.file for finding in group)
        grouped.append(GroupedFinding(tests, files, channel, _spanned([finding.message for finding in group])))
    return grouped


def _spanned(messages: list[str]) -> str:
    """Merge messages that differ by their numbers alone.

    Returns:
        One message with the smallest and the largest of each number.
    """
    columns = iter([sorted(set(column), key=float) for column in zip(*map(NUMBER.findall, messages), strict=True)])
    return NUMBER.sub(lambda _: " to ".join(dict.fromkeys(((column := next(columns))[0], column[-1]))), messages[0])


def _unique(names: Iterable[str]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(names))
