"""Lifetime statistics: statistics of runs weighted by the probability of their cases."""

import math
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

Runs = Float[np.ndarray, "case seed"]


class Lifetime(NamedTuple):
    """Lifetime statistics of one channel, in its unit.

    Attributes:
        mean: Weighted mean.
        standard_deviation: Root of the weighted mean variance about each run's own mean.
        standard_deviation_spread: Its standard deviation over seeds; NaN with one seed.
        ranges: Damage-equivalent range (sum p R^m)^(1/m) for each exponent m, (m,).
        maximum: Largest value of all runs.
        maximum_of_seed: Largest value of a seed's runs, averaged over seeds.
        maximum_spread: Its standard deviation over seeds; NaN with one seed.
        minimum: Smallest value of all runs.
        minimum_of_seed: Smallest value of a seed's runs, averaged over seeds.
        minimum_spread: Its standard deviation over seeds; NaN with one seed.
    """

    mean: float
    standard_deviation: float
    standard_deviation_spread: float
    ranges: Float[np.ndarray, " m"]
    maximum: float
    maximum_of_seed: float
    maximum_spread: float
    minimum: float
    minimum_of_seed: float
    minimum_spread: float


def weighted(probability: Float[np.ndarray, " case"], values: Runs) -> float:
    """Mean over seeds, then over cases by probability; NaN is left out.

    Args:
        probability: Probability of each case, (case,).
        values: Values by case and seed, NaN where a run failed.
    """
    finite = np.isfinite(values)
    count = finite.sum(axis=1)
    share = np.where(count > 0, probability, 0.0)
    means = np.where(finite, values, 0.0).sum(axis=1) / np.maximum(count, 1)
    return float(share @ means / share.sum()) if share.sum() > 0 else math.nan


def lifetime(
    probability: Float[np.ndarray, " case"],
    mean: Runs,
    deviation: Runs,
    least: Runs,
    most: Runs,
    ranges: Float[np.ndarray, "case seed m"],
    exponents: Float[np.ndarray, " m"],
) -> Lifetime:
    """Lifetime statistics from the statistics of the runs, NaN where a run failed.

    Cases without a run are left out.

    Args:
        probability: Probability of each case, (case,).
        mean: Means, (case, seed).
        deviation: Standard deviations, (case, seed).
        least: Minima, (case, seed).
        most: Maxima, (case, seed).
        ranges: Damage-equivalent ranges, (case, seed, m).
        exponents: Slopes m of the S-N curves, (m,).
    """

    def root(values: Runs, power: float) -> float:
        largest = np.nanmax(np.abs(values), initial=0.0)
        return largest * weighted(probability, (np.abs(values) / largest) ** power) ** (1 / power) if largest > 0 else 0.0

    def over_seeds(values: np.ndarray) -> float:
        return float(values.std(ddof=1)) if len(values) > 1 else math.nan

    if not np.isfinite(deviation).any():
        none = math.nan
        return Lifetime(none, none, none, np.full(len(exponents), none), none, none, none, none, none, none)
    seeds = [k for k in range(deviation.shape[1]) if np.isfinite(deviation[:, k]).any()]
    each = np.array([root(deviation[:, [k]], 2) for k in seeds])
    highest, lowest = np.nanmax(most[:, seeds], axis=0), np.nanmin(least[:, seeds], axis=0)
    return Lifetime(
        weighted(probability, mean),
        root(deviation, 2),
        over_seeds(each),
        np.array([root(ranges[:, :, i], m) for i, m in enumerate(exponents)]),
        float(highest.max()),
        float(highest.mean()),
        over_seeds(highest),
        float(lowest.min()),
        float(lowest.mean()),
        over_seeds(lowest),
    )


def exceedance(
    probability: Float[np.ndarray, " case"], values: Float[np.ndarray, " case"]
) -> tuple[Float[np.ndarray, " case"], Float[np.ndarray, " case"]]:
    """Ascending values, and the probability that a run of a random case reaches each.

    NaN is left out.

    Args:
        probability: Probability of each case, (case,).
        values: Values, NaN where a run failed, (case,).
    """
    finite = np.isfinite(values)
    order = np.argsort(values[finite])
    share = probability[finite][order] / probability[finite].sum()
    return values[finite][order], np.cumsum(share[::-1])[::-1]
