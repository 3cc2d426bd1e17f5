"""Coulomb (dry) friction in each degree of freedom."""

from collections.abc import Sequence
from typing import Any, ClassVar, Self

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.per_dof import about, all_dofs, both_units, dofs_only, entries, nulls
from jaxhydro.parameters import Parameter

PARAMETERS = {
    "force": both_units("N", "N m", "dry friction in {dof}, whatever the speed", 0.0),
    "speed": (
        Parameter("m/s", "speed in {dof} below which dry friction is resolved as a damper", 1e-6, 10.0, 0.01),
        Parameter("rad/s", "speed in {dof} below which dry friction is resolved as a damper", 1e-8, 1.0, 2e-4),
    ),
}


class CoulombFriction(AbstractLoad):
    """Coulomb friction in each degree of freedom, smoothed by tanh.

    F_i = -f_i tanh(v_i/v0) along body axes: the same force at all speeds well above v0.

    v is the velocity of the reference point (m/s) and the angular velocity (rad/s). In a free decay of a spring C the
    amplitude falls by 4 f/C per cycle, whatever it is. Sheaves, fairleads, chains on the ground, guides, cables.

    tanh stands for the sign: below the `speed` v0 it is a damper f/v0. So it creeps where real dry friction sticks, to the
    equilibrium in a time f/(v0 C): what stays off it at the end of a record is not in this law. v0 is how sharply the law is
    resolved: explicit steps have to be shorter than v0 m/f or so, m the moving mass, and derivatives want a step or two
    within v0 of every turn: a tenth of the speed's amplitude for a fit.

    Den Hartog 1931, Forced vibrations with combined Coulomb and viscous friction (Trans. ASME 53, APM-53-9, 107-115); tanh
    for the sign is common in simulation (Andersson, Soderberg and Bjorklund 2007, Tribology International 40, 580-587).
    Labels are `coulomb_friction.surge.force` and so on.
    """

    values: dict[str, Float[Array, ""]]
    source: ClassVar[str] = "Den Hartog 1931, Trans. ASME 53, APM-53-9, 107-115"

    @classmethod
    def null(cls, dofs: Sequence[str], speed: float | None = None) -> Self:
        """Load at its neutral value, in some degrees of freedom."""
        return cls(nulls("coulomb_friction", dofs, PARAMETERS, {"speed": speed}))

    def about(self, label: str) -> Parameter:
        return about(label, PARAMETERS)

    def act(self, now: Instant, memory: Any) -> Action:
        sign = jnp.tanh(dofs_only(now.velocity, self.values) / entries(self.values, "speed"))
        return Action(body_force=all_dofs(-entries(self.values, "force") * sign, self.values))
