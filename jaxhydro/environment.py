"""Water and gravity; names of the degrees of freedom."""

import equinox as eqx
from jaxtyping import Array, Float

STANDARD_GRAVITY = 9.80665  # m/s2

DOFS = ("surge", "sway", "heave", "roll", "pitch", "yaw")
"""Degrees of freedom of the reference point, always in this order on the last axis."""


class Environment(eqx.Module):
    """Water and gravity.

    Attributes:
        density: Density of the water (kg/m³).
        depth: Water depth (m).
        gravity: Acceleration of gravity (m/s²).
    """

    density: float | Float[Array, ""] = 1025.0
    depth: float | Float[Array, ""] = 200.0
    gravity: float | Float[Array, ""] = STANDARD_GRAVITY
