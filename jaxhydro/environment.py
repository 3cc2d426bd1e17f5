"""The water and the gravity that a platform floats in."""

import equinox as eqx
from jaxtyping import Array, Float

STANDARD_GRAVITY = 9.80665  # m/s2

DOFS = ("surge", "sway", "heave", "roll", "pitch", "yaw")
"""Degrees of freedom of the reference point, always in this order on the last axis."""


class Environment(eqx.Module):
    """Water density (kg/m3), depth (m) and gravity (m/s2)."""

    density: float | Float[Array, ""] = 1025.0
    depth: float | Float[Array, ""] = 200.0
    gravity: float | Float[Array, ""] = STANDARD_GRAVITY
