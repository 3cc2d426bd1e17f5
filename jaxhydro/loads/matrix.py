"""Loads whose parameters are entries of a 6 x 6 matrix, by keys such as B11 or C35."""

from collections.abc import Mapping
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.environment import DOFS
from jaxhydro.parameters import Parameter, parameters

UNITS = {
    "B": ("N s/m", "N s", "N m s/rad"),
    "Q": ("N s2/m2", "", "N m s2/rad2"),
    "A": ("kg", "kg m", "kg m2"),
    "C": ("N/m", "N", "N m/rad"),
}
"""Units of a term between two translations, a translation and a rotation, two rotations."""
Entries = Mapping[str, Float[Array, ""] | float]
"""Entries of a matrix by key: a letter, row and column from 1."""


def by_entry(symbol: str, quantity: str, cause: str) -> Any:
    """Field of a load with one parameter, `prefix.B15`, for each entry of a matrix.

    Parameters on the diagonal are not negative.

    Args:
        symbol: Key of `UNITS`.
        quantity: What the matrix is, for example "linear damping".
        cause: What the matrix multiplies, for example "velocity".
    """

    def about(load: Any, key: str) -> Parameter:
        i, j = row_and_column(key)
        return Parameter(unit(symbol, key), meaning(quantity, cause, key), 0.0 if i == j else float("-inf"))

    return parameters(about, "{prefix}.{key}")


def by_pair(symbol: str, quantity: str) -> Any:
    """Field of a load with one parameter, `prefix.B15`, for each pair of degrees of freedom.

    Args:
        symbol: Key of `UNITS`.
        quantity: What the matrix is, for example "linear damping".
    """

    def about(load: Any, key: str) -> Parameter:
        i, j = row_and_column(key)
        return Parameter(unit(symbol, key), f"{quantity} that couples {DOFS[i]} and {DOFS[j]}")

    return parameters(about, "{prefix}.{key}")


def meaning(quantity: str, cause: str, key: str) -> str:
    """Meaning of an entry of a matrix, in words.

    Examples are "linear damping in surge", and "linear damping: surge force from pitch velocity".

    Args:
        quantity: Quantity of the matrix, for example "linear damping".
        cause: Factor of the matrix, for example "velocity".
        key: Key of the entry, for example "B15".
    """
    i, j = row_and_column(key)
    if i == j:
        return f"{quantity} in {DOFS[i]}"
    return f"{quantity}: {DOFS[i]} {'force' if i < 3 else 'moment'} from {DOFS[j]} {cause}"


def row_and_column(key: str) -> tuple[int, int]:
    """Row and column, from 0, of a key such as B15."""
    return int(key[-2]) - 1, int(key[-1]) - 1


def unit(symbol: str, key: str) -> str:
    """Unit of an entry."""
    i, j = row_and_column(key)
    return UNITS[symbol][(i > 2) + (j > 2)]


def assemble(values: Entries) -> Float[Array, "6 6"]:
    """Matrix (6, 6) of entries by key; the others are 0."""
    if not values:
        return jnp.zeros((6, 6))
    basis = np.zeros((len(values), 36))
    for row, key in enumerate(values):
        i, j = row_and_column(key)
        basis[row, 6 * i + j] = 1.0
    return (jnp.stack(list(values.values())) @ basis).reshape(6, 6)


def assemble_symmetric(values: Entries) -> Float[Array, "6 6"]:
    """Symmetric matrix (6, 6) of entries above the diagonal by key; the others are 0."""
    matrix = assemble(values)
    return matrix + matrix.T
