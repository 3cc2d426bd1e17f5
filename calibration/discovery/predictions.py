"""Predictions of held-out tests: bands that 95 % of the samples are expected in.

The variance of a predicted sample is g C g^T + e^2 + n^2. g are the slopes of the motion along the fitted parameters, C is
their covariance. n is the sensor's noise. e is the error above the noise in fitted tests of the same kind, in proportion to the
motion.

References:
    Seber and Wild 2003, Nonlinear Regression, section 5.1: prediction intervals by linearisation.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from calibration.discovery.diagnosis import Prediction
from calibration.discovery.effect_fits import EffectFits
from calibration.discovery.fit_state import FitState
from calibration.discovery.score_covariance import parameter_covariance
from calibration.result import TestFit
from jaxhydro.environment import DOFS

NORMAL_95 = 1.96  # standard deviations of a normal distribution on both sides of its mean that hold 95 %


def predictions_of(fits: EffectFits, state: FitState, tests: Sequence[TestFit]) -> tuple[Prediction, ...]:
    """Predicted motions of the held-out tests, with their bands.

    Args:
        fits: Study, candidates, priors.
        state: A fit.
        tests: Measured and simulated motions of every test with this fit.
    """
    held = [(test, series) for test in tests if test.use == "holdout" for series in test.series if series.scored]
    if not held:
        return ()
    covariance = parameter_covariance(fits.study, state.linearisation, fits.prior(state.chosen))
    slopes, errors = motion_slopes(fits, state), relative_errors(tests)
    predictions = []
    for test, series in held:
        mine = slopes[test.id, series.channel][: len(series.measured)]
        parameters = np.maximum(np.einsum("tq,qr,tr->t", mine, covariance, mine), 0.0)
        spread = float(np.std(series.measured))
        error = float(np.hypot(series.noise, errors.get((test.kind == "decay", series.channel), 0.0) * spread))
        half_width = NORMAL_95 * np.sqrt(parameters + error**2)
        inside = float(np.mean(np.abs(series.measured - series.simulated) <= half_width))
        predictions.append(Prediction(test.id, series.channel, half_width, inside, float(np.sqrt(np.mean(parameters))), error))
    return tuple(predictions)


def relative_errors(tests: Sequence[TestFit]) -> dict[tuple[bool, str], float]:
    """Relative errors of the fitted tests, by kind (whether decays) and motion.

    A relative error is the RMSE above the noise over the motion's standard deviation.
    """
    squares: dict[tuple[bool, str], list[float]] = {}
    for test in tests:
        for series in test.series if test.use == "fit" else ():
            if series.scored and (variance := float(np.var(series.measured))) > 0:
                above = float(np.mean((series.measured - series.simulated) ** 2)) - series.noise**2
                squares.setdefault((test.kind == "decay", series.channel), []).append(max(above, 0.0) / variance)
    return {key: float(np.sqrt(np.mean(values))) for key, values in squares.items()}


def motion_slopes(fits: EffectFits, state: FitState) -> dict[tuple[str, str], np.ndarray]:
    """Slopes of the motions in time along a fit's directions (t, q), by test and motion.

    A decay's own initial position, rate and offset are fitted to it whatever the parameters are. Its slopes are the remainder
    after that fit.
    """
    study = fits.study
    parts = study.simulations.time_slopes(state.linearisation.point, state.linearisation.active)
    q, by_motion = len(state.linearisation.active), {}
    if study.decays is not None:
        dofs = study.decays.data.dofs
        whole = parts.pop(0)
        for record, mine in zip(study.decay_records, whole.reshape(-1, len(dofs), *whole.shape[1:]), strict=True):
            weight = np.array([1 / record.noise[DOFS[dof]] if DOFS[dof] in record.noise else 0.0 for dof in dofs])
            weighed = (weight[:, None, None] * mine).reshape(-1, mine.shape[-1])
            moved = np.linalg.lstsq(weighed[:, q:], weighed[:, :q], rcond=None)[0]
            for dof, slopes in zip(dofs, mine[..., :q] - mine[..., q:] @ moved, strict=True):
                by_motion[record.id, DOFS[dof]] = slopes
    for sea, mine in zip(study.seas, parts, strict=True):
        by_test = mine.reshape(len(sea.tests), len(sea.dofs), *mine.shape[1:])
        for test, motions in zip(sea.tests, by_test, strict=True):
            for dof, slopes in zip(sea.dofs, motions, strict=True):
                by_motion[test, DOFS[dof]] = slopes
    return by_motion
