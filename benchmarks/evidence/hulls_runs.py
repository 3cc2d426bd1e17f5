"""Natural periods of the hulls of the section `hulls`, and their motion in a small regular wave."""

import copy
import math
from typing import Any

import numpy as np

from benchmarks.evidence.hulls_cases import CASES, Case, scaled, two_members

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
    """Steady amplitude (m, rad) per metre of wave amplitude, by degree of freedom.

    The wave grows smoothly. The rest of the natural motions is fitted beside the wave's own frequency.

    Args:
        model: The model.
        case: The hull, and its wave at full scale.
        scale: Scale of the model, 1/50 at 1:50. Amplitudes of angles are per metre at that scale.
    """
    import jaxhydro as jh

    period, amplitude = case.period * scale**0.5, case.amplitude * scale
    times = np.arange(0.0, (RAMP + WAVES) * period, period / SAMPLES)
    sea = jh.regular_wave(2 * amplitude, period, model.environment, heading=math.radians(case.heading), ramp=RAMP * period)
    late = times >= RAMP * period
    positions, t = np.asarray(jh.simulate(model, times, sea).position)[late], times[late]
    natural = np.unique(np.round(jh.natural_modes(model).period / period, 4)) * period
    columns = [np.cos(0 * t)]
    for cycle in (period, *natural):
        columns += [np.cos(2 * np.pi / cycle * t), np.sin(2 * np.pi / cycle * t)]
    part = np.linalg.lstsq(np.stack(columns, axis=1), positions, rcond=None)[0]
    return dict(zip(jh.DOFS, (np.hypot(part[1], part[2]) / amplitude).tolist()))


def reference(case: Case) -> dict[str, Any]:
    """Natural periods, motion and heave at rest in plain NumPy."""
    from benchmarks.evidence.hulls_reference import Hull

    hull = Hull(platform_of(case))
    amplitudes = np.abs(hull.motion(case.period, math.radians(case.heading)))
    names = ("surge", "sway", "heave", "roll", "pitch", "yaw")
    return {"periods": hull.periods(), "motion": dict(zip(names, amplitudes.tolist())), "heave": hull.heave}


def worked_out(case: Case) -> dict[str, Any]:
    """Periods and motion by jaxhydro and in plain NumPy."""
    model = model_of(platform_of(case))
    return {"periods": periods(model), "motion": motion(model, case), "reference": reference(case)}


def variants() -> dict[str, Any]:
    """OC4-DeepCwind with its step as two members, and at 1:50, over the stepped full-scale one, less 1."""
    case = CASES["oc4-deepcwind"]
    plain, differences = platform_of(case), {}
    first = model_of(plain)
    whole, moving = periods(first), motion(first, case)
    for label, platform, scale in (
        ("two members", two_members(plain), 1.0),
        ("1:50", scaled(plain, 1 / 50), 1 / 50),
    ):
        model = model_of(platform)
        variant, waves = periods(model), motion(model, case, scale)
        turned = {dof: waves[dof] * (scale if dof == "pitch" else 1.0) / moving[dof] - 1 for dof in case.moved}
        differences[label] = {"periods": {dof: variant[dof] / scale**0.5 / whole[dof] - 1 for dof in whole}, "motion": turned}
    return differences
