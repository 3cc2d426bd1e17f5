"""Finding on the quality of a record: a warning or an error."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from jaxhydro.errors import Problem

Severity = Literal["warning", "error"]


@dataclass(frozen=True)
class Finding:
    """Observation on the quality of a record.

    Attributes:
        severity: Warning or error.
        file: Name of the data file.
        test: Name of the test.
        channel: Channel, or "".
        time: Time on the file's axis, or None.
        message: The observation in words.
        expected: What an error should have been instead.
    """

    severity: Severity
    file: str
    test: str
    channel: str
    time: float | None
    message: str
    expected: str = ""

    @property
    def place(self) -> str:
        return f"{self.file}, test {self.test}{', channel ' + self.channel if self.channel else ''}"

    def __str__(self) -> str:
        return f"{self.place}: {self.message}"

    @property
    def problem(self) -> Problem:
        """The finding as a line of an InputError."""
        return Problem(self.place, self.expected or "a sound record", self.message)
