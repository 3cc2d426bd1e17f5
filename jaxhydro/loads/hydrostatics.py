"""Buoyancy of the hull up to still water level, with declared hydrostatics."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, ClassVar

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.hull.member import Member
from jaxhydro.hull.strips import END_WETTING_LENGTH
from jaxhydro.hull.waterplane import chord, segment
from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.quick_jit import as_data, on_device, quick_jit
from jaxhydro.rotations import cross, rotation
from jaxhydro.scales import covered, entered

SLABS_ALONG, SLICES_ACROSS = 16, 4  # slabs and slices of a member that lies at the surface


class Buoyancy(AbstractLoad):
    """Buoyancy of the hull up to still water level.

    F = rho g V up, at the centroid of the volume V that is under still water.

    V and its centroid follow the finite displacement and rotation. They are those of the wetted length along the axis, and
    for a column those of the wedge of its inclined waterplane. The wedge moves the volume by I tan across and I tan^2/2
    along the axis. I is the second moment of the section at the waterline (Newman 1977, Marine Hydrodynamics, chapter 6,
    Hydrostatics, without linearisation). A column is taken as cut through its sides, not its ends.

    Sizes vary linearly along a piece. A prismatic column is exact at any lean; a tapered one is exact when upright or wholly
    under water, and to second order in the lean where the waterline cuts it.

    `extra_force` and `extra_stiffness` are the hydrostatics of the platform file less those of the geometry. They are about
    the upright platform at its reference position: extra volume acts at the geometry's centre of buoyancy.
    """

    lower: Float[Array, "3 p"]  # m, body axes: the lower end of a piece
    axis: Float[Array, "3 p"]
    length: Float[Array, " p"]
    size: Float[Array, "2 p"]  # m, extent along either direction at the lower end
    taper: Float[Array, "2 p"]  # its change per metre
    shape: Float[Array, " p"]  # area over the product of extents: pi/4 for a circle
    bend: Float[Array, " p"]  # second moment over extent^3 times the other extent: pi/64 for a circle, 1/12 for a box
    directions: Float[Array, "3 2 p"]
    thickness: Float[Array, " p"]  # m, vertical extent beyond that of the axis
    tube: Float[Array, "3 t"]  # m: middles of slices of cylinders that lie at the surface
    tube_across: Float[Array, "3 2 t"]  # unit vectors across their axes
    tube_radius: Float[Array, " t"]
    tube_length: Float[Array, " t"]
    hull_size: Float[Array, ""]  # `scales.size_of` the platform
    extra_force: Float[Array, ""]  # N
    extra_stiffness: Float[Array, "3"]  # C33, C44, C55 beyond the geometry's
    source: ClassVar[str] = "Newman 1977, chapter 6, Hydrostatics"

    def act(self, now: Instant, memory: Any) -> Action:
        weight_density = now.environment.density * now.environment.gravity
        return Action(body_force=self.force(now.position, now.rotation, weight_density))

    def geometry(self, heave: Float[Array, ""], vertical: Float[Array, "3"]) -> tuple[Float[Array, " p"], Float[Array, "3 p"]]:
        """Wetted volume (m³) of every piece and its first moment about the reference point (m⁴, body axes).

        Args:
            heave: Heave of the reference point (m).
            vertical: Vertical in body axes.
        """
        sides = jnp.concatenate([self.lower, self.axis, self.directions[:, 0], self.directions[:, 1]], axis=1)
        low, slope, *lean = (vertical @ sides).reshape(4, -1)
        rise = jnp.abs(slope) * self.length
        low = heave + low + 0.5 * (slope * self.length - rise) - 0.5 * self.thickness
        height = rise + self.thickness
        width = END_WETTING_LENGTH * self.hull_size
        wet = (entered(-low, width) - entered(-low - height, width)) / height
        # a column fills from its lower end; a pontoon loses volume evenly
        column = self.thickness == 0
        filled = jnp.where(column, wet, 1.0) * self.length
        volume, along = self._frustum(filled)
        volume, along = (jnp.where(column, part, part * wet) for part in (volume, along))
        # the wedge of an inclined waterplane moves volume by -I tan along a direction and by I tan^2/2 along the axis
        tangent = jnp.stack(lean) / jnp.where(column, slope, 1.0)
        pierced = jnp.where(column, covered(-low, width) - covered(-low - height, width), 0.0)
        second, change = (part * tangent * pierced for part in self._second_moment(filled))
        swell = 0.5 * (change * tangent).sum(axis=0)  # where the section grows, the raised side gains more than the other loses
        volume, along = volume + swell, along + 0.5 * (second * tangent).sum(axis=0) + filled * swell
        moment = volume * self.lower + along * self.axis - (self.directions * second).sum(axis=1)
        return volume, moment

    def _tubes(self, heave: Float[Array, ""], vertical: Float[Array, "3"]) -> tuple[Float[Array, " t"], Float[Array, "3 t"]]:
        """Wet volume (m³) of slices of cylinders, and its first moment (m⁴): segments of circles."""
        depth = -(heave + vertical @ self.tube)
        upward = jnp.einsum("i,idt->dt", vertical, self.tube_across)
        slope = jnp.sqrt((upward**2).sum(axis=0))
        x = depth / (slope * self.tube_radius)
        volume = segment(x) * self.tube_radius**2 * self.tube_length
        towards = jnp.einsum("idt,dt->it", self.tube_across, upward / slope)
        first = 2 / 3 * chord(x) ** 3 * self.tube_radius**3 * self.tube_length
        return volume, volume * self.tube - first * towards

    def _frustum(self, reach: Float[Array, " p"]) -> tuple[Float[Array, " p"], Float[Array, " p"]]:
        """Volume (m³) of pieces up to `reach` (m) from their lower ends, and its first moment (m⁴)."""
        (a, b), (p, q) = self.size, self.taper
        area = [self.shape * part for part in (a * b, a * q + b * p, p * q)]  # by power of the distance
        parts = [[part * reach ** (i + j) / (i + j) for i, part in enumerate(area)] for j in (1, 2)]
        volume, first = (constant + linear + quadratic for constant, linear, quadratic in parts)
        return volume, first

    def _second_moment(self, reach: Float[Array, " p"]) -> tuple[Float[Array, "2 p"], Float[Array, "2 p"]]:
        """Second moment (m4) of sections for a lean along either direction, and its change per metre (m3).

        Args:
            reach: Distance (m) of the section from the lower end of each piece, (p,).
        """
        size = self.size + self.taper * reach
        other, growth = size[::-1], self.taper[::-1]
        return self.bend * size**3 * other, self.bend * size**2 * (3 * self.taper * other + size * growth)

    def force(
        self, position: Float[Array, "6"], matrix: Float[Array, "3 3"], weight_density: Float[Array, ""] | float
    ) -> Float[Array, "6"]:
        """Buoyancy (N, N m) in body axes at a displacement of the reference point.

        Args:
            position: Position (m, rad).
            matrix: Rotation from body to earth axes.
            weight_density: rho g (N/m³).
        """
        vertical = matrix[2]
        volume, moment = self.geometry(position[2], vertical)
        if self.tube_radius.size:
            more = self._tubes(position[2], vertical)
            volume, moment = (jnp.concatenate(parts, axis=-1) for parts in zip((volume, moment), more, strict=True))
        total = jnp.concatenate([volume[None], moment]).sum(axis=1) * weight_density
        up = total[0] + self.extra_force - self.extra_stiffness[0] * position[2]
        # the sine of the lean about the body's own x and y: roll and pitch to first order
        lean = self.extra_stiffness[1:] * jnp.stack([vertical[1], -vertical[0]])
        extra = jnp.concatenate([-lean, jnp.zeros(1)])
        return jnp.concatenate([up * vertical, cross(total[1:], vertical) + extra])

    def upright(self, weight_density: float) -> dict[str, float]:
        """Hydrostatics of the members alone, upright at the reference position.

        Args:
            weight_density: rho g (N/m³).

        Returns:
            Displaced volume (m³), z of its centroid (m), C33 (N/m), C44 and C55 (N m/rad) without the contribution of the
                weight.
        """
        volume, moment, slope = (np.asarray(x) for x in _upright(self, as_data(weight_density)))
        total = float(volume.sum())
        return {
            "displaced_volume": total,
            "centre_of_buoyancy": float(moment[2].sum() / total) if total > 0 else 0.0,
            "C33": -float(slope[2, 2]) if len(volume) else 0.0,
            "C44": -float(slope[3, 3]),
            "C55": -float(slope[4, 4]),
        }


@quick_jit
def _upright(load: Buoyancy, weight_density: Float[Array, ""]):
    zeros = jnp.zeros(6)
    slope = jax.jacfwd(lambda q: load.force(q, rotation(q[3:]), weight_density))(zeros)
    pieces, tubes = load.geometry(zeros[0], jnp.eye(3)[2]), load._tubes(zeros[0], jnp.eye(3)[2])
    return *(jnp.concatenate(parts, axis=-1) for parts in zip(pieces, tubes, strict=True)), slope


def buoyancy(members: Sequence[Member], size: float = 1.0) -> Buoyancy:
    """Buoyancy of members, without declared hydrostatics.

    A member is cut where its taper changes.

    Args:
        members: Members of the platform.
        size: Length scale (-) of the platform (`scales.size_of`).
    """
    rows: list[tuple] = []
    tubes: list[tuple] = []
    for member in members:
        edges = [0.0, *member.kinks(), 1.0]
        span = member.b - member.a
        upward = bool(member.axis @ span > 0)
        directions = np.stack(member.directions, axis=1)
        if (up := member.upward) is not None and member.floats:
            if member.circular:
                tubes += _slices(member, directions)
            else:
                rows += _slabs(member, directions, up)
            continue
        for near, far in pairwise(edges):
            low, high = (near, far) if upward else (far, near)
            first, last = member.size(np.array(low)), member.size(np.array(high))
            length = (far - near) * float(np.linalg.norm(span))
            rows.append(
                (
                    member.a + span * low,
                    member.axis,
                    length,
                    first,
                    (last - first) / length,
                    np.pi / 4 if member.circular else 1.0,
                    np.pi / 64 if member.circular else 1 / 12,
                    directions,
                    0.0 if member.fills else float(np.abs(directions[2]) @ (0.5 * (first + last))),
                )
            )
    flat, triple = np.zeros(0), np.zeros((3, 0))
    pair = np.zeros((2, 0))
    arrays = [triple, triple, flat, pair, pair, flat, flat, np.zeros((3, 2, 0)), flat]
    if rows:
        arrays = [np.stack(column, axis=-1) for column in zip(*rows, strict=True)]
    names = ("lower", "axis", "length", "size", "taper", "shape", "bend", "directions", "thickness")
    pieces: dict[str, Any] = dict(zip(names, map(on_device, arrays), strict=True))
    of_tubes = [triple, np.zeros((3, 2, 0)), flat, flat]
    if tubes:
        of_tubes = [np.stack(column, axis=-1) for column in zip(*tubes, strict=True)]
    pieces |= zip(("tube", "tube_across", "tube_radius", "tube_length"), map(on_device, of_tubes), strict=True)
    pieces["hull_size"] = on_device(float(size))
    return Buoyancy(**pieces, extra_force=on_device(0.0), extra_stiffness=on_device(np.zeros(3)))


def _slabs(member: Member, directions: np.ndarray, up: int) -> list[tuple]:
    """Upright slabs of a box that lies at the surface: exact while still water cuts their sides."""
    span, upward = member.b - member.a, directions[:, up] * np.sign(directions[2, up])
    across = directions[:, 1 - up]
    slabs = []
    for s in (np.arange(SLABS_ALONG) + 0.5) / SLABS_ALONG:
        size = member.size(np.array(s))
        height, width = float(size[up]), float(size[1 - up])
        extent = np.array([np.linalg.norm(span) / SLABS_ALONG, width / SLICES_ACROSS])
        for u in (np.arange(SLICES_ACROSS) + 0.5) / SLICES_ACROSS - 0.5:
            lower = member.a + span * s + u * width * across - 0.5 * height * upward
            frame = np.stack([member.axis, across], axis=1)
            slabs.append((lower, upward, height, extent, np.zeros(2), 1.0, 1 / 12, frame, 0.0))
    return slabs


def _slices(member: Member, directions: np.ndarray) -> list[tuple]:
    """Slices of a cylinder that lies at the surface, at Gauss points of its length."""
    point, weight = np.polynomial.legendre.leggauss(SLABS_ALONG)
    span = member.b - member.a
    return [
        (member.a + span * s, directions, 0.5 * float(member.size(np.array(s))[0]), float(np.linalg.norm(span)) * w)
        for s, w in zip(0.5 * (1 + point), 0.5 * weight, strict=True)
    ]
