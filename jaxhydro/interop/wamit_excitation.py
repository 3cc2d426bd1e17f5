"""First-order wave forces from WAMIT's .3 files."""

from os import PathLike

import numpy as np
from jaxtyping import Float

from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.wamit_tables import UNITS, contradictions, headings_in, of_heading, quantity, table_of, to_omega
from jaxhydro.waves.excitation import DirectionalExcitation, Excitation

COLUMNS = "PER BETA I MOD PHASE RE IM"


def read_excitation(
    path: str | PathLike[str],
    density: float,
    gravity: float,
    *,
    length: float = 1.0,
    heading: float = 0.0,
    by: str = "period",
    body: int | None = None,
    warnings: list[str] | None = None,
) -> Excitation:
    """Read the first-order excitation in a .3 file, for waves of one heading.

    X_i = rho g L^m (RE + i IM), m = 2 for forces and 3 for moments. It is for waves of amplitude Re A exp(i omega t) at the
    origin. Modes without a row are zero.

    Args:
        path: The file.
        density: Of the water, rho, kg/m3.
        gravity: g, m/s2.
        length: The file's unit of length L, WAMIT's ULEN, m.
        heading: BETA of the rows that are taken, deg.
        by: What the first column is: "period" (s), "rad/s" or "Hz".
        body: Number of the body, from 1; None: the file has one.
        warnings: What is doubtful is appended here.

    Raises:
        InputError: With file and row.

    References:
        WAMIT user manual, sections 3.3 and 4.13.
    """
    rows = table_of(path, ".3", COLUMNS, periods=slice(0, 1), mode=2, by=by, body=body)
    mine = of_heading(path, rows, slice(1, 2), heading)
    if warnings is not None:
        warnings += contradictions(mine, 3, str(path))
    return _of_rows(path, mine, density * gravity, length, by)


def read_directional_excitation(
    path: str | PathLike[str],
    density: float,
    gravity: float,
    *,
    length: float = 1.0,
    by: str = "period",
    body: int | None = None,
    warnings: list[str] | None = None,
) -> DirectionalExcitation:
    """Read the first-order excitation in a .3 file for waves of all its headings.

    Args:
        path: The file.
        density: Of the water, rho, kg/m3.
        gravity: g, m/s2.
        length: The file's unit of length L, WAMIT's ULEN, m.
        by: What the first column is: "period" (s), "rad/s" or "Hz".
        body: Number of the body, from 1; None: the file has one.
        warnings: What is doubtful is appended here.

    Raises:
        InputError: With file and row, or where headings have other frequencies than the first.
    """
    rows = table_of(path, ".3", COLUMNS, periods=slice(0, 1), mode=2, by=by, body=body)
    headings = headings_in(rows, slice(1, 2))
    if warnings is not None:
        warnings += contradictions(rows, 3, str(path))
    tables = [
        _of_rows(path, _once(of_heading(path, rows, slice(1, 2), heading)), density * gravity, length, by)
        for heading in headings
    ]
    try:
        return DirectionalExcitation.of(np.radians(headings), tables)
    except ValueError as error:
        raise InputError(str(path), [Problem("BETA", "the same periods for all headings", str(error))]) from None


def _once(rows: Float[np.ndarray, "r c"]) -> Float[np.ndarray, "r c"]:
    """Rows of the first spelling of a heading: a file may have the same waves at -180 and 180 degrees."""
    return rows[rows[:, 1] == rows[0, 1]]


def _of_rows(path: str | PathLike[str], mine: Float[np.ndarray, "r c"], weight: float, length: float, by: str) -> Excitation:
    """Excitation from the rows of one heading; `weight` is rho g."""

    def wrong(expected: str, found: str, where: str) -> InputError:
        return InputError(str(path), [Problem(where, expected, found)])

    column, name = np.unique(mine[:, 0]), quantity(by)
    if len(column) < 2:
        raise wrong("two periods or more" if by == "period" else "two frequencies or more", f"{len(column)}", "PER")
    mode, index = mine[:, 2].astype(int) - 1, np.searchsorted(column, mine[:, 0])
    count = np.zeros((6, len(column)), int)
    np.add.at(count, (mode, index), 1)
    for i in np.flatnonzero(count.any(axis=1)):
        if (count[i] != 1).any():
            faulty = int(np.flatnonzero(count[i] != 1)[-1 if by == "period" else 0])
            raise wrong(f"each {name} once", f"{count[i, faulty]} times {column[faulty]:.5g} {UNITS[by]}", DOFS[i])
    force = np.zeros((6, len(column)), complex)
    force[mode, index] = mine[:, 5] + 1j * mine[:, 6]
    unit = weight * length ** np.array([2, 2, 2, 3, 3, 3])
    omega = to_omega(column, by)
    order = np.argsort(omega)
    return Excitation.of(omega[order], unit[:, None] * force[:, order])
