"""Slow part of a platform's horizontal displacement, which computed wave forces follow."""

import math

import jax.numpy as jnp
from jaxtyping import Array, Float

CORNER = 2 * math.pi * 0.02  # rad/s, at the size of VolturnUS-S: between slow surge and the longest waves


def memory_at_rest() -> Float[Array, "2 2"]:
    """Memory of the filter before t = 0: y (m) and z' (m/s) of `memory_rate`, each of both axes."""
    return jnp.zeros((2, 2))


def memory_rate(memory: Float[Array, "2 2"], velocity: Float[Array, "2"], corner: float) -> Float[Array, "2 2"]:
    """Rate of the memory: a low-pass filter of second order (Butterworth).

    u is the velocity, y the part of the displacement that is left out, z' the velocity of the rest, and c the corner. Then
    dy/dt = u - z' and dz'/dt = c² y - sqrt(2) c z'.

    Args:
        memory: y (m) and z' (m/s), each of both horizontal axes.
        velocity: u (m/s, earth axes).
        corner: c (rad/s).
    """
    fast, slow_velocity = memory
    return jnp.stack([velocity - slow_velocity, corner * (corner * fast - math.sqrt(2) * slow_velocity)])
