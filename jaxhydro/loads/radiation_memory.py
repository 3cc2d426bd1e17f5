"""Radiation memory with two states in each degree of freedom."""

from typing import Any, ClassVar

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Complex, Float

from jaxhydro.environment import DOFS
from jaxhydro.loads.base import Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.per_dof import AbstractLoadPerDof, PerDof, by_dof


class RadiationMemory(AbstractLoadPerDof):
    """Radiation memory of second order in each degree of freedom.

    F_i = -int_0^inf K_i(s) v_i(t - s) ds along body axes, of transfer b 2 zeta w0 s/(s^2 + 2 zeta w0 s + w0^2).

    v is the velocity of the reference point (m/s) and the angular velocity (rad/s). The kernel is the only one with two
    states that has the properties of a retardation function in potential theory. They are (Perez and Fossen 2008, Modeling,
    Identification and Control 29, 1-19): K(0) = 2 zeta w0 b finite, no damping at frequencies 0 and infinity, no force on a
    body at rest, passive. Radiation damping is

        B(w) = b (2 zeta w0 w)^2/((w0^2 - w^2)^2 + (2 zeta w0 w)^2), at most b, at w0,

    and added mass A(w) = 2 zeta w0 b (w0^2 - w^2)/(same). The model's added mass is then the one at infinite frequency, to
    which A(0) = 2 zeta b/w0 comes in slow motion. A real platform's B(w) has more humps, and no coupling between degrees of
    freedom is here. It is an effect to be found, not a replacement for a computed kernel. Before t = 0 the platform was at
    rest.

    Labels are `radiation_memory.heave.strength` (b; N s/m, N m s/rad), `.frequency` (w0; rad/s), `.damping_ratio` (zeta).
    """

    strength: PerDof = by_dof("N s/m", "N m s/rad", "largest radiation damping in {dof}", 0.0)
    frequency: PerDof = by_dof("rad/s", "rad/s", "frequency of the largest radiation damping in {dof}", 0.02, 30.0, 0.6)
    damping_ratio: PerDof = by_dof("-", "-", "width of the radiation damping in {dof}, against its frequency", 0.05, 2.0, 0.4)
    source: ClassVar[str] = "Perez and Fossen 2008, Modeling, Identification and Control 29, 1-19"

    def rest(self) -> Float[Array, "2 k"]:
        return jnp.zeros((2, self.entries(self.strength).shape[0]))

    def retardation(self, omega: float) -> Complex[np.ndarray, "6 6"]:
        strength, frequency, ratio = (np.asarray(self.entries(x)) for x in (self.strength, self.frequency, self.damping_ratio))
        band = 2j * ratio * frequency * omega
        basis = np.array([[dof == other for other in DOFS] for dof in self.dofs], float).reshape(-1, 6)
        return np.diag((strength * band / (frequency**2 - omega**2 + band)) @ basis)

    def act(self, now: Instant, memory: Any) -> Action:
        strength, frequency, ratio = map(self.entries, (self.strength, self.frequency, self.damping_ratio))
        passed, displaced = memory  # the band-passed velocity and its integral
        rate = 2 * ratio * frequency * (self.dofs_only(now.velocity) - passed) - frequency**2 * displaced
        return Action(body_force=self.all_dofs(-strength * passed), memory_rate=jnp.stack([rate, passed]))
