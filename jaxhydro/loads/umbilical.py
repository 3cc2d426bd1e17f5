"""Umbilical cable: spring, pull and hanging mass at a point."""

from typing import Any, ClassVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import parameter
from jaxhydro.rotations import cross, skew

HEIGHT = "height over the reference point where the cable leaves the platform"


class Umbilical(AbstractLoad):
    """Umbilical cable that acts at a point of the body.

    F = (p - k x, -k y, -m g) at the point (0, 0, h) of the body, x and y its displacement along earth axes; and its mass m.

    k (N/m) is the horizontal spring of a slack cable, alike along x and y. p (N) is its mean pull along x. m (kg) is the
    part of it that hangs on the platform: weight and inertia of a point that moves with the hull. As all this acts at the
    displaced point, surge couples with pitch, and sway with roll, by the lever h. There is no drag, no damping, no vertical
    spring, and no lever in yaw. Where the cable leaves off the axis, the moment is left to `static_force` in yaw.

    Fossen 2011, Handbook of Marine Craft Hydrodynamics and Motion Control, section 3.3, for the point's mass; spring and
    pull are the cable's statics, linearised, and ours. Labels are `umbilical.stiffness`, `.pull`, `.mass`, `.height` (h; m).
    """

    stiffness: Float[Array, ""] = parameter("N/m", "horizontal spring where the cable leaves the platform", 0.0)
    pull: Float[Array, ""] = parameter("N", "mean pull of the cable along x, earth axes")
    mass: Float[Array, ""] = parameter("kg", "mass of the cable that the platform carries", 0.0)
    height: Float[Array, ""] = parameter("m", HEIGHT, -30.0, 60.0, 12.0)
    source: ClassVar[str] = "Fossen 2011, section 3.3; the spring is ours"

    def act(self, now: Instant, memory: Any) -> Action:
        stiffness, pull, mass, height = self.stiffness, self.pull, self.mass, self.height
        zero = jnp.zeros_like(height)
        arm, spin = jnp.stack([zero, zero, height]), now.velocity[3:]
        point = now.position[:3] + height * now.rotation[:, 2]  # from the reference point's own reference position
        earth = jnp.stack([pull - stiffness * point[0], -stiffness * point[1], -mass * now.environment.gravity])
        force = earth @ now.rotation - mass * cross(spin, cross(spin, arm))
        lever = mass * skew(arm)
        upper = jnp.concatenate([mass * jnp.eye(3), -lever], axis=1)
        inertia = jnp.concatenate([upper, jnp.concatenate([lever, -lever @ skew(arm)], axis=1)])
        return Action(body_force=jnp.concatenate([force, cross(arm, force)]), added_mass=inertia)
