"""Selection of effects: subsets of candidates compared by their evidence on a linearised model.

The best subsets are found best first: from every one of the few best, effects are added, removed and exchanged. The posterior
probability of a subset is its evidence times its prior. The likelihood is tempered where the best subset leaves more than
noise (coarsened posterior; by how much: `dispersion`).

Two kinds of subsets are left out:

- Of several effects, one is at the end of its plausible range. Several such effects together would follow almost any record.
  One alone takes part: it says what the missing effect acts like.
- An effect hardly matters beside the others. Long records show the smallest error of a model beyond doubt, and any effect can
  take a small part of it.

References:
    Miller and Dunson 2019, Journal of the American Statistical Association 114, 1113-1125: coarsened posteriors.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import chain, islice, takewhile

import numpy as np

from calibration.discovery.selection.bounded_quadratic import bounded_minimum
from calibration.discovery.selection.dispersion import dispersion
from calibration.discovery.selection.linear_model import LinearModel
from calibration.discovery.selection.subsets import Selection, Subset, Variant, bagged_posterior
from calibration.identifiability.information import pseudo_inverse
from jaxhydro.interrupts import stop_if_asked

EXPANDED_SUBSETS = 5  # best subsets whose neighbours are all tried
MAX_SUBSETS = 400  # subsets that are fitted
MAX_ADDITIONS = 8  # effects added to a subset in turn, those with the largest gain of one linear step
MAX_EXCHANGES = 3  # effects tried in the place of each effect of a subset
MAX_EFFECTS = 8  # of a subset: nobody can test more one by one
MIN_LOG_POSTERIOR = -30.0  # of a subset, over the best: less is no part of the answer
EXPLAINED_ROUNDING = 1e-9  # of a column's square: what other columns leave of it is rounding


class JointSelection:
    """Search for the most probable subsets of effects.

    Attributes:
        model: The linear model.
        base: Columns that are always fitted.
        variants: Candidate effects at values of their shapes.
        series: Series of every pool (p,), for resampling.
        told: Called with the number of subsets that were fitted.
        matters: Whether an effect matters, from the residuals without and with it; None: every effect does.
        among: Variants that may be added; None: all.
        required: Names of effects that every answer has, unless no set with them takes part. They are left out in turn all
            the same, for their probability.
    """

    def __init__(
        self,
        model: LinearModel,
        base: Sequence[int],
        variants: Sequence[Variant],
        series: np.ndarray,
        told: Callable[[int], None] = lambda count: None,
        matters: Callable[[np.ndarray, np.ndarray], bool] | None = None,
        among: Sequence[int] | None = None,
        required: frozenset[str] = frozenset(),
    ) -> None:
        self.model, self.base, self.variants, self.series, self.told = model, tuple(base), tuple(variants), series, told
        self.matters, self.among = matters, frozenset(range(len(variants)) if among is None else among)
        self.required = required
        self.fitted: dict[tuple[int, ...], Subset] = {}
        self.judged: dict[tuple[int, ...], bool] = {}

    def subset(self, variants: Sequence[int], begin: Subset | None = None) -> Subset:
        """A subset, fitted."""
        key = tuple(sorted(variants))
        if key not in self.fitted:
            mine = [column for i in key for column in self.variants[i].columns if column not in self.base]
            fit = self.model.fit([*self.base, *dict.fromkeys(mine)], None if begin is None else begin.fit)
            odds = sum(self.variants[i].log_odds for i in key)
            self.fitted[key] = Subset(key, fit, self.model.log_evidence(fit) + odds, self.model.at_end(fit))
        return self.fitted[key]

    def without(self, subset: Subset, out: int) -> Subset:
        """A subset without one of its variants."""
        return self.subset([i for i in subset.variants if i != out], subset)

    def takes_part(self, subset: Subset) -> bool:
        """Whether no effect is at the end of its plausible range beside others, and every effect matters."""
        if not subset.plausible or self.matters is None:
            return subset.plausible
        if subset.variants not in self.judged:
            after = self.model.residual_after(subset.fit)
            asked = (i for i in subset.variants if self.variants[i].name not in self.required)
            rest = (self.model.residual_after(self.without(subset, i).fit) for i in asked)
            self.judged[subset.variants] = all(self.matters(before, after) for before in rest)
        return self.judged[subset.variants]

    def steps(self, subset: Subset) -> dict[int, tuple[float, float, bool]]:
        """Gain of one linear step along each variant of other candidates, with the subset's weights.

        Returns:
            By variant: decrease of -2 ln L and prior, and of -2 times the logarithm of evidence times prior; whether the step
            ends at the end of a plausible range.
        """
        model, mine = self.model, list(subset.fit.columns)
        present = {self.variants[i].name for i in subset.variants}
        new = {i: variant for i, variant in enumerate(self.variants) if i in self.among and variant.name not in present}
        others = [i for i, variant in new.items() if not set(variant.columns) <= set(mine)]
        columns = list(dict.fromkeys([*mine, *(c for i in others for c in self.variants[i].columns)]))
        whole = model.products_after(subset.fit)[np.ix_([*columns, -1], [*columns, -1])]
        base = len(mine)
        inner = whole[:base, :base] + np.diag(1 / model.width[mine] ** 2)
        rest = whole[base:, base:] - whole[base:, :base] @ pseudo_inverse(inner) @ whole[:base, base:]
        # a column that the subset's columns explain leaves rounding, of either sign
        explained = np.diag(rest) <= EXPLAINED_ROUNDING * np.diag(whole)[base:]
        rest[explained], rest[:, explained] = 0.0, 0.0
        position = {column: i for i, column in enumerate(columns[base:])}
        gains = {}
        for i in others:
            added = [c for c in self.variants[i].columns if c in position]
            rows, width = [position[c] for c in added], model.width[added]
            matrix, slope = rest[np.ix_(rows, rows)] + np.diag(1 / width**2), rest[rows, -1]
            neutral = model.neutral[added]
            low, high = model.lower[added] - neutral, model.upper[added] - neutral
            step = bounded_minimum(matrix, slope, low, high)
            gain = float(-(step @ matrix @ step) - 2 * slope @ step)
            occam = float(np.linalg.slogdet(matrix * np.outer(width, width))[1]) if step.any() else 0.0
            at_end = bool((model.ends[added] & ((step <= low) | (step >= high)) & (step != 0)).any())
            gains[i] = gain, gain - occam + 2 * self.variants[i].log_odds, at_end
        return gains

    def additions(self, subset: Subset) -> list[int]:
        """Variants of other candidates, the most promising first, by one linear step.

        Beside other effects, those that would be at the end of their plausible range come last.
        """
        gains = self.steps(subset)
        return sorted(gains, key=lambda i: (bool(subset.variants) and gains[i][2], -gains[i][1]))

    def first_order_gains(self, subset: Subset) -> dict[int, float]:
        """Decrease of -2 ln L and prior by one linear step along each variant of other candidates."""
        return {i: gain for i, (gain, _, _) in self.steps(subset).items()}

    def helpful(self, subset: Subset) -> set[int]:
        """Variants of other candidates that raise the evidence by one linear step."""
        return {i for i, (_, evidence, _) in self.steps(subset).items() if evidence > 0}

    def neighbours(self, subset: Subset) -> list[Subset]:
        """Subsets with one effect more, one less, or one exchanged."""
        more = self.additions(subset)[:MAX_ADDITIONS] if len(subset.variants) < MAX_EFFECTS else []
        subsets = [self.subset([*subset.variants, i], subset) for i in more]
        for i in subset.variants:
            subsets.append(rest := self.without(subset, i))
            others = [j for j in self.additions(rest) if j != i][:MAX_EXCHANGES]
            subsets += [self.subset([*rest.variants, j], rest) for j in others]
        return subsets

    def run(self, begin: Sequence[int] = ()) -> Selection:
        """The most probable subsets.

        Args:
            begin: Variants of a subset to begin with, beside none.
        """
        if self.required:  # what is added to them has room
            begin = [i for i in begin if self.variants[i].name in self.required]
        self.temper(self.grown(self.with_required(self.subset(begin))))
        self.subset(())
        self.with_required(self.subset(begin))
        done: set[tuple[int, ...]] = set()
        while len(self.fitted) < MAX_SUBSETS:
            ahead = chain(self.answers(EXPANDED_SUBSETS), self.best(EXPANDED_SUBSETS))
            todo = next((subset for subset in ahead if subset.variants not in done), None)
            if todo is None:
                break
            done.add(todo.variants)
            stop_if_asked()
            self.neighbours(todo)
            self.told(len(self.fitted))
        subsets, answers = probable(self.best()), probable(self.answers())
        return Selection(subsets, self.variants, bagged_posterior(subsets, self.series, self.model.used), answers)

    def with_required(self, subset: Subset) -> Subset:
        """A subset with the required effects that it lacks, each in its most promising variant."""
        while not self.has_required(subset):
            present = {self.variants[i].name for i in subset.variants}
            lacking = (i for i in self.additions(subset) if self.variants[i].name in self.required - present)
            subset = self.subset([*subset.variants, next(lacking)], subset)
        return subset

    def grown(self, subset: Subset) -> Subset:
        """A subset to which effects are added one by one as long as the evidence grows."""
        while len(subset.variants) < MAX_EFFECTS:
            trials = [self.subset([*subset.variants, i], subset) for i in self.additions(subset)[:MAX_ADDITIONS]]
            better = [trial for trial in trials if trial.evidence > subset.evidence and self.takes_part(trial)]
            if not better:
                break
            subset = max(better, key=lambda trial: trial.evidence)
        return subset

    def temper(self, best: Subset) -> None:
        """Temper the likelihood where a subset leaves more than noise."""
        if (factor := dispersion(self.model, best.fit)) > 1:
            self.model, self.fitted, self.judged = self.model.tempered(factor), {}, {}

    def has_required(self, subset: Subset) -> bool:
        """Whether a subset has every required effect."""
        return self.required <= {self.variants[i].name for i in subset.variants}

    def answers(self, most: int | None = None) -> Iterator[Subset]:
        """The subsets of `best` that may be the answer, at most `most` of them.

        They have every required effect, and none at the end of its range. There are none where nothing is required.
        """
        mine = (subset for subset in self.by_evidence() if self.required and self.has_required(subset) and not subset.at_end)
        return islice(filter(self.takes_part, mine), most)

    def best(self, most: int | None = None) -> Iterator[Subset]:
        """The fitted subsets that take part, the most probable first, at most `most` of them."""
        return islice(filter(self.takes_part, self.by_evidence()), most)

    def by_evidence(self) -> list[Subset]:
        """The fitted subsets, the most probable first."""
        return sorted(self.fitted.values(), key=lambda subset: -subset.evidence)


def probable(ordered: Iterator[Subset]) -> tuple[Subset, ...]:
    """Subsets, in order of evidence, that are not far less probable than the first."""
    first = next(ordered, None)
    if first is None:
        return ()
    return (first, *takewhile(lambda subset: subset.evidence > first.evidence + MIN_LOG_POSTERIOR, ordered))
