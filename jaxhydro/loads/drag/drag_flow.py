"""Relative velocity u, |u|u and areas that drag laws use, and values that are kept for some lines.

A line is a strip's direction or an end's axis (see `Hull`): strips' first directions, their second ones, then ends.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.hull.hull import Hull
from jaxhydro.loads.coefficients import PerGroup, spread, spread_ends
from jaxhydro.loads.instant import Instant

# m2/s2 under the root: keeps the gradient of the speed finite at rest, and is lost in rounding elsewhere
MIN_SQUARED_SPEED = 1e-12


@dataclass(frozen=True)
class DragFlow:
    """Flow past all strips, or past all ends and faces, at an instant.

    Arrays are (2, n) for strips, by direction, and (m,) for ends.

    Attributes:
        now: Motion, geometry and flow at the instant.
        ends: Whether it is the flow along members past their ends, or that across them past their strips.
        coupled: Whether the speed past a strip is that of both directions together.
    """

    now: Instant
    ends: bool
    coupled: bool

    @property
    def velocity(self) -> Float[Array, "..."]:
        """Velocity of the water relative to the hull (m/s)."""
        return self.now.end_flow.relative if self.ends else self.now.strip_flow.relative

    @property
    def area(self) -> Float[Array, "..."]:
        """Wet area normal to the flow (m²)."""
        return self.now.end_shape.facing * self.now.end_flow.wet if self.ends else self.now.strip_shape.facing

    @property
    def extent(self) -> Float[Array, "..."]:
        """Size across the flow (m)."""
        hull = self.now.hull
        if self.ends:
            return jnp.where(hull.ends.radius > 0, 2 * hull.ends.radius, 1.0)
        return (hull.strips.size + hull.strips.taper * self.part(self.now.lines.away))[::-1]

    @property
    def coefficients(self) -> list[tuple[str, str]]:
        """Groups and kinds of the drag coefficients of these strips or ends."""
        hull = self.now.hull
        return hull.ends.owners("Cd") if self.ends else hull.elements.owners("Cd")

    def spread(self, values: PerGroup, missing: float) -> Float[Array, "..."]:
        """Parameters by group and kind as an array; `missing` where there is none."""
        if self.ends:
            return spread_ends(self.now.hull.ends, values, "Cd", missing)
        return self.now.over_strips(spread(self.now.hull.elements, values, "Cd", missing))

    def part(self, lines: Float[Array, " l"]) -> Float[Array, "..."]:
        """Values at these strips or ends, out of values at all lines."""
        return self.now.hull.split(lines)[self.ends]

    def together(self, values: Float[Array, "..."]) -> Float[Array, "..."]:
        """Sum over the two directions of strips where they are `coupled`; else the values."""
        return values.sum(axis=0) if self.coupled and not self.ends else values

    def signed_square(self, velocity: Float[Array, "..."]) -> Float[Array, "..."]:
        """|u| u (m²/s²) of a velocity u (m/s); |u| is that of the vector where directions are `coupled`."""
        return jnp.sqrt(self.together(velocity**2) + MIN_SQUARED_SPEED) * velocity


def relative_velocity(now: Instant) -> Float[Array, " l"]:
    """Velocity of the water relative to the hull along all lines (m/s), (l,)."""
    return now.hull.join(now.strip_flow.relative, now.end_flow.relative)


def lines_of(hull: Hull, coefficients: Iterable[tuple[str, str]], both: bool = False) -> tuple[int, ...]:
    """Lines whose drag coefficient is among `coefficients`, in order.

    Args:
        hull: The hull.
        coefficients: Groups and kinds of drag coefficients.
        both: Include the other directions of their strips.
    """
    wanted, elements = set(coefficients), hull.elements
    names, of_ends = elements.owners("Cd"), hull.ends.owners("Cd")
    strips = np.array([[names[row[e]] in wanted for e in hull.strips.element] for row in elements.label], bool)
    strips = strips.reshape(2, len(hull.strips.element))
    if both:
        strips = strips | strips[::-1]
    wide = np.asarray(hull.ends.radius) > 0
    ends = [bool(wide[i]) and of_ends[k] in wanted for i, k in enumerate(hull.ends.label)]
    return tuple(map(int, np.flatnonzero(np.concatenate([strips.reshape(-1), np.array(ends, bool)]))))


def on_all_lines(hull: Hull, values: Float[Array, " k"], lines: tuple[int, ...]) -> Float[Array, " l"]:
    """Values of some lines on all lines, 0 on the others.

    By a gather: scatters are slow on a CPU.

    Args:
        hull: The hull.
        values: Values of `lines`, (k,).
        lines: Numbers of these lines.
    """
    index = np.full(2 * len(hull.strips.element) + len(hull.ends.label), len(lines))
    index[list(lines)] = np.arange(len(lines))
    return jnp.concatenate([values, jnp.zeros(1)])[index]
