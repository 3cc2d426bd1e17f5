"""How water moves: at points in space, and past the strips and ends of a moving platform."""

import equinox as eqx
from jaxtyping import Array, Float


class Flow(eqx.Module):
    """Water at points, along earth axes: velocity (m/s), acceleration (m/s2), dynamic pressure over density (m2/s2)."""

    velocity: Float[Array, "3 n"]
    acceleration: Float[Array, "3 n"]
    pressure: Float[Array, " n"]


class StripFlow(eqx.Module):
    """Flow past strips along their two directions.

    `relative` is the water's velocity less the strip's (m/s), `acceleration` the water's (m/s2; None in still water).
    """

    relative: Float[Array, "2 n"]
    acceleration: Float[Array, "2 n"] | None


class EndFlow(eqx.Module):
    """The same for the ends of columns, along their axes; `pressure` is the dynamic pressure over density (m2/s2), `wet` 1
    under water and 0 above."""

    relative: Float[Array, " m"]
    acceleration: Float[Array, " m"] | None
    pressure: Float[Array, " m"] | None
    wet: Float[Array, " m"]
