"""WAMIT's numeric output files: forces by period or frequency, and heading."""

import math
from os import PathLike
from typing import Any, Literal, get_args

import numpy as np
from jaxtyping import Float

from jaxhydro.choices import check
from jaxhydro.errors import InputError, Problem

By = Literal["period", "rad/s", "Hz"]
UNITS: dict[str, str] = {"period": "s", "rad/s": "rad/s", "Hz": "Hz"}
HEADING_TOLERANCE = 1e-6  # of a degree
MAX_MODULUS_MISMATCH = 0.02  # of a value's modulus, by which MOD and PHASE may differ from RE and IM


def to_omega(values: Any, by: str) -> Any:
    """Angular frequencies (rad/s) from a first column by "period" (s), "rad/s" or "Hz".

    Raises:
        UnknownName: Another word.
    """
    check(by=(by, get_args(By)))
    if by == "period":
        return 2 * math.pi / np.asarray(values)
    return np.asarray(values) * (2 * math.pi if by == "Hz" else 1.0)


def quantity(by: str) -> str:
    """Name of a file's first column in messages."""
    return "period" if by == "period" else "frequency"


def table_of(
    path: str | PathLike[str],
    ending: str,
    columns: str,
    periods: slice,
    mode: int,
    by: str = "period",
    body: int | None = None,
) -> Float[np.ndarray, "r c"]:
    """Read the named columns of a WAMIT file; a first line of words (NUMHDR = 1) is skipped.

    Args:
        path: The file.
        ending: Its usual ending, for messages.
        columns: Names of its columns.
        periods: Columns that hold periods or, as `by` says, frequencies: all above 0.
        mode: Column that holds the mode, from 1 to 6 for every body.
        by: "period" (s), "rad/s" or "Hz".
        body: Number of the body, from 1, whose rows are kept; None: the file has one.

    Returns:
        The rows, modes from 1 to 6.

    Raises:
        InputError: With the file and the row that is wrong, or where the file has several bodies and none is chosen.
    """
    names = columns.split()

    def wrong(expected: str, found: str, where: str = "", hint: str = "") -> InputError:
        return InputError(str(path), [Problem(where, expected, found, hint)])

    try:
        with open(path, encoding="utf-8", errors="replace") as lines:
            text = lines.read().splitlines()
        header = bool(text) and bool(text[0].split()) and not _is_number(text[0].split()[0])
        numbers = [line.replace("D", "E").replace("d", "e") for line in text[int(header) :]]  # Fortran's exponents
        rows = np.loadtxt(numbers, ndmin=2) if any(line.strip() for line in numbers) else np.zeros((0, 0))
    except FileNotFoundError:
        raise wrong(f"a {ending} file", "no such file") from None
    except (OSError, UnicodeDecodeError) as error:
        raise wrong(f"a {ending} file that can be read", str(getattr(error, "strerror", None) or error)) from None
    except ValueError as error:
        raise wrong(f"rows of {len(names)} numbers {columns}", str(error)) from None
    if not rows.size or rows.shape[1] != len(names):
        raise wrong(f"rows of {len(names)} numbers {columns}", f"{rows.shape[1] if rows.size else 0}")
    several = body is not None or (rows[:, mode] > 6).any()
    for bad, expected in (
        (~np.isfinite(rows).all(axis=1), "finite numbers"),
        ((rows[:, periods] <= 0).any(axis=1), "periods above 0" if by == "period" else f"frequencies above 0 ({by})"),
        ((rows[:, mode] < 1) | (rows[:, mode] % 1 != 0) | (rows[:, mode] > 6) & (body is None), "a mode from 1 to 6"),
    ):
        if bad.any():
            row = int(np.argmax(bad))
            hint = several_bodies(rows[:, mode].max()) if several and body is None and expected.startswith("a mode") else ""
            raise wrong(expected, " ".join(f"{x:g}" for x in rows[row]), f"row {row + 1}", hint)
    if body is None:
        return rows
    body_of_row = 1 + (rows[:, mode] - 1) // 6
    if not (body_of_row == body).any():
        raise wrong(f"rows of body {body}", f"bodies {', '.join(f'{number:g}' for number in np.unique(body_of_row))}", "body")
    rows = rows[body_of_row == body]
    rows[:, mode] -= 6 * (body - 1)
    return rows


def several_bodies(highest_mode: float) -> str:
    """Hint for a file of several bodies, by its highest mode."""
    count = math.ceil(highest_mode / 6)
    return f"A file of {count} bodies: say which, `body: 1` to `body: {count}`."


def contradictions(rows: Float[np.ndarray, "r c"], first: int, source: str) -> list[str]:
    """Warning where MOD and PHASE (deg) do not agree with RE and IM; `first` is the column of MOD."""
    polar = rows[:, first] * np.exp(1j * np.radians(rows[:, first + 1]))
    value = rows[:, first + 2] + 1j * rows[:, first + 3]
    size = np.maximum(np.abs(polar), np.abs(value))
    bad = np.abs(polar - value) > MAX_MODULUS_MISMATCH * size + 1e-4 * size.max(initial=0.0)
    if not bad.any():
        return []
    row = " ".join(f"{x:g}" for x in rows[int(np.argmax(bad))])
    where = f"{bad.sum()} of {len(rows)} rows (first: {row})"
    return [f"{source}: MOD and PHASE contradict RE and IM in {where}; RE and IM are used"]


def _is_number(word: str) -> bool:
    try:
        float(word.replace("D", "E"))
    except ValueError:
        return False
    return True


def same_heading(headings: float | Float[np.ndarray, "..."], heading: float) -> Any:
    """Whether headings (deg) are equal to one heading (deg) up to whole turns."""
    return np.abs((headings - heading + 180) % 360 - 180) < HEADING_TOLERANCE


def headings_in(rows: Float[np.ndarray, "r c"], headings: slice) -> Float[np.ndarray, " d"]:
    """Headings (deg) of rows, ascending from -180; of pairs of waves those of two waves of one heading."""
    same = rows[np.ptp(rows[:, headings], axis=1) < HEADING_TOLERANCE, headings.start]
    return distinct(same)


def distinct(headings: Float[np.ndarray, " r"]) -> Float[np.ndarray, " d"]:
    """Headings (deg) once each, ascending from -180: 360 and 0 are one."""
    turned = np.sort(np.mod(headings + 180 + HEADING_TOLERANCE, 360) - 180 - HEADING_TOLERANCE)
    return turned[np.r_[True, np.diff(turned) > 2 * HEADING_TOLERANCE]] if turned.size else turned


def of_heading(
    path: str | PathLike[str], rows: Float[np.ndarray, "r c"], headings: slice, heading: float
) -> Float[np.ndarray, "s c"]:
    """Rows for waves of one heading (deg).

    Raises:
        InputError: There are none.
    """
    mine = rows[same_heading(rows[:, headings], heading).all(axis=1)]
    if not len(mine):
        same = np.ptp(rows[:, headings], axis=1) < HEADING_TOLERANCE
        listed = ", ".join(f"{beta:g}" for beta in np.unique(rows[same, headings.start]))
        raise InputError(str(path), [Problem("BETA", f"waves of heading {heading:g} deg", f"{listed} deg")])
    return mine
