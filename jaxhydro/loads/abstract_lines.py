"""Base of mooring lines from fairleads to anchors."""

import abc
from typing import Any, ClassVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.rotations import cross


class AbstractLines(AbstractLoad):
    """Base class of mooring lines, which pull at their fairleads.

    Attributes:
        anchor: Anchors (m), earth axes, (3, l).
        fairlead: Fairleads (m), body axes, (3, l).
    """

    anchor: Float[Array, "3 l"]
    fairlead: Float[Array, "3 l"]
    label_prefix: ClassVar[str] = "mooring"

    @abc.abstractmethod
    def tension(
        self, position: Float[Array, "6"], matrix: Float[Array, "3 3"]
    ) -> tuple[Float[Array, " l"], Float[Array, "3 l"]]:
        """Tension at the fairleads, and the direction in which the lines pull there.

        Args:
            position: Position of the platform (m, rad).
            matrix: Rotation matrix from body to earth axes.

        Returns:
            Tension (N), (l,), and unit vectors of the pull in body axes, (3, l).
        """

    @abc.abstractmethod
    def pull(self, position: Float[Array, "6"], matrix: Float[Array, "3 3"]) -> Float[Array, "3 l"]:
        """Force of each line at its fairlead (N), body axes, (3, l).

        Args:
            position: Position of the platform (m, rad).
            matrix: Rotation matrix from body to earth axes.
        """

    def chord(self, position: Float[Array, "6"], matrix: Float[Array, "3 3"]) -> tuple[Float[Array, " l"], Float[Array, "3 l"]]:
        """Distance from fairlead to anchor (m), (l,), and unit vectors to the anchors in body axes, (3, l).

        Args:
            position: Position of the platform (m, rad).
            matrix: Rotation matrix from body to earth axes.
        """
        away = self.anchor - position[:3, None]
        towards = (matrix[:, :, None] * away[:, None, :]).sum(axis=0) - self.fairlead
        length = jnp.sqrt((towards**2).sum(axis=0))
        return length, towards / length

    def act(self, now: Instant, memory: Any) -> Action:
        pull = self.pull(now.position, now.rotation)
        return Action(body_force=jnp.concatenate([pull, cross(self.fairlead, pull)]).sum(axis=1))
