"""WAMIT's `.1` file: added mass and radiation damping, by the conventions of its manual as HydroDyn reads them (WAMIT.f90)."""

import math
from os import PathLike
from pathlib import Path

import numpy as np

from jaxhydro.interop.coefficients import RadiationCoefficients
from jaxhydro.problems import InputError, Problem, shown

FEWEST = 4  # frequencies


def read_wamit(path: str | PathLike[str], density: float, length: float = 1.0) -> RadiationCoefficients:
    """The coefficients in a `.1` file of rows PER I J A B, made dimensional by the water's `density` (kg/m3) and `length`
    (m), WAMIT's ULEN: A rho L^k and B rho omega L^k, k = 3 between translations, 5 between rotations and 4 across.

    PER is the period (s); below 0 it stands for frequency 0 and at 0 for an infinite one, and these rows have no B. Pairs
    without a row are zero, and a first row of words (NUMHDR = 1) is passed over. Raises InputError with the line that is
    wrong; for files by frequency (IPEROUT other than 1), which no row tells from periods, there is no check.
    """
    source = str(path)
    power = np.array([[3 + (i > 2) + (j > 2) for j in range(6)] for i in range(6)])
    unit = density * length**power
    mass: dict[float, np.ndarray] = {}
    damping: dict[float, np.ndarray] = {}
    seen: set[tuple[float, int, int]] = set()
    for number, line in enumerate(_lines(path), 1):
        words = line.replace("D", "E").replace("d", "e").split()
        if not words or (number == 1 and not _is_number(words[0])):
            continue
        period, i, j, *values = _row(source, number, words)
        if (period, i, j) in seen:
            raise _wrong(source, number, "each period and pair once", f"period {period:g} s, {i} {j} again")
        seen.add((period, i, j))
        mass.setdefault(period, np.zeros((6, 6)))[i - 1, j - 1] = values[0]
        if period > 0:
            damping.setdefault(period, np.zeros((6, 6)))[i - 1, j - 1] = values[1]
    periods = sorted(damping, reverse=True)
    if len(periods) < FEWEST:
        raise InputError(source, [Problem("", f"added mass and damping at {FEWEST} periods or more", f"{len(periods)}")])
    omega = 2 * math.pi / np.array(periods)
    below = [period for period in mass if period < 0]
    return RadiationCoefficients(
        omega,
        unit * np.stack([mass[period] for period in periods]),
        unit * omega[:, None, None] * np.stack([damping[period] for period in periods]),
        unit * mass[0.0] if 0.0 in mass else None,
        unit * mass[below[0]] if below else None,
    )


def _lines(path: str | PathLike[str]) -> list[str]:
    try:
        return Path(path).read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError as error:
        found = "no such file" if isinstance(error, FileNotFoundError) else str(error.strerror)
        raise InputError(str(path), [Problem("", "a WAMIT .1 file", found)]) from None
    except ValueError as error:
        raise InputError(str(path), [Problem("", "a WAMIT .1 file", str(error))]) from None


def _row(source: str, number: int, words: list[str]) -> list:
    """PER, I, J and one or two values of a row."""
    shape = "PER I J A B" if not _is_number(words[0]) or float(words[0]) > 0 else "PER I J A"
    if not all(map(_is_number, words)):
        bad = next(word for word in words if not _is_number(word))
        raise _wrong(source, number, f"finite numbers {shape}", shown(bad))
    if len(words) != 5 and not (len(words) == 4 and float(words[0]) <= 0):
        raise _wrong(source, number, f"{len(shape.split())} numbers {shape}", f"{len(words)}")
    if not (set(words[1:3]) <= set("123456")):
        raise _wrong(source, number, "motions I and J of one body, 1 to 6", f"{words[1]} {words[2]}")
    return [float(words[0]), int(words[1]), int(words[2]), *map(float, words[3:])]


def _is_number(word: str) -> bool:
    try:
        return math.isfinite(float(word))
    except ValueError:
        return False


def _wrong(source: str, number: int, expected: str, found: str) -> InputError:
    return InputError(source, [Problem(f"line {number}", expected, found)])
