"""Quadratic damping in each degree of freedom."""

from typing import Any, ClassVar

import jax.numpy as jnp

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.drag.drag_flow import MIN_SQUARED_SPEED
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.matrix import Entries, assemble, by_entry


class QuadraticDamping(AbstractLoad):
    """Quadratic damping in each degree of freedom.

    F_i = -Q_ii |v_i| v_i along body axes: a body's drag without members, or what its members do not give.

    Labels are `quadratic_damping.B44` and so on, as in the platform file. Himeno 1981, Prediction of Ship Roll Damping
    (University of Michigan, report 239).
    """

    entries: Entries = by_entry("Q", "quadratic damping", "velocity")
    source: ClassVar[str] = "Himeno 1981, Prediction of Ship Roll Damping"

    def act(self, now: Instant, memory: Any) -> Action:
        velocity = now.velocity
        return Action(body_force=-jnp.diagonal(assemble(self.entries)) * jnp.sqrt(velocity**2 + MIN_SQUARED_SPEED) * velocity)
