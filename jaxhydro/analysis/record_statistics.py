"""Statistics of an evenly sampled record, and exceedance of its peaks."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxhydro.analysis.spectral import checked_record


class Statistics(NamedTuple):
    """Statistics of a record.

    Attributes:
        mean: Mean (unit).
        standard_deviation: Standard deviation (unit).
        minimum: Smallest value (unit).
        maximum: Largest value (unit).
        skewness: Third standardised moment (-); 0 for a Gaussian process.
        kurtosis: Fourth standardised moment (-); 3 for a Gaussian process.
        zero_crossing_period: Mean time (s) between upward crossings of the mean; NaN with fewer than two.
        significant_double_amplitude: Mean of the highest third of the ranges between these crossings (unit); NaN as above.
    """

    mean: float
    standard_deviation: float
    minimum: float
    maximum: float
    skewness: float
    kurtosis: float
    zero_crossing_period: float
    significant_double_amplitude: float


def statistics(time: Float[np.ndarray, " t"], x: Float[np.ndarray, " t"]) -> Statistics:
    """Moments, extremes and zero-crossing statistics of a record.

    Noise adds crossings of its own: filter it out first.

    Args:
        time: Sample times (s), (t,), even.
        x: Record (unit), (t,).

    Returns:
        Statistics in the unit of the record; skewness, kurtosis and zero-crossing statistics are NaN where undefined.

    Raises:
        ValueError: The times are uneven, or values are not finite.
    """
    _, x = checked_record(time, x)
    centred = x - x.mean()
    deviation = float(centred.std())
    scaled = centred / deviation if deviation > 0 else np.full(len(x), np.nan)
    crossing, cycles = _cycles(np.asarray(time, float), centred)
    ranges = np.sort([float(np.ptp(cycle)) for cycle in cycles])[::-1]
    highest = ranges[: max(round(len(ranges) / 3), 1)]
    return Statistics(
        float(x.mean()),
        deviation,
        float(x.min()),
        float(x.max()),
        float(np.mean(scaled**3)),
        float(np.mean(scaled**4)),
        float((crossing[-1] - crossing[0]) / len(cycles)) if cycles else float("nan"),
        float(highest.mean()) if cycles else float("nan"),
    )


class Exceedance(NamedTuple):
    """Peaks of a record and how often they are exceeded.

    Attributes:
        amplitude: Peaks above the mean (unit), ascending, (n,).
        probability: Fraction of peaks above each, (n,).
        rayleigh: The same for a narrow-band Gaussian process of the record's standard deviation, (n,).
    """

    amplitude: Float[np.ndarray, " n"]
    probability: Float[np.ndarray, " n"]
    rayleigh: Float[np.ndarray, " n"]


def exceedance(time: Float[np.ndarray, " t"], x: Float[np.ndarray, " t"]) -> Exceedance:
    """Exceedance probability of the peaks of a record.

    A peak is the highest value above the mean between two upward crossings of the mean. For troughs, give -x. The i-th
    highest of n peaks is exceeded with probability i / (n + 1) (Weibull's plotting position).

    Args:
        time: Sample times (s), (t,), even.
        x: Record (unit), (t,).

    Returns:
        Peaks and probabilities; empty with fewer than two crossings.

    Raises:
        ValueError: The times are uneven, or values are not finite.

    References:
        Longuet-Higgins (1952): Rayleigh distribution exp(-a² / (2 s²)), s the standard deviation.
    """
    _, x = checked_record(time, x)
    centred = x - x.mean()
    _, cycles = _cycles(np.asarray(time, float), centred)
    peaks = np.sort([float(cycle.max()) for cycle in cycles])
    probability = np.arange(len(peaks), 0, -1) / (len(peaks) + 1)
    return Exceedance(peaks, probability, np.exp(-0.5 * peaks**2 / max(centred.var(), 1e-300)))


def _cycles(time: np.ndarray, centred: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
    """Times of the upward zero crossings (linear interpolation), and the samples between them."""
    before = np.flatnonzero((centred[:-1] < 0) & (centred[1:] >= 0))
    share = centred[before] / (centred[before] - centred[before + 1])
    crossing = time[before] + share * (time[before + 1] - time[before])
    return crossing, np.split(centred, before + 1)[1:-1]
