"""Coulomb (dry) friction in each degree of freedom."""

from typing import Any, ClassVar

import jax.numpy as jnp

from jaxhydro.loads.base import Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.per_dof import AbstractLoadPerDof, PerDof, by_dof
from jaxhydro.parameters import Parameter

RESOLVED = "speed in {dof} below which dry friction is resolved as a damper"


class CoulombFriction(AbstractLoadPerDof):
    """Coulomb friction in each degree of freedom, smoothed by tanh.

    F_i = -f_i tanh(v_i/v0) along body axes: the same force at all speeds well above v0.

    v is the velocity of the reference point (m/s) and the angular velocity (rad/s). In a free decay of a spring C the
    amplitude falls by 4 f/C per cycle, whatever it is. Typical causes are sheaves, fairleads, chains on the ground, guides,
    cables.

    tanh stands for the sign: below the `speed` v0 it is a damper f/v0. So it creeps to the equilibrium in a time f/(v0 C),
    where real dry friction sticks. An offset that remains at the end of a record is not in this law.

    v0 is how sharply the law is resolved. Explicit steps have to be shorter than v0 m/f or so, with m the moving mass.
    Derivatives want a step or two within v0 of every turn. For a fit, take a tenth of the speed's amplitude.

    Den Hartog 1931, Forced vibrations with combined Coulomb and viscous friction (Trans. ASME 53, APM-53-9, 107-115); tanh
    for the sign is common in simulation (Andersson, Soderberg and Bjorklund 2007, Tribology International 40, 580-587).
    Labels are `coulomb_friction.surge.force` and so on.
    """

    force: PerDof = by_dof("N", "N m", "dry friction in {dof}, whatever the speed", 0.0)
    speed: PerDof = by_dof(Parameter("m/s", RESOLVED, 1e-6, 10.0, 0.01), Parameter("rad/s", RESOLVED, 1e-8, 1.0, 2e-4))
    source: ClassVar[str] = "Den Hartog 1931, Trans. ASME 53, APM-53-9, 107-115"

    def act(self, now: Instant, memory: Any) -> Action:
        sign = jnp.tanh(self.dofs_only(now.velocity) / self.entries(self.speed))
        return Action(body_force=self.all_dofs(-self.entries(self.force) * sign))
