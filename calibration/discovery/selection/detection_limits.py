"""Detection limits: the sizes from which effects that are not named would have been.

What an effect does to the records has two parts. Coefficients, nuisances and the effects in the model can follow the one. Only
the other, the remainder, tells of the effect. A detection limit is the size whose remainder, added to the residual, passes the
rules by which effects are selected and accepted. It holds to first order, for one amplitude at a time.

An effect whose limit is beyond its plausible range cannot be seen in the records. Nor can one whose remainder is zero: it lies
in the space of what the coefficients do.

References:
    Currie 1968, Analytical Chemistry 40, 586-593: limits for qualitative detection.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

import numpy as np

from calibration.discovery.acceptance import HeldOutComparison, reason_to_reject
from calibration.discovery.diagnosis import DetectionLimit
from calibration.discovery.effect_fits import EffectFits
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.fit_state import ResidualSummary
from calibration.discovery.refusal import ComparedData
from calibration.discovery.selection.candidate_columns import CandidateColumns
from calibration.discovery.selection.joint_selection import EXPLAINED_ROUNDING, JointSelection
from calibration.discovery.selection.linear_model import LinearModel
from calibration.discovery.selection.subsets import Subset
from calibration.identifiability.information import pseudo_inverse
from jaxhydro.interrupts import stop_if_asked

# upper ends of the search, over the largest plausible size: the first that is named. Far beyond it the prior outweighs any gain
UPPER_ENDS = (1.0, 3.0, 10.0, 30.0)
LOWER_END = 1e-3  # lower end of the search, over the largest plausible size
HALVINGS = 9  # of the logarithm of the size: a limit is found to 2 %
RANGE_DEVIATIONS = 2.0  # largest plausible size where no range is stated, in standard deviations of the prior


class Remainders(NamedTuple):
    """What is left of columns after the columns of a fit and the decays' own unknowns have followed them.

    Attributes:
        information: Products of the remainders, with the weights of the fit (k, k).
        total: Weighted squares of the columns themselves (k,).
        rows: Remainder in rows (n,) of a column.
    """

    information: np.ndarray
    total: np.ndarray
    rows: Callable[[int], np.ndarray]


def remainders(model: LinearModel, subset: Subset) -> Remainders:
    """What is left of all columns of a model after a fit's have followed them.

    Args:
        model: The linear model.
        subset: The fit.
    """
    mine = list(subset.fit.columns)
    sums = model.products.weighted(model.weights(subset.fit.levels[model.products.pools]))
    whole, back = model.eliminated(sums, [unknowns.value for unknowns in model.own])
    follow = pseudo_inverse(whole[np.ix_(mine, mine)] + np.diag(1 / model.width[mine] ** 2)) @ whole[mine, :-1]
    information = whole[:-1, :-1] - whole[:-1, mine] @ follow

    def rows(column: int) -> np.ndarray:
        steps = np.zeros(len(whole))
        steps[column] = 1.0
        steps[mine] -= follow[:, column]
        left = model.slopes @ steps[:-1]
        for unknowns, solved in zip(model.own, back, strict=True):
            left[unknowns.rows] -= unknowns.slopes @ (solved @ steps)
        return np.asarray(left)

    return Remainders(information, np.diag(sums.whole)[:-1], rows)


def detection_limits(
    fits: EffectFits, columns: CandidateColumns, selector: JointSelection, subset: Subset
) -> dict[str, tuple[DetectionLimit, ...]]:
    """Detection limits of the candidates that a subset lacks, by their names.

    Args:
        fits: Study, candidates, priors.
        columns: The linear model of all candidates.
        selector: The subsets that were compared on it.
        subset: The subset.
    """
    limits = _Limits(fits, columns, selector, subset)
    present = {columns.variants[i].name for i in subset.variants}
    by_label: dict[str, dict[str, list[DetectionLimit]]] = {}
    for i, variant in enumerate(columns.variants):
        stop_if_asked()
        if variant.name not in present:
            mine = by_label.setdefault(variant.name, {})
            for limit in limits.of(i):
                mine.setdefault(limit.label, []).append(limit)
    return {name: tuple(map(_over_shapes, mine.values())) for name, mine in by_label.items() if mine}


def _over_shapes(limits: list[DetectionLimit]) -> DetectionLimit:
    """The limit of an amplitude over all shapes of its effect that were tried."""
    best = min(limits, key=lambda limit: limit.smallest)
    return best._replace(largest=max(limit.largest for limit in limits))


class _Limits:
    """Detection limits of variants beside a subset."""

    def __init__(self, fits: EffectFits, columns: CandidateColumns, selector: JointSelection, subset: Subset) -> None:
        self.fits, self.columns, self.variants, self.model = fits, columns, selector.variants, selector.model
        self.candidates: Mapping[str, Candidate] = {candidate.name: candidate for candidate in fits.setup.candidates}
        self.base = frozenset(subset.fit.columns)
        self.left = remainders(self.model, subset)
        self.residual = self.model.residual_after(subset.fit)
        self.after = ResidualSummary.of(fits.study, self.residual)
        self.deviance = self._deviance(self.residual)
        dof, used = fits.study.dof.sum(axis=1), fits.study.used
        self.held_out_share = float(dof[~used].sum() / dof[used].sum())  # of held-out samples, over the fitted ones

    def of(self, number: int) -> Iterator[DetectionLimit]:
        """Limits of a variant, one for each of its amplitudes."""
        variant, study, model = self.variants[number], self.fits.study, self.model
        candidate = self.candidates[variant.name]
        amplitudes = study.index(candidate.amplitudes)
        mine = [c for c in variant.columns if c not in self.base and self.columns.directions[c] in amplitudes]
        width = model.width[mine]
        information = self.left.information[np.ix_(mine, mine)] + np.diag(1 / width**2)
        occam = float(np.linalg.slogdet(information * np.outer(width, width))[1]) if mine else 0.0
        for column, precision in zip(mine, np.diag(information), strict=True):
            ends = np.array([model.lower[column], model.upper[column]]) - model.neutral[column]
            ends = np.where(np.isfinite(ends), ends, np.sign(ends) * RANGE_DEVIATIONS * model.width[column])
            end = float(ends[np.argmax(np.abs(ends))])
            total, rest = self.left.total[column], self.left.information[column, column]
            told = max(0.0, float(rest / total)) if total > 0 else 0.0
            size = math.inf
            if end != 0 and told > EXPLAINED_ROUNDING:
                size = self._limit(candidate, column, end, occam - 2 * variant.log_odds, float(precision), len(mine))
            label = study.names[self.columns.directions[column]]
            step = self._per_step(label, self.columns.directions[column])
            yield DetectionLimit(label, size * step, size * step, abs(end) * step, told, study.model.about(label).unit)

    def _limit(self, candidate: Candidate, column: int, end: float, asked: float, precision: float, count: int) -> float:
        """Smallest step along a column that would have been named; infinite if no step is.

        Args:
            candidate: The effect.
            column: The column.
            end: Step to the further end of the plausible range.
            asked: Decrease of -2 ln L and prior from which the effect is probable.
            precision: One over the square of the step's standard deviation.
            count: Number of the effect's amplitudes.
        """
        rows, width, study = self.left.rows(column), self.model.width[column], self.fits.study
        apart = not study.used.all()

        def named(step: float) -> bool:
            before = self.residual + step * rows
            gain = self._deviance(before) - self.deviance
            if gain - (step / width) ** 2 <= asked:
                return False
            grounds = HeldOutComparison(study, study.used, ResidualSummary.of(study, before), self.after, False)
            held, told = grounds.error_reduction()
            return (
                reason_to_reject(
                    gain - len(candidate.labels) * math.log(self.fits.count),
                    held if told else None,
                    gain * (self.held_out_share if apart else 1.0),
                    math.sqrt(max(step**2 * precision - count + 1, 0.0)),
                    grounds.relevance(),
                    ComparedData.HELD_OUT if apart else ComparedData.FITTED,
                )
                is None
            )

        upper = next((size for size in UPPER_ENDS if named(size * end)), None)
        if upper is None:
            return math.inf
        low, high = math.log(LOWER_END), math.log(upper)
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            low, high = (low, middle) if named(math.exp(middle) * end) else (middle, high)
        return math.exp(high) * abs(end)

    def _deviance(self, residual: np.ndarray) -> float:
        return float(self.model.deviances(self.model.levels(residual)).sum())

    def _per_step(self, label: str, direction: int) -> float:
        """Change of a parameter (SI) by a unit step along its direction."""
        study = self.fits.study
        moved = study.value(label, study.start + study.directions[direction])
        return abs(moved - study.value(label, study.start))
