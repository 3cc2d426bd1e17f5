"""Length and time scale of a platform relative to VolturnUS-S, by Froude's similarity.

A hull and its model at 1:50 then have the same numbers. Lengths in the code are those of VolturnUS-S, whose size is 1. What
is left in metres and seconds is listed in docs/constants.md.
"""

from typing import Any

from jaxtyping import Array, Float

REFERENCE_VOLUME = 20093000.0 / 1025.0  # m3, mass of VolturnUS-S over density: NREL/TP-5000-76773
REFERENCE_GRAVITY = 9.80665  # m/s2


def size_of(mass: Any, density: Any) -> Any:
    """Length scale (-) of a platform relative to VolturnUS-S.

    It is the cube root of the ratio of displaced volumes.

    Args:
        mass: Mass (kg).
        density: Density of the water (kg/m³).
    """
    return (mass / density / REFERENCE_VOLUME) ** (1 / 3)


def pace_of(size: Any, gravity: Any) -> Any:
    """Time scale (-) of a platform relative to VolturnUS-S by Froude's similarity, (L/g)^(1/2).

    Args:
        size: Length scale (-).
        gravity: Acceleration of gravity (m/s²).
    """
    return (size * (REFERENCE_GRAVITY / gravity)) ** 0.5


def entered(depth: Float[Array, "..."], width: Float[Array, ""] | float) -> Float[Array, "..."]:
    """Submerged length (m) of a body that ends at a `depth` (m) below the surface.

    It is the depth, or 0 above. Within `width` (m) below the surface the two are joined smoothly, twice continuously
    differentiable. An end at the surface or above has not entered at all; one deeper than `width` is exact.
    """
    x = depth / width
    inner = x.clip(0.0, 1.0)
    return width * (inner**3 * (6.0 - 8.0 * inner + 3.0 * inner**2) + (x - 1.0).clip(0.0))


def covered(depth: Float[Array, "..."], width: Float[Array, ""] | float) -> Float[Array, "..."]:
    """Fraction of a face that water covers: 0 at the surface and above, 1 from `width` (m) below on.

    Args:
        depth: Depth of the face (m).
        width: Depth over which it is covered (m).
    """
    inner = (depth / width).clip(0.0, 1.0)
    return inner**2 * (3.0 - 2.0 * inner)
