"""Why the study's ratios between cases are not the paper's: one thing changed at a time, and pontoons in more elements."""

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from benchmarks.evidence import study
from benchmarks.evidence.common import SHARED, cached, keep, say

SEA, SEEDS = "moderate", 5
ELEMENTS = (1, 2, 3, 5, 10)
STIFFER = 2.6  # times: surge at 86 s, near the 80 s of FOCAL's campaign 2
FOCAL = SHARED / "measured" / "focal-c2" / "platform.yaml"


class Variant(NamedTuple):
    """What is changed: the platform file, the model, the sea's peak enhancement, whether the flow is that at the rest
    position; and which cases it is of."""

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

    kept = ("coefficients", "linear_damping", "wetting", "diffraction")
    other = load_platform(FOCAL).model_copy(update={key: getattr(platform, key) for key in kept})
    pontoon = next(member for member in platform.members if member.group == "pontoon")
    return with_elements(other, "pontoon", pontoon.elements, pontoon.points)


def fine(platform: Any) -> Any:
    """Pontoons in ten elements of two points."""
    from jaxhydro.platform.convergence import with_elements

    return with_elements(platform, "pontoon", 10)


def changed(key: str, value: str) -> Callable[[Any], Any]:
    return lambda platform: platform.model_copy(update={key: value})


VARIANTS = (
    Variant("as above"),
    Variant("pontoons of many strips", fine),
    Variant(f"lines {STIFFER:g} times as stiff", stiffer),
    Variant("body, lines and water (350 m) of FOCAL campaign 2", focal),
    Variant("peak enhancement 3.3", gamma=3.3),
    Variant("strips' directions of the platform at rest", model={"directions": "earth"}),
    Variant("flow at the rest position", at_rest=True, cases="12"),
    Variant("both of these", model={"directions": "earth"}, at_rest=True, cases="12"),
    Variant("displaced hull under a flat surface", changed("wetting", "instantaneous"), cases="12"),
    Variant("drag of each component", changed("drag_speed", "component")),
    Variant("MacCamy-Fuchs without its lag", model={"lag": False}, cases="3"),
    Variant("bound waves not diffracted", model={"bound": False}, cases="3"),
    Variant("neither, as OpenFAST", model={"lag": False, "bound": False}, cases="3"),
    Variant("tuned Ca kept in long waves", changed("diffraction", "ramp"), cases="3"),
    Variant("stretching without MacCamy-Fuchs", changed("diffraction", "none"), cases="3"),
    Variant("MacCamy-Fuchs without stretching", changed("wetting", "mean"), cases="3"),
)


@cache
def at_rest_parts() -> tuple[Any, Any]:
    """A sea whose flow is that at given points wherever the strips are, and motion in it: made once, compiled once."""
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
    """Mean over the seeds of the band integrals (and mean surge) of its cases, and natural periods in still water."""
    import dataclasses

    from jaxhydro import build, load_platform, natural_modes, simulate

    result: dict[str, Any] = {}
    for name in variant.cases:
        case = study.CASES[name]
        platform = variant.platform(study.rounded(load_platform(study.PLATFORM), case))
        model = dataclasses.replace(build(platform), **variant.model)
        still = name == "3" and platform.wetting == "mean"
        rows = []
        for seed in range(1, SEEDS + 1):
            stretching = "none" if still else case.stretching
            sea = study.sea_of(SEA, seed, model.environment, case.order, stretching, variant.gamma)
            times = study.times()
            position = at_rest(model, sea, times) if variant.at_rest else np.asarray(simulate(model, times, sea).position)
            rows.append(study.integrals(position, SEA))
        result[name] = np.mean(rows, axis=0).tolist()
        result["periods"] = [natural_modes(model).of(dof) for dof in ("surge", "heave", "pitch")]
    return result


def elements() -> dict[str, Any]:
    """Case 3 with the pontoons in more elements of one and of two points, one seed."""
    from jaxhydro import convergence, load_platform

    platform = study.rounded(load_platform(study.PLATFORM), study.CASES["3"])
    sea = study.sea_of(SEA, 1, study.model_of("3").environment, 2, "vertical")
    found = {}
    for points in (1, 2):
        one = convergence(
            platform,
            sea,
            study.times(),
            peak_period=study.SEAS[SEA][1],
            elements=ELEMENTS,
            points=points,
            transient=study.TRANSIENT,
        )
        integral = [one.integral[dof][band].tolist() for dof, band in study.COLUMNS]
        found[str(points)] = {
            "integral": integral,
            "period": [one.period[dof].tolist() for dof in ("heave", "pitch")],
            "difference": [one.difference[dof].tolist() for dof in ("surge", "heave", "pitch")],
        }
    return found


def run(key: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """Every variant by name, and the pontoons."""
    found = {}
    for number, variant in enumerate(VARIANTS):
        if variant.platform is focal and not FOCAL.exists():
            continue
        name = f"variant-{number}"
        result = cached("study", key, name)
        if result is None:
            result = keep("study", key, name, of_variant(variant))
            say(f"  {variant.name}")
        found[variant.name] = result
    return found, cached("study", key, "elements", elements)
