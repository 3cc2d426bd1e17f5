"""Which effects the held-out tests support, as a linear model predicts them."""

from collections.abc import Sequence

import numpy as np

from calibration.discovery.acceptance import MIN_HELD_OUT_GAIN, MIN_HELD_OUT_SHARE, HeldOutComparison
from calibration.discovery.eliminated_least_squares import row_weights
from calibration.discovery.fit_state import ResidualSummary
from calibration.discovery.linearisations import Linearisation
from calibration.discovery.refusal import ComparedData, Refusal, RefusalKind
from calibration.discovery.selection.joint_selection import JointSelection
from calibration.discovery.selection.study_linear_model import decays_with_unknowns
from calibration.discovery.selection.subsets import Subset
from calibration.discovery.study import Study

REWEIGHTINGS = 3  # fits of a held-out decay's own unknowns


def predicted_summary(study: Study, linearisation: Linearisation, residual: np.ndarray) -> ResidualSummary:
    """Summary of a residual, with the held-out decays' own unknowns fitted to them.

    Args:
        study: The study.
        linearisation: Linearisation of all tests.
        residual: Residual that the linear model predicts (n,).
    """
    residual = residual.copy()
    for _, unknowns, _ in decays_with_unknowns(study, linearisation, fitted=False):
        before, prior = residual[unknowns.rows].copy(), np.diag(1 / unknowns.width**2)
        for _ in range(REWEIGHTINGS):
            weighted = row_weights(study, residual)[unknowns.rows, None] * unknowns.slopes
            step = np.linalg.solve(weighted.T @ unknowns.slopes + prior, -(weighted.T @ before + prior @ unknowns.value))
            residual[unknowns.rows] = before + unknowns.slopes @ step
    return ResidualSummary.of(study, residual)


def refusal_by_prediction(study: Study, without: ResidualSummary, with_it: ResidualSummary) -> Refusal | None:
    """Why predicted held-out tests speak against an effect; None where they do not.

    Args:
        study: The study.
        without: Residual of the fit without the effect.
        with_it: Residual of the fit with it.
    """
    compared = HeldOutComparison(study, ~study.used, without, with_it, True)
    share, told = compared.error_reduction()
    if told and share < MIN_HELD_OUT_SHARE:
        return Refusal(RefusalKind.HELD_OUT_ERROR, (share,), compared=ComparedData.HELD_OUT)
    if told and compared.likelihood_gain < MIN_HELD_OUT_GAIN:
        return Refusal(RefusalKind.HELD_OUT_LIKELIHOOD, (compared.likelihood_gain,), compared=ComparedData.HELD_OUT)
    return None


def supported_effects(
    study: Study, linearisation: Linearisation, selection: JointSelection, present: Sequence[int]
) -> tuple[Subset, dict[int, Refusal]]:
    """The effects that predicted held-out tests support, and why the others are left out.

    Unsupported effects go one at a time, first the effect without which the tests are followed best. The others are then
    assessed anew.

    Args:
        study: The study.
        linearisation: Linearisation of all tests.
        selection: Subsets on the linear model.
        present: Variants of the effects in the model.
    """
    subset, reasons = selection.subset(present), {}
    while subset.variants:
        with_it = predicted_summary(study, linearisation, selection.model.residual_after(subset.fit))
        refused = {}
        for i in subset.variants:
            rest = selection.without(subset, i)
            without = predicted_summary(study, linearisation, selection.model.residual_after(rest.fit))
            if (why := refusal_by_prediction(study, without, with_it)) is not None:
                refused[i] = float(without.likelihood.sum()), why, rest
        if not refused:
            break
        least = min(refused, key=lambda i: refused[i][0])
        _, reasons[least], subset = refused[least]
    return subset, reasons
