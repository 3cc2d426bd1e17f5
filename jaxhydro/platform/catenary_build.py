"""Catenary mooring lines of a platform file."""

from typing import Protocol

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.errors import InputError, Problem
from jaxhydro.loads.catenary.catenary_lines import CatenaryLines, segment_names
from jaxhydro.loads.catenary.catenary_profile import reach
from jaxhydro.platform.catenary_schema import Catenary
from jaxhydro.quick_jit import quick_jit


class WaterProperties(Protocol):
    """Density (kg/m³), depth (m) and gravity (m/s²)."""

    density: float
    depth: float
    gravity: float


def catenary_lines(mooring: Catenary, water: WaterProperties) -> CatenaryLines:
    """The load of catenary mooring lines.

    Args:
        mooring: Checked contents of the platform file.
        water: Density, depth and gravity.

    Returns:
        The load; copies of a line by heading follow each other.
    """
    ends, grounded = [], []
    types: list[tuple[str, ...]] = []
    lengths: dict[str, float] = {}
    for line in mooring.lines:
        for end in line.copies():
            kinds = tuple(segment.type for segment in line.segments)
            names = segment_names(len(types), len(kinds))
            lengths |= {name: segment.length for name, segment in zip(names, line.segments)}
            ends.append(end)
            types.append(kinds)
            grounded.append(mooring.on_seabed(line, water.depth))
    used = {kind: mooring.line_types[kind] for kinds in types for kind in kinds}
    return CatenaryLines(
        jnp.asarray(np.array([anchor for anchor, _ in ends]).T),
        jnp.asarray(np.array([fairlead for _, fairlead in ends]).T),
        tuple(types),
        tuple(grounded),
        {kind: line_type.axial_stiffness for kind, line_type in used.items()},
        {kind: line_type.weight(water.density, water.gravity) for kind, line_type in used.items()},
        lengths,
        {f"line{i + 1}": 0.0 for i in range(len(types))},
        jnp.asarray(mooring.seabed.friction),
    )


USUAL_STRAIN = 0.05  # of a line in the reference position: chain and wire break at 0.01 to 0.02, polyester near 0.12


@quick_jit
def _at_rest(load: CatenaryLines) -> tuple[Float[Array, " l"], Float[Array, " l"], Float[Array, " l"]]:
    """Horizontal tension, lowest point and strain of lines in the reference position.

    Returns:
        Horizontal tension (N), lowest point under the fairlead (m) and strain (-) at the fairlead, (l,) each.
    """
    tension, direction = load.tension(jnp.zeros(6), jnp.eye(3))
    horizontal, vertical = tension * jnp.hypot(direction[0], direction[1]), -tension * direction[2]
    # what is suspended of a line that may rest on a seabed anywhere ends at its lowest point
    segments = load.segments()._replace(grounded=jnp.ones(tension.shape, bool))
    pull = jnp.maximum(horizontal, 1e-9 * tension)
    return horizontal, reach(pull, jnp.maximum(vertical, 0.0), segments)[1], tension / segments.stiffness[0]


def catenary_remarks(mooring: Catenary, water: WaterProperties, source: str) -> list[str]:
    """Warnings of lines that hang straight down, or are stretched by much, in the reference position.

    Args:
        mooring: Checked contents of the platform file.
        water: Density, depth and gravity.
        source: Name of the platform, for the message.

    Raises:
        InputError: A line has no balance in the reference position, or one whose anchor is above the seabed sags into it.
    """
    load, depth = catenary_lines(mooring, water), mooring.seabed_depth(water.depth)
    horizontal, drop, strain = (np.asarray(values) for values in _at_rest(load))
    fairlead = np.asarray(load.fairlead)[2]
    places = [(i, copy) for i, line in enumerate(mooring.lines) for copy in range(len(line.heading))]
    problems = {}
    for (i, _), on_bed, pull, low in zip(places, load.grounded, horizontal, fairlead - drop):
        if not np.isfinite(pull):
            problems[i] = Problem(
                f"mooring.lines[{i}]", "a line that can be in balance", "no balance at the reference position"
            )
        elif not on_bed and low < -depth:
            hint = (
                "Let the anchor be on the sea bed, or shorten the line: a line between two points above it must not touch it."
            )
            problems[i] = Problem(f"mooring.lines[{i}].anchor", f"an anchor at z = {-depth:g} m", f"a sag to {low:.4g} m", hint)
    if problems:
        raise InputError(source, list(problems.values()))
    remarks = []
    if taut := [i for i, value in enumerate(strain) if value > USUAL_STRAIN]:
        worst = max(taut, key=lambda i: strain[i])
        subject = f"line {', '.join(str(i + 1) for i in taut)}"
        remarks.append(
            f"mooring.lines: {subject} is stretched by up to {strain[worst]:.0%} at the reference position, "
            f"with {float(horizontal[worst]) / 1e3:.4g} kN of horizontal tension in line {worst + 1}. Chain and wire break at "
            "1 to 2 %, polyester near 12 %. Check lengths, anchors and axial stiffness"
        )
    taut_lines = [mooring.lines[i].distance() > mooring.lines[i].length() for i, _ in places]  # vertical tendons, too
    hanging = [on_bed and pull == 0.0 and not taut for on_bed, pull, taut in zip(load.grounded, horizontal, taut_lines)]
    if slack := [i + 1 for i, hangs in enumerate(hanging) if hangs]:
        subject = "every line hangs" if len(slack) == len(places) else f"line {', '.join(map(str, slack))}: hangs"
        remarks.append(
            f"mooring.lines: {subject} straight down at the reference position and has no horizontal tension. "
            "The line is longer than the way down to the sea bed and along it to its anchor."
        )
    return remarks
