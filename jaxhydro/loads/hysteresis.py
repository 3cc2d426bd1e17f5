"""Rate-independent hysteresis (Bouc-Wen) in each degree of freedom."""

from typing import Any, ClassVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.per_dof import AbstractLoadPerDof, PerDof, by_dof, magnitude
from jaxhydro.parameters import Parameter

MIN_SQUARED_SPEED = 1e-12  # m2/s2, rad2/s2 and of z^2 under roots: speeds well below 1e-6 m/s do not count as motion
YIELD = "displacement in which the hysteretic force in {dof} comes to its limit"


class Hysteresis(AbstractLoadPerDof):
    """Bouc-Wen hysteresis in each degree of freedom.

    F_i = -f_i z_i, dz/dt = (v - (|v| z + v |z|)/2)/Y along earth axes: Bouc and Wen's law with n = 1, beta = gamma = 1/2.

    v is the velocity of the reference point (m/s) and the angular velocity (rad/s), which for small angles is the rate of
    roll, pitch, yaw. z lies within -1 and 1. Moved one way it loads by an exponential, z = 1 - exp(-x/Y) from z = 0; turned
    round, it unloads with stiffness f/Y. What it does depends on the path and not on how fast it goes: the loss per cycle is
    the same at every frequency. Small motion feels a stiffness f/Y and loses the third power of its amplitude, a large one
    feels dry friction f. Chains on the ground, mooring lines that slide, cables, synthetic ropes.

    Over part of a cycle that does not reverse fully the law drifts (it is not a Preisach model): offsets under waves on a
    slow motion are approximate. Wen 1976, Method for random vibration of hysteretic systems (Journal of the Engineering
    Mechanics Division 102, 249-263). Labels are `hysteresis.surge.force` (f; N, N m) and `.yield_displacement` (Y; m, rad).
    """

    force: PerDof = by_dof("N", "N m", "largest hysteretic force in {dof}", 0.0)
    yield_displacement: PerDof = by_dof(Parameter("m", YIELD, 1e-3, 50.0, 0.5), Parameter("rad", YIELD, 1e-5, 1.0, 0.01))
    source: ClassVar[str] = "Wen 1976, Journal of the Engineering Mechanics Division 102, 249-263"

    def rest(self) -> Float[Array, " k"]:
        return jnp.zeros_like(self.entries(self.force))

    def settled(self, displacement: Float[Array, "6"]) -> Float[Array, " k"]:
        part = self.dofs_only(displacement) / self.entries(self.yield_displacement)
        # sign(x) (1 - exp(-|x|/Y)), in parts whose slopes add up to 1/Y at 0
        return jnp.expm1(jnp.minimum(part, 0.0)) - jnp.expm1(-jnp.maximum(part, 0.0))

    def act(self, now: Instant, memory: Any) -> Action:
        v, z = self.dofs_only(now.earth_velocity()), memory
        bent = 0.5 * (magnitude(v, MIN_SQUARED_SPEED) * z + v * magnitude(z, MIN_SQUARED_SPEED))
        rate = (v - bent) / self.entries(self.yield_displacement)
        return Action(force=self.all_dofs(-self.entries(self.force) * z), memory_rate=rate)
