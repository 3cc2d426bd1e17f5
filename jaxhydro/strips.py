"""Members cut into strips: what every hydrodynamic load is integrated over.

A member is cut into load elements, and each is integrated by two-point Gauss quadrature: it makes two strips, which are
looked at in the Gauss points and wetted over their own halves of the element. Inertia is then exact, and so is the drag of a
rotating member, where midpoints would need several times as many (Abramowitz and Stegun 1964, eq. 25.4.30).

Everything is in body axes about the reference point; the strip is the last axis. A strip is loaded in the two directions
across its member's axis, an end along it. A member steeper than 45 degrees is a column: both directions take the transverse
coefficients (t) and its ends the axial ones (z). A flatter one is a pontoon: its horizontal direction takes t, the other,
near-vertical one z, and its ends take none.

A *line* is a strip's direction or an end's axis. Its velocity is `lever . (u, v, w, p, q, r)`, so the velocities of all lines
are one matrix product and the load on the platform is its transpose.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.rotations import ramp

COLUMN_SLOPE = math.cos(math.radians(45.0))
COLUMN_ELEMENT = 4.0  # m, longest load element of a column where the platform file does not say
PONTOON_ELEMENT = 10.0  # m, of a pontoon
GAUSS = 0.5 / math.sqrt(3.0)  # of an element's length, from its middle to either point of two-point Gauss quadrature


class Member(NamedTuple):
    """One straight member: ends a, b (m), station sizes along it, and the group whose coefficients it uses.

    `stations` are fractions 0..1 of the length, `sizes` (station, 2) the extents (m) along direction 1 and 2: a diameter twice,
    or width and height. `twist` (rad) turns the directions about the axis.
    """

    name: str
    group: str
    circular: bool
    a: np.ndarray
    b: np.ndarray
    stations: np.ndarray
    sizes: np.ndarray
    twist: float = 0.0
    elements: int | None = None
    maccamy_fuchs: bool = False

    @property
    def axis(self) -> np.ndarray:
        """Unit vector from the lower to the upper end of a column, from a to b of a pontoon."""
        axis = (self.b - self.a) / np.linalg.norm(self.b - self.a)
        return -axis if self.column and axis[2] < 0 else axis

    @property
    def column(self) -> bool:
        return abs(self.b[2] - self.a[2]) > COLUMN_SLOPE * float(np.linalg.norm(self.b - self.a))

    @property
    def directions(self) -> tuple[np.ndarray, np.ndarray]:
        """The two unit vectors across the axis: for a pontoon horizontal and upward, for a vertical column x and y."""
        axis = self.axis
        if abs(axis[2]) > 1.0 - 1e-9:
            first = np.array([1.0, 0.0, 0.0])
        else:
            first = np.cross([0.0, 0.0, 1.0], axis)
            first /= np.linalg.norm(first)
        second = np.cross(axis, first)
        c, s = math.cos(self.twist), math.sin(self.twist)
        return c * first + s * second, c * second - s * first

    def size(self, fraction: np.ndarray) -> np.ndarray:
        """Extents (n, 2) at fractions of the length."""
        return np.stack([np.interp(fraction, self.stations, self.sizes[:, i]) for i in range(2)], axis=-1)

    def area(self, size: np.ndarray) -> np.ndarray:
        return size[..., 0] * size[..., 1] * (math.pi / 4 if self.circular else 1.0)

    def edges(self) -> np.ndarray:
        """Fractions of the length at which the load elements begin and end.

        As many as the platform file says, evenly; else short ones that end at every station and at still water.
        """
        length = float(np.linalg.norm(self.b - self.a))
        if self.elements is not None:
            return np.linspace(0.0, 1.0, self.elements + 1)
        longest = COLUMN_ELEMENT if self.column else PONTOON_ELEMENT
        ends = set(self.stations)
        if self.column and min(self.a[2], self.b[2]) < 0 < max(self.a[2], self.b[2]):
            ends.add(self.a[2] / (self.a[2] - self.b[2]))
        at = np.array(sorted(ends))
        parts = [
            np.linspace(lo, hi, max(1, math.ceil((hi - lo) * length / longest - 1e-9)) + 1)[:-1]
            for lo, hi in zip(at[:-1], at[1:], strict=True)
        ]
        return np.append(np.concatenate(parts), 1.0)


class Strips(eqx.Module):
    """Strips of all members. See the module's docstring for the frame and the two directions."""

    position: Float[Array, "3 n"]  # m, the Gauss point
    middle: Float[Array, " n"]  # m along the axis, from there to the strip's middle
    axis: Float[Array, "3 n"]
    directions: Float[Array, "3 2 n"]
    length: Float[Array, " n"]  # m
    area: Float[Array, " n"]  # m2, of the section
    extent: Float[Array, "2 n"]  # m, size along either direction
    blur: Float[Array, " n"]  # m, length of the member's longest strip
    thickness: Float[Array, " n"]  # m, vertical extent beyond that of the axis: none for a column
    label: tuple[tuple[int, ...], ...] = eqx.field(static=True)  # index into `labels`, by direction and strip
    labels: tuple[tuple[str, str], ...] = eqx.field(static=True)  # (group, "t" or "z")

    @property
    def volume(self) -> Float[Array, " n"]:
        return self.length * self.area

    @property
    def facing(self) -> Float[Array, "2 n"]:
        """Projected area (m2) that a flow along either direction sees."""
        return self.extent[::-1] * self.length


class Ends(eqx.Module):
    """Free ends of columns."""

    position: Float[Array, "3 m"]
    axis: Float[Array, "3 m"]  # unit vector, upward
    outward: Float[Array, " m"]  # +1 where the face looks along the axis (a top), -1 where against it (a bottom)
    area: Float[Array, " m"]
    radius: Float[Array, " m"]  # m, of the circle of equal area
    label: tuple[int, ...] = eqx.field(static=True)
    labels: tuple[str, ...] = eqx.field(static=True)


class Hull(eqx.Module):
    """Strips and ends, and the constant matrices between the platform's motion and that of their lines.

    Lines are the strips' first directions, their second ones, then the ends. `lever` (6, line) is d and r x d. `inward` (6,
    line) gives the centripetal acceleration along a line from the products p^2, q^2, r^2, pq, pr, qr of the angular velocity.
    `mass_product` (line, 36) is lever lever^T: a line's mass times it is its share of the 6 x 6 added mass.
    """

    strips: Strips
    ends: Ends
    places: Float[Array, "3 n+m"]
    lever: Float[Array, "6 l"]
    inward: Float[Array, "6 l"]
    mass_product: Float[Array, "l 36"]

    @classmethod
    def of(cls, members: Sequence[Member]) -> "Hull":
        """The hull that members make."""
        strips, tips = cut(members), ends(members)
        position = np.concatenate([strips.position, strips.position, tips.position], axis=1)
        first, second = np.asarray(strips.directions[:, 0]), np.asarray(strips.directions[:, 1])
        direction = np.concatenate([first, second, tips.axis], axis=1)
        lever = np.concatenate([direction, np.cross(position, direction, axis=0)])
        (dx, dy, dz), (x, y, z) = direction, position
        # omega (omega . r) - omega^2 r along d, by product of angular velocities
        inward = np.stack(
            [-dy * y - dz * z, -dx * x - dz * z, -dx * x - dy * y, dx * y + dy * x, dx * z + dz * x, dy * z + dz * y]
        )
        product = np.einsum("il,jl->lij", lever, lever).reshape(-1, 36)
        places = np.concatenate([strips.position, tips.position], axis=1)
        return cls(strips, tips, *map(jnp.asarray, (places, lever, inward, product)))

    def split(self, lines: Float[Array, " l"]) -> tuple[Float[Array, "2 n"], Float[Array, " m"]]:
        """What belongs to the strips, by direction, and what to the ends."""
        n = self.strips.length.shape[0]
        return lines[: 2 * n].reshape(2, n), lines[2 * n :]

    def join(self, strips: Float[Array, "2 n"], ends: Float[Array, " m"]) -> Float[Array, " l"]:
        """The inverse of `split`."""
        return jnp.concatenate([strips.reshape(-1), ends])


def cut(members: Sequence[Member]) -> Strips:
    """Cut members into strips: two for every load element."""
    labels: list[tuple[str, str]] = []
    rows: list[tuple] = []
    for member in members:
        first, second = member.directions
        edges = member.edges()
        whole, centre = np.diff(edges), 0.5 * (edges[1:] + edges[:-1])
        point = np.stack([centre - GAUSS * whole, centre + GAUSS * whole], axis=1).reshape(-1)
        halves = np.sort(np.concatenate([edges, centre]))
        span = float(np.linalg.norm(member.b - member.a))
        sense = 1.0 if member.axis @ (member.b - member.a) > 0 else -1.0
        offset = sense * span * (0.5 * (halves[1:] + halves[:-1]) - point)
        length = np.diff(halves) * span
        size = member.size(point)
        for kind in ("t", "t" if member.column else "z"):
            if (member.group, kind) not in labels:
                labels.append((member.group, kind))
        label = (labels.index((member.group, "t")), labels.index((member.group, "t" if member.column else "z")))
        n = len(point)
        rows.append(
            (
                member.a[:, None] + (member.b - member.a)[:, None] * point,
                offset,
                np.repeat(member.axis[:, None], n, axis=1),
                np.repeat(np.stack([first, second], axis=1)[:, :, None], n, axis=2),
                length,
                np.full(n, length.max()),
                # the mean area of a tapered strip (frustum), so that the volume is exact
                _mean_area(member, halves),
                size.T,
                np.repeat(np.array(label)[:, None], n, axis=1),
            )
        )
    empty = (np.zeros((3, 0)), np.zeros(0), np.zeros(0), np.zeros((3, 0)), np.zeros((3, 2, 0)), np.zeros(0), np.zeros(0), np.zeros((2, 0)), np.zeros((2, 0)))
    columns = [np.concatenate(column, axis=-1) for column in zip(*(rows or [empty]), strict=True)]
    position, middle, axis, directions, length, blur, area, extent, label_of = columns
    column = np.concatenate([np.full(len(row[1]), m.column) for m, row in zip(members, rows, strict=True)] or [np.zeros(0)])
    thickness = np.where(column, 0.0, (np.abs(directions[2]) * extent).sum(axis=0))
    arrays = (position, middle, axis, directions, length, area, extent, blur, thickness)
    return Strips(*map(jnp.asarray, arrays), tuple(tuple(map(int, row)) for row in label_of), tuple(labels))


def _mean_area(member: Member, edges: np.ndarray) -> np.ndarray:
    """Volume over length between edges; Simpson's rule is exact for a section that varies linearly."""
    middle = 0.5 * (edges[1:] + edges[:-1])
    area = [member.area(member.size(at)) for at in (edges[:-1], middle, edges[1:])]
    return (area[0] + 4 * area[1] + area[2]) / 6


def ends(members: Sequence[Member]) -> Ends:
    """The two ends of every column; what is not in the water is left out by its wetting."""
    columns = [m for m in members if m.column]
    labels = tuple(dict.fromkeys(m.group for m in columns))
    position, axis, outward, area, label = [], [], [], [], []
    for member in columns:
        upright = member.b[2] > member.a[2]
        for point, fraction, top in ((member.a, 0.0, not upright), (member.b, 1.0, upright)):
            position.append(point)
            axis.append(member.axis)
            outward.append(1.0 if top else -1.0)
            area.append(float(member.area(member.size(np.array([fraction])))[0]))
            label.append(labels.index(member.group))
    points, along = np.array(position).reshape(-1, 3).T, np.array(axis).reshape(-1, 3).T
    areas = np.array(area)
    arrays = (points, along, np.array(outward), areas, np.sqrt(areas / math.pi))
    return Ends(*map(jnp.asarray, arrays), tuple(label), labels)


def wetted(strips: Strips, upward: Float[Array, "3"], depth: Float[Array, " n"]) -> Float[Array, " n"]:
    """Fraction of every strip that is under water: smooth, and exact in the sum over a member.

    `upward` is the vertical in body axes, `depth` (m) that of the strip's Gauss point under the surface. All strips of a
    member are blurred by one kernel, as wide as its longest, so that they add up to the exact wetted length unless the
    surface is within a strip of the member's end.
    """
    slope = upward @ strips.axis
    steep = jnp.abs(slope)
    half = 0.5 * (steep * strips.length + strips.thickness)
    blur = 0.5 * (steep * strips.blur + strips.thickness)
    middle = depth - slope * strips.middle
    return 0.5 * blur / half * (ramp((middle + half) / blur) - ramp((middle - half) / blur))
