"""Steady current that changes with depth."""

from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.parameters import parameter
from jaxhydro.water.water_effect import AbstractWaterEffect


class CurrentProfile(AbstractWaterEffect):
    """Steady current of a profile over depth, that acts through drag.

    u_c(z) = f (U(z), V(z), 0), U and V linear between the heights that they are stated at, and constant beyond. In waves it
    is taken at the height where a strip is, and above the highest height it is that of the highest. It adds to the velocity
    past every strip and end, as `Current` does.

    DNV-RP-C205, sections 4.1.4 (profiles) and 6.2 (drag). Its label is `current_profile.factor` (f; -).
    """

    height: Float[Array, " k"] = eqx.field(default_factory=lambda: jnp.zeros(1))  # m over still water, increasing
    velocity: Float[Array, "2 k"] = eqx.field(default_factory=lambda: jnp.array([[1.0], [0.0]]))  # m/s, along earth's x and y
    factor: Float[Array, ""] = parameter("-", "factor on the stated current", 0.0, 5.0)
    source: ClassVar[str] = "DNV-RP-C205, sections 4.1.4 and 6.2"

    def current(self, height: Float[Array, " p"]) -> Float[Array, "3 p"]:
        x, y = (jnp.interp(height, self.height, component) for component in self.velocity)
        return self.factor * jnp.stack([x, y, jnp.zeros_like(height)])
