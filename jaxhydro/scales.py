"""Length and time scale of a platform relative to VolturnUS-S, by Froude's similarity.

A hull and its model at 1:50 then have the same numbers. Lengths in the code are those of VolturnUS-S, whose size is 1. What
is left in metres and seconds is listed in docs/constants.md.
"""

from typing import Any

from jaxtyping import Array, Float

REFERENCE_VOLUME = 20093000.0 / 1025.0  # m3, mass of VolturnUS-S over density: NREL/TP-5000-76773
REFERENCE_GRAVITY = 9.80665  # m/s2


def size_of(mass: Any, density: Any) -> Any:
    """Length (-) over that of VolturnUS-S: the cube root of mass (kg) over the water's density (kg/m3), over the same there."""
    return (mass / density / REFERENCE_VOLUME) ** (1 / 3)


def pace_of(size: Any, gravity: Any) -> Any:
    """Time (-) over that of VolturnUS-S, by Froude: (L/g)^(1/2)."""
    return (size * (REFERENCE_GRAVITY / gravity)) ** 0.5


def entered(depth: Float[Array, "..."], width: Float[Array, ""] | float) -> Float[Array, "..."]:
    """How much (m) lies below the surface of what ends at a `depth` (m) under it: the depth, or 0 above.

    Within `width` (m) under the surface the two are joined smoothly, twice continuously differentiable. So what ends at still
    water or above has not entered at all, and what ends deeper than that is exact.
    """
    x = depth / width
    inner = x.clip(0.0, 1.0)
    return width * (inner**3 * (6.0 - 8.0 * inner + 3.0 * inner**2) + (x - 1.0).clip(0.0))


def covered(depth: Float[Array, "..."], width: Float[Array, ""] | float) -> Float[Array, "..."]:
    """Share (-) that water covers of a face at a `depth` (m): 0 at the surface and above, 1 from `width` (m) under it on."""
    inner = (depth / width).clip(0.0, 1.0)
    return inner**2 * (3.0 - 2.0 * inner)
