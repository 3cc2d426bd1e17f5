"""Functions that the drag laws share: quadratic force, areas and exponents by strip and end.

A line is a strip's direction or an end's axis (see `Hull`): strips' first directions, their second ones, then ends.
"""

from collections.abc import Iterable, Mapping
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.hull.hull import Hull
from jaxhydro.loads.coefficients import PerGroup, by_group, spread, spread_ends
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import Parameter, parameter, parameters

MIN_SQUARED_SPEED = (
    1e-12  # m2/s2 under the root: keeps the gradient of the speed finite at rest, and is lost in rounding elsewhere
)
SUCTION = "share of the drag of the ends of {group} that moves to where the flow leaves them"
MEANING = "{way} drag coefficient of {group}, on {area} area"

POWER_LABEL = "amplitude_dependent_drag"  # labels of coefficients that go with a power of the speed
REFERENCE_SPEED = 0.5  # m/s at which Cd is what it says
MIN_SPEED_RATIO = 0.04  # of that speed, below which the coefficient no longer changes
SLOW_DRAG_LABEL = "sea_state_dependent_drag"  # labels of drag in which slow motion has a coefficient of its own
TRANSVERSE = {"way": "transverse", "area": "projected"}
VERTICAL_OR_AXIAL = {"way": "vertical or axial", "area": "plan or end"}


def drag_coefficients() -> Any:
    """Field of a load with the drag coefficients of strips and ends."""
    return by_group("-", MEANING, 0.0, 30.0, t=TRANSVERSE, z=VERTICAL_OR_AXIAL)


def law_parameters(unit: str, meaning: str, lower: float, upper: float, neutral: float = 0.0) -> Any:
    """Field of a load with a parameter of a drag law for each drag coefficient; {way} and {group} are filled in."""
    return by_group(unit, meaning, lower, upper, neutral, t=TRANSVERSE, z=VERTICAL_OR_AXIAL)


def low_share() -> Any:
    """Field of a load: how much of all drag coefficients slow motion feels."""
    meaning = "share of all drag coefficients that the platform's slow motion feels"
    return parameter("-", meaning, 0.0, 3.0, 1.0, prefix=SLOW_DRAG_LABEL)


def cutoff() -> Any:
    """Field of a load: frequency (Hz) below which the platform's motion is slow."""
    return parameter("Hz", "frequency below which the platform's motion is slow", 0.005, 0.08, 0.03, prefix=SLOW_DRAG_LABEL)


def exponents_of_the_speed() -> Any:
    """Field of a load with an exponent of the speed for each group."""

    def about(load: Any, group: str) -> Parameter:
        speed = getattr(load, "speed", REFERENCE_SPEED)
        return Parameter("-", f"exponent of the drag coefficients of {group} in the speed over {speed:g} m/s", -1.0, 1.0)

    return parameters(about, POWER_LABEL + ".{key}.{name}")


def of_both_kinds(exponent: Mapping[str, Float[Array, ""] | float]) -> PerGroup:
    """Exponents of groups, for both kinds of drag coefficient."""
    return {(group, kind): value for group, value in exponent.items() for kind in "tz"}


def groups_of(coefficients: PerGroup) -> tuple[str, ...]:
    """Groups of members with a drag coefficient."""
    return tuple(dict.fromkeys(group for group, _ in coefficients))


def quadratic(
    density: float | Float[Array, ""], area: Float[Array, "... k"], relative: Float[Array, "... k"], coupled: bool = False
) -> Float[Array, "... k"]:
    """Quadratic drag force 1/2 rho Cd A |u| u (N).

    Args:
        density: Density of the water (kg/m³).
        area: Cd A (m²).
        relative: Relative velocity u of the water (m/s).
        coupled: Whether |u| is that of the vector along the first axis, or of each component.
    """
    square = relative**2
    if coupled:
        square = square.sum(axis=0)
    return 0.5 * density * area * jnp.sqrt(square + MIN_SQUARED_SPEED) * relative


def one_sided(
    density: float | Float[Array, ""],
    area: Float[Array, " m"],
    relative: Float[Array, " m"],
    outward: Float[Array, " m"],
    suction: Float[Array, " m"],
) -> Float[Array, " m"]:
    """One-sided drag force 1/2 rho Cd A (|w| w + s n w²) (N) along the axis of ends.

    Args:
        density: Density of the water (kg/m³).
        area: Cd A (m²), (m,).
        relative: Relative velocity w of the water (m/s), (m,).
        outward: Outward direction n along the axis, 1 or -1, (m,).
        suction: Fraction s of the drag on the side where the flow leaves, (m,).
    """
    return quadratic(density, area, relative) + 0.5 * density * area * suction * outward * relative**2


def of_strips(now: Instant, values: PerGroup, missing: float) -> Float[Array, "2 n"]:
    """Parameters of drag by direction and strip; `missing` where absent."""
    return now.over_strips(spread(now.hull.elements, values, "Cd", missing))


def of_ends(now: Instant, values: PerGroup, missing: float) -> Float[Array, " m"]:
    """Parameters of drag by end; `missing` where absent."""
    return spread_ends(now.hull.ends, values, "Cd", missing)


def strip_area(now: Instant, coefficients: PerGroup) -> Float[Array, "2 n"]:
    """Cd A (m²) by direction and strip, A normal to the flow; 0 without a coefficient."""
    return of_strips(now, coefficients, 0.0) * now.strip_shape.facing


def end_area(now: Instant, coefficients: PerGroup) -> Float[Array, " m"]:
    """Cd A (m²) by end, A the free wet area; 0 without a coefficient."""
    return of_ends(now, coefficients, 0.0) * now.end_shape.facing * now.end_flow.wet


def lines_of(hull: Hull, coefficients: Iterable[tuple[str, str]], both: bool = False) -> tuple[int, ...]:
    """Lines whose drag coefficient is among `coefficients`, in order.

    Args:
        hull: The hull.
        coefficients: Groups and kinds of drag coefficients.
        both: Include the other directions of their strips.
    """
    known, elements = set(coefficients), hull.elements
    names, of_ends = elements.owners("Cd"), hull.ends.owners("Cd")
    strips = np.array([[names[row[e]] in known for e in hull.strips.element] for row in elements.label], bool)
    strips = strips.reshape(2, len(hull.strips.element))
    if both:
        strips = strips | strips[::-1]
    wide = np.asarray(hull.ends.radius) > 0
    ends = [bool(wide[i]) and of_ends[k] in known for i, k in enumerate(hull.ends.label)]
    return tuple(map(int, np.flatnonzero(np.concatenate([strips.reshape(-1), np.array(ends, bool)]))))


def on_all(some: Float[Array, " k"], lines: tuple[int, ...], count: int) -> Float[Array, " l"]:
    """Values of some lines on all lines, 0 on the others.

    By a gather: scatters are slow on a CPU.

    Args:
        some: Values of `lines`, (k,).
        lines: Numbers of these lines.
        count: Number of all lines.
    """
    place = np.full(count, len(lines))
    place[list(lines)] = np.arange(len(lines))
    return jnp.concatenate([some, jnp.zeros(1)])[place]


def power(square: Float[Array, "..."], exponent: Float[Array, "..."], speed: float = REFERENCE_SPEED) -> Float[Array, "..."]:
    """Factor ((u² + e²)/(U0² + e²))^(n/2) of the drag; exactly 1 for n = 0.

    Args:
        square: u² (m²/s²).
        exponent: n (-).
        speed: U0 (m/s); e is a small fraction of it.
    """
    slow = (MIN_SPEED_RATIO * speed) ** 2
    return jnp.exp(0.5 * exponent * jnp.log((square + slow) / (speed**2 + slow)))
