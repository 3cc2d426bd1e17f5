"""Subsets of candidate effects and their posterior probabilities.

A linear model with the wrong noise is too sure. So the posterior is averaged over resampled series of the records (bagged
posterior). Each series' -2 ln L at the fitted point is resampled; nothing is fitted again.

References:
    Kass and Raftery 1995, Journal of the American Statistical Association 90, 773-795: strength of evidence.
    Huggins and Miller 2023, Bayesian Analysis 18, 79-104: reproducible model selection with bagged posteriors.
    Kishino, Miyata and Hasegawa 1990, Journal of Molecular Evolution 31, 151-160: resampled estimated log-likelihoods.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from calibration.discovery.selection.linear_model import LinearFit

STRONG_EVIDENCE = 3.0  # logarithm of a Bayes factor (Kass and Raftery 1995)
RESAMPLES = 400  # resamplings of the series
MIN_SERIES = 8  # series that are resampled; of fewer, their pools of bands are
SEED = 7


class Variant(NamedTuple):
    """A candidate effect at some values of its shapes.

    Attributes:
        name: Name of the candidate.
        columns: Its columns of the linear model.
        log_odds: Logarithm of its prior odds.
        laboratory: Whether it is a mistake of the laboratory.
    """

    name: str
    columns: tuple[int, ...]
    log_odds: float
    laboratory: bool = False


@dataclass(frozen=True)
class Subset:
    """Some effects with their fit.

    Attributes:
        variants: Numbers of the variants.
        fit: Their fit, with the base columns.
        evidence: Logarithm of evidence times prior.
        at_end: Whether an effect is at the end of its plausible range.
    """

    variants: tuple[int, ...]
    fit: LinearFit
    evidence: float
    at_end: bool

    @property
    def plausible(self) -> bool:
        """Whether no effect is at the end of its plausible range beside others."""
        return not self.at_end or len(self.variants) < 2


@dataclass(frozen=True)
class Selection:
    """Posterior over subsets of effects.

    Attributes:
        subsets: Subsets, the most probable first.
        variants: The variants.
        weights: Bagged posterior probability of every subset.
        answers: Subsets that may be the answer, the most probable first; none: all may.
    """

    subsets: tuple[Subset, ...]
    variants: tuple[Variant, ...]
    weights: np.ndarray
    answers: tuple[Subset, ...] = ()

    @property
    def best(self) -> Subset:
        """Answer with the fewest effects among those that are not clearly worse than the first.

        Of several with as few effects, it is the most probable. `STRONG_EVIDENCE` defines what is clearly worse.
        """
        answers = self.answers or self.subsets
        near = [subset for subset in answers if subset.evidence > answers[0].evidence - STRONG_EVIDENCE]
        return min(near, key=lambda subset: (len(subset.variants), -subset.evidence))

    def names(self, subset: Subset) -> tuple[str, ...]:
        """Names of a subset's effects."""
        return tuple(self.variants[i].name for i in subset.variants)

    def probability(self) -> dict[str, float]:
        """Posterior probability of every effect that is in any subset."""
        probabilities: dict[str, float] = {}
        for subset, weight in zip(self.subsets, self.weights, strict=True):
            for name in self.names(subset):
                probabilities[name] = probabilities.get(name, 0.0) + float(weight)
        return dict(sorted(probabilities.items(), key=lambda item: -item[1]))


def bagged_posterior(subsets: Sequence[Subset], series: np.ndarray, used: np.ndarray) -> np.ndarray:
    """Posterior probability of subsets, averaged over resampled series.

    Where there are fewer series than `MIN_SERIES`, pools are resampled instead.

    Args:
        subsets: The subsets.
        series: Series of every pool (p,).
        used: Which pools count (p,).
    """
    few = len(np.unique(series[used])) < MIN_SERIES
    unit = np.arange(len(series)) if few else series
    mine = np.unique(unit[used])
    deviance = np.array([np.bincount(unit, subset.fit.deviance, unit.max() + 1)[mine] for subset in subsets])
    constant = np.array([subset.evidence for subset in subsets]) + 0.5 * deviance.sum(axis=1)
    count = np.random.default_rng(SEED).multinomial(len(mine), np.full(len(mine), 1 / len(mine)), RESAMPLES)
    log = constant[:, None] - 0.5 * deviance @ count.T
    weight = np.exp(log - log.max(axis=0))
    return (weight / weight.sum(axis=0)).mean(axis=1)
