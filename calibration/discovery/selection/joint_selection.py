"""Selection of effects: subsets of candidates compared by their evidence on a linearised model.

The best subsets are found best first: from every one of the few best, effects are added, removed and exchanged. The posterior
probability of a subset is its evidence times its prior. A linear model with the wrong noise is too sure. So the posterior is
averaged over resampled series of the records (bagged posterior). Each series' -2 ln L at the fitted point is resampled; nothing
is fitted again.

The likelihood is tempered by what the best subset leaves above the noise (coarsened posterior).

A subset with an effect at the end of its plausible range is left out. Several such effects together would follow almost any
record. One alone takes part: it says what the missing effect acts like.

References:
    Kass and Raftery 1995, Journal of the American Statistical Association 90, 773-795: strength of evidence.
    Huggins and Miller 2023, Bayesian Analysis 18, 79-104: reproducible model selection with bagged posteriors.
    Kishino, Miyata and Hasegawa 1990, Journal of Molecular Evolution 31, 151-160: resampled estimated log-likelihoods.
    Miller and Dunson 2019, Journal of the American Statistical Association 114, 1113-1125: coarsened posteriors.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from calibration.discovery.selection.linear_model import LinearFit, LinearModel, bounded_minimum
from calibration.identifiability.information import pseudo_inverse
from jaxhydro.interrupts import stop_if_asked

EXPANDED_SUBSETS = 5  # best subsets whose neighbours are all tried
MAX_SUBSETS = 400  # subsets that are fitted
MAX_ADDITIONS = 8  # effects added to a subset in turn, those with the largest gain of one linear step
MAX_EXCHANGES = 3  # effects tried in the place of each effect of a subset
MAX_GROWN = 12  # effects of the subset that tells how much the best model leaves
STRONG_EVIDENCE = 3.0  # logarithm of a Bayes factor (Kass and Raftery 1995)
EXPLAINED_ROUNDING = 1e-9  # of a column's square: what other columns leave of it is rounding
MIN_DISCREPANCY = 1.2  # a smaller one may be noise by chance
RESAMPLES = 400  # resamplings of the series
MIN_SERIES = 8  # series that are resampled; of fewer, their pools of bands are
SEED = 7


class Variant(NamedTuple):
    """A candidate effect at some values of its shapes.

    Attributes:
        name: Name of the candidate.
        columns: Its columns of the linear model.
        log_odds: Logarithm of its prior odds.
    """

    name: str
    columns: tuple[int, ...]
    log_odds: float


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
        """Whether it takes part: no effect is at the end of its plausible range, or there is only one effect."""
        return not self.at_end or len(self.variants) < 2


@dataclass(frozen=True)
class Selection:
    """Posterior over subsets of effects.

    Attributes:
        subsets: Subsets, the most probable first.
        variants: The variants.
        weights: Bagged posterior probability of every subset.
    """

    subsets: tuple[Subset, ...]
    variants: tuple[Variant, ...]
    weights: np.ndarray

    @property
    def best(self) -> Subset:
        """The subset with the fewest parameters, of those whose evidence is not far below the highest."""
        near = [one for one in self.subsets if one.evidence > self.subsets[0].evidence - STRONG_EVIDENCE]
        return min(near, key=lambda one: (len(one.fit.columns), -one.evidence))

    def names(self, subset: Subset) -> tuple[str, ...]:
        """Names of a subset's effects."""
        return tuple(self.variants[i].name for i in subset.variants)

    def probability(self) -> dict[str, float]:
        """Posterior probability of every effect that is in any subset."""
        found: dict[str, float] = {}
        for subset, weight in zip(self.subsets, self.weights, strict=True):
            for name in self.names(subset):
                found[name] = found.get(name, 0.0) + float(weight)
        return dict(sorted(found.items(), key=lambda item: -item[1]))


class JointSelection:
    """Search for the most probable subsets of effects.

    Attributes:
        model: The linear model.
        base: Columns that are always fitted.
        variants: Candidate effects at values of their shapes.
        series: Series of every pool (p,), for resampling.
    """

    def __init__(
        self,
        model: LinearModel,
        base: Sequence[int],
        variants: Sequence[Variant],
        series: np.ndarray,
        told: Callable[[int], None] = lambda count: None,
    ) -> None:
        self.model, self.base, self.variants, self.series, self.told = model, tuple(base), tuple(variants), series, told
        self.fitted: dict[tuple[int, ...], Subset] = {}

    def subset(self, variants: Sequence[int], begin: Subset | None = None) -> Subset:
        """A subset, fitted."""
        key = tuple(sorted(variants))
        if key not in self.fitted:
            mine = [column for i in key for column in self.variants[i].columns if column not in self.base]
            fit = self.model.fit([*self.base, *dict.fromkeys(mine)], None if begin is None else begin.fit)
            odds = sum(self.variants[i].log_odds for i in key)
            self.fitted[key] = Subset(key, fit, self.model.log_evidence(fit) + odds, self.model.at_end(fit))
        return self.fitted[key]

    def steps(self, subset: Subset) -> dict[int, tuple[float, float, bool]]:
        """What one linear step along each variant of other candidates would gain, with the subset's weights.

        Returns:
            By variant: decrease of -2 ln L and prior, and of -2 times the logarithm of evidence times prior; whether the step
            ends at the end of a plausible range.
        """
        model, mine = self.model, list(subset.fit.columns)
        there = {self.variants[i].name for i in subset.variants}
        others = [i for i, one in enumerate(self.variants) if one.name not in there and not set(one.columns) <= set(mine)]
        columns = list(dict.fromkeys([*mine, *(c for i in others for c in self.variants[i].columns)]))
        residual = model.residual_after(subset.fit)
        whole, _ = model.products(model.weights(residual), columns, residual)
        base = len(mine)
        inner = whole[:base, :base] + np.diag(1 / model.width[mine] ** 2)
        rest = whole[base:, base:] - whole[base:, :base] @ pseudo_inverse(inner) @ whole[:base, base:]
        # a column that the subset's columns explain leaves rounding, of either sign
        explained = np.diag(rest) <= EXPLAINED_ROUNDING * np.diag(whole)[base:]
        rest[explained], rest[:, explained] = 0.0, 0.0
        at = {column: i for i, column in enumerate(columns[base:])}
        found = {}
        for i in others:
            some = [c for c in self.variants[i].columns if c in at]
            rows, width = [at[c] for c in some], model.width[some]
            matrix, slope = rest[np.ix_(rows, rows)] + np.diag(1 / width**2), rest[rows, -1]
            neutral = model.neutral[some]
            low, high = model.lower[some] - neutral, model.upper[some] - neutral
            step = bounded_minimum(matrix, slope, low, high)
            gain = float(-(step @ matrix @ step) - 2 * slope @ step)
            occam = float(np.linalg.slogdet(matrix * np.outer(width, width))[1]) if step.any() else 0.0
            at_end = bool((model.ends[some] & ((step <= low) | (step >= high)) & (step != 0)).any())
            found[i] = gain, gain - occam + 2 * self.variants[i].log_odds, at_end
        return found

    def additions(self, subset: Subset) -> list[int]:
        """Variants of other candidates, the most promising first, by one linear step.

        Beside other effects, those that would be at the end of their plausible range come last.
        """
        found = self.steps(subset)
        return sorted(found, key=lambda i: (bool(subset.variants) and found[i][2], -found[i][1]))

    def first_order_gains(self, subset: Subset) -> dict[int, float]:
        """Decrease of -2 ln L and prior by one linear step along each variant of other candidates."""
        return {i: gain for i, (gain, _, _) in self.steps(subset).items()}

    def neighbours(self, subset: Subset) -> list[Subset]:
        """Subsets with one effect more, one less, or one exchanged."""
        found = [self.subset([*subset.variants, i], subset) for i in self.additions(subset)[:MAX_ADDITIONS]]
        for i in subset.variants:
            rest = self.subset([j for j in subset.variants if j != i], subset)
            found.append(rest)
            others = [j for j in self.additions(rest) if j != i][:MAX_EXCHANGES]
            found += [self.subset([*rest.variants, j], rest) for j in others]
        return found

    def run(self, begin: Sequence[int] = ()) -> Selection:
        """The most probable subsets.

        Args:
            begin: Variants of a subset to begin with, beside none.
        """
        self.temper(self.grown(self.subset(begin)))
        self.subset(())
        if begin:
            self.subset(begin)
        done: set[tuple[int, ...]] = set()
        while len(self.fitted) < MAX_SUBSETS:
            best = self.ordered()[:EXPANDED_SUBSETS]
            todo = next((one for one in best if one.variants not in done), None)
            if todo is None:
                break
            done.add(todo.variants)
            stop_if_asked()
            self.neighbours(todo)
            self.told(len(self.fitted))
        ordered = self.ordered()
        return Selection(ordered, self.variants, self.bagged(ordered))

    def grown(self, subset: Subset) -> Subset:
        """A subset to which effects are added one by one as long as the evidence grows."""
        while True:
            trials = [self.subset([*subset.variants, i], subset) for i in self.additions(subset)[:MAX_EXCHANGES]]
            better = [one for one in trials if one.plausible and one.evidence > subset.evidence]
            if not better or len(subset.variants) >= MAX_GROWN:
                return subset
            subset = max(better, key=lambda one: one.evidence)

    def temper(self, best: Subset) -> None:
        """Temper the likelihood by what a subset leaves above the noise."""
        discrepancy = self.model.discrepancy(self.model.residual_after(best.fit))
        if discrepancy > MIN_DISCREPANCY:
            self.model, self.fitted = self.model.tempered(discrepancy), {}

    def ordered(self) -> tuple[Subset, ...]:
        """The fitted subsets that take part, the most probable first."""
        return tuple(sorted((one for one in self.fitted.values() if one.plausible), key=lambda one: -one.evidence))

    def bagged(self, subsets: Sequence[Subset]) -> np.ndarray:
        """Posterior probability of subsets, averaged over resampled series; over resampled pools where series are few."""
        few = len(np.unique(self.series[self.model.used])) < MIN_SERIES
        unit = np.arange(len(self.series)) if few else self.series
        used = np.unique(unit[self.model.used])
        deviance = np.array([np.bincount(unit, one.fit.deviance, unit.max() + 1)[used] for one in subsets])
        constant = np.array([one.evidence for one in subsets]) + 0.5 * deviance.sum(axis=1)
        count = np.random.default_rng(SEED).multinomial(len(used), np.full(len(used), 1 / len(used)), RESAMPLES)
        log = constant[:, None] - 0.5 * deviance @ count.T
        weight = np.exp(log - log.max(axis=0))
        return (weight / weight.sum(axis=0)).mean(axis=1)
