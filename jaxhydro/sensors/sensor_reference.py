"""Tracked point that is not the reference point."""

from typing import ClassVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.parameters import parameter
from jaxhydro.rotations import rotation
from jaxhydro.sensors.sensor_effect import AbstractSensorEffect

MAX_OFFSET = 200.0  # m
ABOUT = "{} of the tracked point from the reference point, body axes"


class SensorReference(AbstractSensorEffect):
    """Motion sensors that track another point than the reference point.

    y = p + R o - o: the surge, sway and heave that are recorded are those of a point at o = (x, 0, z) in body axes.

    R is the exact rotation (Fossen 2011, Handbook of Marine Craft Hydrodynamics and Motion Control, section 2.2). The
    point's own position is taken off, so that at zero attitude it reads as the reference point does. To first order surge gets
    + z theta, heave - x theta of the pitch theta, sway - z phi + x psi. Angles are those of any point. No force: the motion
    is the same.
    """

    x: Float[Array, ""] = parameter("m", ABOUT.format("x"), -MAX_OFFSET, MAX_OFFSET)
    z: Float[Array, ""] = parameter("m", ABOUT.format("z"), -MAX_OFFSET, MAX_OFFSET)
    source: ClassVar[str] = "Fossen 2011, section 2.2"

    def seen(self, position: Float[Array, "... 6"]) -> Float[Array, "... 6"]:
        offset = jnp.stack([self.x, jnp.zeros(()), self.z])

        def reading(motion: Float[Array, "6"]) -> Float[Array, "6"]:
            return jnp.concatenate([motion[:3] + (rotation(motion[3:]) @ offset - offset), motion[3:]])

        return jnp.vectorize(reading, signature="(n)->(n)")(position)
