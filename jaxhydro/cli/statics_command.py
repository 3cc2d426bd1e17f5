"""Command `statics`: where a platform rests, by which forces, and what its moorings do."""

import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.cli.console import say, table
from jaxhydro.cli.model_messages import calibrated, print_position, print_remarks, print_rest
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.static_forces import LineState, forces_by_load, line_states, mooring_stiffness, offset_curve
from jaxhydro.dynamics.statics import equilibrium, linearised
from jaxhydro.environment import DOFS
from jaxhydro.loads import AbstractLines
from jaxhydro.loads.static_force import StaticForce
from jaxhydro.platform.build import build
from jaxhydro.platform.schema import load_platform
from jaxhydro.units import for_people, unit_of

POINTS = 6  # of an offset curve
NO_FORCE = 1e-9  # of the weight: what is below is rounding
NO_COUPLING = 1e-13  # of the largest stiffness: what is below is rounding, also where neither motion is restored
PREFIXES = ((1e6, "M"), (1e3, "k"), (1.0, ""))  # of N
OF_TENSIONS = PREFIXES[1:]  # as moorings are described


def print_statics(platform: str, force: Mapping[str, float], offset: Mapping[str, float], calibration: Path | None) -> None:
    """Print rest position, natural periods, forces by load, mooring lines and stiffness.

    Offset curves follow where they are asked for, and the position under a steady force.

    Args:
        platform: A platform file, or a built-in name.
        force: Steady force at the reference point by motion (N, N m).
        offset: Largest offset of a curve by motion (m, rad).
        calibration: A calibration's folder or file, whose values are taken.

    Raises:
        InputError: The platform or the calibration cannot be used.
        EquilibriumError: The platform does not rest, with the force or without.
    """
    contents = load_platform(platform)
    model = build(contents)
    if calibration is not None:
        model = calibrated(model, platform, contents.name, calibration)
    print_remarks(model.remarks)
    print_rest(model, platform)
    rest = equilibrium(model)
    _print_forces(model, rest)
    _print_lines(model, rest, "at rest")
    _print_stiffness(model, rest)
    for dof, most in offset.items():
        _print_curve(model, dof, float(np.asarray(rest)[DOFS.index(dof)]), most)
    if force:
        pushed = model.with_effect(StaticForce(force=dict(force)))
        words = ", ".join(f"{dof} {value:g} {_force_unit(dof)}" for dof, value in force.items())
        position = equilibrium(pushed)
        print_position(f"Under a steady force: {words}", np.asarray(position))
        _print_lines(pushed, position, "under the steady force")


def _force_unit(dof: str) -> str:
    return "N m" if dof in DOFS[3:] else "N"


def _prefix(values: Iterable[float], prefixes: Sequence[tuple[float, str]] = PREFIXES) -> tuple[float, str]:
    """Size and letter of the prefix of N that makes the largest of some values 1 or more.

    Where no prefix does, it is the last one.
    """
    largest = max((abs(x) for x in values if math.isfinite(x)), default=0.0)
    return next(((size, letter) for size, letter in prefixes if largest >= size), prefixes[-1])


def _print_forces(model: Model, position: Float[Array, "6"]) -> None:
    forces = forces_by_load(model, position)
    least = NO_FORCE * float(model.body.mass * model.environment.gravity)
    units = [_prefix(x for six in forces.values() for x in six[part]) for part in (slice(0, 3), slice(3, 6)) for _ in range(3)]
    heads = ("Load", *(f"{dof} ({letter}{_force_unit(dof)})" for dof, (_, letter) in zip(DOFS, units, strict=True)))
    rows = [
        (load, *(f"{x / size:.5g}" if abs(x) > least else "0" for x, (size, _) in zip(six, units, strict=True)))
        for load, six in forces.items()
    ]
    table("Forces at rest, about the reference point", heads, rows)


def _print_lines(model: Model, position: Float[Array, "6"], when: str) -> None:
    if not (lines := line_states(model, position)):
        return
    size, letter = _prefix((line.tension for line in lines), OF_TENSIONS)
    heads = ("Line", f"Tension ({letter}N)", "Below the horizontal (deg)", "Strain (%)", "On the sea bed (m)")
    rows = [
        (
            str(i + 1),
            f"{line.tension / size:.5g}",
            f"{math.degrees(line.angle):.4g}",
            f"{100 * line.strain:.3g}",
            f"{line.on_seabed:.4g}",
        )
        for i, line in enumerate(lines)
    ]
    table(f"Mooring lines {when}, at the fairlead", heads, rows)


def _print_stiffness(model: Model, position: Float[Array, "6"]) -> None:
    """Stiffness of all loads, and of the moorings alone."""
    heads = ("", *DOFS)
    total = np.asarray(linearised(model, position)[1])
    size, letter = _prefix(total.flat)
    parts = {f"Stiffness at rest ({letter}N/m, {letter}N, {letter}N m)": total}
    if any(isinstance(load, AbstractLines) for load in model.loads):
        parts["Stiffness of the mooring lines alone, earth axes"] = np.asarray(mooring_stiffness(model, position))
    for title, stiffness in parts.items():
        matrix = stiffness / size
        largest = np.sqrt(np.outer(abs(np.diag(matrix)), abs(np.diag(matrix))))
        least = np.maximum(NO_FORCE * largest, NO_COUPLING * abs(matrix).max())
        rows = [
            (dof, *(f"{x:.5g}" if abs(x) > low else "0" for x, low in zip(row, lows, strict=True)))
            for dof, row, lows in zip(DOFS, matrix, least, strict=True)
        ]
        table(title, heads, rows)
    if len(parts) > 1:
        say("That of the lines is not symmetric where they pull: moments are about the reference point, which moves")


def _print_curve(model: Model, dof: str, rest: float, most: float) -> None:
    offsets = rest + np.linspace(0.0, most, POINTS)
    curve = offset_curve(model, dof, jnp.asarray(offsets))
    size, letter = _prefix(map(float, curve.force))
    heads = [f"{dof} ({unit_of(dof)})", f"Force ({letter}{_force_unit(dof)})"]
    others = [other_dof for other_dof in ("surge", "sway", "heave", "roll", "pitch") if other_dof != dof]
    heads += [f"{other_dof} ({unit_of(other_dof)})" for other_dof in others]
    tensions: list[list[LineState]] = [line_states(model, jnp.asarray(held_position)) for held_position in curve.position]
    line_size, line_letter = _prefix((line.tension for lines in tensions for line in lines), OF_TENSIONS)
    heads += [f"Line {i + 1} ({line_letter}N)" for i in range(len(tensions[0]))]
    rows = []
    least = NO_FORCE * float(model.body.mass * model.environment.gravity)
    for position, force, lines in zip(curve.position.round(8) + 0.0, curve.force, tensions):
        motion = dict(zip(DOFS, position, strict=True))
        cells = [f"{float(for_people(dof, motion[dof])):.4g}", "0" if abs(force) < least else f"{force / size:.5g}"]
        cells += [f"{float(for_people(other_dof, motion[other_dof]).round(3)) + 0.0:.3f}" for other_dof in others]
        rows.append((*cells, *(f"{line.tension / line_size:.5g}" for line in lines)))
    table(f"Held in {dof}: the force that it takes{', and the tensions' if tensions[0] else ''}", heads, rows)
    if not np.isfinite(curve.force).all():
        say("nan: the platform or a line finds no balance there")
