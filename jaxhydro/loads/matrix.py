"""Entries of 6 x 6 matrices by labels such as B11 or C35."""

from collections.abc import Mapping

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.environment import DOFS

UNITS = {
    "B": ("N s/m", "N s", "N m s/rad"),
    "Q": ("N s2/m2", "", "N m s2/rad2"),
    "A": ("kg", "kg m", "kg m2"),
    "C": ("N/m", "N", "N m/rad"),
}
"""Units of a term between two translations, a translation and a rotation, two rotations."""


def place(label: str) -> tuple[int, int]:
    """Row and column, from 0, of a label that ends in two digits from 1."""
    return int(label[-2]) - 1, int(label[-1]) - 1


def unit(symbol: str, label: str) -> str:
    i, j = place(label)
    return UNITS[symbol][(i > 2) + (j > 2)]


def meaning(quantity: str, cause: str, label: str) -> str:
    """Meaning of a term, by the names of its degrees of freedom.

    Args:
        quantity: What the matrix is, for example "linear damping".
        cause: What the matrix multiplies, for example "velocity".
        label: The term's label, for example "linear_damping.B15".

    Returns:
        "linear damping in surge" on the diagonal, "linear damping: surge force from pitch velocity" off it.
    """
    i, j = place(label)
    if i == j:
        return f"{quantity} in {DOFS[i]}"
    return f"{quantity}: {DOFS[i]} {'force' if i < 3 else 'moment'} from {DOFS[j]} {cause}"


def assemble(values: Mapping[str, Float[Array, ""]]) -> Float[Array, "6 6"]:
    """Matrix (6, 6) of labelled entries; the others are 0."""
    if not values:
        return jnp.zeros((6, 6))
    basis = np.zeros((len(values), 36))
    for row, label in enumerate(values):
        i, j = place(label)
        basis[row, 6 * i + j] = 1.0
    return (jnp.stack([jnp.asarray(v) for v in values.values()]) @ basis).reshape(6, 6)
