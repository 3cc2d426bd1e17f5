"""Tension at the fairlead of catenaries from the distance between anchor and fairlead."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from jaxhydro.loads.catenary.catenary_profile import Segments, flexibility, hanging_straight_down, reach

MOST_STEPS = 150  # of Newton's method; 3 to 6 are usual
TOLERANCE = 1e-8  # of the last step over the tension: squared after it, as Newton's method converges
ACCEPTED = 1e-6  # the same: what is beyond is no solution, and is told as NaN
DEEPEST_CUT = 0.1  # of a tension that cannot be negative: what one step leaves of it at least
STEEPEST_RISE = 0.5  # of the energy's slope at a step's end, over its fall at the start, with which the step is accepted
SHORTEST = 0.1  # of a step that is shortened: what is left of it at least


def end_tension(
    span: Float[Array, " l"], height: Float[Array, " l"], segments: Segments
) -> tuple[Float[Array, " l"], Float[Array, " l"]]:
    """Horizontal and vertical tension at the fairlead of elastic catenaries.

    `reach` is solved for the tension by Newton's method. Without friction its inverse is the minimum of a convex function,
    the complementary energy, so that the root is unique. A line that is longer than the way down to the seabed and along it
    to the anchor is slack: it hangs straight down, without horizontal tension. Derivatives of every order follow from the
    implicit function theorem, in forward and reverse mode.

    Args:
        span: Horizontal distance from anchor to fairlead (m); positive.
        height: Height of the fairlead over the anchor (m); positive where the anchor is on the seabed.
        segments: The lines.

    Returns:
        Horizontal and vertical tension (N), (l,) each; vertical is positive where the line pulls the fairlead down.

    References:
        Jonkman 2007, NREL/TP-500-41958, equations 2-35 to 2-43; Peyrot and Goulois 1979, Computers & Structures 10, 805-813.
    """
    straight, rests = hanging_straight_down(height, segments)
    slack = segments.grounded & (span <= rests)
    # lines that are slack are solved for some distance at which they are not, and the result is not used
    span = jnp.where(slack, rests + 0.3 * height, span)
    horizontal, vertical = _root(span, height, segments)
    return jnp.where(slack, 0.0, horizontal), jnp.where(slack, straight, vertical)


class _Search(NamedTuple):
    """State of Newton's method for each line.

    Attributes:
        horizontal: Horizontal tension (N) at the last point that was accepted.
        vertical: Vertical tension (N) there.
        change: Step (N) of the horizontal tension to the next point.
        lift: Step (N) of the vertical tension.
        slope: Derivative of the complementary energy along the step (J); negative.
    """

    horizontal: Float[Array, " l"]
    vertical: Float[Array, " l"]
    change: Float[Array, " l"]
    lift: Float[Array, " l"]
    slope: Float[Array, " l"]

    def within(self, tolerance: float) -> Bool[Array, " l"]:
        """Whether the next step is that small over the tension, for each line."""
        step = jnp.maximum(jnp.abs(self.change), jnp.abs(self.lift))
        return step <= tolerance * (self.horizontal + jnp.abs(self.vertical))


@jax.custom_jvp
def _root(span: Float[Array, " l"], height: Float[Array, " l"], segments: Segments) -> tuple[Array, Array]:
    """Tension that `reach` needs for a distance, by Newton's method with a line search."""

    def newton(search: _Search) -> _Search:
        horizontal, vertical = search.horizontal + search.change, search.vertical + search.lift
        (x, z), by_horizontal, by_vertical = flexibility(horizontal, vertical, segments)
        x, z = x - span, z - height  # gradient of the complementary energy
        # beyond the minimum along the step, where the energy rises steeply: back by the secant
        slope = x * search.change + z * search.lift
        overshot = slope > -STEEPEST_RISE * search.slope
        back = jnp.where(overshot, jnp.maximum(search.slope / (search.slope - jnp.where(overshot, slope, 0.0)), SHORTEST), 1.0)
        full, fall = _solve(by_horizontal, by_vertical, -x, -z)
        # a tension that cannot be negative falls by a factor of 10 at most: by itself, or else with the whole step shortened
        lowest = jnp.where(segments.grounded, (DEEPEST_CUT - 1) * vertical, -jnp.inf)
        change, lift = jnp.maximum(full, (DEEPEST_CUT - 1) * horizontal), jnp.maximum(fall, lowest)
        whole = jnp.minimum(change / jnp.where(change > full, full, change), lift / jnp.where(lift > fall, fall, lift))
        steep = x * change + z * lift > 0.1 * (x * full + z * fall) * whole
        change, lift = jnp.where(steep, whole * full, change), jnp.where(steep, whole * fall, lift)
        return _Search(
            jnp.where(overshot, search.horizontal, horizontal),
            jnp.where(overshot, search.vertical, vertical),
            jnp.where(overshot, back * search.change, change),
            jnp.where(overshot, back * search.lift, lift),
            jnp.where(overshot, back * search.slope, x * change + z * lift),
        )

    none = jnp.zeros_like(span)
    search = newton(_Search(*start(span, height, segments), none, none, none))
    going = lambda state: ~state[0].within(TOLERANCE).all() & (state[1] < MOST_STEPS)  # noqa: E731
    search, _ = jax.lax.while_loop(going, lambda state: (newton(state[0]), state[1] + 1), (search, jnp.asarray(1)))
    solved = search.within(ACCEPTED)
    return jnp.where(solved, search.horizontal + search.change, jnp.nan), jnp.where(
        solved, search.vertical + search.lift, jnp.nan
    )


@_root.defjvp
def _root_jvp(primals, tangents):
    """By the implicit function theorem."""
    *_, segments = primals
    horizontal, vertical = _root(*primals)
    _, by_horizontal, by_vertical = flexibility(horizontal, vertical, segments)
    _, (x, z) = jax.jvp(lambda parts: reach(horizontal, vertical, parts), (segments,), (tangents[2],))
    return (horizontal, vertical), _solve(by_horizontal, by_vertical, tangents[0] - x, tangents[1] - z)


def _solve(
    first: tuple[Array, Array], second: tuple[Array, Array], x: Float[Array, " l"], z: Float[Array, " l"]
) -> tuple[Float[Array, " l"], Float[Array, " l"]]:
    """Solution of 2 x 2 systems with these columns."""
    determinant = first[0] * second[1] - first[1] * second[0]
    return (x * second[1] - z * second[0]) / determinant, (z * first[0] - x * first[1]) / determinant


def start(
    span: Float[Array, " l"], height: Float[Array, " l"], segments: Segments
) -> tuple[Float[Array, " l"], Float[Array, " l"]]:
    """Tension at the fairlead from which Newton's method starts (N).

    All segments are taken together as one. The start decides how many steps are taken, and nothing else.

    - A line that rests on the seabed: with q = H / (w z), its span is that of the slack line plus z phi(q),
      phi = 1 - sqrt(1 + 2 q) + q acosh(1 + 1 / q). This is inverted by a fit of ours, to about 5 %.
    - A suspended line: its tension T along the chord D is that of a parabolic cable (Irvine 1981, chapter 2). It is the root
      of the cubic T³ + EA (l / D - 1) T² = EA (w X)² / 24.
    """
    length = segments.length.sum(axis=0)
    weight = (segments.weight * segments.length).sum(axis=0) / length
    stiffness = length / (segments.length / segments.stiffness).sum(axis=0)
    # suspended: l0 (1 + T / EA) = D (1 + (w X)² / (24 T²)), a cubic for T
    chord = jnp.sqrt(span**2 + height**2)
    excess = stiffness * (length / chord - 1)
    sag = stiffness * (weight * span) ** 2 / 24
    tension = jnp.maximum(-excess, 0.0) + jnp.sqrt(sag / (jnp.abs(excess) + jnp.cbrt(sag)))
    for _ in range(2):
        tension -= (tension**3 + excess * tension**2 - sag) / (3 * tension**2 + 2 * excess * tension)
    horizontal = tension * span / chord
    vertical = tension * height / chord + 0.5 * weight * length
    # on the seabed
    drop = jnp.where(segments.grounded, jnp.maximum(height, 1e-6 * length), 1.0)
    stretched = length
    touching = jnp.zeros_like(span)
    for _ in range(2):
        phi = jnp.clip((span - stretched) / drop + 1, 1e-12, 1 - 1e-9)
        ratio = phi / ((1 - phi) ** 2 * (4.5 * phi + (1 - phi) * (1.6 - jnp.log(phi))))
        touching = weight * drop * ratio
        stretched = length * (1 + touching / stiffness)
    suspended = drop * jnp.sqrt(1 + 2 * ratio)
    rests = segments.grounded & (suspended < length) & (phi < 1 - 1e-9)
    return jnp.where(rests, touching, horizontal), jnp.where(rests, weight * suspended, vertical)
