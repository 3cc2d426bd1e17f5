"""Error of the declared mass, centre of mass and inertia."""

from typing import Any, ClassVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import parameter
from jaxhydro.rotations import cross, skew

INERTIA = "inertia about the centre of mass in {} that was not declared"


class MassError(AbstractLoad):
    """Difference between the true rigid body and that of the model.

    F = -(M' - M) a - (G' - G) + (W' - W): the body with M + m, c + d, I + dI less the model's body M, c, I.

    m is mass at the centre of mass. d = (dx, 0, dz) is the error of the centre of all the mass. dI is inertia about the
    centre of mass. G is the gyroscopic and centripetal force, W the weight: exact for any motion. `total` (kg) and `centre`
    (m, body axes) are those of the model's body.

    Mass that is added weighs: the platform sinks by m/(rho Aw). Where the draught was ballasted to its target, the volume is
    also wrong. Then `added_mass` in surge, sway and heave is the better name for the rest. In one free decay it cannot be
    told from stiffness, nor dz from the metacentre. Mass and inertia that come out negative are nonsense.

    Fossen 2011, Handbook of Marine Craft Hydrodynamics and Motion Control, section 3.3. Labels are `mass_properties.mass`,
    `.centre_x`, `.centre_z`, `.inertia_roll`, `.inertia_pitch`, `.inertia_yaw`.
    """

    total: Float[Array, ""]
    centre: Float[Array, "3"]
    mass: Float[Array, ""] = parameter("kg", "mass at the centre of mass that was not declared")
    centre_x: Float[Array, ""] = parameter("m", "how far forward of the declared one the centre of mass is")
    centre_z: Float[Array, ""] = parameter("m", "how far above the declared one the centre of mass is")
    inertia_roll: Float[Array, ""] = parameter("kg m2", INERTIA.format("roll"))
    inertia_pitch: Float[Array, ""] = parameter("kg m2", INERTIA.format("pitch"))
    inertia_yaw: Float[Array, ""] = parameter("kg m2", INERTIA.format("yaw"))
    label_prefix: ClassVar[str] = "mass_properties"
    source: ClassVar[str] = "Fossen 2011, section 3.3"

    def act(self, now: Instant, memory: Any) -> Action:
        mass, forward, up = self.mass, self.centre_x, self.centre_z
        inertias = (self.inertia_roll, self.inertia_pitch, self.inertia_yaw)
        shift, spin = jnp.stack([forward, jnp.zeros_like(forward), up]), now.velocity[3:]
        # every difference is a sum of terms with a factor that is 0 where nothing is wrong: exactly silent there
        first = mass * (self.centre + shift) + self.total * shift
        old, by, new = skew(self.centre), skew(shift), skew(self.centre + shift)
        second = jnp.diag(jnp.stack(inertias)) - mass * new @ new - self.total * (old @ by + by @ old + by @ by)
        upper = jnp.concatenate([mass * jnp.eye(3), -skew(first)], axis=1)
        inertia = jnp.concatenate([upper, jnp.concatenate([skew(first), second], axis=1)])
        down = -now.environment.gravity * now.rotation[2]  # in body axes
        force = jnp.concatenate(
            [mass * down - cross(spin, cross(spin, first)), cross(first, down) - cross(spin, second @ spin)]
        )
        return Action(body_force=force, added_mass=inertia)
