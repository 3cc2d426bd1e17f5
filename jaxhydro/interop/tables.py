"""WAMIT's numeric output files that tabulate forces by period and heading."""

from os import PathLike
from typing import Any

import numpy as np
from jaxtyping import Float

from jaxhydro.problems import InputError, Problem

SAME = 1e-6  # of a degree


def table_of(
    path: str | PathLike[str], ending: str, columns: str, periods: slice, mode: int
) -> Float[np.ndarray, "r c"]:
    """The rows of a file of so named `columns`, those of `periods` above 0, that of the `mode` from 1 to 6; a first line of
    words (NUMHDR = 1) is passed over. Raises InputError with file and row."""
    names = columns.split()

    def wrong(expected: str, found: str, where: str = "") -> InputError:
        return InputError(str(path), [Problem(where, expected, found)])

    try:
        with open(path, encoding="utf-8", errors="replace") as lines:
            head = next(lines, "").split()
        header = bool(head) and not _is_number(head[0])
        rows = np.loadtxt(path, ndmin=2, skiprows=int(header))
    except FileNotFoundError:
        raise wrong(f"a {ending} file", "no such file") from None
    except (OSError, UnicodeDecodeError) as error:
        raise wrong(f"a {ending} file that can be read", str(getattr(error, "strerror", None) or error)) from None
    except ValueError as error:
        raise wrong(f"rows of {len(names)} numbers {columns}", str(error)) from None
    if not rows.size or rows.shape[1] != len(names):
        raise wrong(f"rows of {len(names)} numbers {columns}", f"{rows.shape[1] if rows.size else 0}")
    for bad, expected in (
        (~np.isfinite(rows).all(axis=1), "finite numbers"),
        ((rows[:, periods] <= 0).any(axis=1), "periods above 0"),
        (~np.isin(rows[:, mode], range(1, 7)), "a mode from 1 to 6"),
    ):
        if bad.any():
            row = int(np.argmax(bad))
            raise wrong(expected, " ".join(f"{x:g}" for x in rows[row]), f"row {row + 1}")
    return rows


def _is_number(word: str) -> bool:
    try:
        float(word.replace("D", "E"))
    except ValueError:
        return False
    return True


def same_heading(one: float | Float[np.ndarray, "..."], other: float) -> Any:
    """Whether waves run the same way (deg), whole turns aside."""
    return np.abs((one - other + 180) % 360 - 180) < SAME


def of_heading(
    path: str | PathLike[str], rows: Float[np.ndarray, "r c"], headings: slice, heading: float
) -> Float[np.ndarray, "s c"]:
    """The rows for waves of one heading (deg). Raises InputError where there are none."""
    mine = rows[same_heading(rows[:, headings], heading).all(axis=1)]
    if not len(mine):
        same = (np.ptp(rows[:, headings], axis=1) < SAME)
        known = ", ".join(f"{beta:g}" for beta in np.unique(rows[same, headings.start]))
        raise InputError(str(path), [Problem("BETA", f"waves of heading {heading:g} deg", f"{known} deg")])
    return mine
