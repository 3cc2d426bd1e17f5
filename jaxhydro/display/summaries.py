"""Short texts of models, motions, natural modes and seas, for `repr`."""

from dataclasses import fields
from typing import TYPE_CHECKING

import jax
import numpy as np

from jaxhydro.dynamics.conventions import Conventions
from jaxhydro.environment import DOFS
from jaxhydro.units import for_people, unit_of

if TYPE_CHECKING:
    from jaxhydro.dynamics.model import Model
    from jaxhydro.dynamics.natural_modes import Modes
    from jaxhydro.dynamics.response import Response
    from jaxhydro.parameters import AbstractEffect
    from jaxhydro.waves.components import Components
    from jaxhydro.waves.irregular_sea import IrregularSea

SMALLEST = 1e-6  # m or deg: what is smaller is shown as 0


def are_numbers(tree: object) -> bool:
    """Whether all leaves are numbers or arrays.

    None does not count, nor do placeholders while JAX traces or compares shapes.
    """
    leaves = jax.tree.leaves(tree, is_leaf=lambda x: x is None)
    return all(isinstance(x, int | float | np.ndarray | jax.Array) and not isinstance(x, jax.core.Tracer) for x in leaves)


def has_numbers(model: "Model") -> bool:
    """Whether a model holds the numbers of one platform, and not shapes, tracers or several platforms."""
    parts = (model.environment, model.body, model.hull.elements, model.hull.strips)
    return are_numbers(parts) and np.ndim(model.body.mass) == 0


def model_summary(model: "Model") -> str:
    """Mass, water, strips, loads and number of parameters of a model; natural periods are not computed.

    Args:
        model: The platform.
    """
    water, hull = model.environment, model.hull
    groups = list(dict.fromkeys(group for group, _ in hull.elements.labels))
    mass, density, depth = (float(x) for x in (model.body.mass, water.density, water.depth))
    centre = ", ".join(f"{float(x):.3g}" for x in np.asarray(model.body.centre).round(6) + 0.0)
    lines = [f"Model of a floating platform: {mass / 1e3:.5g} t in water of {density:g} kg/m³, {depth:g} m deep"]
    lines.append(f"  centre of mass: ({centre}) m from the reference point")
    strips = f"{hull.elements.length.size} load elements, {len(hull.strips.element)} strips"
    lines.append(f"  hull: {strips} in {', '.join(groups)}" if groups else "  hull: no members")
    for name, effects in (("loads", model.loads), ("water effects", model.water), ("sensor effects", model.sensors)):
        if effects:
            lines.append(f"  {name}: {', '.join(_effect(effect) for effect in effects)}")
    default = Conventions()
    chosen = [(f.name, getattr(model.conventions, f.name)) for f in fields(Conventions)]
    if changed := [f"{name} {value}" for name, value in chosen if value != getattr(default, name)]:
        lines.append(f"  conventions: {', '.join(changed)}")
    lines.append(f"  {len(model.values)} parameters: `values`, and `about` for what each means")
    if model.remarks:
        lines.append(f"  {len(model.remarks)} remark{'' if len(model.remarks) == 1 else 's'} on its files (`remarks`)")
    return "\n".join(lines)


def _effect(effect: "AbstractEffect") -> str:
    """Class of an effect, and its number of parameters."""
    return f"{type(effect).__name__} ({len(effect.values)})" if effect.values else type(effect).__name__


def response_summary(response: "Response") -> str:
    """Duration, step and range of each motion.

    Args:
        response: The motion, (t, 6).
    """
    rows = [(dof, *(f"{_shown(x):.3g}" for x in ends(response, dof)), unit_of(dof)) for dof in DOFS]
    width = max(len(cell) for row in rows for cell in row[1:3])
    return "\n".join(
        [
            f"Response: {span(response)}",
            *(f"  {dof:<5} {low:>{width}} to {high:>{width}} {unit}" for dof, low, high, unit in rows),
        ]
    )


def span(response: "Response") -> str:
    """First and last instant of a motion, number and step of its samples."""
    time = np.asarray(response.time)
    if len(time) < 2:
        return f"{len(time)} sample{'' if len(time) == 1 else 's'}"
    steps = np.diff(time)
    even = np.ptp(steps) <= 1e-6 * steps.mean()
    step = f"step {steps.mean():.4g} s" if even else f"steps {steps.min():.4g} to {steps.max():.4g} s"
    return f"{time[0]:.6g} to {time[-1]:.6g} s in {len(time)} samples, {step}"


def ends(response: "Response", dof: str) -> tuple[float, float]:
    """Smallest and largest value of a motion (m or deg); NaN without samples."""
    values = for_people(dof, np.asarray(response[dof]))
    return (float(values.min()), float(values.max())) if values.size else (float("nan"), float("nan"))


def _shown(value: float) -> float:
    return 0.0 if abs(value) < SMALLEST else value


def modes_summary(modes: "Modes") -> str:
    """Natural periods by motion.

    Args:
        modes: The natural modes.
    """
    count = len(modes.period)
    lines = [f"Modes: {count} natural period{'' if count == 1 else 's'}"]
    lines += [f"  {motion:<5} {period:>8.2f} s" for motion, period in zip(modes.motion, modes.period, strict=True)]
    return "\n".join([*lines, *([f"  unstable in {', '.join(modes.unstable)}"] if modes.unstable else [])])


def components_summary(waves: "Components") -> str:
    """Number, frequencies, height and headings of wave components.

    Args:
        waves: The components.
    """
    amplitude, frequency = np.asarray(waves.amplitude), np.asarray(waves.omega) / (2 * np.pi)
    heading = np.rad2deg(np.asarray(waves.heading))
    if not frequency.size:
        return "no wave components"
    where = f"{heading.min():.3g}" if np.ptp(heading) < SMALLEST else f"{heading.min():.3g} to {heading.max():.3g}"
    if frequency.size == 1:
        return f"one wave component of {amplitude[0]:.4g} m, {1 / frequency[0]:.4g} s, heading {where} deg"
    high = 4 * float((0.5 * amplitude**2).sum()) ** 0.5
    band = f"{frequency.min():.3g} to {frequency.max():.3g} Hz"
    return f"{frequency.size} wave components, {band}: Hs {high:.3g} m, heading {where} deg"


def irregular_sea_summary(sea: "IrregularSea") -> str:
    """Order, water and components of an irregular sea.

    Args:
        sea: The sea.
    """
    grown = f", grown from rest over {float(sea.ramp):g} s" if float(sea.ramp) else ""
    depth = f"in water {float(sea.environment.depth):g} m deep"
    return (
        f"IrregularSea of order {sea.order} {depth}, stretching {sea.stretching}{grown}\n  {components_summary(sea.components)}"
    )
