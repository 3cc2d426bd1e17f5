"""Motion, submerged geometry and flow of a platform at an instant, from its position and velocity."""

from typing import TYPE_CHECKING, NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.dynamics.combined_loads import StripChanges
from jaxhydro.dynamics.conventions import Conventions
from jaxhydro.dynamics.member_flow import flow_at_lids, flow_past, flow_past_slender
from jaxhydro.dynamics.newton_euler import optional_sum
from jaxhydro.dynamics.state import State
from jaxhydro.hull.hull import Hull, Wetted
from jaxhydro.hull.submerged import EndShape, Lines, StripShape
from jaxhydro.loads.instant import Instant
from jaxhydro.rotations import rotation, turned
from jaxhydro.waves.sea import AbstractSea

if TYPE_CHECKING:
    from jaxhydro.dynamics.model import Model


class _Submerged(NamedTuple):
    """Submerged part of a hull.

    Attributes:
        elements: Submerged part of each load element.
        covered: Wet length (m) of each strip, (n,).
        reach: Distance (m) of each strip from the start of its element, (n,).
        extent: Size (m) of each strip along its two directions, (2, n).
        ends: Submerged fraction of each end and face, (m,).
    """

    elements: Wetted
    covered: Float[Array, " n"]
    reach: Float[Array, " n"]
    extent: Float[Array, "2 n"]
    ends: Float[Array, " m"]


def instant(model: "Model", time: Float[Array, ""], state: State, sea: AbstractSea) -> Instant:
    """Motion, submerged geometry and flow at an instant.

    Args:
        model: The platform.
        time: Time (s).
        state: Position, velocity and memory.
        sea: The sea that the platform meets, after its water effects.

    Returns:
        What the loads read.
    """
    position, velocity, conventions, cylinders = state.position, state.velocity, model.conventions, model.cylinders
    changes = StripChanges.of(model.loads, state.memory)
    replaced, second_order = changes.replaced, changes.second_order
    matrix = rotation(position[3:])
    hull = model.hull if conventions.directions == "body" else model.hull.turned(matrix.T)
    submerged = _submerged(time, position, matrix, sea, hull, conventions)
    lines, still = _lines(velocity, submerged, hull, conventions)
    points = _points(position, matrix, submerged, hull, conventions)
    if (steady := optional_sum([effect.current(points[2]) for effect in model.water])) is not None:
        still = still + _along(matrix.T @ steady, hull)
    flow = sea.flow(time, points, cylinders) if second_order is None else sea.flow(time, points, cylinders, gradient=True)
    slender = None
    if second_order is not None:
        share = second_order if replaced is None else second_order * (1 - replaced)
        slender = flow_past_slender(share, velocity, hull, submerged.reach, matrix, flow)
        flow = None if flow is None else flow.convected(second_order, cylinders)
    if flow is not None and replaced is not None:
        flow = flow.weakened(1 - replaced)
    strip_flow, end_flow = flow_past(flow, still, submerged.ends, matrix, hull)
    covered, extent, shape = submerged.covered, submerged.extent, hull.strips.shape
    strip_shape = StripShape(covered * shape * extent[0] * extent[1], covered * extent[::-1])
    added_mass_part, added_mass_volume = submerged.elements, strip_shape.volume
    if replaced is not None and conventions.wetting != "mean":
        rest = _wetted_at_rest(hull)
        added_mass_part = Wetted(
            *(wet + replaced * (at_rest - wet) for wet, at_rest in zip(added_mass_part, rest.elements, strict=True))
        )
        at_rest = rest.covered * shape * rest.extent[0] * rest.extent[1]
        added_mass_volume = added_mass_volume + replaced * (at_rest - added_mass_volume)
    fast = changes.fast_displacement
    slow = position if fast is None else position.at[:2].add(-fast)
    excitation = sea.excitation(time, _origin(slow, matrix, conventions)[0]) if changes.excited else None
    return Instant(
        time,
        position,
        matrix,
        velocity,
        model.environment,
        hull,
        submerged.elements,
        added_mass_part,
        added_mass_volume,
        strip_shape,
        EndShape.of(hull, submerged.elements, covered, extent),
        strip_flow,
        end_flow,
        lines,
        sea.drift(time),
        excitation,
        changes.forces_at_rest(excitation),
        _wetted_at_rest(hull).elements if changes.mass_replaced and replaced is None else None,
        slender,
        flow_at_lids(flow, matrix, hull),
        matrix if conventions.directions == "earth" else None,
    )


def _origin(
    position: Float[Array, "6"], matrix: Float[Array, "3 3"], conventions: Conventions
) -> tuple[Float[Array, "2"], Float[Array, "2 3"]]:
    """Horizontal position where the platform meets the waves, and the map of its points.

    Returns:
        Position (m), (2,), and the matrix from the platform's points to horizontal ones, (2, 3).
    """
    if conventions.waves_at == "displaced":
        return position[:2], matrix[:2]
    return jnp.zeros(2), jnp.eye(3)[:2]


def _submerged(
    time: Float[Array, ""],
    position: Float[Array, "6"],
    matrix: Float[Array, "3 3"],
    sea: AbstractSea,
    hull: Hull,
    conventions: Conventions,
) -> _Submerged:
    """Submerged part of the hull's elements, strips, ends and faces."""
    if conventions.wetting == "mean":
        return _wetted_at_rest(hull)
    roots, vertical = _roots(hull), matrix[2]
    depth = -(position[2] + vertical @ roots)
    origin, follows = _origin(position, matrix, conventions)
    surface = sea.surface(time, origin[:, None] + follows @ hull.gauges)
    depth = depth if surface is None else depth + surface[jnp.array(hull.gauge_of, dtype=int)]
    return _wetted(hull, vertical, depth)


def _roots(hull: Hull) -> Float[Array, "3 k"]:
    """Starts of elements, then ends without faces."""
    return jnp.concatenate([hull.elements.start, hull.ends.position[:, : hull.ends_without_faces]], axis=1)


def _wetted_at_rest(hull: Hull) -> _Submerged:
    """Submerged part of the hull at its reference position in still water."""
    return _wetted(hull, jnp.array([0.0, 0.0, 1.0]), -_roots(hull)[2])


def _wetted(hull: Hull, vertical: Float[Array, "3"], depth: Float[Array, " k"]) -> _Submerged:
    """Submerged part of the hull, with the vertical in body axes and the depths of `_roots` (m)."""
    strips, ends, count = hull.strips, hull.ends, hull.elements.start.shape[1]
    elements, element_of = hull.wetted(vertical, depth[:count]), jnp.array(strips.element, dtype=int)
    covered, reach = elements.length[element_of] * strips.weight, elements.reach[element_of] * strips.fraction
    wet = jnp.concatenate([hull.ends_wetted(depth[count:]), jnp.ones(len(ends.strip))])
    return _Submerged(elements, covered, reach, strips.size + strips.taper * reach, wet)


def _lines(
    velocity: Float[Array, "6"], submerged: _Submerged, hull: Hull, conventions: Conventions
) -> tuple[Lines, Float[Array, " l"]]:
    """Distances and accelerations of lines, and the velocity (m/s) of still water relative to them, (l,)."""
    of_faces = submerged.reach[jnp.array(hull.ends.strip, dtype=int)]
    on_ends = jnp.concatenate([jnp.zeros(hull.ends_without_faces), of_faces])
    away = hull.join(jnp.stack([submerged.reach, submerged.reach]), on_ends)
    still, turning = (velocity @ hull.motion).reshape(2, -1)
    if conventions.centripetal:
        p, q, r = velocity[3:]
        square = jnp.stack([p * p, q * q, r * r, p * q, p * r, q * r])
        inward, outgoing = (square @ hull.inward).reshape(2, -1)
        inward = inward + away * outgoing
    else:
        inward = jnp.zeros_like(away)
    return Lines(away, inward), -(still + turning * away)


def _along(field: Float[Array, "3 p"], hull: Hull) -> Float[Array, " l"]:
    """Components of a vector field along all lines, (l,).

    Args:
        field: Vectors at `_points`, (3, p), or one vector everywhere, (3, 1), body axes.
        hull: The hull.
    """
    on_strips = on_ends = field
    if field.shape[1] > 1:
        n, whole = len(hull.strips.element), hull.ends_without_faces
        of_ends = jnp.concatenate([jnp.arange(n, n + whole), jnp.array(hull.ends.strip, dtype=int)])
        on_strips, on_ends = field[:, :n], field[:, of_ends]
    across = (on_strips[:, None] * hull.strips.directions).sum(axis=0)
    return hull.join(across, (on_ends * hull.ends.axis).sum(axis=0))


def _points(
    position: Float[Array, "6"], matrix: Float[Array, "3 3"], submerged: _Submerged, hull: Hull, conventions: Conventions
) -> Float[Array, "3 n"]:
    """Points (m, earth axes) where the flow is needed: strips, ends without faces, `Hull.leaning`."""
    strips, lids = hull.strips, [] if hull.leaning is None else [hull.leaning.point]
    on_strips = strips.start + submerged.reach * strips.axis
    points = jnp.concatenate([on_strips, hull.ends.position[:, : hull.ends_without_faces], *lids], axis=1)
    displaced = position[:3, None] + turned(matrix, points)
    level = points if conventions.waves_at == "mean" else displaced
    return jnp.concatenate([level[:2], (points if conventions.wetting == "mean" else displaced)[2:]])
