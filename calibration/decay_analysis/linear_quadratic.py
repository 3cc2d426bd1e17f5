"""Decay analysis: linear and quadratic (P-Q) damping from logarithmic decrements.

The law is x'' + p x' + q x'|x'| + w^2 x = 0, of one degree of freedom, with p in 1/s and q in 1/m or 1/rad. Between two
successive extremes A0, A1 the energy w^2 (A0^2 - A1^2)/2 per unit mass is lost to damping. Along x = a cos wt the loss over
half a cycle is pi w a^2 p/2 + 4 w^2 a^3 q/3. With a = (A0 + A1)/2, A0^2 - A1^2 = 2 a (A0 - A1) and A0 - A1 = a ln(A0/A1),

    ln(A0/A1) = (t1 - t0)/2 p + 4/3 a q,        or for whole cycles        2/T ln(A0/A2) = p + 16/(3 T) a q,

the linear-quadratic fit of basin practice (Faltinsen 1990, Sea Loads on Ships and Offshore Structures, chapter 7). It is
equivalent linearisation too, since 16/(3 T) = 8 w/(3 pi).

It is exact for q = 0, whatever p is, since the period is the measured, damped one. Otherwise its relative error is of second
order in the decrement. Time run backwards changes the sign of p and q and swaps A0 and A1. That leaves `a` and t1 - t0 as they
are, so ln(A0/A1) is odd in (p, q). The size of the error comes from solutions of the equation, with L the largest ln(A0/A1) of
a half cycle. L is between 0.1 and 1, and p goes up to zeta = 0.16. Then q is low by up to 0.08 L^2 of itself (0.65 L^2 over
whole cycles), and p is high by up to 0.005 L^2 w (0.02 L^2 w). Extremes read off a record add their own error where it starts
or ends within a half cycle: some 1e-4 of p in clean data.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy  # its parts are imported when they are used: that takes a second

from calibration.campaign.signals import noise_level
from calibration.decay_analysis.decrements import Decrements, decrements

MIN_DECREMENTS = 3  # decrements that a fit of two numbers with an interval needs
CONFIDENCE = 0.95
_TERMS = ("linear", "quadratic")


class EstimateWithInterval(NamedTuple):
    """An estimate with its 95 % confidence interval: floats, or arrays of one shape.

    Attributes:
        value: Estimate.
        lower: Lower end of the interval.
        upper: Upper end of the interval.
    """

    value: np.ndarray | float
    lower: np.ndarray | float
    upper: np.ndarray | float


@dataclass(frozen=True, eq=False)
class LinearQuadratic:
    """Linear and quadratic (P-Q) damping of a decay.

    Attributes:
        linear: p (1/s).
        quadratic: q (1/m or 1/rad).
        covariance: (2, 2) covariance of p and q.
        scatter: Standard deviation of the extremes about the fit (m or rad).
        freedom: Degrees of freedom: number of decrements less two.
        period: Mean period (s).
        warnings: Sentences on a negative p or q.
    """

    linear: EstimateWithInterval
    quadratic: EstimateWithInterval
    covariance: np.ndarray
    scatter: float
    freedom: int
    period: float
    warnings: tuple[str, ...]

    def damping(self, inertia: float) -> tuple[EstimateWithInterval, EstimateWithInterval]:
        """Dimensional damping: B_lin = M p (N s/m, N m s) and B_quad = M q (N s2/m2, N m s2).

        Args:
            inertia: M, mass or moment of inertia with added mass (kg, kg m2).

        Returns:
            B_lin and B_quad.
        """
        return tuple(
            EstimateWithInterval(*(inertia * number for number in estimate)) for estimate in (self.linear, self.quadratic)
        )  # type: ignore


@dataclass(frozen=True, eq=False)
class Classical:
    """Classical analysis of one decay record.

    Crests and troughs are also analysed apart, over whole cycles. Where their decrements differ, the record does not
    oscillate about zero.

    Attributes:
        half_cycles: Pairs of extremes half a cycle apart.
        positive: Pairs of crests a whole cycle apart.
        negative: Pairs of troughs a whole cycle apart.
        fit: Damping by half cycles.
        positive_fit: Damping by crests; None with too few cycles.
        negative_fit: Damping by troughs; None with too few cycles.
        equivalent: Equivalent damping at the amplitudes of `half_cycles` (N s/m, N m s); None without an inertia.
    """

    half_cycles: Decrements
    positive: Decrements
    negative: Decrements
    fit: LinearQuadratic
    positive_fit: LinearQuadratic | None
    negative_fit: LinearQuadratic | None
    equivalent: EstimateWithInterval | None


def linear_quadratic(pairs: Decrements) -> LinearQuadratic:
    """Fit linear and quadratic damping to decrements.

    The law is ln(A0/A1) = (t1 - t0)/2 p + 8/3 c a q, with c = 1/2 for half cycles and 1 for whole ones (see the module).
    All extremes have one standard deviation. A decrement then has a variance of 1/A0^2 + 1/A1^2, and neighbours
    share an extreme, with a correlation near -1/2. Intervals are by Student's t, since the standard deviation is estimated.

    Args:
        pairs: Pairs of extremes.

    Returns:
        p and q with their intervals.

    Raises:
        ValueError: If there are fewer than 3 decrements, or the amplitude hardly varies.

    References:
        Aitken 1935, Proceedings of the Royal Society of Edinburgh 55, 42-48 (generalised least squares).
    """
    count, amplitude = len(pairs.first), pairs.amplitude
    if count < MIN_DECREMENTS:
        raise ValueError(f"expected a decay with at least {MIN_DECREMENTS} decrements, found {count}")
    duration = pairs.period * pairs.cycles
    design = np.stack([0.5 * duration, 8 / 3 * pairs.cycles * amplitude], axis=1)
    ratio = np.zeros((count, len(pairs.heights)))  # d ln(A0/A1) for a unit error of each extreme
    ratio[np.arange(count), pairs.first] = 1 / pairs.heights[pairs.first]
    ratio[np.arange(count), pairs.second] = -1 / pairs.heights[pairs.second]
    whiten = np.linalg.cholesky(ratio @ ratio.T)
    scale = np.linalg.norm(design, axis=0)
    rows = np.linalg.solve(whiten, design / scale)
    target = np.linalg.solve(whiten, pairs.decrement * pairs.cycles)
    if np.linalg.cond(rows) > 1e6:
        raise ValueError(f"expected a decay, found amplitudes between {amplitude.min():.6g} and {amplitude.max():.6g} only")
    solution, *_ = np.linalg.lstsq(rows, target)
    freedom = count - 2
    variance = float(np.sum((target - rows @ solution) ** 2)) / freedom
    covariance = variance * np.linalg.inv(rows.T @ rows) / np.outer(scale, scale)
    best, half = solution / scale, _quantile(freedom) * np.sqrt(np.diag(covariance))
    warnings = tuple(
        f"{name} damping is negative: {value:.3g}, {'within' if value + width >= 0 else 'beyond'} its uncertainty"
        for name, value, width in zip(_TERMS, best, half)
        if value < 0
    )
    linear, quadratic = (EstimateWithInterval(float(b), float(b - h), float(b + h)) for b, h in zip(best, half))
    # the time of an extreme is the less certain, the lower it is
    period = float(np.average(pairs.period, weights=amplitude**2))
    return LinearQuadratic(linear, quadratic, covariance, math.sqrt(variance), freedom, period, warnings)


def equivalent_damping(fit: LinearQuadratic, amplitude: np.ndarray | float, inertia: float) -> EstimateWithInterval:
    """Compute the equivalent linear damping B_eq(a) = M (p + 8/(3 pi) q w a), w = 2 pi/T.

    It dissipates the same energy per cycle at amplitude a. The interval is that of p and q together; the inertia is taken
    as known.

    Args:
        fit: Linear and quadratic damping.
        amplitude: Amplitude of motion (m or rad), of any shape.
        inertia: M, mass or moment of inertia with added mass (kg, kg m2).

    Returns:
        B_eq (N s/m, N m s) of the shape of `amplitude`, with its interval.

    References:
        Faltinsen 1990, Sea Loads on Ships and Offshore Structures, chapter 7.
    """
    a = np.asarray(amplitude, dtype=float)
    row = np.stack([np.ones_like(a), 16 / (3 * fit.period) * a], axis=-1)
    value = row @ np.array([fit.linear.value, fit.quadratic.value])
    width = _quantile(fit.freedom) * np.sqrt(np.einsum("...i,ij,...j", row, fit.covariance, row))
    return EstimateWithInterval(inertia * value, inertia * (value - width), inertia * (value + width))


def _quantile(freedom: int) -> float:
    """Half the width of the confidence interval over its standard deviation: a quantile of Student's t distribution.

    Args:
        freedom: Degrees of freedom.
    """
    return float(scipy.special.stdtrit(freedom, 0.5 + CONFIDENCE / 2))  # as of scipy.stats, which takes long to import


def classical(
    time: np.ndarray, motion: np.ndarray, noise: float | None = None, inertia: float | None = None, skip: int = 0
) -> Classical:
    """Analyse a free decay about zero: decrements, linear and quadratic damping, equivalent damping.

    Args:
        time: (k,) increasing times (s).
        motion: (k,) motion (m or rad).
        noise: Standard deviation of the noise on `motion` (m or rad); None: estimated by `noise_level`.
        inertia: Mass or moment of inertia with added mass (kg, kg m2); None: no equivalent damping.
        skip: Half cycles left out at the start, where the flow has not built up and damps less.

    Returns:
        The analysis.

    Raises:
        ValueError: If the record is no such series, has fewer than 3 half cycles, or does not decay.
    """
    time, motion = np.asarray(time, dtype=float), np.asarray(motion, dtype=float)
    if time.ndim != 1 or time.shape != motion.shape:
        raise ValueError(f"expected time and motion of one length, found shapes {time.shape} and {motion.shape}")
    if not (np.isfinite(time).all() and np.isfinite(motion).all() and np.all(np.diff(time) > 0)):
        raise ValueError("expected finite numbers and increasing times, found others")
    noise = noise_level(time, motion) if noise is None else noise
    half, *sides = decrements(time, motion, noise)
    if skip < 0 or len(half.first) - skip < MIN_DECREMENTS:
        raise ValueError(
            f"expected at least {MIN_DECREMENTS} half cycles after the {skip} skipped, clear of noise of {noise:.3g}, "
            f"found {max(len(half.first) - skip, 0)}"
        )
    start = half.first[skip]
    half, positive, negative = (
        Decrements(pairs.extreme_times, pairs.heights, pairs.first[late], pairs.second[late], pairs.cycles)
        for pairs in (half, *sides)
        for late in [pairs.first >= start]
    )
    fit = linear_quadratic(half)
    crests, troughs = (linear_quadratic(side) if len(side.first) >= MIN_DECREMENTS else None for side in (positive, negative))
    equivalent = None if inertia is None else equivalent_damping(fit, half.amplitude, inertia)
    return Classical(half, positive, negative, fit, crests, troughs, equivalent)
