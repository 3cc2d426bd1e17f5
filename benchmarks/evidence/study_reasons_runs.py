"""The study's cases simulated with one thing changed at a time, and with pontoons in more elements."""

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from benchmarks.evidence import common, study_runs
from benchmarks.evidence.common import SHARED, cached, keep, say

SEA, SEEDS = "moderate", 5
ELEMENTS = (1, 2, 3, 5, 10)
STIFFER = 2.6  # times: surge at 86 s, near the 80 s of FOCAL's campaign 2
FOCAL = SHARED / "measured" / "focal-c2" / "platform.yaml"


class Variant(NamedTuple):
    """One change of the study's cases.

    Attributes:
        name: Short name.
        platform: Change of the platform file.
        model: Conventions of the model that are replaced.
        gamma: Peak enhancement of the sea, or None for the default.
        at_rest: Whether the flow is that at the rest position of the strips.
        cases: Cases that the change applies to.
    """

    name: str
    platform: Callable[[Any], Any] = lambda platform: platform
    model: dict[str, Any] = {}
    gamma: float | None = None
    at_rest: bool = False
    cases: str = "123"


def stiffer(platform: Any) -> Any:
    """Lines of more stiffness and the same pretension."""
    lines = tuple(line.model_copy(update={"stiffness": STIFFER * line.stiffness}) for line in platform.mooring.lines)
    return platform.model_copy(update={"mooring": platform.mooring.model_copy(update={"lines": lines})})


def focal(platform: Any) -> Any:
    """Body, lines and water of FOCAL's campaign 2 with this platform's coefficients."""
    from jaxhydro import load_platform
    from jaxhydro.platform.convergence import with_elements

    keys = ("coefficients", "linear_damping", "wetting", "diffraction")
    with_body = load_platform(FOCAL).model_copy(update={key: getattr(platform, key) for key in keys})
    pontoon = next(member for member in platform.members if member.group == "pontoon")
    return with_elements(with_body, "pontoon", pontoon.elements, pontoon.points)


def fine(platform: Any) -> Any:
    """Pontoons in ten elements of two points."""
    from jaxhydro.platform.convergence import with_elements

    return with_elements(platform, "pontoon", 10)


def changed(key: str, value: str) -> Callable[[Any], Any]:
    return lambda platform: platform.model_copy(update={key: value})


VARIANTS = (
    Variant("base"),
    Variant("many", fine),
    Variant("lines", stiffer),
    Variant("focal", focal),
    Variant("sharp", gamma=3.3),
    Variant("still", model={"directions": "earth"}),
    Variant("rest", at_rest=True, cases="12"),
    Variant("both", model={"directions": "earth"}, at_rest=True, cases="12"),
    Variant("flat", changed("wetting", "instantaneous"), cases="12"),
    Variant("component", changed("drag_speed", "component")),
    Variant("no lag", model={"lag": False}, cases="3"),
    Variant("free", model={"bound": False}, cases="3"),
    Variant("neither", model={"lag": False, "bound": False}, cases="3"),
    Variant("tuned", changed("diffraction", "ramp"), cases="3"),
    Variant("plain", changed("diffraction", "none"), cases="3"),
    Variant("unstretched", changed("wetting", "mean"), cases="3"),
)


@cache
def at_rest_parts() -> tuple[Any, Any]:
    """A sea whose flow is that at given points wherever the strips are, and motion in it.

    Both are made once, so that they are compiled once.
    """
    import equinox as eqx
    import jax.numpy as jnp

    from jaxhydro import AbstractSea
    from jaxhydro.dynamics.integrate import integrate

    class AtRest(AbstractSea):
        sea: Any
        points: Any

        def flow(self, time, points, cylinders=None):
            return self.sea.flow(time, self.points, cylinders)

        def elevation(self, time, points):
            return self.sea.elevation(time, points)

        def surface(self, time, points):
            return None

    @eqx.filter_jit
    def motion(model, sea, start, times, step, steps):
        return integrate(model, sea, start, times[0], jnp.asarray(step), steps, "ab4", "forward").at(times)[0]

    return AtRest, motion


def at_rest(model: Any, sea: Any, times: np.ndarray, step: float = 0.25) -> np.ndarray:
    """Motion where the flow is that at the strips' rest position; `wetting` is "mean"."""
    import jax.numpy as jnp

    from jaxhydro import State, equilibrium
    from jaxhydro.dynamics.integrate import clock

    kind, motion = at_rest_parts()
    hull, steps = model.hull, round(float(times[-1] + times[1]) / step)
    wetted = hull.wetted(jnp.array([0.0, 0.0, 1.0]), -hull.elements.start[2])
    reach = wetted.reach[jnp.array(hull.strips.element)] * hull.strips.fraction
    points = jnp.concatenate([hull.strips.start + reach * hull.strips.axis, hull.ends.position], axis=1)
    prepared = sea.prepared(hull.extremities(), model.cylinders, clock("ab4", 0.0, step, steps))
    start = State(equilibrium(model), jnp.zeros(6), model.rest().memory)
    return np.asarray(motion(model, kind(prepared, points), start, jnp.asarray(times), step, steps))


def of_variant(variant: Variant) -> dict[str, Any]:
    """Band integrals and mean surge of a variant's cases, means over the seeds; natural periods (s)."""
    import dataclasses

    from jaxhydro import build, load_platform, natural_modes, simulate

    result: dict[str, Any] = {}
    for name in variant.cases:
        case = study_runs.CASES[name]
        platform = variant.platform(study_runs.rounded(load_platform(study_runs.PLATFORM), case))
        model = dataclasses.replace(build(platform), **variant.model)
        still = name == "3" and platform.wetting == "mean"
        rows = []
        for seed in range(1, SEEDS + 1):
            stretching = "none" if still else case.stretching
            sea = study_runs.sea_of(SEA, seed, model.environment, case.order, stretching, variant.gamma)
            times = study_runs.times()
            position = at_rest(model, sea, times) if variant.at_rest else np.asarray(simulate(model, times, sea).position)
            rows.append(study_runs.integrals(position, SEA))
        result[name] = np.mean(rows, axis=0).tolist()
        result["periods"] = [natural_modes(model).of(dof) for dof in ("surge", "heave", "pitch")]
    return result


def elements() -> dict[str, Any]:
    """Case 3 with the pontoons in more elements of one and of two points, one seed."""
    from jaxhydro import convergence, load_platform

    platform = study_runs.rounded(load_platform(study_runs.PLATFORM), study_runs.CASES["3"])
    sea = study_runs.sea_of(SEA, 1, study_runs.model_of("3").environment, 2, "vertical")
    results = {}
    for points in (1, 2):
        study = convergence(
            platform,
            sea,
            study_runs.times(),
            peak_period=study_runs.SEAS[SEA][1],
            elements=ELEMENTS,
            points=points,
            transient=study_runs.TRANSIENT,
        )
        integral = [study.integral[dof][band].tolist() for dof, band in study_runs.COLUMNS]
        results[str(points)] = {
            "integral": integral,
            "period": [study.period[dof].tolist() for dof in ("heave", "pitch")],
            "difference": [study.difference[dof].tolist() for dof in ("surge", "heave", "pitch")],
        }
    return results


def run(key: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """Results of the variants by name, and of the pontoons."""
    results = {}
    for number, variant in enumerate(VARIANTS):
        if variant.platform is focal and not (FOCAL.exists() or common.text_only):
            continue
        name = f"variant-{number}"
        result = cached("study", key, name)
        if result is None:
            result = keep("study", key, name, of_variant(variant))
            say(f"  {variant.name}")
        results[variant.name] = result
    return results, cached("study", key, "elements", elements)
