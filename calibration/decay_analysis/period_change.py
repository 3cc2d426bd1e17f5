"""Change of a decay's period with its amplitude, measured against simulated."""

import math
from typing import NamedTuple

import numpy as np

from jaxhydro.dynamics.response import decay_cycles

MIN_CYCLES = 6  # whole cycles of a decay whose early and late periods are compared
MIN_CHANGE = 1e-3  # of the period: what is smaller matters to nobody
MIN_DEVIATIONS = 4.0  # standard errors of a slope over the amplitude


class PeriodChange(NamedTuple):
    """Mean periods of the first and of the last half of a decay's cycles (s).

    Attributes:
        large: Measured, at large amplitude.
        small: Measured, at small amplitude.
        simulated_large: Simulated, at large amplitude.
        simulated_small: Simulated, at small amplitude.
    """

    large: float
    small: float
    simulated_large: float
    simulated_small: float


def unexplained_period_change(
    time: np.ndarray, measured: np.ndarray, simulated: np.ndarray, noise: float = 0.0
) -> PeriodChange | None:
    """Compare how the period changes while a decay dies out, measured and simulated.

    Args:
        time: (k,) times (s).
        measured: (k,) measured motion about zero (m or rad).
        simulated: (k,) simulated motion about zero (m or rad).
        noise: Standard deviation of the noise on `measured` (m or rad).

    Returns:
        The periods, or None where the difference is small. The measured period has to change otherwise than the simulated one
        by 0.1 % of it or more. The slope of their difference over the amplitude has to be four standard errors or more.
    """
    cycles, simulated_cycles = decay_cycles(time, measured, noise), decay_cycles(time, simulated, noise)
    count = min(len(cycles.period), len(simulated_cycles.period)) // 2
    if count < MIN_CYCLES:
        return None
    # crests and troughs of a motion off zero alternate: whole cycles do not
    real, model, amplitude = (
        half_cycles[: 2 * count].reshape(count, 2).mean(axis=1)
        for half_cycles in (cycles.period, simulated_cycles.period, cycles.amplitude)
    )
    periods = PeriodChange(*(float(half.mean()) for series in (real, model) for half in np.split(series, [count // 2])))
    change = (periods.large - periods.small) - (periods.simulated_large - periods.simulated_small)
    (slope, _), covariance = np.polyfit(amplitude, real - model, 1, cov=True)
    if abs(change) < MIN_CHANGE * float(real.mean()) or abs(slope) < MIN_DEVIATIONS * math.sqrt(covariance[0, 0]):
        return None
    return periods
