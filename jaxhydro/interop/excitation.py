"""First-order wave forces from WAMIT's .3 files."""

import math
from os import PathLike

import numpy as np

from jaxhydro.environment import DOFS
from jaxhydro.interop.tables import of_heading, table_of
from jaxhydro.problems import InputError, Problem
from jaxhydro.waves.excitation import Excitation

COLUMNS = "PER BETA I MOD PHASE RE IM"


def read_excitation(
    path: str | PathLike[str], density: float, gravity: float, *, length: float = 1.0, heading: float = 0.0
) -> Excitation:
    """The excitation in a .3 file (WAMIT user manual, section 3.3 and 4.13), for waves of one `heading` (deg).

    X_i = rho g L^m (RE + i IM), m = 2 for forces and 3 for moments, L the file's `length` (m, ULEN), for waves of amplitude
    Re A exp(i omega t) at the origin; periods by PER. Modes without a row are none. Raises InputError with file and row.
    """
    mine = of_heading(path, table_of(path, ".3", COLUMNS, periods=slice(0, 1), mode=2), slice(1, 2), heading)

    def wrong(expected: str, found: str, where: str) -> InputError:
        return InputError(str(path), [Problem(where, expected, found)])

    periods = np.unique(mine[:, 0])[::-1]
    if len(periods) < 2:
        raise wrong("two periods or more", f"{len(periods)}", "PER")
    mode, place = mine[:, 2].astype(int) - 1, np.searchsorted(-periods, -mine[:, 0])
    count = np.zeros((6, len(periods)), int)
    np.add.at(count, (mode, place), 1)
    for i in np.flatnonzero(count.any(axis=1)):
        if (count[i] != 1).any():
            at = int(np.argmax(count[i] != 1))
            raise wrong("each period once", f"{count[i, at]} times {periods[at]:.5g} s", DOFS[i])
    force = np.zeros((6, len(periods)), complex)
    force[mode, place] = mine[:, 5] + 1j * mine[:, 6]
    unit = density * gravity * length ** np.array([2, 2, 2, 3, 3, 3])
    return Excitation.of(2 * math.pi / periods, unit[:, None] * force)
