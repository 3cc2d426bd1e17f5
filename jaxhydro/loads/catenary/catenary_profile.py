"""Shape of elastic catenaries of several segments, with seabed contact.

Span and height follow from the tension at the fairlead.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

SMALL_RATIO = 1e-3  # of weight to twice the mean tension: below it, a series is exact to 1e-15


class Segments(NamedTuple):
    """Lines that each consist of segments, from the fairlead down to the anchor; l lines, s segments.

    A line with fewer segments than others has segments of no length at the end.

    Attributes:
        length: Unstretched length of each segment (m).
        weight: Weight in water of each segment (N/m); positive.
        stiffness: Axial stiffness EA of each segment (N).
        friction: Friction coefficient of the seabed (-) for each line.
        grounded: Whether the anchor of each line is on the seabed, so that the line may rest there.
    """

    length: Float[Array, "s l"]
    weight: Float[Array, "s l"]
    stiffness: Float[Array, "s l"]
    friction: Float[Array, " l"]
    grounded: Bool[Array, " l"]


def reach(
    horizontal: Float[Array, " l"], vertical: Float[Array, " l"], segments: Segments
) -> tuple[Float[Array, " l"], Float[Array, " l"]]:
    """Horizontal and vertical distance from anchor to fairlead that a tension at the fairlead holds.

    A suspended segment of length l, weight w and stiffness EA carries H and, at its two ends, V1 (above) and V2 = V1 - w l.
    With T = sqrt(H² + V²) at the ends and S = T1 + T2 it reaches

        x = H l (2 atanh(w l / S) / (w l) + 1 / EA),  z = l (V1 + V2) (1 / S + 1 / (2 EA)).

    This is equation 2-35 of Jonkman (2007), with asinh a - asinh b = 2 atanh((a - b) / (sqrt(1 + a²) + sqrt(1 + b²))). This
    form has no cancellation, and without weight it is the straight spring. A segment touches the seabed where V is 0. What
    rests there is stretched by H less friction, mu w per length, down to 0 (equation 2-37). Segments follow each other as
    in Peyrot and Goulois (1979).

    Args:
        horizontal: Horizontal tension H at the fairlead (N); positive.
        vertical: Vertical tension at the fairlead (N); positive where the line pulls it down.
        segments: The lines.

    Returns:
        Horizontal and vertical distance (m), (l,) each.

    References:
        Jonkman 2007, NREL/TP-500-41958, equations 2-35 to 2-38; Irvine 1981, Cable Structures, equations 2.24 and 2.25;
        Peyrot and Goulois 1979, Computers & Structures 10, 805-813.
    """
    x, z = jnp.zeros_like(horizontal), jnp.zeros_like(horizontal)
    upper, pull = vertical, horizontal  # vertical tension above; tension of what rests on the seabed
    for length, weight, stiffness in zip(segments.length, segments.weight, segments.stiffness):
        hanging = jnp.where(segments.grounded, jnp.clip(upper / weight, 0.0, length), length)
        lower = upper - weight * hanging
        tensions = jnp.sqrt(horizontal**2 + upper**2) + jnp.sqrt(horizontal**2 + lower**2)
        ratio = weight * hanging / tensions
        x += horizontal * hanging * (2 * _atanh_over(ratio) / tensions + 1 / stiffness)
        z += hanging * (upper + lower) * (1 / tensions + 0.5 / stiffness)
        rests, resistance = length - hanging, segments.friction * weight
        slides = jnp.where(resistance * rests < pull, rests, pull / jnp.where(resistance > 0, resistance, 1.0))
        beyond = pull - resistance * slides
        x += rests + 0.5 * (pull + beyond) * slides / stiffness
        upper, pull = lower, beyond
    return x, z


def length_on_seabed(vertical: Float[Array, " l"], segments: Segments) -> Float[Array, " l"]:
    """Unstretched length of lines that rests on the seabed.

    Args:
        vertical: Vertical tension at the fairlead (N); positive where the line pulls it down.
        segments: The lines.

    Returns:
        Length (m), (l,).

    References:
        Jonkman 2007, NREL/TP-500-41958, section 2.6: the suspended part weighs as much as the vertical tension.
    """
    upper, rests = vertical, jnp.zeros_like(vertical)
    for length, weight in zip(segments.length, segments.weight):
        hanging = jnp.where(segments.grounded, jnp.clip(upper / weight, 0.0, length), length)
        upper, rests = upper - weight * hanging, rests + length - hanging
    return rests


def _atanh_over(ratio: Float[Array, " l"]) -> Float[Array, " l"]:
    """atanh(u) / u."""
    small = ratio < SMALL_RATIO
    u = jnp.where(small, 0.5, ratio)
    return jnp.where(small, 1 + ratio**2 / 3 + ratio**4 / 5, 0.5 * jnp.log1p(2 * u / (1 - u)) / u)


def hanging_straight_down(height: Float[Array, " l"], segments: Segments) -> tuple[Float[Array, " l"], Float[Array, " l"]]:
    """Vertical tension at the fairlead, and length on the seabed, of lines that hang straight down to it.

    A slack line does so. In the segment where it touches down, the hanging length is the root of a quadratic.

    Args:
        height: Height of the fairlead over the seabed (m); positive.
        segments: The lines.

    Returns:
        Tension (N) and unstretched length on the seabed (m), (l,) each.

    References:
        Jonkman 2007, NREL/TP-500-41958, section 2.6: the limit H = 0 of equation 2-37.
    """
    pull, rests = jnp.zeros_like(height), jnp.zeros_like(height)
    linear, constant = jnp.ones_like(height), -height  # of l + w l² / (2 EA) + what hangs above, less the height
    above = jnp.zeros_like(height)  # flexibility of what hangs above
    for length, weight, stiffness in zip(segments.length, segments.weight, segments.stiffness):
        linear = 1 + weight * above
        gap = jnp.minimum(constant, 0.0)
        hanging = jnp.minimum(-2 * gap / (linear + jnp.sqrt(linear**2 - 2 * weight / stiffness * gap)), length)
        pull, rests = pull + weight * hanging, rests + length - hanging
        constant += length + weight * length * (above + 0.5 * length / stiffness)
        above += length / stiffness
    return pull, rests


def flexibility(
    horizontal: Float[Array, " l"], vertical: Float[Array, " l"], segments: Segments
) -> tuple[tuple[Array, Array], tuple[Array, Array], tuple[Array, Array]]:
    """Distances of `reach`, and their slopes by horizontal and by vertical tension (m/N)."""
    ones, zeros = jnp.ones_like(horizontal), jnp.zeros_like(horizontal)
    distances, by_horizontal = jax.jvp(lambda h, v: reach(h, v, segments), (horizontal, vertical), (ones, zeros))
    _, by_vertical = jax.jvp(lambda h, v: reach(h, v, segments), (horizontal, vertical), (zeros, ones))
    return distances, by_horizontal, by_vertical
