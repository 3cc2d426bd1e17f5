"""Time steps: defaults, and the longest that resolve a platform's motions, memories and waves."""

import math
from typing import get_args

from jaxhydro.choices import check
from jaxhydro.dynamics.integrate import Method
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.statics import natural_modes
from jaxhydro.integrators.adams_bashforth_coefficients import START_STEPS
from jaxhydro.waves.irregular import fourier_length
from jaxhydro.waves.irregular_sea import IrregularSea

SEA_STEP = 0.25  # s times the platform's pace, in irregular seas where no step is asked for
LONGEST_STEP, STEP_AT_REST = 1.0, 0.5  # the same elsewhere: the longest, and that of a platform which nothing restores
STEP_MARGIN = 1.001  # of a step: hulls of nearly one size take the same
STEPS_PER_PERIOD = 24  # of the shortest natural period, where no step is asked for
STEP_PER_WAVE_PERIOD = 0.075  # of the shortest waves' period: the longest step
STABILITY_LIMIT = {"ab4": 0.3}  # step times the fastest rate of a memory: Adams-Bashforth is stable to there (on the real axis)
DEFAULT_STABILITY_LIMIT = 1.0  # by Runge-Kutta schemes, stable to 2.8: for accuracy


def default_step(model: Model, method: Method = "tsit5") -> float:
    """Default time step (s) outside irregular seas.

    It is a 24th of the shortest natural period, at most 1 s times `Model.pace`, and short enough for `memory_step`. The
    error of a decay is then about 1e-6 of its amplitude. Waves shorter than the platform's motions need a smaller step.
    """
    periods = natural_modes(model).period
    pace = float(model.pace)
    step = min(LONGEST_STEP * pace, float(periods.min()) / STEPS_PER_PERIOD) if len(periods) else STEP_AT_REST * pace
    return min(step, memory_step(model, method))


def memory_step(model: Model, method: Method = "tsit5") -> float:
    """Longest time step (s) that resolves the loads' memories; infinite where none is fast.

    Args:
        model: The platform.
        method: Integration scheme.

    Raises:
        UnknownName: Another method.
    """
    check(method=(method, get_args(Method)))
    fastest = max(load.fastest() for load in model.loads)
    return STABILITY_LIMIT.get(method, DEFAULT_STABILITY_LIMIT) / fastest if fastest else math.inf


def sea_step(model: Model) -> float:
    """Default time step (s) in irregular seas: 0.25 s at the size of VolturnUS-S."""
    return STEP_MARGIN * SEA_STEP * float(model.pace)


def largest_step(model: Model, cutoff: float) -> float:
    """Largest time step (s) in an irregular sea that resolves the platform's motions and the waves.

    Args:
        model: The platform.
        cutoff: Highest frequency of the waves (Hz).
    """
    return min(sea_step(model), default_step(model, "ab4"), STEP_PER_WAVE_PERIOD / cutoff)


def steps_in(sea: IrregularSea, duration: float, limit: float) -> tuple[float, int]:
    """Size (s) and number of time steps that divide the sea's period and cover a duration.

    Args:
        sea: The sea.
        duration: Duration (s).
        limit: Largest time step (s).
    """
    period = float(sea.components.period)
    step = period / fourier_length(period / limit)
    return step, max(START_STEPS, math.ceil(duration / step - 1e-9))
