"""Statistics over the life of a platform: runs weighed by the probability of their cases. Pure."""

import math
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

Runs = Float[np.ndarray, "case seed"]


class Lifetime(NamedTuple):
    """Of one channel, in its unit. `spread` are standard deviations over seeds, NaN of one seed.

    `mean`; `standard_deviation` about each run's own mean, root of the weighted mean of variances; `ranges` by exponent m,
    (sum p R^m)^(1/m), those that do the same damage in the same time; `maximum` and `minimum` of all runs; `maximum_of_seed`
    and `minimum_of_seed`, the same of every seed's runs, averaged over seeds.
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
    """Mean over the seeds of each case that are not NaN, then over cases that have any, by probability."""
    there = np.isfinite(values)
    count = there.sum(axis=1)
    share = np.where(count > 0, probability, 0.0)
    means = np.where(there, values, 0.0).sum(axis=1) / np.maximum(count, 1)
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
    """From the runs' statistics, NaN where a run failed. The shares of cases without a run are left out."""

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
    seen, under = np.nanmax(most[:, seeds], axis=0), np.nanmin(least[:, seeds], axis=0)
    return Lifetime(
        weighted(probability, mean),
        root(deviation, 2),
        over_seeds(each),
        np.array([root(ranges[:, :, i], m) for i, m in enumerate(exponents)]),
        float(seen.max()),
        float(seen.mean()),
        over_seeds(seen),
        float(under.min()),
        float(under.mean()),
        over_seeds(under),
    )


def exceedance(
    probability: Float[np.ndarray, " case"], values: Float[np.ndarray, " case"]
) -> tuple[Float[np.ndarray, " case"], Float[np.ndarray, " case"]]:
    """Values in ascending order, and the probability that a run of a random case has at least that value; NaN is left out."""
    there = np.isfinite(values)
    order = np.argsort(values[there])
    share = probability[there][order] / probability[there].sum()
    return values[there][order], np.cumsum(share[::-1])[::-1]
