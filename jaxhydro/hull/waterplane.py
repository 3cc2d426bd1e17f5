"""Members within 10 degrees of the horizontal that still water cuts.

They are wet by the depth of every part of their length. Strips have the wet section's volume, at its centroid. Still water
makes a lid of the section, which a wet body does not have. The pressure of the waves on that lid is a load of its own:
without it the force would be that on a closed body under water.
"""

from collections.abc import Sequence
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.scales import covered

MIN_SECTION_SHARE = 0.02  # of a section's height: share that is wet or dry, below which the surface has left it


@jax.custom_jvp
def segment(x: Float[Array, "..."]) -> Float[Array, "..."]:
    """Area of the part of a circle of radius 1 that is under a line `x` above its centre, -1 to 1."""
    inner = jnp.clip(x, -1.0, 1.0)
    return 0.5 * jnp.pi + inner * jnp.sqrt(1 - inner**2) + jnp.arcsin(inner)


@segment.defjvp
def _segment_jvp(primals, tangents):
    inner = jnp.clip(primals[0], -1.0, 1.0)
    return segment(primals[0]), 2 * chord(inner) * tangents[0]


def chord(x: Float[Array, "..."]) -> Float[Array, "..."]:
    """Half the width of a circle of radius 1 at a height `x` above its centre; 0 outside."""
    square = 1 - x**2
    return jnp.where(square > 0, jnp.sqrt(jnp.where(square > 0, square, 1.0)), 0.0)


def wet_section(share: float, circular: bool) -> tuple[float, float, float]:
    """Relative area, centroid height above the middle, and waterline width of a wet section.

    Heights are over the height, the width over the greatest width.
    """
    if not circular:
        return share, 0.5 * share - 0.5, 1.0
    x = 2 * share - 1
    area, wide = float(segment(jnp.asarray(x))), float(chord(jnp.asarray(x)))
    return area / np.pi, -(wide**3) / 3 / area, wide


class Waterplane(eqx.Module):
    """The strips of members that lie at the surface."""

    width: Float[Array, " k"]  # m, of the section at still water
    length: Float[Array, " k"]  # m, that the strip stands for
    strip: tuple[int, ...] = eqx.field(static=True)
    up: tuple[int, ...] = eqx.field(static=True)  # the direction of the strip that is near vertical, 0 or 1

    def act(self, now: Any) -> tuple[Float[Array, "2 n"], Float[Array, "6"]]:
        """Force (N) on strips and moment (N, N m; body axes) from the pressure on the waterplane.

        The pressure is that of the strip's point, continued to still water and across the width by its slope, minus density
        times acceleration: for waves longer than the section.
        """
        flow, strips, density = now.strip_flow, now.hull.strips, now.environment.density
        assert flow.acceleration is not None and flow.pressure is not None
        strip_index, up = jnp.array(self.strip, dtype=int), jnp.array(self.up, dtype=int)
        home = jnp.array(strips.element, dtype=int)[strip_index]
        share = now.wetted.length[home] / now.hull.elements.length[home]
        pierced = covered(share, MIN_SECTION_SHARE) * covered(1 - share, MIN_SECTION_SHARE)
        point = (
            strips.start[:, strip_index] + now.wetted.reach[home] * strips.fraction[strip_index] * strips.axis[:, strip_index]
        )
        height = jnp.maximum(-(now.position[2] + now.rotation[2] @ point), 0.0)
        rising, aside = flow.acceleration[up, strip_index], flow.acceleration[1 - up, strip_index]
        upward, across = strips.directions[:, up, strip_index], strips.directions[:, 1 - up, strip_index]
        sign = jnp.sign(upward[2])
        area = density * self.width * self.length * pierced
        force = area * (sign * flow.pressure[strip_index] - height * rising)
        moment = -area * self.width**2 / 12 * aside * sign * jnp.cross(across, upward, axis=0)
        on_strips = jnp.zeros_like(flow.acceleration).at[up, strip_index].add(force)
        return on_strips, jnp.concatenate([jnp.zeros(3), moment.sum(axis=1)])


class Leaning(eqx.Module):
    """Wave pressure on the waterplane of inclined members that still water cuts.

    The pressure on the ends of such members and the inertia of their strips already make up two forces. These are the force
    on the wet volume, and the axial part of that on the lid. The lid is the section that still water cuts. With A the
    section, p the pressure there, s the axis and k the vertical, there remains

        p A (k / (k . s) - s).

    The moment about the lid's middle has two parts. One is that of the pressure's slope over the lid, less that of an
    upright column. The other is that of the wedge by which the wet volume is not symmetrical about the axis.
    """

    point: Float[Array, "3 k"]  # m, where still water cuts the axis
    axis: Float[Array, "3 k"]
    area: Float[Array, " k"]
    second: Float[Array, "3 3 k"]  # m4, integral of r r^T over the section

    def act(self, now: Any) -> Float[Array, "6"]:
        """Force and moment (N, N m; body axes) on the platform at an instant (`loads.base.Instant`)."""
        assert now.lid is not None
        density, vertical = now.environment.density, now.rotation[2]
        (pressure, water), steep = now.lid, vertical @ self.axis
        force = density * pressure * self.area * (vertical[:, None] / steep - self.axis)
        slanted = jnp.eye(3)[:, :, None] - self.axis[:, None] * vertical[None, :, None] / steep  # along the axis, onto the lid
        lid = jnp.einsum("ijk,jlk,mlk,mk->ik", slanted, self.second, slanted, water) / steep
        upright = jnp.einsum("ijk,jk->ik", self.second, water)
        lean = jnp.einsum("ijk,j->ik", self.second, vertical) / steep
        wedge = 0.5 * (lean * vertical[:, None]).sum(axis=0) / steep * self.axis - lean
        moment = jnp.cross(self.point, force, axis=0) + density * (
            jnp.cross(upright, self.axis, axis=0) - jnp.cross(lid, vertical[:, None], axis=0) + jnp.cross(wedge, water, axis=0)
        )
        return jnp.concatenate([force, moment]).sum(axis=1)


MIN_LEAN = 0.02  # rad: what leans less is upright


def leaning(members: Sequence[Any]) -> Leaning | None:
    """Load of the `Member`s that lean and that still water cuts, or None."""
    rows = []
    for member in members:
        low, high = sorted((float(member.a[2]), float(member.b[2])))
        if member.fills and low < 0 < high and abs(float(member.axis[2])) < np.cos(MIN_LEAN):
            share = float(-member.a[2] / (member.b[2] - member.a[2]))
            size, directions = member.size(np.array(share)), np.stack(member.directions)
            along = size**2 / (16 if member.circular else 12)  # of the area: mean squares of the distances
            second = float(member.area(size)) * (along * directions.T) @ directions
            rows.append((member.gauge, member.axis, float(member.area(size)), second))
    return Leaning(*(jnp.array(np.stack(part, axis=-1)) for part in zip(*rows, strict=True))) if rows else None


def waterplane(members: Sequence[Any], size: float = 1.0) -> Waterplane | None:
    """Load of the `Member`s that lie at the surface, or None."""
    width, length = list[float](), list[float]()
    strip, up, count = list[int](), list[int](), 0
    for member in members:
        span = float(np.linalg.norm(member.b - member.a))
        for lo, hi, order in member.elements_and_orders(size):
            if (upward := member.upward) is not None and member.floats:
                across = float(member.size(np.array(0.5 * (lo + hi)))[1 - upward])
                share = 0.5 * np.polynomial.legendre.leggauss(order)[1]
                width += order * [across * wet_section(member.submerged, member.circular)[2]]
                length += [float(weight) * (hi - lo) * span for weight in share]
                strip += range(count, count + order)
                up += order * [upward]
            count += order
    return Waterplane(jnp.array(width), jnp.array(length), tuple(strip), tuple(up)) if strip else None
