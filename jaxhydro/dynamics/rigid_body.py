"""Mass and inertia of a rigid body."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.rotations import skew


class RigidBody(eqx.Module):
    """Mass and inertia of the platform, body axes.

    Attributes:
        mass: Mass (kg).
        centre: Centre of mass (m) from the reference point.
        inertia: Inertia about the centre of mass (kg m²).
    """

    mass: Float[Array, ""]
    centre: Float[Array, "3"]
    inertia: Float[Array, "3 3"]

    def inertia_at_reference(self) -> Float[Array, "3 3"]:
        """Inertia about the reference point (kg m²), by the parallel-axis theorem."""
        s = skew(self.centre)
        return self.inertia - self.mass * s @ s

    def mass_matrix(self) -> Float[Array, "6 6"]:
        """Mass matrix about the reference point (kg, kg m, kg m²).

        References:
            Fossen (2011), section 3.3.
        """
        lever = self.mass * skew(self.centre)
        upper = jnp.concatenate([self.mass * jnp.eye(3), -lever], axis=1)
        return jnp.concatenate([upper, jnp.concatenate([lever, self.inertia_at_reference()], axis=1)])
