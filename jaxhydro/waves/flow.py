"""Water velocity, acceleration and pressure at points, and flow past strips and ends."""

from dataclasses import replace

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float


class Cylinders(eqx.Module):
    """Vertical circular cylinders that diffract waves, and which points lie on them.

    Attributes:
        radius: Radii (m), (c,).
        radius_index: Index into `radius` by point; -1 for a point on no cylinder.
        lag: Whether the force has its phase lag; False as in OpenFAST.
        bound: Whether the acceleration of bound waves acts; False as in OpenFAST.
        ramp: Whether `Flow.tuned` is computed.
    """

    radius: Float[Array, " c"]
    radius_index: tuple[int, ...] = eqx.field(static=True)
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
        gradient: Slope (1/s) of each component of the velocity along each axis, (a, a, n), symmetric as the flow has no
            rotation; None where it is not asked for.
    """

    velocity: Float[Array, "a n"]
    acceleration: Float[Array, "a n"]
    pressure: Float[Array, " n"]
    diffracted: Float[Array, "a n"] | None = None
    tuned: Float[Array, "a n"] | None = None
    axes: Float[Array, "3 a"] | None = None
    gradient: Float[Array, "a a n"] | None = None

    def convected(self, share: Float[Array, ""], cylinders: Cylinders | None = None) -> "Flow":
        """The flow with the second-order part of its accelerations and pressures.

        It adds `share` times the convective acceleration grad(v) v, and takes off `share` times the pressure v²/2 over
        density. Cylinders are excited by twice the convective acceleration, their coefficient in long waves.

        Args:
            share: Fraction (-) of the second-order part.
            cylinders: Which points diffract the waves, as in `AbstractSea.flow`.

        References:
            Rainey (1989), Journal of Fluid Mechanics 204, 295-324, section 2.
        """
        assert self.gradient is not None
        convective = share * (self.gradient * self.velocity[None]).sum(axis=1)
        pressure = self.pressure - 0.5 * share * (self.velocity**2).sum(axis=0)
        diffracted, tuned = self.diffracted, self.tuned
        if diffracted is not None and cylinders is not None:
            on_cylinders = jnp.where(jnp.array(cylinders.radius_index) >= 0, convective, 0.0)
            diffracted = diffracted + 2 * on_cylinders
            tuned = None if tuned is None else tuned + on_cylinders
        return replace(self, acceleration=self.acceleration + convective, pressure=pressure, diffracted=diffracted, tuned=tuned)

    def weakened(self, share: Float[Array, ""]) -> "Flow":
        """The same velocities, with accelerations and pressures times `share` (-)."""
        diffracted, tuned = (None if field is None else share * field for field in (self.diffracted, self.tuned))
        acceleration, pressure = share * self.acceleration, share * self.pressure
        return replace(self, acceleration=acceleration, pressure=pressure, diffracted=diffracted, tuned=tuned)

    def earth(self) -> "Flow":
        """The same flow along earth axes."""
        if (axes := self.axes) is None:
            return self
        diffracted, tuned = (None if field is None else axes @ field for field in (self.diffracted, self.tuned))
        gradient = None if self.gradient is None else jnp.einsum("ia,abn,jb->ijn", axes, self.gradient, axes)
        return Flow(axes @ self.velocity, axes @ self.acceleration, self.pressure, diffracted, tuned, None, gradient)


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
