"""Difference-frequency quadratic transfer functions from WAMIT's .12d files."""

from os import PathLike

import numpy as np
from jaxtyping import Complex, Float, Int

from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.wamit_tables import UNITS, contradictions, headings_in, of_heading, table_of, to_omega
from jaxhydro.waves.directional_transfer import DirectionalTransfer
from jaxhydro.waves.quadratic_transfer import Transfer

COLUMNS = "PER1 PER2 BETA1 BETA2 I MOD PHASE RE IM"
FREQUENCY_TOLERANCE = 1e-6  # of a period or frequency
MAX_ASYMMETRY = 0.01  # of the larger of two values, by which they may differ and still be conjugate
NEGLIGIBLE_FORCE = 1e-4  # of the largest force or moment: smaller differences are rounding


def read_transfer(
    path: str | PathLike[str],
    density: float,
    gravity: float,
    *,
    length: float = 1.0,
    heading: float = 0.0,
    newman: bool = False,
    by: str = "period",
    body: int | None = None,
    warnings: list[str] | None = None,
) -> Transfer:
    """Read the difference-frequency transfer function in a .12d file, for waves of one heading.

    T_ij = rho g L^k F_ij, k = 1 for forces and 2 for moments. F_ij is for the product of amplitudes A_i conj(A_j) at PER1 and
    PER2. The file may have either half of the Hermitian table or both, which then have to be conjugate.

    Args:
        path: The file.
        density: Of the water, rho, kg/m3.
        gravity: g, m/s2.
        length: The file's unit of length L, WAMIT's ULEN, m.
        heading: BETA1 and BETA2 of the rows that are taken, deg.
        newman: Use the diagonal alone (`Transfer.of`).
        by: What the first two columns are: "period" (s), "rad/s" or "Hz".
        body: Number of the body, from 1; None: the file has one.
        warnings: What is doubtful is appended here.

    Raises:
        InputError: With file and row, or with the pair that is given twice and contradicts itself.

    References:
        WAMIT user manual, section 4.13.
    """
    rows = table_of(path, ".12d", COLUMNS, periods=slice(0, 2), mode=4, by=by, body=body)
    mine = of_heading(path, rows, slice(2, 4), heading)
    if warnings is not None:
        warnings += contradictions(mine, 5, str(path))
    omega, table = _of_rows(path, mine, newman, by)
    return Transfer.of(omega, _unit(density * gravity, length) * table, newman)


def read_directional_transfer(
    path: str | PathLike[str],
    density: float,
    gravity: float,
    *,
    length: float = 1.0,
    newman: bool = False,
    by: str = "period",
    body: int | None = None,
    warnings: list[str] | None = None,
) -> DirectionalTransfer:
    """Read the difference-frequency transfer function in a .12d file, for waves of each of its headings.

    Rows for pairs of waves of two headings are left out.

    Args:
        path: The file.
        density: Of the water, rho, kg/m3.
        gravity: g, m/s2.
        length: The file's unit of length L, WAMIT's ULEN, m.
        newman: Use the diagonal alone (`Transfer.of`).
        by: What the first two columns are: "period" (s), "rad/s" or "Hz".
        body: Number of the body, from 1; None: the file has one.
        warnings: What is doubtful is appended here.

    Raises:
        InputError: As `read_transfer`, or where headings have other frequencies than the first.
    """
    rows = table_of(path, ".12d", COLUMNS, periods=slice(0, 2), mode=4, by=by, body=body)
    headings = headings_in(rows, slice(2, 4))
    if not headings.size:
        raise InputError(str(path), [Problem("BETA1", "rows of two waves of one heading", "none")])
    if warnings is not None:
        warnings += contradictions(rows, 5, str(path))
    unit, tables = _unit(density * gravity, length), []
    for heading in headings:
        mine = of_heading(path, rows, slice(2, 4), heading)
        omega, table = _of_rows(path, mine[(mine[:, 2:4] == mine[0, 2:4]).all(axis=1)], newman, by)
        tables.append((omega, unit * table))
    omega = tables[0][0]
    if any(
        frequencies.shape != omega.shape or not np.allclose(frequencies, omega, rtol=FREQUENCY_TOLERANCE, atol=0)
        for frequencies, _ in tables
    ):
        raise InputError(str(path), [Problem("BETA1", "the same periods for all headings", "others at some")])
    return DirectionalTransfer.of(omega, np.radians(headings), [table for _, table in tables], newman)


def _unit(weight: float, length: float) -> Float[np.ndarray, "6 1 1"]:
    """Unit of forces and moments; `weight` is rho g."""
    return (weight * length ** np.array([1, 1, 1, 2, 2, 2]))[:, None, None]


def _of_rows(
    path: str | PathLike[str], mine: Float[np.ndarray, "r c"], newman: bool, by: str
) -> tuple[Float[np.ndarray, " n"], Complex[np.ndarray, "6 n n"]]:
    """Frequencies (rad/s), ascending, and F of the rows of one heading."""

    def wrong(expected: str, found: str, where: str) -> InputError:
        return InputError(str(path), [Problem(where, expected, found)])

    column = np.unique(mine[:, :2])[::-1]
    column = column[np.r_[True, np.abs(np.diff(column)) > FREQUENCY_TOLERANCE * column[:-1]]]
    n, many = len(column), "periods" if by == "period" else "frequencies"
    if n < 2:
        raise wrong(f"two {many} or more", f"{n}", "PER1")
    first, second = (np.abs(mine[:, [i]] - column).argmin(axis=1) for i in (0, 1))
    mode, value = mine[:, 4].astype(int) - 1, mine[:, 7] + 1j * mine[:, 8]

    def named(pair: np.ndarray) -> str:
        return " and ".join(f"{column[k]:.5g} {UNITS[by]}" for k in pair)

    if (against := _contradicting(mode, first, second, value)) is not None:
        first_value, second_value, i, *pair = against
        expected = f"one value for {named(np.array(pair))}, given twice, the halves of the table conjugate"
        raise wrong(expected, f"{first_value:.5g} and {second_value:.5g} (as (i, j) both)", DOFS[i])
    table = np.full((6, n, n), np.nan, complex)
    table[mode, second, first] = value.conj()
    table[mode, first, second] = value
    for i in range(6):
        if np.isnan(table[i]).all():  # a mode that the file leaves out
            table[i] = 0.0
    lost = np.argwhere(np.isnan(np.einsum("ikk->ik", table) if newman else table))
    if len(lost):
        i, *pair = lost[0]
        raise wrong(f"all pairs of {n} {many}", f"none at {named(np.array(pair))}", DOFS[i])
    if newman:
        table = np.where(np.isnan(table), 0.0, table)
    omega = to_omega(column, by)
    order = np.argsort(omega)
    return omega[order], table[:, order[:, None], order]


def _contradicting(
    mode: Int[np.ndarray, " r"], first: Int[np.ndarray, " r"], second: Int[np.ndarray, " r"], value: Complex[np.ndarray, " r"]
) -> tuple[complex, complex, int, int, int] | None:
    """The two values of one pair of frequencies that contradict each other most; None: all agree.

    All are taken to the half of the table in which the first index is not the larger. A value on the diagonal has to be real,
    as it is its own conjugate. Differences are compared as fractions of the allowed one.

    Returns:
        Both values, the mode, and the indices of the pair.
    """
    low, high = np.minimum(first, second), np.maximum(first, second)
    turned = np.where(first <= second, value, value.conj())
    worst: tuple[float, tuple[complex, complex, int, int, int] | None] = (1.0, None)
    for i in np.unique(mode):
        of_mode = np.flatnonzero(mode == i)
        # a mode that symmetry makes zero is rounding: forces and moments are each beside the largest of their kind
        largest = np.abs(value[(mode > 2) == (i > 2)]).max()
        order = of_mode[np.lexsort((high[of_mode], low[of_mode]))]
        same = (np.diff(low[order]) == 0) & (np.diff(high[order]) == 0)
        pairs = [(turned[order[k]], turned[order[k + 1]], order[k]) for k in np.flatnonzero(same)]
        pairs += [(turned[k], turned[k].conj(), k) for k in of_mode[low[of_mode] == high[of_mode]]]
        for first_value, second_value, k in pairs:
            limit = MAX_ASYMMETRY * max(abs(first_value), abs(second_value)) + NEGLIGIBLE_FORCE * largest
            if limit > 0 and (excess := abs(first_value - second_value) / limit) > worst[0]:
                worst = (excess, (complex(first_value), complex(second_value), int(i), int(low[k]), int(high[k])))
    return worst[1]
