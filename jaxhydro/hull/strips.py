"""Members cut into load elements, and these into strips (Gauss points).

Everything is in body axes about the reference point; the strip is the last axis. A strip is loaded in the two directions
across its member's axis, an end along it. A member steeper than 45 degrees is a column: both directions take the transverse
coefficients (t) and its ends the axial ones (z). A flatter one is a pontoon: its horizontal direction takes t, the other,
near-vertical one z, and its ends take none but the pressure.

Where the section of a member changes, its side looks along the axis too. Every strip of a tapered element therefore has a
face, which is loaded along the axis as an end is. A step in size is a short taper.

A load element is integrated by Gauss quadrature over the length that is under water (Abramowitz and Stegun 1964, eq.
25.4.30). So the strips of a column that pierces the surface move along it with the surface: the wetted length is
exact, forces are smooth in the motion, and no strip is spent on what is dry.
"""

import math
from collections.abc import Sequence
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.hull.coefficient_labels import Shares, owners, shares_of
from jaxhydro.hull.member import Member
from jaxhydro.hull.waterplane import wet_section
from jaxhydro.quick_jit import on_device

END_WETTING_LENGTH = 0.1  # m times the size of the hull, in which an element's end enters the water
FACE_WETTING_LENGTH = 0.5  # the same, in which water covers a face


class Strips(eqx.Module):
    """Strips of all load elements. See the module's docstring for the frame and the two directions.

    A strip is at `start + fraction * reach * axis`. `reach` is the wetted length of its element, or its whole length where
    it does not pierce the surface. The strip stands for the share `weight` of the wetted length. Sizes vary linearly along
    an element.
    """

    start: Float[Array, "3 n"]  # m, the lower end of the strip's element
    axis: Float[Array, "3 n"]
    directions: Float[Array, "3 2 n"]
    fraction: Float[Array, " n"]
    weight: Float[Array, " n"]
    size: Float[Array, "2 n"]  # m, extent along either direction at the element's start
    taper: Float[Array, "2 n"]  # its change per metre
    shape: Float[Array, " n"]  # area over the product of extents: pi/4 for a circle
    element: tuple[int, ...] = eqx.field(static=True)
    diffracts: tuple[float, ...] = eqx.field(static=True)  # radius (m) of a strip that diffracts waves, 0 of others


class Elements(eqx.Module):
    """Load elements of all members, the parts whose wetted length is computed."""

    start: Float[Array, "3 e"]  # m, the lower end
    axis: Float[Array, "3 e"]  # upward for a column
    length: Float[Array, " e"]  # m
    thickness: Float[Array, " e"]  # m, vertical extent of a pontoon beyond that of its axis; 0: it fills from its lower end
    gauge: Float[Array, "3 e"]  # m, where the surface is looked up: a column's axis at still water, a pontoon's middle
    circle: Float[Array, " e"]  # 1: wet by the segment of a circle (a cylinder that lies at the surface), 0: evenly
    label: tuple[tuple[int, ...], ...] = eqx.field(static=True)  # index into `labels`, by direction and element
    labels: tuple[tuple[str, str], ...] = eqx.field(static=True)  # (group, "t" or "z")
    shares: Shares = eqx.field(static=True, default=())

    def owners(self, symbol: str) -> list[tuple[str, str]]:
        """Group and kind (t, z) of a parameter, such as `symbol` Cd, in the order of `labels`."""
        return owners(self.labels, symbol, self.shares)


_STRIP_ARRAYS = ("start", "axis", "directions", "fraction", "weight", "size", "taper", "shape")


def cut(members: Sequence[Member], size: float = 1.0) -> tuple[Elements, Strips]:
    """Cut members into load elements and strips; `size` as in `Member.elements_and_orders`."""
    labels: list[tuple[str, str]] = []
    elements: list[tuple] = []
    rows: list[tuple] = []
    for member in members:
        kinds = ("t", "t" if member.column else "z")
        for kind in kinds:
            if (member.group, kind) not in labels:
                labels.append((member.group, kind))
        label = [labels.index((member.group, kind)) for kind in kinds]
        span = float(np.linalg.norm(member.b - member.a))
        directions = np.stack(member.directions, axis=1)
        upright = member.axis @ (member.b - member.a) > 0
        for lo, hi, order in member.elements_and_orders(size):
            near, far = (lo, hi) if upright else (hi, lo)
            length = (hi - lo) * span
            first, last = member.size(np.array(near)), member.size(np.array(far))
            start = member.a + (member.b - member.a) * near
            thickness = 0.0 if member.fills else float(np.abs(directions[2]) @ (0.5 * (first + last)))
            lowered = np.zeros(3)
            if (up := member.upward) is not None and member.floats:
                height = 0.5 * float(first[up] + last[up])
                thickness = height
                middle = wet_section(member.submerged, member.circular)[1]
                lowered = middle * height * directions[:, up] * np.sign(directions[2, up])
            point, weight = np.polynomial.legendre.leggauss(order)
            for fraction, share in zip(0.5 * (1 + point), 0.5 * weight, strict=True):
                rows.append(
                    (
                        start + lowered,
                        member.axis,
                        directions,
                        fraction,
                        share,
                        first,
                        (last - first) / length,
                        math.pi / 4 if member.circular else 1.0,
                        len(elements),
                        0.25 * float(first[0] + last[0]) if member.diffracts else 0.0,
                    )
                )
            round_ = 1.0 if member.floats and member.circular else 0.0
            elements.append((start, member.axis, length, thickness, member.gauge, round_, label))
    triple, pair, flat = np.zeros((3, 0)), np.zeros((2, 0)), np.zeros(0)
    whole = [triple, triple, flat, flat, triple, flat]
    parts = [triple, triple, np.zeros((3, 2, 0)), flat, flat, pair, pair, flat]
    label_of: tuple[tuple[int, ...], ...] = ((), ())
    element_of: tuple[int, ...] = ()
    radius_of: tuple[float, ...] = ()
    if rows:
        *whole, element_labels = (np.stack(column, axis=-1) for column in zip(*elements, strict=True))
        *parts, home, radius = (np.stack(column, axis=-1) for column in zip(*rows, strict=True))
        radius_of = tuple(map(float, radius))
        label_of, element_of = tuple(tuple(map(int, row)) for row in element_labels), tuple(map(int, home))
    of_strips: dict[str, Any] = dict(zip(_STRIP_ARRAYS, map(on_device, parts), strict=True))
    strips = Strips(**of_strips, element=element_of, diffracts=radius_of)
    names = ("start", "axis", "length", "thickness", "gauge", "circle")
    of_elements: dict[str, Any] = dict(zip(names, map(on_device, whole), strict=True))
    shares = shares_of((member.group, member.shared) for member in members)
    return Elements(**of_elements, label=label_of, labels=tuple(labels), shares=shares), strips
