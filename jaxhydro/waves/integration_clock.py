"""Times at which a time integration asks for the sea, and interpolation between them."""

from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float, Int

INTERPOLATION_STEPS = 8  # steps of a clock between which a sea is interpolated


class Clock(NamedTuple):
    """Times at which a time integration asks for the sea.

    Attributes:
        start: First time (s).
        step: Time step (s).
        steps: Number of steps.
        nodes: Fractions of a step at which the sea is asked for.
        fine: Number of first steps that are also asked for at their middle.
    """

    start: float
    step: float
    steps: int
    nodes: tuple[float, ...]
    fine: int = 0


def between(steps: Float[Array, "..."], total: int) -> tuple[Int[Array, "... h"], Float[Array, "... h"]]:
    """Steps of a clock and their weights for Lagrange interpolation between steps.

    Args:
        steps: Fractional step numbers.
        total: Number of steps of the clock.
    """
    base = jnp.clip(jnp.floor(steps).astype(int) - INTERPOLATION_STEPS // 2 + 1, 0, max(total - INTERPOLATION_STEPS, 0))
    nodes = jnp.arange(INTERPOLATION_STEPS)
    apart = jnp.where(jnp.eye(INTERPOLATION_STEPS, dtype=bool), 1.0, nodes[:, None] - nodes)
    away = (steps - base)[..., None, None] - nodes
    weight = jnp.where(jnp.eye(INTERPOLATION_STEPS, dtype=bool), 1.0, away / apart).prod(axis=-1)
    return jnp.minimum(base[..., None] + nodes, total - 1), weight
