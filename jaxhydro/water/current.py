"""Steady uniform current."""

from typing import ClassVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.parameters import parameter
from jaxhydro.water.water_effect import AbstractWaterEffect

MAX_SPEED = 5.0  # m/s


class Current(AbstractWaterEffect):
    """Steady current, uniform over depth, that acts through drag.

    u_c = (U, V, 0) everywhere: it adds to the velocity past every strip and end, and so acts through their drag.

    Uniform over depth, steady, and there from the start. Parallel and steady flow has no acceleration, hence no
    Froude-Krylov force; lift, Munk's moment and what a current does to the waves (Doppler shift, steepness) are left out.
    That a current adds to the waves' velocity inside the drag term is common practice (DNV-RP-C205, section 6; Faltinsen
    1990, Sea Loads on Ships and Offshore Structures, chapter 6). A platform without drag loads does not feel it, and one
    that rests in still water has no slope by it at U = 0: |u| u has none. In a decay and in waves it has.
    """

    x: Float[Array, ""] = parameter("m/s", "velocity of the current along earth's x", -MAX_SPEED, MAX_SPEED)
    y: Float[Array, ""] = parameter("m/s", "velocity of the current along earth's y", -MAX_SPEED, MAX_SPEED)
    source: ClassVar[str] = "DNV-RP-C205, section 6; Faltinsen 1990, chapter 6"

    def current(self, height: Float[Array, " p"]) -> Float[Array, "3 1"]:
        return jnp.stack([self.x, self.y, jnp.zeros(())])[:, None]
