"""Flow past strips, ends and lids of a hull, in body axes, from the flow at their points."""

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.hull.hull import Hull
from jaxhydro.loads.slender_flow import SlenderFlow, slender_flow
from jaxhydro.waves.flow import EndFlow, Flow, StripFlow


def flow_past(
    flow: Flow | None, still: Float[Array, " l"], wet: Float[Array, " m"], matrix: Float[Array, "3 3"], hull: Hull
) -> tuple[StripFlow, EndFlow]:
    """Flow past strips and ends.

    Args:
        flow: Flow at strips, ends without faces, and `Hull.leaning`; None in still water.
        still: Velocity (m/s) of still water relative to the lines, (l,).
        wet: Submerged fraction of each end and face, (m,).
        matrix: Rotation from body to earth axes.
        hull: The hull.
    """
    still_strips, still_ends = hull.split(still)
    if flow is None:
        return StripFlow(still_strips, None), EndFlow(still_ends, None, None, wet)
    ends, n, whole = hull.ends, len(hull.strips.element), hull.ends_without_faces
    axes = matrix if flow.axes is None else flow.axes.T @ matrix
    toward = (axes @ hull.strips.directions.reshape(3, 2 * n)).reshape(len(axes), 2, n)
    toward_end = axes @ ends.axis

    def across(field: Float[Array, "a k"]) -> Float[Array, "2 n"]:
        return (toward * field[:, None, :n]).sum(axis=0)

    diffracted, tuned = (None if field is None else across(field) for field in (flow.diffracted, flow.tuned))
    strips = StripFlow(still_strips + across(flow.velocity), across(flow.acceleration), diffracted, tuned, flow.pressure[:n])
    end_index = (
        jnp.concatenate([jnp.arange(n, n + whole), jnp.array(ends.strip, dtype=int)]) if ends.strip else slice(n, n + whole)
    )
    velocity, acceleration = ((toward_end * field[:, end_index]).sum(axis=0) for field in (flow.velocity, flow.acceleration))
    return strips, EndFlow(still_ends + velocity, acceleration, flow.pressure[end_index], wet)


def flow_past_slender(
    share: Float[Array, ""],
    velocity: Float[Array, "6"],
    hull: Hull,
    reach: Float[Array, " n"],
    matrix: Float[Array, "3 3"],
    flow: Flow | None,
) -> SlenderFlow:
    """Flow past slender members to second order.

    Args:
        share: Fraction of the second-order forces that acts.
        velocity: Velocity of the reference point and angular velocity, body axes (m/s, rad/s).
        hull: The hull.
        reach: Distance (m) of each strip from the start of its element, (n,).
        matrix: Rotation from body to earth axes.
        flow: As in `flow_past`, with its gradient.
    """
    if flow is None or flow.gradient is None:
        return slender_flow(share, velocity, hull, reach, None, None)
    axes = (matrix if flow.axes is None else flow.axes.T @ matrix).T
    gradient = jnp.einsum("ia,abp,jb->ijp", axes, flow.gradient, axes)
    return slender_flow(share, velocity, hull, reach, axes @ flow.velocity, gradient)


def flow_at_lids(
    flow: Flow | None, matrix: Float[Array, "3 3"], hull: Hull
) -> tuple[Float[Array, " k"], Float[Array, "3 k"]] | None:
    """Pressure over density (m²/s²) and acceleration (m/s², body axes) at `Hull.leaning`, if any."""
    if flow is None or hull.leaning is None:
        return None
    first = len(hull.strips.element) + hull.ends_without_faces
    axes = matrix if flow.axes is None else flow.axes.T @ matrix
    return flow.pressure[first:], axes.T @ flow.acceleration[:, first:]
