"""Motion, submerged geometry and flow at one instant, as loads read them."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from jaxhydro.environment import Environment
from jaxhydro.hull.hull import Hull, Wetted
from jaxhydro.hull.submerged import EndShape, Lines, StripShape
from jaxhydro.loads.forces_at_rest import ForcesAtRest
from jaxhydro.loads.slender_flow import SlenderFlow
from jaxhydro.waves.flow import EndFlow, StripFlow


class Instant(eqx.Module):
    """Motion, submerged geometry and flow at one instant: everything that a load may read.

    It is computed once per evaluation of the equation of motion.

    Attributes:
        time: Time (s).
        position: Surge, sway, heave (m), roll, pitch, yaw (rad) of the reference point.
        rotation: Rotation matrix from body to earth axes.
        velocity: Velocity of the reference point and angular velocity, body axes (m/s, rad/s).
        environment: Water and gravity.
        hull: The hull.
        wetted: Submerged part of each load element.
        added_mass_part: Part of each load element that has added mass: the submerged one; where computed wave forces replace
            those of strips, the one that is wet at rest.
        added_mass_volume: Volume (m³) of that part by strip, (n,).
        part_at_rest: Part of each load element that is wet at rest, or None. It is stated where a table's added mass replaces
            that of the elements alone, and strips keep the forces of changing wetting.
        strip_shape: Submerged part of each strip.
        end_shape: Areas of ends and faces.
        strip_flow: Flow past each strip.
        end_flow: Flow past each end and face.
        lines: Distances and centripetal accelerations of strips and ends.
        drift: Squared wave envelopes (m²) of `AbstractSea.drift`, or None.
        excitation: First-order forces (N, N m) of `AbstractSea.excitation`, or None.
        at_rest: First-order forces at rest that strips and ends do not keep, or None.
        slender: Flow past slender members to second order, or None.
        lid: Pressure over density (m²/s²) and acceleration (m/s², body axes) of the water at the points of `Hull.leaning`.
        matrix_axes: Rotation matrix from body axes to those that matrices of added mass and radiation are along; None: body
            axes.
    """

    time: Float[Array, ""]
    position: Float[Array, "6"]
    rotation: Float[Array, "3 3"]
    velocity: Float[Array, "6"]
    environment: Environment
    hull: Hull
    wetted: Wetted
    added_mass_part: Wetted
    added_mass_volume: Float[Array, " n"]
    strip_shape: StripShape
    end_shape: EndShape
    strip_flow: StripFlow
    end_flow: EndFlow
    lines: Lines
    drift: Float[Array, " d"] | None = None
    excitation: Float[Array, " k"] | None = None
    at_rest: ForcesAtRest | None = None
    part_at_rest: Wetted | None = None
    slender: SlenderFlow | None = None
    lid: tuple[Float[Array, " k"], Float[Array, "3 k"]] | None = None
    matrix_axes: Float[Array, "3 3"] | None = None

    def earth_velocity(self) -> Float[Array, "6"]:
        """Velocity of the reference point and angular velocity in earth axes (m/s, rad/s)."""
        return jnp.concatenate([self.rotation @ self.velocity[:3], self.rotation @ self.velocity[3:]])

    def matrix_velocity(self) -> Float[Array, "6"]:
        """Velocity of the reference point and angular velocity along `matrix_axes` (m/s, rad/s)."""
        if self.matrix_axes is None:
            return self.velocity
        return jnp.concatenate([self.matrix_axes @ self.velocity[:3], self.matrix_axes @ self.velocity[3:]])

    def body_force(self, force: Float[Array, "6"]) -> Float[Array, "6"]:
        """Force and moment in body axes (N, N m), from those along `matrix_axes`."""
        if self.matrix_axes is None:
            return force
        return jnp.concatenate([force[:3] @ self.matrix_axes, force[3:] @ self.matrix_axes])

    def body_added_mass(self, matrix: Float[Array, "6 6"]) -> Float[Array, "6 6"]:
        """Added mass in body axes (kg, kg m, kg m²), from that along `matrix_axes`."""
        if self.matrix_axes is None:
            return matrix
        blocks = matrix.reshape(2, 3, 2, 3)
        return jnp.einsum("ki,akbl,lj->aibj", self.matrix_axes, blocks, self.matrix_axes).reshape(6, 6)

    def diffracting(self) -> Bool[Array, " n"]:
        """Whether each strip diffracts the waves."""
        return jnp.array(self.hull.strips.diffracts) > 0

    def over_strips(self, elements: Float[Array, "2 e"]) -> Float[Array, "2 n"]:
        """Values per load element repeated for each of its strips: (2, e) to (2, n)."""
        return elements[:, jnp.array(self.hull.strips.element, dtype=int)]
