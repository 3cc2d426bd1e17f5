"""Position, velocity and memory of a platform, and the rates of its position."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.rotations import angular_velocity, attitude_rates_of, cosines, rotation, rotation_of


class State(eqx.Module):
    """Position, velocity and memory of the platform.

    Attributes:
        position: Surge, sway, heave (m), roll, pitch, yaw (rad) of the reference point.
        velocity: Velocity of the reference point and angular velocity, body axes (m/s, rad/s).
        memory: One entry per load; None for a load without memory.
    """

    position: Float[Array, "6"]
    velocity: Float[Array, "6"]
    memory: tuple[Any, ...]


def position_rate(position: Float[Array, "6"], velocity: Float[Array, "6"]) -> Float[Array, "6"]:
    """Rates of surge ... yaw (m/s, rad/s) from a velocity in body axes."""
    both = cosines(position[3:])
    return jnp.concatenate([rotation_of(both) @ velocity[:3], attitude_rates_of(both, velocity[3:])])


def body_velocity(position: Float[Array, "6"], rates: Float[Array, "6"]) -> Float[Array, "6"]:
    """Velocity in body axes from rates of surge ... yaw: the inverse of `position_rate`."""
    attitude = position[3:]
    return jnp.concatenate([rotation(attitude).T @ rates[:3], angular_velocity(attitude, rates[3:])])
