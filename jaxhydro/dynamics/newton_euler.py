"""Newton's and Euler's equations of a platform: sum of its loads, and the acceleration that follows."""

from collections.abc import Sequence
from typing import Any, NamedTuple, TypeVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.dynamics.rigid_body import RigidBody
from jaxhydro.dynamics.solve6 import accelerate
from jaxhydro.loads.base import AbstractLoad
from jaxhydro.loads.instant import Instant
from jaxhydro.rotations import cross

T = TypeVar("T")


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
    added = total("added_mass", jnp.zeros((6, 6)))
    if (replaced := optional_sum([load.replaces_added_mass() for load in loads])) is not None:
        if now.part_at_rest is None:
            per_volume, end_mass = (1 - replaced) * per_volume, (1 - replaced) * end_mass
        else:
            added = added - replaced * (hull.moments @ hull.masses(per_volume, end_mass, now.part_at_rest))
    line_mass = hull.join(now.over_strips(per_volume) * now.added_mass_volume, end_mass)
    on_lines = hull.join(total("strip_force", on_strips), total("end_force", on_ends)) - line_mass * now.lines.inward
    return LoadSum(
        force + hull.wrench(on_lines, now.lines.away),
        added,
        hull.masses(per_volume, end_mass, now.added_mass_part),
        hull.moments,
        tuple(action.memory_rate for action in actions),
    )


def body_acceleration(body: RigidBody, velocity: Float[Array, "6"], total: LoadSum, fixed_lines: bool) -> Float[Array, "6"]:
    """Rate of the velocity in body axes (m/s², rad/s²), by Newton and Euler about the reference point.

    Args:
        body: Mass and inertia.
        velocity: Velocity of the reference point and angular velocity, body axes (m/s, rad/s).
        total: Sum of the loads.
        fixed_lines: Whether strips and ends keep their directions in earth axes, so that `moments` turn with the attitude.

    References:
        Fossen (2011), section 3.3.
    """
    spin, linear = velocity[3:], velocity[:3]
    inertia = body.inertia_at_reference()
    gyroscopic = jnp.concatenate([body.mass * cross(spin, cross(spin, body.centre)), cross(spin, inertia @ spin)])
    # the solution is the acceleration of the reference point, not the rate of its body-axes velocity
    mass, masses, moments = body.mass_matrix() + total.added_mass, total.masses, total.moments
    if fixed_lines:  # `accelerate` takes `moments` for constant
        mass, masses, moments = mass + moments @ masses, masses[:0], moments[..., :0]
    acceleration = accelerate(mass, total.force - gyroscopic, masses, moments)
    return acceleration - jnp.concatenate([cross(spin, linear), jnp.zeros(3)])


def optional_sum(parts: Sequence[Array | None]) -> Array | None:
    """Sum of the terms that are not None; None where there are none."""
    terms = [part for part in parts if part is not None]
    return sum(terms[1:], terms[0]) if terms else None


def at_most_one(quantity: str, parts: Sequence[T | None]) -> T | None:
    """The term that is not None, or None; ValueError for two."""
    terms = [part for part in parts if part is not None]
    if len(terms) > 1:
        raise ValueError(f"two loads have a {quantity}: expected one")
    return terms[0] if terms else None
