"""Lines and matrices of the text files of panel programs."""

import re
from pathlib import Path

import numpy as np
from jaxtyping import Float

from jaxhydro.errors import InputError, Problem, shown

FORTRAN = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][-+]?\d+)?")


def text_of(path: Path, what: str) -> str:
    """Text of a file.

    Raises:
        InputError: It cannot be read; `what` says what it is.
    """
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except OSError as error:
        found = "no such file" if isinstance(error, FileNotFoundError) else error.strerror or str(error)
        raise InputError(str(path), [Problem("", what, found)]) from None


def to_float(word: str) -> float:
    """A number, with Fortran's exponents; NaN for another word."""
    try:
        return float(word.upper().replace("D", "E"))
    except ValueError:
        return float("nan")


def matrix_after(path: Path, text: str, title: str) -> Float[np.ndarray, "6 6"] | None:
    """The six rows of six numbers after the line that has a title; None where no line has it.

    Raises:
        InputError: The rows are not there.
    """
    lines = text.splitlines()
    first = next((i for i, line in enumerate(lines) if title.lower() in line.lower()), None)
    if first is None:
        return None
    rows = [[to_float(word) for word in line.split()] for line in lines[first + 1 : first + 7]]
    if len(rows) < 6 or any(len(row) != 6 or not np.isfinite(row).all() for row in rows):
        bad = next((i for i, row in enumerate(rows) if len(row) != 6 or not np.isfinite(row).all()), len(rows))
        line = lines[first + 1 + bad].strip() if first + 1 + bad < len(lines) else "the end of the file"
        raise InputError(str(path), [Problem(f"line {first + 2 + bad}, {title}", "six rows of six numbers", shown(line[:60]))])
    return np.array(rows)


def numbers_after(path: Path, text: str, title: str, count: int) -> list[float] | None:
    """Numbers after a title on its line; None where no line has it.

    Raises:
        InputError: There are fewer.
    """
    for number, line in enumerate(text.splitlines(), 1):
        _, separator, rest = line.partition(title)
        if separator:
            values = [to_float(word) for word in rest.replace("=", " ").replace(":", " ").split()[:count]]
            if len(values) < count or not np.isfinite(values).all():
                where = f"line {number}, {title.rstrip(' :=')}"
                expected = "a number" if count == 1 else f"{count} numbers"
                raise InputError(str(path), [Problem(where, expected, shown(rest.strip()[:60]))])
            return values
    return None
