"""Difference-frequency quadratic transfer functions from WAMIT's .12d files."""

import math
from os import PathLike

import numpy as np

from jaxhydro.environment import DOFS
from jaxhydro.interop.tables import of_heading, table_of
from jaxhydro.problems import InputError, Problem
from jaxhydro.waves.transfer import Transfer

COLUMNS = "PER1 PER2 BETA1 BETA2 I MOD PHASE RE IM"
SAME = 1e-6  # of a period


def read_transfer(
    path: str | PathLike[str],
    density: float,
    gravity: float,
    *,
    length: float = 1.0,
    heading: float = 0.0,
    newman: bool = False,
) -> Transfer:
    """The transfer function in a .12d file (WAMIT user manual, section 4.13), for waves of one `heading` (deg).

    T_ij = rho g L^k F_ij, k = 1 for forces and 2 for moments, L the file's `length` (m, ULEN), F_ij for the product of
    amplitudes A_i conj(A_j) at the periods PER1 and PER2. The file may have either half of the Hermitian table or both.
    `newman`: its diagonal alone is used (`Transfer.of`). Raises InputError with file and row.
    """
    rows = table_of(path, ".12d", COLUMNS, periods=slice(0, 2), mode=4)
    mine = of_heading(path, rows, slice(2, 4), heading)

    def wrong(expected: str, found: str, where: str) -> InputError:
        return InputError(str(path), [Problem(where, expected, found)])

    periods = np.unique(mine[:, :2])[::-1]
    periods = periods[np.r_[True, np.abs(np.diff(periods)) > SAME * periods[:-1]]]
    if len(periods) < 2:
        raise wrong("two periods or more", f"{len(periods)}", "PER1")
    first, second = (np.abs(mine[:, [i]] - periods).argmin(axis=1) for i in (0, 1))
    mode, value = mine[:, 4].astype(int) - 1, mine[:, 7] + 1j * mine[:, 8]
    n = len(periods)
    table = np.full((6, n, n), np.nan, complex)
    table[mode, second, first] = value.conj()
    table[mode, first, second] = value
    for i in range(6):
        if np.isnan(table[i]).all():  # a mode that the file leaves out
            table[i] = 0.0
    lost = np.argwhere(np.isnan(np.einsum("ikk->ik", table) if newman else table))
    if len(lost):
        i, *pair = lost[0]
        where = " and ".join(f"{periods[k]:.5g} s" for k in pair)
        raise wrong(f"all pairs of {n} periods", f"none at {where}", DOFS[i])
    if newman:
        table = np.where(np.isnan(table), 0.0, table)
    unit = density * gravity * length ** np.array([1, 1, 1, 2, 2, 2])
    return Transfer.of(2 * math.pi / periods, unit[:, None, None] * table, newman)
