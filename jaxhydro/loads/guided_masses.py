"""Masses that follow a point of the platform in some directions only, such as a carriage."""

from collections.abc import Mapping
from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import Parameter, parameters
from jaxhydro.rotations import cross


class GuidedMasses(AbstractLoad):
    """Masses that follow a point of the body along some earth axes only.

    F = -m (e . a_P) e at the point P of the body, for every earth axis e along which the mass m follows P.

    A guide keeps the mass from moving in the other directions, and takes the force that this needs, without friction. The
    force is that of d'Alembert's principle for a particle that is constrained to e. It does the virtual work
    -m (e . a_P)(e . dP) (Goldstein, Poole and Safko 2002, Classical Mechanics, 3rd edition, eq. 1.45). So its inertia about
    the reference point is m g g^T, with g = (e, r x e) in body axes. r is the position of the point in the body. The
    centripetal acceleration of P along e is part of a_P: exact for any finite rotation.

    A mass of which `weighs` is true also hangs on the platform: its weight -m g along z acts at P. Labels are
    `guided_masses.NAME.mass`.

    Attributes:
        names: Of every mass, in the order of what follows.
        points: Position of P of every mass from the reference point, m, body axes.
        along: Earth axes, 0 to 2 for x, y, z, of every mass.
        weighs: Whether the platform carries the weight of every mass.
        mass: Masses (kg) by name.
    """

    names: tuple[str, ...] = eqx.field(static=True)
    points: Float[Array, "k 3"]
    along: tuple[tuple[int, ...], ...] = eqx.field(static=True)
    weighs: tuple[bool, ...] = eqx.field(static=True)
    mass: Mapping[str, Float[Array, ""] | float] = parameters(lambda load, name: load.about_mass(name))
    source: ClassVar[str] = "Goldstein, Poole and Safko 2002, Classical Mechanics, eq. 1.45 (d'Alembert's principle)"

    def about_mass(self, name: str) -> Parameter:
        """Unit and meaning of a mass by its name."""
        axes = " and ".join("xyz"[axis] for axis in self.along[self.names.index(name)])
        return Parameter("kg", f"mass of {name}, which follows the platform along {axes}", 0.0)

    def act(self, now: Instant, memory: Any) -> Action:
        spin, force, inertia = now.velocity[3:], jnp.zeros(6), jnp.zeros((6, 6))
        for name, point, axes, weighs in zip(self.names, self.points, self.along, self.weighs, strict=True):
            mass = self.mass[name]
            inward = cross(spin, cross(spin, point))
            for axis in axes:
                direction = now.rotation[axis]  # the earth axis in body axes
                lever = jnp.concatenate([direction, cross(point, direction)])
                inertia = inertia + mass * lever[:, None] * lever
                force = force - mass * (direction @ inward) * lever
            if weighs:
                down = -now.environment.gravity * now.rotation[2]
                force = force + mass * jnp.concatenate([down, cross(point, down)])
        return Action(body_force=force, added_mass=inertia)
