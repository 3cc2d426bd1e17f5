"""Starting point for a phase shift: gauge positions and clock lags too large for slopes.

A shift d turns first-order waves of circular frequency omega (rad/s) by a phase c(omega) d (rad). A motion X of a linear
platform becomes X exp(i c d), and its slope at no shift is i c X. So one linearisation gives the change for every d:

    motion changes by (exp(i c d) - 1) / (i c) times its slope

A fit by slopes does not cross a phase of half a wave. It ends on the wrong side, and other parameters compensate.
"""

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from calibration.discovery.effects.peaks import highest_peaks
from calibration.discovery.eliminated_least_squares import minus_two_log_likelihood
from jaxhydro.environment import Environment

if TYPE_CHECKING:
    from calibration.discovery.linearisations import Linearisation
    from calibration.discovery.study import Study

PhasePerUnit = Callable[[np.ndarray, Environment], np.ndarray]

PHASE_SPACING = 0.2  # rad, between the phase shifts that are compared
MIN_PHASE_SHIFT = 0.5  # rad: smaller shifts are found by slopes


class PhaseShiftStart(NamedTuple):
    """Starting point of a refit.

    Attributes:
        values: Values by label.
        gain: Decrease of -2 ln L of the fitted tests there, nothing else moved.
    """

    values: Mapping[str, float]
    gain: float


def phase_shift_start(
    study: "Study", linearisation: "Linearisation", label: str, turns: PhasePerUnit
) -> PhaseShiftStart | None:
    """The likeliest value of a parameter that shifts the phase of waves.

    Args:
        study: The study.
        linearisation: Linearisation at the neutral value, with the slopes along the parameter.
        label: Label of the parameter.
        turns: Phase per unit (rad) by circular frequency and water.

    Returns:
        The starting point; None where it is near the neutral value, or gains nothing.
    """
    (i,) = study.index([label])
    about = study.model.about(label)
    unit = study.value(label, linearisation.point.x + study.directions[i]) - study.value(label, linearisation.point.x)
    waves = study.first_order
    along = linearisation.slopes[:, linearisation.active.index(i)].reshape(-1, 2)[waves] @ [1, 1j] / unit
    phase = turns(2 * math.pi * study.frequency[waves], study.model.environment)
    weight = (study.share * study.used[study.row_series])[::2][waves]
    motion = float(weight @ np.abs(along / phase) ** 2)
    if motion == 0:
        return None
    usual = math.sqrt(float(weight @ np.abs(along) ** 2) / motion)  # rad a unit
    tried = np.arange(about.lower, about.upper, PHASE_SPACING / usual)

    def deviance(value: float) -> float:
        residual = linearisation.residual.reshape(-1, 2).copy()
        change = along * np.expm1(1j * phase * value) / (1j * phase)
        residual[waves] += np.stack([change.real, change.imag], axis=1)
        return float(minus_two_log_likelihood(study, residual.ravel())[study.used].sum())

    gain = deviance(0.0) - np.array([deviance(value) for value in tried])
    best = highest_peaks(gain)[:1]
    far = best[np.abs(tried[best]) * usual > MIN_PHASE_SHIFT]
    return PhaseShiftStart({label: float(tried[far[0]])}, float(gain[far[0]])) if far.size else None


def phase_shift_factor(study: "Study", turns: PhasePerUnit, value: float) -> np.ndarray:
    """Change of the Fourier lines by a phase shift, over the change that the slopes predict.

    The slopes are those at no shift.

    Args:
        study: The study.
        turns: Phase per unit (rad) by circular frequency and water.
        value: The parameter's value.

    Returns:
        Complex factors of the lines (l,).
    """
    factor = np.ones(len(study.frequency), complex)
    waves = study.first_order
    phase = 1j * value * turns(2 * math.pi * study.frequency[waves], study.model.environment)
    factor[waves] = np.expm1(phase) / phase
    return factor
