"""Hull: elements, strips and ends, and matrices that map the platform's motion to theirs.

A *line* is a strip's direction or an end's axis. Its velocity is `lever . (u, v, w, p, q, r)`, so the velocities of all
lines are one matrix product and the load on the platform is its transpose.
"""

from collections.abc import Sequence
from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.hull.ends import Ends, ends
from jaxhydro.hull.member import Member
from jaxhydro.hull.strips import END_WETTING_LENGTH, FACE_WETTING_LENGTH, Elements, Strips, cut
from jaxhydro.hull.waterplane import Leaning, Waterplane, leaning, segment, waterplane
from jaxhydro.quick_jit import on_device, quick_jit
from jaxhydro.scales import covered, entered
from jaxhydro.waves.flow import Cylinders


class Wetted(NamedTuple):
    """Submerged length (m) of every load element, and length over which its strips are distributed."""

    length: Float[Array, " e"]
    reach: Float[Array, " e"]


class Hull(eqx.Module):
    """Elements, strips and ends, and the constant matrices between the platform's motion and theirs.

    Lines are the strips' first directions, their second ones, then the ends and faces. Quantities of a line are linear in
    the distance s of its strip from the element's start. They are stored as the part for s = 0 and the part that goes with
    s. `motion` is the lever. `inward` times the products p^2, q^2, r^2, pq, pr, qr of the angular velocity is the
    centripetal acceleration. `moments` are those of the displaced volume: see `masses`.
    """

    elements: Elements
    strips: Strips
    ends: Ends
    cylinders: Cylinders  # of strips, ends without faces, and `leaning`
    gauges: Float[Array, "3 g"]  # m, where the surface elevation is looked up
    gauge_of: tuple[int, ...] = eqx.field(static=True)  # the gauge of every element, then end without faces
    motion: Float[Array, "6 2*l"]
    inward: Float[Array, "6 2*l"]
    moments: Float[Array, "6 6 k"]
    size: Float[Array, ""]  # `scales.size_of` the platform
    waterplane: Waterplane | None = None  # of members that lie at the surface
    leaning: Leaning | None = None  # members that lean and that still water cuts

    @classmethod
    def of(cls, members: Sequence[Member], size: float = 1.0) -> "Hull":
        """Hull from members.

        Args:
            members: Members of the platform.
            size: Length scale (-) of the platform (`scales.size_of`).
        """
        elements, strips = cut(members, size)
        tips = ends(members, strips, size)
        powers = 5 if np.asarray(strips.taper).any() else 3
        radii = sorted({r for r in strips.diffracts if r > 0})
        index = tuple(radii.index(r) if r > 0 else -1 for r in strips.diffracts)
        whole = len(tips.label) - len(tips.strip)
        lean = leaning(members)
        points = whole + (0 if lean is None else lean.area.size)
        cylinders = Cylinders(on_device(np.array(radii, float)), (*index, *[-1] * points))
        gauges = np.concatenate([elements.gauge, tips.gauge[:, :whole]], axis=1).round(9)
        positions, gauge_index = np.unique(gauges, axis=1, return_inverse=True)
        gauge_of = tuple(map(int, gauge_index.reshape(-1)))
        matrices = _compiled_matrices(elements, strips, tips, powers)
        more = (on_device(float(size)), waterplane(members, size), lean)
        return cls(elements, strips, tips, cylinders, on_device(positions), gauge_of, *matrices, *more)

    def turned(self, rotation: Float[Array, "3 3"]) -> "Hull":
        """Hull with the directions of strips and ends rotated about their points; one without members is as it was."""
        if not len(self.elements.length):
            return self
        strips = eqx.tree_at(lambda x: x.directions, self.strips, jnp.einsum("ij,jdn->idn", rotation, self.strips.directions))
        tips = eqx.tree_at(lambda x: x.axis, self.ends, rotation @ self.ends.axis)
        powers = (self.moments.shape[2] - tips.area.size) // max(2 * len(self.elements.length), 1)
        matrices = _matrices(self.elements, strips, tips, powers)
        points, more = (self.cylinders, self.gauges, self.gauge_of), (self.size, self.waterplane, self.leaning)
        return Hull(self.elements, strips, tips, *points, *matrices, *more)

    def wrench(self, force: Float[Array, " l"], away: Float[Array, " l"]) -> Float[Array, "6"]:
        """Force and moment (N, N m) on the platform, body axes, from forces along lines.

        Args:
            force: Forces along the lines (N), (l,).
            away: Distances of the lines' strips from their elements' starts (m), (l,).
        """
        return self.motion @ jnp.concatenate([force, away * force])

    def split(self, lines: Float[Array, " l"]) -> tuple[Float[Array, "2 n"], Float[Array, " m"]]:
        """Values per line split into those of strips, by direction, and those of ends."""
        n = len(self.strips.element)
        return lines[: 2 * n].reshape(2, n), lines[2 * n :]

    def join(self, strips: Float[Array, "2 n"], ends: Float[Array, " m"]) -> Float[Array, " l"]:
        """The inverse of `split`."""
        return jnp.concatenate([strips.reshape(-1), ends])

    def masses(self, elements: Float[Array, "2 e"], ends: Float[Array, " m"], wetted: Wetted) -> Float[Array, " k"]:
        """Factors of `moments` in the added mass matrix (kg, kg m, kg m²), body axes.

        The product equals the sum over strips of m h h^T, h the lever, but costs less: in an element of wetted length s that
        sum is s times a polynomial in s.

        Args:
            elements: Added mass per displaced volume (kg/m³) by direction and element.
            ends: Added mass of the ends (kg).
            wetted: Submerged part of each element.
        """
        count, reach = elements.size, wetted.reach
        powers = (self.moments.shape[2] - ends.size) // count if count else 0
        rows = [elements * wetted.length]
        rows += [rows[0] * reach**power for power in range(1, powers)]
        return jnp.concatenate([*[row.reshape(-1) for row in rows[:powers]], ends])

    def extremities(self) -> np.ndarray:
        """Points (m) where a sea must be known: ends of all elements and members, and the reference point."""
        start, axis = np.asarray(self.elements.start), np.asarray(self.elements.axis)
        ends = (start, start + axis * np.asarray(self.elements.length), np.asarray(self.ends.position))
        return np.concatenate([*ends, np.zeros((3, 1))], axis=1)

    def wetted(self, vertical: Float[Array, "3"], depth: Float[Array, " e"]) -> Wetted:
        """Submerged part of every load element.

        It is exact, except where an end has just entered the water (`scales.entered`). A pontoon loses volume evenly as it
        leaves the water.

        Args:
            vertical: Vertical in body axes.
            depth: Depth of the elements' lower ends below the surface (m).
        """
        elements = self.elements
        column, slope = elements.thickness == 0, vertical @ elements.axis
        steep = jnp.where(column, jnp.maximum(slope, 1e-3), 1.0)
        rise = jnp.where(column, steep * elements.length, jnp.abs(slope) * elements.length + elements.thickness)
        low = depth + jnp.where(column, 0.0, 0.5 * elements.thickness + jnp.maximum(-slope, 0.0) * elements.length)
        width = END_WETTING_LENGTH * self.size
        under = entered(low, width) - entered(low - rise, width)
        share = under / rise
        if self.waterplane is not None:
            share = jnp.where(elements.circle > 0, segment(2 * share - 1) / jnp.pi, share)
        wet = share * elements.length
        return Wetted(wet, jnp.where(column, wet, elements.length))

    @property
    def ends_without_faces(self) -> int:
        """Number of ends; the faces of tapered strips come after them."""
        return len(self.ends.label) - len(self.ends.strip)

    def ends_wetted(self, depth: Float[Array, " m"]) -> Float[Array, " m"]:
        """Submerged fraction of ends at a `depth` (m)."""
        return covered(depth, FACE_WETTING_LENGTH * self.size)


def _matrices(elements: Elements, strips: Strips, ends: Ends, powers: int) -> tuple[Array, Array, Array]:
    """`motion`, `inward` and `moments` of a hull."""
    first, second = strips.directions[:, 0], strips.directions[:, 1]
    direction = jnp.concatenate([first, second, ends.axis], axis=1)
    point = jnp.concatenate([strips.start, strips.start, ends.position], axis=1)
    face_strip, whole = jnp.array(ends.strip, dtype=int), len(ends.label) - len(ends.strip)
    of_faces = strips.axis[:, face_strip]
    along = jnp.concatenate([strips.axis, strips.axis, jnp.zeros((3, whole)), of_faces], axis=1)
    lever = jnp.concatenate([direction, jnp.cross(point, direction, axis=0)])
    twist = jnp.concatenate([jnp.zeros_like(direction), jnp.cross(along, direction, axis=0)])
    motion = jnp.concatenate([lever, twist], axis=1)
    inward = jnp.concatenate([_centripetal(direction, point), _centripetal(direction, along)], axis=1)
    # of faces of wholly wet elements; along their own axis the distance does not matter
    home = jnp.array(strips.element, dtype=int)
    away = jnp.concatenate([jnp.zeros(whole), (elements.length[home] * strips.fraction)[face_strip]])
    tips = lever[:, lever.shape[1] - away.size :] + away * twist[:, twist.shape[1] - away.size :]
    return motion, inward, _moments(elements, strips, lever, twist, tips, powers)


_compiled_matrices = quick_jit(_matrices)  # for all hulls, so that those of one form share a program


def _centripetal(direction: Float[Array, "3 l"], point: Float[Array, "3 l"]) -> Float[Array, "6 l"]:
    """omega (omega . r) - omega^2 r along d, by product of angular velocities."""
    (dx, dy, dz), (x, y, z) = direction, point
    return jnp.stack([-dy * y - dz * z, -dx * x - dz * z, -dx * x - dy * y, dx * y + dy * x, dx * z + dz * x, dy * z + dz * y])


def _moments(
    elements: Elements,
    strips: Strips,
    lever: Float[Array, "6 l"],
    twist: Float[Array, "6 l"],
    tips: Float[Array, "6 m"],
    powers: int,
) -> Float[Array, "6 6 k"]:
    """Moments of the displaced volume as polynomials of the elements' wetted lengths, then of the ends.

    An element's entry is the sum over its strips of share times sectional area times h h^T. It is stored as coefficients of
    a polynomial in the wetted length, by power, direction and element. The entry of an end is h h^T.
    """
    n, e = len(strips.element), len(elements.length)
    fraction = jnp.concatenate([strips.fraction, strips.fraction])
    h, twisted = lever[:, : 2 * n], twist[:, : 2 * n] * fraction

    def outer(a, b):
        return a[:, None] * b[None]

    (width, height), (wider, higher) = strips.size, strips.taper * strips.fraction
    area = [width * height, width * higher + height * wider, wider * higher][: powers - 2]
    square = [outer(h, h), outer(h, twisted) + outer(twisted, h), outer(twisted, twisted)]
    of_strips = [jnp.zeros((6, 6, 2 * n)) for _ in range(powers)]
    for p, coefficient in enumerate(area):
        share = jnp.tile(coefficient * strips.shape * strips.weight, 2)
        for q, matrix in enumerate(square):
            of_strips[p + q] = of_strips[p + q] + share * matrix
    home = jnp.array(strips.element, dtype=int)
    index = jnp.concatenate([home, home + e])  # by direction and element
    moments = jnp.stack([jnp.zeros((6, 6, 2 * e)).at[:, :, index].add(part) for part in of_strips], axis=2)
    return jnp.concatenate([moments.reshape(6, 6, -1), outer(tips, tips)], axis=2)
