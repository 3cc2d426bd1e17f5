"""Water velocity, acceleration and pressure at points, and flow past strips and ends."""

import equinox as eqx
from jaxtyping import Array, Float


class Cylinders(eqx.Module):
    """Vertical circular cylinders that diffract waves, and which points lie on them.

    Attributes:
        radius: Radii (m), (c,).
        of: Index into `radius` by point; -1 for a point on no cylinder.
        lag: Whether the force has its phase lag; False as in OpenFAST.
        bound: Whether the acceleration of bound waves acts; False as in OpenFAST.
        ramp: Whether `Flow.tuned` is computed.
    """

    radius: Float[Array, " c"]
    of: tuple[int, ...] = eqx.field(static=True)
    lag: bool = eqx.field(static=True, default=True)
    bound: bool = eqx.field(static=True, default=True)
    ramp: bool = eqx.field(static=True, default=False)


class Flow(eqx.Module):
    """Water velocity, acceleration and dynamic pressure at points.

    Attributes:
        velocity: Velocity (m/s), (a, n), with components along `axes`.
        acceleration: Acceleration (m/s²), (a, n).
        pressure: Dynamic pressure over density (m²/s²), (n,).
        diffracted: Acceleration times MacCamy and Fuchs' inertia coefficient (m/s²), (a, n). Times the displaced mass of a
            cylinder it is the excitation. Zero at points on no cylinder; None without cylinders. A leaning cylinder takes
            the vertical component across it with the same coefficient.
        tuned: Acceleration in waves that are long for the cylinder (m/s²), or None: see `diffraction.long_waves`.
        axes: Unit vectors of the components in earth axes, (3, a); None: earth axes.
    """

    velocity: Float[Array, "a n"]
    acceleration: Float[Array, "a n"]
    pressure: Float[Array, " n"]
    diffracted: Float[Array, "a n"] | None = None
    tuned: Float[Array, "a n"] | None = None
    axes: Float[Array, "3 a"] | None = None

    def weakened(self, share: Float[Array, ""]) -> "Flow":
        """The same velocities, with accelerations and pressures times `share` (-)."""
        diffracted, tuned = (None if field is None else share * field for field in (self.diffracted, self.tuned))
        return Flow(self.velocity, share * self.acceleration, share * self.pressure, diffracted, tuned, self.axes)

    def earth(self) -> "Flow":
        """The same flow along earth axes."""
        if (axes := self.axes) is None:
            return self
        extra = (None if field is None else axes @ field for field in (self.diffracted, self.tuned))
        return Flow(axes @ self.velocity, axes @ self.acceleration, self.pressure, *extra)


class StripFlow(eqx.Module):
    """Flow past strips along their two directions.

    Attributes:
        relative: Velocity of the water relative to the strip (m/s), (2, n).
        acceleration: Acceleration of the water (m/s²), (2, n); None in still water.
        diffracted: As in `Flow`.
        tuned: As in `Flow`.
        pressure: Dynamic pressure over density (m²/s²), (n,).
    """

    relative: Float[Array, "2 n"]
    acceleration: Float[Array, "2 n"] | None
    diffracted: Float[Array, "2 n"] | None = None
    tuned: Float[Array, "2 n"] | None = None
    pressure: Float[Array, " n"] | None = None


class EndFlow(eqx.Module):
    """Flow past the ends of columns and pontoons along their axes.

    Attributes:
        relative: Velocity of the water relative to the end (m/s), (m,).
        acceleration: Acceleration of the water (m/s²), (m,); None in still water.
        pressure: Dynamic pressure over density (m²/s²), (m,); None in still water.
        wet: 1 under water, 0 above, (m,).
    """

    relative: Float[Array, " m"]
    acceleration: Float[Array, " m"] | None
    pressure: Float[Array, " m"] | None
    wet: Float[Array, " m"]
