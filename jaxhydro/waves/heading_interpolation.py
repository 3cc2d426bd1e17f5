"""Interpolation of complex tables over wave headings."""

import math
from typing import Self

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Complex, Float, Int

from jaxhydro.quick_jit import as_data, on_device, quick_jit

HEADING_TOLERANCE = math.radians(1e-6)  # rad, by which a heading may be outside a table or off an even step
REFINEMENT = 8  # times as many headings, to which an even table of the whole circle is refined before it is splined


class HeadingInterpolation(eqx.Module):
    """Complex table over headings, interpolated between them.

    Real and imaginary parts are interpolated, not modulus and phase: where a modulus is near zero, a phase jumps.

    - Even headings over the whole circle: the trigonometric polynomial through them, refined by Fourier transform and then
      splined. N headings resolve N/2 harmonics. A body of radius R in waves of wavenumber k has about k R of them.
    - Other headings: a cubic spline, periodic where they cover the whole circle; a line between two headings.

    At a heading of the table its values are returned without rounding. Beyond the table there is nothing: see `covers`.

    Attributes:
        heading: Knots (rad), ascending, (d,).
        coefficient: Coefficients of cubics in heading minus knot, highest power first, (4, d-1, ...); (4, 1, ...) for one.
        wraps: Whether the knots cover the whole circle; the last is then the first, a turn on.
    """

    heading: Float[Array, " d"]
    coefficient: Complex[Array, "4 c ..."]
    wraps: bool = eqx.field(static=True)

    @classmethod
    def of(cls, heading: Float[np.ndarray, " d"], values: Complex[np.ndarray, "d ..."]) -> Self:
        """Interpolation of a table.

        A heading that is given twice, a turn apart, is taken once. The whole circle is covered where the largest gap between
        headings is not above twice the usual one.

        Args:
            heading: Headings (rad) in any order, (d,).
            values: The table, (d, ...).
        """
        turned = np.mod(np.asarray(heading, float) + HEADING_TOLERANCE, 2 * math.pi) - HEADING_TOLERANCE
        order = np.argsort(turned, kind="stable")
        order = order[np.r_[True, np.diff(turned[order]) > 2 * HEADING_TOLERANCE]]
        knots, values = turned[order], np.asarray(values, complex)[order]
        gaps = np.diff(np.r_[knots, knots[0] + 2 * math.pi])
        if len(knots) == 1:
            none = np.zeros_like(values)
            return cls(on_device(knots), on_device(np.stack([none, none, none, values])), False)
        wraps = bool(len(knots) > 3 and gaps.max() <= 2 * np.median(gaps) * (1 + 1e-6))
        if not wraps:
            begin = int(np.argmax(gaps)) + 1  # after the largest gap
            knots = np.r_[knots[begin:], knots[:begin] + 2 * math.pi]
            values = np.roll(values, -begin, axis=0)
        elif np.ptp(gaps) < 4 * HEADING_TOLERANCE:
            exact, count = values, len(knots)
            values = _refined(values, REFINEMENT)
            values[::REFINEMENT] = exact
            knots = np.interp(
                np.arange(count * REFINEMENT) / REFINEMENT, np.arange(count + 1), np.r_[knots, knots[0] + 2 * math.pi]
            )
        if wraps:
            knots = np.r_[knots, knots[0] + 2 * math.pi]
            values = np.concatenate([values, values[:1]])
        cubic = _spline(knots, values, wraps)
        return cls(on_device(knots), on_device(cubic), wraps)

    def covers(self, heading: Float[np.ndarray, "..."] | float) -> Bool[np.ndarray, "..."]:
        """Whether headings (rad) lie within the table, whole turns aside."""
        if self.wraps:
            return np.ones(np.shape(heading), bool)
        knots = np.asarray(self.heading)
        first, last = float(knots[0]), float(knots[-1])
        past = np.mod(np.asarray(heading, float) - first + HEADING_TOLERANCE, 2 * math.pi)
        return past <= last - first + 2 * HEADING_TOLERANCE

    def locate(self, heading: Float[Array, "..."]) -> tuple[Int[Array, "..."], Float[Array, "..."]]:
        """Knot below each heading (rad), and angle (rad) from there on.

        A heading beyond the table is taken to the nearer end.
        """
        knots, first = self.heading, self.heading[0]
        past = jnp.mod(heading - first + HEADING_TOLERANCE, 2 * math.pi) - HEADING_TOLERANCE
        span = knots[-1] - first
        past = jnp.where(past > 0.5 * (2 * math.pi + span), 0.0, jnp.clip(past, 0.0, span))
        index = jnp.clip(jnp.searchsorted(knots, first + past, side="right") - 1, 0, self.coefficient.shape[1] - 1)
        # a knot that is met up to rounding is that knot
        offset = past - (knots[index] - first)
        return index, jnp.where(jnp.abs(offset) < 1e-12, 0.0, offset)

    def at(self, heading: Float[Array, ""] | float) -> Complex[Array, "..."]:
        """The table at one heading (rad)."""
        return _at(self, as_data(heading))


@quick_jit
def _at(table: HeadingInterpolation, heading: Float[Array, ""]) -> Complex[Array, "..."]:
    """Values of a table at a heading (rad), in one compiled program."""
    index, offset = table.locate(heading)
    cubic = table.coefficient[:, index]
    return ((cubic[0] * offset + cubic[1]) * offset + cubic[2]) * offset + cubic[3]


def _spline(
    knots: Float[np.ndarray, " d"], values: Complex[np.ndarray, "d ..."], wraps: bool
) -> Complex[np.ndarray, "4 c ..."]:
    """Coefficients of a cubic spline, highest power first: periodic, or without a knot next to the ends.

    Three knots have a parabola, two a line.

    References:
        de Boor (1978), A Practical Guide to Splines, chapter IV.
    """
    count, flat = len(knots), values.reshape(len(knots), -1)
    h = np.diff(knots)
    slope = np.diff(flat, axis=0) / h[:, None]
    matrix, right = np.zeros((count, count)), np.zeros_like(flat)
    for i in range(1, count - 1):
        matrix[i, i - 1 : i + 2] = h[i - 1], 2 * (h[i - 1] + h[i]), h[i]
        right[i] = 6 * (slope[i] - slope[i - 1])
    if wraps:
        matrix[0, [0, 1, -2]] = 2 * (h[-1] + h[0]), h[0], h[-1]
        right[0] = 6 * (slope[0] - slope[-1])
        matrix[-1, [0, -1]] = 1.0, -1.0
    elif count > 3:
        matrix[0, :3] = -h[1], h[0] + h[1], -h[0]
        matrix[-1, -3:] = -h[-1], h[-2] + h[-1], -h[-2]
    else:  # equal curvatures, none of a line
        matrix[0, [0, 1]] = 1.0, -1.0 if count == 3 else 0.0
        matrix[-1, [-1, -2]] = 1.0, -1.0 if count == 3 else 0.0
    bend = np.linalg.solve(matrix, right)
    step = h[:, None]
    cubic = (np.diff(bend, axis=0) / (6 * step), 0.5 * bend[:-1], slope - step * (2 * bend[:-1] + bend[1:]) / 6, flat[:-1])
    return np.stack(cubic).reshape(4, count - 1, *values.shape[1:])


def _refined(values: Complex[np.ndarray, "d ..."], times: int) -> Complex[np.ndarray, "e ..."]:
    """Trigonometric polynomial through even values of a period, at `times` as many points."""
    count = len(values)
    half = count // 2
    spectrum = np.fft.fft(values, axis=0)
    wide = np.zeros((count * times, *values.shape[1:]), complex)
    wide[: half + 1] = spectrum[: half + 1]
    wide[-half:] = spectrum[-half:] if half else 0.0
    if count % 2 == 0:  # the highest harmonic, shared by both signs
        wide[half] = wide[-half] = 0.5 * spectrum[half]
    return np.fft.ifft(wide, axis=0) * times
