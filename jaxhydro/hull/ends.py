"""Member ends and faces of tapered strips, loaded along a member's axis.

Positions are in body axes; the end is the last axis.
"""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.hull.coefficient_labels import Shares, owners, shares_of
from jaxhydro.hull.member import Member
from jaxhydro.hull.strips import Strips
from jaxhydro.hull.waterplane import wet_section
from jaxhydro.quick_jit import on_device


class Ends(eqx.Module):
    """Ends of members, then the faces of tapered strips: what is loaded along the axis.

    The sizes of a face depend on how much of its element is wet: see `EndShape`. Here they are 0, but for `radius`.
    """

    position: Float[Array, "3 m"]  # m; of a face, the start of its element
    axis: Float[Array, "3 m"]  # unit vector, upward for a column
    gauge: Float[Array, "3 m"]  # as that of the member's elements
    outward: Float[Array, " m"]  # +1 where the face looks along the axis (a top), -1 where against it (a bottom)
    area: Float[Array, " m"]  # m2, on which pressure acts
    radius: Float[Array, " m"]  # m, of the circle of equal section; 0: of a pontoon, without added mass and drag
    facing: Float[Array, " m"]  # m2, on which drag acts: what no other member covers
    volume: Float[Array, " m"]  # m3, to which added mass refers
    label: tuple[int, ...] = eqx.field(static=True)
    labels: tuple[str, ...] = eqx.field(static=True)
    strip: tuple[int, ...] = eqx.field(static=True)  # the strip of every face
    beside: tuple[int, ...] = eqx.field(static=True)  # the strip next to every end, then that of every face
    shares: Shares = eqx.field(static=True, default=())
    # ends of members that lie at the surface: their place, the element beside, its wet share at the reference position
    afloat: tuple[tuple[int, int, float], ...] = eqx.field(static=True, default=())

    def owners(self, symbol: str) -> list[tuple[str, str]]:
        """Group and kind (t, z) of a parameter, such as `symbol` Cd, in the order of `labels`."""
        return owners([(group, "z") for group in self.labels], symbol, self.shares)


class _End(NamedTuple):
    """An end of a member, or a face."""

    position: np.ndarray
    axis: np.ndarray
    gauge: np.ndarray
    outward: float
    area: float
    radius: float
    facing: float
    volume: float
    label: int


def ends(members: Sequence[Member], strips: Strips, size: float = 1.0) -> Ends:
    """Two ends of every member, and faces of tapered strips, in or out of the water.

    Pressure acts on all of them: where members meet, it cancels that on the other's side, which its strips count as exposed.
    Added mass and drag have columns only, on what is free of an end: see `_free`.
    """
    labels = tuple(dict.fromkeys(m.group for m in members if m.column))
    rows: list[_End] = []
    faces: list[_End] = []
    strip_of: list[int] = []
    beside: list[int] = []
    afloat: list[tuple[int, int, float]] = []
    taper, count, elements = np.asarray(strips.taper), 0, 0
    for member in members:
        upright = bool(member.axis @ (member.b - member.a) > 0)
        label = labels.index(member.group) if member.column else 0
        orders = member.elements_and_orders(size)
        beside += [count, count + sum(order for *_, order in orders) - 1]
        for point, fraction, far in ((member.a, 0.0, not upright), (member.b, 1.0, upright)):
            area = float(member.area(member.size(np.array([fraction])))[0])
            radius = math.sqrt(area / math.pi) if member.column else 0.0
            sizes = (radius, area if member.column else 0.0, 2 / 3 * math.pi * radius**3)
            if (up := member.upward) is not None and member.floats:
                part, middle, _ = wet_section(member.submerged, member.circular)
                afloat.append((len(rows), elements + (len(orders) - 1 if fraction else 0), part))
                area, direction = part * area, member.directions[up]
                height = float(member.size(np.array([fraction]))[0][up])
                point = point + middle * height * direction * np.sign(direction[2])
            rows.append(_End(point, member.axis, member.gauge, 1.0 if far else -1.0, area, *sizes, label))
        elements += len(orders)
        for lo, hi, order in orders:
            near, far_end = (lo, hi) if upright else (hi, lo)
            first, last = (float(member.area(member.size(np.array([station])))[0]) for station in (near, far_end))
            if taper[:, count].any():
                radius = math.sqrt(0.5 * (first + last) / math.pi) if member.column else 0.0
                start = member.a + (member.b - member.a) * near
                outward = -1.0 if last >= first else 1.0
                faces += order * [_End(start, member.axis, member.gauge, outward, 0.0, radius, 0.0, 0.0, label)]
                strip_of += range(count, count + order)
            count += order
    columns = list(zip(*(_free(rows) + faces), strict=True)) if rows else [()] * len(_End._fields)
    vectors = [np.array(column, float).reshape(-1, 3).T for column in columns[:3]]
    numbers = [np.array(column, float) for column in columns[3:-1]]
    fields: dict[str, Any] = dict(zip(_End._fields, map(on_device, (*vectors, *numbers))))
    shares = shares_of((member.group, member.shared) for member in members)
    return Ends(
        **fields,
        label=columns[-1],
        labels=labels,
        strip=tuple(strip_of),
        beside=(*beside, *strip_of),
        shares=shares,
        afloat=tuple(afloat),
    )


def _free(rows: Sequence[_End]) -> list[_End]:
    """Free parts of column ends: where two meet on one axis, the larger keeps the difference.

    So a step between two members has the added mass and drag of the ring, as OpenFAST HydroDyn and RAFT have it.
    """
    free = list(rows)
    for i, end in enumerate(rows):
        for j, other in enumerate(rows[:i]):
            met = np.linalg.norm(end.position - other.position) < 1e-3 * max(end.radius, other.radius)
            if met and abs(end.axis @ other.axis) > 1 - 1e-6 and end.outward * other.outward * (end.axis @ other.axis) < 0:
                large, small = (i, j) if end.area >= other.area else (j, i)
                ring = (free[large].facing - free[small].facing, free[large].volume - free[small].volume)
                free[large] = free[large]._replace(facing=max(ring[0], 0.0), volume=max(ring[1], 0.0))
                free[small] = free[small]._replace(facing=0.0, volume=0.0)
    return free
