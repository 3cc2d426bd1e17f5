"""First-order wave forces on the strips of a platform at rest, taken off where a table replaces them."""

from collections.abc import Mapping
from typing import Any, Literal, NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

Part = Literal["strips", "ends", "covered_ends"]
PerCoefficient = Mapping[tuple[str, str], Float[Array, "6"]]
"""Force and moment (N, N m, earth axes) per coefficient, by group and kind (t, z)."""
COVERED = ("pontoon ends", "share")  # of `CoveredEnds`, whose coefficient is not one of a group


class ForcesAtRest(NamedTuple):
    """First-order wave forces on a platform at rest that its strips and ends do not keep.

    Attributes:
        strips: Forces per Ca of strips.
        ends: Forces per Ca of ends.
        covered_ends: Force per share of covered ends, with the key `COVERED`.
    """

    strips: PerCoefficient
    ends: PerCoefficient
    covered_ends: PerCoefficient


def taken_off(coefficients: Mapping[tuple[str, str], Any], forces: PerCoefficient) -> Float[Array, "6"]:
    """Minus the force (N, N m, earth axes) that goes with some coefficients."""
    return -sum((coefficients[key] * force for key, force in forces.items()), jnp.zeros(6))
