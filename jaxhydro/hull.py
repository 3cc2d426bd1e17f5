"""The hull: elements, strips and ends, and the constant matrices between the platform's motion and theirs.

A *line* is a strip's direction or an end's axis. Its velocity is `lever . (u, v, w, p, q, r)`, so the velocities of all lines
are one matrix product and the load on the platform is its transpose.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.rotations import ramp
from jaxhydro.strips import SMOOTH, Elements, Ends, Member, Strips, cut, ends


class Wetted(NamedTuple):
    """Length (m) of every element that is under water, and over which its strips are distributed."""

    length: Float[Array, " e"]
    reach: Float[Array, " e"]


class Hull(eqx.Module):
    """Elements, strips and ends, and the constant matrices between the platform's motion and theirs.

    Lines are the strips' first directions, their second ones, then the ends. What belongs to a line is linear in the distance
    s of its strip from the element's start, and stored as the part for s = 0 and the part that goes with s: `motion` is the
    lever, `inward` times the products p^2, q^2, r^2, pq, pr, qr of the angular velocity the centripetal acceleration.
    `moments` are those of the displaced volume: see `masses`.
    """

    elements: Elements
    strips: Strips
    ends: Ends
    motion: Float[Array, "6 2*l"]
    inward: Float[Array, "6 2*l"]
    moments: Float[Array, "6 6 k"]

    @classmethod
    def of(cls, members: Sequence[Member]) -> "Hull":
        """The hull that members make."""
        elements, strips = cut(members)
        tips = ends(members)
        point = np.concatenate([strips.start, strips.start, tips.position], axis=1)
        first, second = np.asarray(strips.directions[:, 0]), np.asarray(strips.directions[:, 1])
        direction = np.concatenate([first, second, tips.axis], axis=1)
        along = np.concatenate([strips.axis, strips.axis, np.zeros_like(tips.axis)], axis=1)
        lever = np.concatenate([direction, np.cross(point, direction, axis=0)])
        twist = np.concatenate([np.zeros_like(direction), np.cross(along, direction, axis=0)])
        motion = np.concatenate([lever, twist], axis=1)
        inward = np.concatenate([_centripetal(direction, point), _centripetal(direction, along)], axis=1)
        moments = _moments(elements, strips, lever, twist)
        matrices = (motion, inward, moments)
        lines: dict[str, Any] = dict(zip(("motion", "inward", "moments"), map(jnp.asarray, matrices), strict=True))
        return cls(elements, strips, tips, **lines)

    def wrench(self, force: Float[Array, " l"], away: Float[Array, " l"]) -> Float[Array, "6"]:
        """Force and moment (N, N m) on the platform, in body axes, of forces (N) along lines whose strips are `away` (m) from
        the element's start."""
        lever, twist = jnp.split(self.motion, 2, axis=1)
        return (lever + twist * away) @ force

    def split(self, lines: Float[Array, " l"]) -> tuple[Float[Array, "2 n"], Float[Array, " m"]]:
        """What belongs to the strips, by direction, and what to the ends."""
        n = len(self.strips.element)
        return lines[: 2 * n].reshape(2, n), lines[2 * n :]

    def join(self, strips: Float[Array, "2 n"], ends: Float[Array, " m"]) -> Float[Array, " l"]:
        """The inverse of `split`."""
        return jnp.concatenate([strips.reshape(-1), ends])

    def masses(
        self, elements: Float[Array, "2 e"], ends: Float[Array, " m"], wetted: Wetted
    ) -> Float[Array, " k"]:
        """What `moments` is to be multiplied by for the added mass matrix (kg, kg m, kg m2) in body axes.

        `elements` (kg/m3) is added mass per displaced volume by direction and element, `ends` (kg) that of the ends. Equal to
        the sum over strips of m h h^T, h the lever, but worked out once: in an element of wetted length s that sum is s times a
        polynomial in s.
        """
        count, reach = elements.size, wetted.reach
        powers = (self.moments.shape[2] - ends.size) // count if count else 0
        rows = [elements * wetted.length]
        rows += [rows[0] * reach**power for power in range(1, powers)]
        return jnp.concatenate([*[row.reshape(-1) for row in rows[:powers]], ends])

    def waterline(self) -> Float[Array, "3 e+m"]:
        """Points (m) where the surface elevation is looked up for elements and ends: a column's axis at still water, a
        pontoon's middle."""
        elements = self.elements
        column = elements.thickness == 0
        at = jnp.where(column, -elements.start[2] / jnp.where(column, elements.axis[2], 1.0), 0.5 * elements.length)
        ends = self.ends.position - self.ends.axis * (self.ends.position[2] / self.ends.axis[2])
        return jnp.concatenate([elements.start + elements.axis * at, ends], axis=1)

    def wetted(self, vertical: Float[Array, "3"], depth: Float[Array, " e"]) -> Wetted:
        """What of every element is under water.

        `vertical` is the vertical in body axes, `depth` (m) that of the elements' lower ends under the surface. Exact, but for
        a quarter of a metre about the element's ends. A pontoon loses volume evenly as its height leaves the water.
        """
        elements = self.elements
        column, slope = elements.thickness == 0, vertical @ elements.axis
        steep = jnp.where(column, jnp.maximum(slope, 1e-3), 1.0)
        rise = jnp.where(column, steep * elements.length, jnp.abs(slope) * elements.length + elements.thickness)
        low = depth + jnp.where(column, 0.0, 0.5 * elements.thickness + jnp.maximum(-slope, 0.0) * elements.length)
        under = SMOOTH * (ramp(low / SMOOTH) - ramp((low - rise) / SMOOTH))
        wet = under / rise * elements.length
        return Wetted(wet, jnp.where(column, wet, elements.length))


def _centripetal(direction: np.ndarray, point: np.ndarray) -> np.ndarray:
    """omega (omega . r) - omega^2 r along d, by product of angular velocities."""
    (dx, dy, dz), (x, y, z) = direction, point
    return np.stack(
        [-dy * y - dz * z, -dx * x - dz * z, -dx * x - dy * y, dx * y + dy * x, dx * z + dz * x, dy * z + dz * y]
    )


def _moments(elements: Elements, strips: Strips, lever: np.ndarray, twist: np.ndarray) -> np.ndarray:
    """Sum over an element's strips of share, sectional area and h h^T as coefficients of a polynomial in its wetted length,
    by power, direction and element; then h h^T of the ends."""
    n, e = len(strips.element), len(elements.length)
    fraction, taper = np.asarray(strips.fraction), np.asarray(strips.taper)
    powers = 5 if taper.any() else 3
    found = np.zeros((6, 6, powers, 2, e))
    for i in range(n):
        sizes = [(float(strips.size[d, i]), taper[d, i] * fraction[i]) for d in range(2)]
        area = np.polynomial.polynomial.polymul(*sizes) * float(strips.shape[i] * strips.weight[i])
        for d in range(2):
            h = np.stack([lever[:, d * n + i], twist[:, d * n + i] * fraction[i]])
            square = [np.outer(h[0], h[0]), np.outer(h[0], h[1]) + np.outer(h[1], h[0]), np.outer(h[1], h[1])]
            for p, share in enumerate(area[: powers - 2]):
                for q, matrix in enumerate(square):
                    found[:, :, p + q, d, strips.element[i]] += share * matrix
    tips = lever[:, 2 * n :]
    return np.concatenate([found.reshape(6, 6, -1), tips[:, None] * tips[None]], axis=2)
