"""What jaxhydro gives for the hulls of the section `hulls`: natural periods, and motion in a small regular wave."""

import copy
import math
from typing import Any

import numpy as np

from benchmarks.evidence.hulls_cases import Case

RAMP, WAVES, SAMPLES = 12, 24, 20  # wave periods of growth and of full height; samples a period


def platform_of(case: Case) -> dict[str, Any]:
    """The platform file as a dictionary of plain values."""
    from ruamel.yaml import YAML

    return YAML(typ="safe").load(case.path)


def model_of(platform: dict[str, Any]) -> Any:
    """The model of a platform file's dictionary."""
    import jaxhydro as jh

    return jh.build(jh.Platform.model_validate(copy.deepcopy(platform)))


def periods(model: Any) -> dict[str, float]:
    """Natural periods (s) of the motions that have one."""
    import jaxhydro as jh

    modes = jh.natural_modes(model)
    return {dof: modes.of(dof) for dof in jh.DOFS if not math.isnan(modes.of(dof))}


def motion(model: Any, case: Case, scale: float = 1.0) -> dict[str, float]:
    """Steady amplitude (m, rad) per metre of wave amplitude in a wave that grows smoothly, by degree of freedom.

    What is left of natural motions is fitted beside the wave's own frequency. At a `scale` (1/50: a model at 1:50) amplitudes
    of angles are per metre there.
    """
    import jaxhydro as jh

    period, amplitude = case.period * scale**0.5, case.amplitude * scale
    times = np.arange(0.0, (RAMP + WAVES) * period, period / SAMPLES)
    sea = jh.regular_wave(2 * amplitude, period, model.environment, heading=math.radians(case.heading), ramp=RAMP * period)
    late = times >= RAMP * period
    found, t = np.asarray(jh.simulate(model, times, sea).position)[late], times[late]
    own = np.unique(np.round(jh.natural_modes(model).period / period, 4)) * period
    columns = [np.cos(0 * t)]
    for one in (period, *own):
        columns += [np.cos(2 * np.pi / one * t), np.sin(2 * np.pi / one * t)]
    part = np.linalg.lstsq(np.stack(columns, axis=1), found, rcond=None)[0]
    return dict(zip(jh.DOFS, (np.hypot(part[1], part[2]) / amplitude).tolist()))


def reference(case: Case) -> dict[str, Any]:
    """The same in plain NumPy."""
    from benchmarks.evidence.hulls_reference import Hull

    hull = Hull(platform_of(case))
    found = np.abs(hull.motion(case.period, math.radians(case.heading)))
    names = ("surge", "sway", "heave", "roll", "pitch", "yaw")
    return {"periods": hull.periods(), "motion": dict(zip(names, found.tolist())), "heave": hull.heave}


def worked_out(case: Case) -> dict[str, Any]:
    """Periods and motion by jaxhydro and in plain NumPy."""
    model = model_of(platform_of(case))
    return {"periods": periods(model), "motion": motion(model, case), "reference": reference(case)}
