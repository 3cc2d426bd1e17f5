"""First-order wave forces from WAMIT's .3 files."""

from os import PathLike

import numpy as np

from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.wamit_tables import UNITS, contradictions, of_heading, quantity, table_of, to_omega
from jaxhydro.waves.excitation import Excitation

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

    X_i = rho g L^m (RE + i IM), m = 2 for forces and 3 for moments, for waves of amplitude Re A exp(i omega t) at the
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

    def wrong(expected: str, found: str, where: str) -> InputError:
        return InputError(str(path), [Problem(where, expected, found)])

    column, name = np.unique(mine[:, 0]), quantity(by)
    if len(column) < 2:
        raise wrong("two periods or more" if by == "period" else "two frequencies or more", f"{len(column)}", "PER")
    mode, place = mine[:, 2].astype(int) - 1, np.searchsorted(column, mine[:, 0])
    count = np.zeros((6, len(column)), int)
    np.add.at(count, (mode, place), 1)
    for i in np.flatnonzero(count.any(axis=1)):
        if (count[i] != 1).any():
            at = int(np.flatnonzero(count[i] != 1)[-1 if by == "period" else 0])
            raise wrong(f"each {name} once", f"{count[i, at]} times {column[at]:.5g} {UNITS[by]}", DOFS[i])
    if warnings is not None:
        warnings += contradictions(mine, 3, str(path))
    force = np.zeros((6, len(column)), complex)
    force[mode, place] = mine[:, 5] + 1j * mine[:, 6]
    unit = density * gravity * length ** np.array([2, 2, 2, 3, 3, 3])
    omega = to_omega(column, by)
    order = np.argsort(omega)
    return Excitation.of(omega[order], unit[:, None] * force[:, order])
