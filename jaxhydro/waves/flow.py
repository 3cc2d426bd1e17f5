"""How water moves: at points in space, and past the strips and ends of a moving platform."""

import equinox as eqx
from jaxtyping import Array, Float


class Cylinders(eqx.Module):
    """Which points are on vertical circular cylinders that diffract waves: radii (m), and by point an index into them or -1.

    `lag` False drops the phase of the force, `bound` False the acceleration of bound waves, both as OpenFAST does. `ramp`
    asks for `Flow.tuned`.
    """

    radius: Float[Array, " c"]
    of: tuple[int, ...] = eqx.field(static=True)
    lag: bool = eqx.field(static=True, default=True)
    bound: bool = eqx.field(static=True, default=True)
    ramp: bool = eqx.field(static=True, default=False)


class Flow(eqx.Module):
    """Water at points: velocity (m/s), acceleration (m/s2), dynamic pressure over density (m2/s2).

    Vectors have components along `axes`, unit vectors in earth axes; None: along earth axes themselves.

    `diffracted` (m/s2) is what the displaced mass of a cylinder is to be multiplied by for its excitation, the inertia
    coefficient of MacCamy and Fuchs included: zero at points that are on none, None where there are none. Its vertical
    component, of which a cylinder that leans takes what is across it, has the same coefficient. `tuned` (m/s2) is the
    acceleration in waves that are long for the cylinder, where it was asked for: see `diffraction.long_waves`.
    """

    velocity: Float[Array, "a n"]
    acceleration: Float[Array, "a n"]
    pressure: Float[Array, " n"]
    diffracted: Float[Array, "a n"] | None = None
    tuned: Float[Array, "a n"] | None = None
    axes: Float[Array, "3 a"] | None = None

    def weakened(self, share: Float[Array, ""]) -> "Flow":
        """The same velocities, a share (-) of accelerations and pressures."""
        diffracted, tuned = (None if field is None else share * field for field in (self.diffracted, self.tuned))
        return Flow(self.velocity, share * self.acceleration, share * self.pressure, diffracted, tuned, self.axes)

    def earth(self) -> "Flow":
        """The same along earth axes."""
        if (axes := self.axes) is None:
            return self
        extra = (None if field is None else axes @ field for field in (self.diffracted, self.tuned))
        return Flow(axes @ self.velocity, axes @ self.acceleration, self.pressure, *extra)


class StripFlow(eqx.Module):
    """Flow past strips along their two directions.

    `relative` is the water's velocity less the strip's (m/s), `acceleration` the water's (m/s2; None in still water),
    `diffracted`, `tuned` and `pressure` are those of `Flow`.
    """

    relative: Float[Array, "2 n"]
    acceleration: Float[Array, "2 n"] | None
    diffracted: Float[Array, "2 n"] | None = None
    tuned: Float[Array, "2 n"] | None = None
    pressure: Float[Array, " n"] | None = None


class EndFlow(eqx.Module):
    """The same for the ends of columns, along their axes; `pressure` is the dynamic pressure over density (m2/s2), `wet` 1
    under water and 0 above."""

    relative: Float[Array, " m"]
    acceleration: Float[Array, " m"] | None
    pressure: Float[Array, " m"] | None
    wet: Float[Array, " m"]
