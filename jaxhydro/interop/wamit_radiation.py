"""Added mass and radiation damping from WAMIT's .1 files.

Conventions are those of WAMIT's manual, as HydroDyn reads them (WAMIT.f90).
"""

import math
from os import PathLike
from pathlib import Path

import numpy as np

from jaxhydro.errors import InputError, Problem, shown
from jaxhydro.interop.radiation_coefficients import RadiationCoefficients
from jaxhydro.interop.wamit_tables import UNITS, quantity, several_bodies, to_omega

MIN_FREQUENCIES = 4  # frequencies


def read_wamit(
    path: str | PathLike[str], density: float, length: float = 1.0, by: str = "period", body: int | None = None
) -> RadiationCoefficients:
    """Read the coefficients in a `.1` file of rows PER I J A B: A rho L^k and B rho omega L^k.

    k is 3 between translations, 5 between rotations and 4 across. A PER below 0 stands for frequency 0 and PER = 0 for an
    infinite frequency, whatever the column is (WAMIT user manual, section 4.2); these rows have no B. Pairs without a row are
    zero. A first row of words (NUMHDR = 1) is passed over.

    Args:
        path: The file.
        density: Of the water, rho, kg/m3.
        length: The file's unit of length L, WAMIT's ULEN, m.
        by: What the first column is: "period" (s), "rad/s" or "Hz".
        body: Number of the body, from 1, whose own coefficients are taken; None: the file has one.

    Raises:
        InputError: With the line that is wrong.
    """
    source = str(path)
    power = np.array([[3 + (i > 2) + (j > 2) for j in range(6)] for i in range(6)])
    unit = density * length**power
    mass: dict[float, np.ndarray] = {}
    damping: dict[float, np.ndarray] = {}
    read_rows: set[tuple[float, int, int]] = set()
    before, highest = 6 * ((body or 1) - 1), 0
    for number, line in enumerate(_lines(path), 1):
        words = line.replace("D", "E").replace("d", "e").split()
        if not words or (number == 1 and not _is_number(words[0])):
            continue
        period, i, j, *values = _row(source, number, words, body)
        if (period, i, j) in read_rows:
            again = f"{quantity(by)} {period:g} {UNITS[by]}, {i} {j} again"
            raise _wrong(source, number, f"each {quantity(by)} and pair once", again)
        read_rows.add((period, i, j))
        highest = max(highest, i, j)
        if not (before < i <= before + 6 and before < j <= before + 6):
            continue
        mass.setdefault(period, np.zeros((6, 6)))[i - 1 - before, j - 1 - before] = values[0]
        if period > 0:
            damping.setdefault(period, np.zeros((6, 6)))[i - 1 - before, j - 1 - before] = values[1]
    if body is not None and not mass:
        raise InputError(source, [Problem("body", f"rows of body {body}", f"{math.ceil(highest / 6)} bodies")])
    column = np.array(sorted(damping))
    if len(column) < MIN_FREQUENCIES:
        expected = f"added mass and damping at {MIN_FREQUENCIES} {'periods' if by == 'period' else 'frequencies'} or more"
        raise InputError(source, [Problem("", expected, f"{len(column)}")])
    omega = to_omega(column, by)
    order = np.argsort(omega)
    omega, column = omega[order], column[order]
    below = [period for period in mass if period < 0]
    return RadiationCoefficients(
        omega,
        unit * np.stack([mass[period] for period in column]),
        unit * omega[:, None, None] * np.stack([damping[period] for period in column]),
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


def _row(source: str, number: int, words: list[str], body: int | None) -> list:
    """PER, I, J and one or two values of a row; I and J above 6 only where a `body` is chosen."""
    shape = "PER I J A B" if not _is_number(words[0]) or float(words[0]) > 0 else "PER I J A"
    if not all(map(_is_number, words)):
        bad = next(word for word in words if not _is_number(word))
        raise _wrong(source, number, f"finite numbers {shape}", shown(bad))
    if len(words) != 5 and not (len(words) == 4 and float(words[0]) <= 0):
        raise _wrong(source, number, f"{len(shape.split())} numbers {shape}", f"{len(words)}")
    whole = all(word.isdigit() and int(word) > 0 for word in words[1:3])
    if not whole or (body is None and max(map(int, words[1:3])) > 6):
        hint = several_bodies(max(map(int, words[1:3]))) if whole else ""
        raise _wrong(source, number, "motions I and J of one body, 1 to 6", f"{words[1]} {words[2]}", hint)
    return [float(words[0]), int(words[1]), int(words[2]), *map(float, words[3:])]


def _is_number(word: str) -> bool:
    try:
        return math.isfinite(float(word))
    except ValueError:
        return False


def _wrong(source: str, number: int, expected: str, found: str, hint: str = "") -> InputError:
    return InputError(source, [Problem(f"line {number}", expected, found, hint)])
