"""Rows of tables in OpenFAST's files, and numbers as Fortran writes them."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

from jaxhydro.errors import InputError, Problem, shown

FLAGS = {"true": True, "t": True, ".true.": True, "false": False, "f": False, ".false.": False}


def to_number(word: str) -> float:
    """Number as Fortran reads it, such as 1.0D+05; NaN for what is none."""
    try:
        return float(re.sub("[dD]", "e", word))
    except ValueError:
        return math.nan


def bare_word(word: str) -> str:
    """A word without its quotes."""
    return word[1:-1].strip() if len(word) > 1 and word[0] in "\"'" and word[-1] == word[0] else word


@dataclass(frozen=True)
class TableRow:
    """A row of a table.

    Attributes:
        source: Name of the file.
        line: Line in it, from 1.
        cells: Words by column.
    """

    source: str
    line: int
    cells: Mapping[str, str]

    def number(self, column: str, default: float | None = None) -> float:
        """A number of the row.

        Args:
            column: Name of the column.
            default: What holds where this version has no such column.

        Raises:
            InputError: It is no finite number.
        """
        if column not in self.cells and default is not None:
            return default
        value = to_number(self.cells[column])
        if not math.isfinite(value):
            raise self.wrong(f"a number for {column}", shown(self.cells[column]))
        return value

    def whole(self, column: str, default: int | None = None) -> int:
        """A whole number of the row.

        Raises:
            InputError: It is none.
        """
        value = self.number(column, default)
        if value != int(value):
            raise self.wrong(f"a whole number for {column}", shown(self.cells[column]))
        return int(value)

    def flag(self, column: str) -> bool:
        """A logical value of the row.

        Raises:
            InputError: It is neither true nor false.
        """
        word = self.cells[column].lower()
        if word not in FLAGS:
            raise self.wrong(f"TRUE or FALSE for {column}", shown(self.cells[column]))
        return FLAGS[word]

    def wrong(self, expected: str, found: str, hint: str = "") -> InputError:
        """The error of this row."""
        return InputError(self.source, [Problem(f"line {self.line}", expected, found, hint)])
