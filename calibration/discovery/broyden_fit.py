"""Levenberg-Marquardt fit of a few parameters with Broyden updates of the Jacobian.

A simulation costs about a twentieth of all slopes. Broyden's update makes slopes agree with the last step. Slopes are computed
anew where they no longer predict the gain.

References:
    Broyden 1965, Mathematics of Computation 19, 577-593.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from calibration.discovery.eliminated_least_squares import cost_of, damped_step, linear_residual, row_weights
from calibration.discovery.linearisations import Linearisation, Point, Prior
from calibration.discovery.record_simulations import OVERFLOW
from calibration.discovery.study import Study
from jaxhydro.interrupts import stop_if_asked

MAX_LOG_STEP = 0.7  # largest step of a logarithmic coordinate
MIN_RELATIVE_GAIN = 1e-4  # of the cost: a step that gains less ends the fit, whatever the number of samples
STEP_PARTS = (1.0, 0.5, 0.25, 0.125)  # of a long step, that are tried in turn
MIN_PREDICTED_SHARE = 0.25  # of the predicted gain: slopes that give less are outdated


class FitOutcome(NamedTuple):
    """Result of a fit.

    Attributes:
        linearisation: Linearisation at the fitted point.
        iterations: Iterations taken.
        settled: Whether the fit converged.
    """

    linearisation: Linearisation
    iterations: int
    settled: bool


def broyden_update(
    study: Study, linearisation: Linearisation, point: Point, residual: np.ndarray, step: np.ndarray, own_step: np.ndarray
) -> Linearisation:
    """The linearisation after a step, its slopes corrected to agree with the step (Broyden's update).

    Args:
        study: The study.
        linearisation: Linearisation before the step.
        point: The point after the step.
        residual: Residual there, in rows (n,).
        step: Step along the active directions (q,).
        own_step: Step of the decays' own unknowns (r, o).

    References:
        Broyden 1965, Mathematics of Computation 19, 577-593.
    """
    weight = row_weights(study, linearisation.residual)
    missed = residual - linear_residual(study, linearisation, step, own_step)
    slopes, mine = linearisation.slopes.copy(), linearisation.own.copy()
    size = (weight[:, None] * linearisation.slopes**2).sum(axis=0) * step
    decays = study.spans[-1].stop if study.spans else 0
    if size @ step > 0:
        slopes[decays:] += np.outer(missed[decays:], size / (size @ step))
    for span, moved in zip(study.spans, own_step):
        inner = (weight[span, None] * linearisation.own[span] ** 2).sum(axis=0) * moved
        total = size @ step + inner @ moved
        if total > 0:
            slopes[span] += np.outer(missed[span], size / total)
            mine[span] += np.outer(missed[span], inner / total)
    return Linearisation(point, linearisation.active, residual, slopes, mine)


def bounded_step(
    study: Study, linearisation: Linearisation, used: np.ndarray, prior: Prior, damping: float
) -> tuple[np.ndarray, np.ndarray]:
    """A damped step within the parameters' bounds.

    Parameters that would leave go to the bound; the others are solved for again.

    Returns:
        Step along the active directions (q,), and of the decays' own unknowns (r, o).
    """
    step, own_step = damped_step(study, linearisation, used, prior, damping)
    low, high = (
        study.limits[list(linearisation.active)] - study.steps(linearisation.point.x)[list(linearisation.active), None]
    ).T
    clipped = np.clip(step, low, high)
    if (held := clipped != step).any() and not held.all():
        rest = linearisation.restricted_to([i for i, out in zip(linearisation.active, held) if not out])
        rest = replace(rest, residual=linearisation.residual + linearisation.slopes[:, held] @ clipped[held])
        clipped[~held], own_step = damped_step(study, rest, used, prior, damping)
    return np.clip(clipped, low, high), own_step


class StepTrial(NamedTuple):
    """Simulation after a step.

    Attributes:
        point: The point after the step.
        residual: Residual there, in rows (n,).
        cost: Cost there; infinite where a simulation diverges.
        predicted: Cost that the linearisation predicts.
    """

    point: Point
    residual: np.ndarray
    cost: float
    predicted: float


def try_step(
    study: Study, linearisation: Linearisation, used: np.ndarray, prior: Prior, step: np.ndarray, own_step: np.ndarray
) -> StepTrial:
    """Simulate after a step along the active directions (q,) and of the decays' own unknowns (r, o)."""
    point = linearisation.point.moved(study.directions[list(linearisation.active)], step, own_step)
    residual = study.residual(point)
    cost = np.inf if has_diverged(residual) else cost_of(study, linearisation, residual, point, used, prior)
    predicted = cost_of(study, linearisation, linear_residual(study, linearisation, step, own_step), point, used, prior)
    return StepTrial(point, residual, cost, predicted)


def far_step(
    study: Study, linearisation: Linearisation, used: np.ndarray, prior: Prior, step: np.ndarray, own_step: np.ndarray
) -> Linearisation:
    """The linearisation after a long step, or after the longest part of it that gains enough.

    A part gains enough if it gains more than `MIN_PREDICTED_SHARE` of what the slopes predict. A damped step is short along
    every direction if one of them leads astray. This one keeps its proportions.

    Args:
        study: The study.
        linearisation: Linearisation where the step begins.
        used: Which series (s,) are fitted.
        prior: Priors of the directions.
        step: Step along the active directions (q,).
        own_step: Step of the decays' own unknowns (r, o).

    Returns:
        The linearisation after the step, its slopes updated; the argument `linearisation` where no part gains enough.
    """
    now = cost_of(study, linearisation, linearisation.residual, linearisation.point, used, prior)
    for part in STEP_PARTS:
        stop_if_asked()
        trial = try_step(study, linearisation, used, prior, part * step, part * own_step)
        if now - trial.cost > MIN_PREDICTED_SHARE * max(now - trial.predicted, 0.0):
            return broyden_update(study, linearisation, trial.point, trial.residual, part * step, part * own_step)
    return linearisation


def has_diverged(residual: np.ndarray) -> bool:
    """Whether a simulation diverges, of a fitted or a held-out test."""
    return not bool((np.abs(residual) < OVERFLOW).all())


def fit(
    study: Study,
    linearisation: Linearisation,
    used: np.ndarray,
    prior: Prior,
    *,
    iterations: int,
    relinearisations: int = 0,
    tolerance: float = 0.5,
    relative_tolerance: float = MIN_RELATIVE_GAIN,
    report: Callable[[int, float], None] = lambda *_: None,
) -> FitOutcome:
    """Fit the directions of a linearisation, and the decays' own unknowns, to some series.

    The fit ends where a step gains less than `tolerance`, or than `relative_tolerance` of the cost. A step that makes a
    simulation diverge is rejected.

    Args:
        study: The study.
        linearisation: Linearisation where the fit begins.
        used: Which series (s,) are fitted.
        prior: Priors of the directions.
        iterations: Maximum number of iterations.
        relinearisations: How often slopes may be computed anew; if any, once more at the end.
        tolerance: Smallest gain in cost that is worth a step.
        relative_tolerance: The same as a fraction of the cost.
        report: Called with the iteration and the cost.
    """
    logarithmic = study.logarithmic[list(linearisation.active)]
    now = cost_of(study, linearisation, linearisation.residual, linearisation.point, used, prior)
    if has_diverged(linearisation.residual):
        return FitOutcome(linearisation, 0, False)
    damping, settled, fresh, taken, renewals_left = 1e-3, False, True, 0, relinearisations
    while taken < iterations and not settled:
        stop_if_asked()
        taken += 1
        step, own_step = bounded_step(study, linearisation, used, prior, damping)
        scale = min(1.0, MAX_LOG_STEP / max(np.abs(step[logarithmic]).max(initial=0.0), 1e-300))
        step, own_step = scale * step, scale * own_step
        trial = try_step(study, linearisation, used, prior, step, own_step)
        expected, gain = now - trial.predicted, now - trial.cost
        least = max(tolerance, relative_tolerance * abs(now))  # of the present cost, not of the first one
        slopes_final, little = fresh or not renewals_left, 0 <= gain < least or expected < least
        if gain > 0:
            linearisation = broyden_update(study, linearisation, trial.point, trial.residual, step, own_step)
            now, fresh = trial.cost, False
            damping = max(damping * 0.2, 1e-6) if scale == 1.0 else damping
            report(taken, now)
        if gain >= max(least, MIN_PREDICTED_SHARE * expected):
            continue
        if slopes_final and little:
            settled = True
        elif not slopes_final:
            linearisation = study.linearise(linearisation.point, linearisation.active)
            fresh, renewals_left, damping = True, renewals_left - 1, 1e-3
        elif gain <= 0:
            damping = max(damping * 8, 1e-2)
            settled = damping > 1e6
    if relinearisations and not fresh:
        linearisation = study.linearise(linearisation.point, linearisation.active)
    return FitOutcome(linearisation, taken, settled)
