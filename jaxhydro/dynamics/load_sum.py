"""Sum of the loads on a platform at an instant."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad
from jaxhydro.loads.instant import Instant


class LoadSum(NamedTuple):
    """Sum of all loads, body axes.

    Attributes:
        force: Force and moment (N, N m) on the reference point.
        added_mass: Added mass (kg, kg m, kg m²) of the body.
        masses: Added masses of `Hull.masses`, (k,).
        moments: Matrices that multiply `masses`, (6, 6, k).
        memory_rate: Time derivative of each load's memory.
    """

    force: Float[Array, "6"]
    added_mass: Float[Array, "6 6"]
    masses: Float[Array, " k"]
    moments: Float[Array, "6 6 k"]
    memory_rate: tuple[Any, ...]


def sum_of_loads(loads: Sequence[AbstractLoad], now: Instant, memory: tuple[Any, ...]) -> LoadSum:
    """Sum of loads in body axes.

    Args:
        loads: The loads.
        now: Motion, geometry and flow at the instant.
        memory: Memory of each load.
    """
    actions = [load.act(now, remembered) for load, remembered in zip(loads, memory, strict=True)]

    def total(name: str, zero: Float[Array, "..."]) -> Float[Array, "..."]:
        parts = [part for action in actions if (part := getattr(action, name)) is not None]
        return sum(parts[1:], parts[0]) if parts else zero

    force, earth = total("body_force", jnp.zeros(6)), total("force", jnp.zeros(0))
    if earth.size:
        force = force + jnp.concatenate([earth[:3] @ now.rotation, earth[3:] @ now.rotation])
    hull, on_strips, on_ends = now.hull, jnp.zeros_like(now.strip_flow.relative), jnp.zeros_like(now.end_flow.relative)
    per_volume, end_mass = total("element_mass", jnp.zeros((2, len(hull.elements.length)))), total("end_mass", on_ends)
    line_mass = hull.join(now.over_strips(per_volume) * now.strip_shape.volume, end_mass)
    on_lines = hull.join(total("strip_force", on_strips), total("end_force", on_ends)) - line_mass * now.lines.inward
    return LoadSum(
        force + hull.wrench(on_lines, now.lines.away),
        total("added_mass", jnp.zeros((6, 6))),
        hull.masses(per_volume, end_mass, now.wetted),
        hull.moments,
        tuple(action.memory_rate for action in actions),
    )
