"""Weight of the platform."""

from typing import Any, ClassVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.rotations import cross


class Weight(AbstractLoad):
    """Weight at the displaced centre of mass.

    F = -m g along z at the displaced centre of mass.

    `mass` (kg) and `centre` (m, body axes) are those of everything that moves with the hull. Newman 1977, Marine
    Hydrodynamics, chapter 6, Hydrostatics.
    """

    mass: Float[Array, ""]
    centre: Float[Array, "3"]
    source: ClassVar[str] = "Newman 1977, chapter 6, Hydrostatics"

    def act(self, now: Instant, memory: Any) -> Action:
        force = -self.mass * now.environment.gravity * now.rotation[2]  # the vertical in body axes
        return Action(body_force=jnp.concatenate([force, cross(self.centre, force)]))
