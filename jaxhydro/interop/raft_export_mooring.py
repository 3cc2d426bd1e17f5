"""Mooring section of a RAFT design from catenary lines or straight springs.

References:
    MoorPy 1.3.0, system.py, parseYAML (points, line_types, lines; gravity is 9.81 m/s² whatever the design says), and
    Catenary.py, which divides by the weight of a line.
"""

from typing import Any

import numpy as np

from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.export_source import ExportSource
from jaxhydro.interop.exported_lines import mooring_system_of
from jaxhydro.interop.mooring_system import Attachment, LineType, MooringLine, MooringPoint, MooringSystem
from jaxhydro.interop.openfast.mass_parts import tidy
from jaxhydro.loads import CatenaryLines, MooringLines

WORDS = {Attachment.GROUND: "fixed", Attachment.PLATFORM: "vessel", Attachment.FREE: "free"}
MOORPY_GRAVITY = 9.81  # m/s²
LIGHT = 1e-9  # weight of a line that stands for a spring, over its axial stiffness


def catenary_mooring(source: ExportSource, load: CatenaryLines) -> tuple[dict[str, Any], list[ConvertedItem]]:
    """Section `mooring` of catenary lines, and what became of them.

    Args:
        source: The platform.
        load: Its lines.
    """
    system = mooring_system_of(source, load)
    text = f"{len(load.types)} lines, elastic catenaries in static balance, as here."
    items = [ConvertedItem("mooring", Treatment.TAKEN, text)]
    if (gravity := float(source.model.environment.gravity)) != MOORPY_GRAVITY:
        text = (
            f"MoorPy weighs lines by {MOORPY_GRAVITY:g} m/s², whatever the design says; here gravity is {gravity:g} m/s². "
            f"Lines are heavier by {MOORPY_GRAVITY / gravity - 1:.3%} in RAFT."
        )
        items.append(ConvertedItem("mooring.line_types", Treatment.APPROXIMATED, text))
    if friction := float(load.seabed_friction):
        text = f"RAFT has lines without friction on the seabed: {friction:g}."
        items.append(ConvertedItem("mooring.seabed.friction", Treatment.LEFT_OUT, text))
    return _section(source, system), items


def spring_mooring(source: ExportSource, load: MooringLines) -> tuple[dict[str, Any] | None, list[ConvertedItem]]:
    """Section `mooring` of straight springs, and what became of them.

    Springs are written as elastic lines of next to no weight.

    Args:
        source: The platform.
        load: Its springs.

    Returns:
        The section; None where no spring has an unstretched length above 0, which MoorPy's lines need.
    """
    points: dict[str, MooringPoint] = {}
    types: dict[str, LineType] = {}
    lines: dict[str, MooringLine] = {}
    items: list[ConvertedItem] = []
    for i, (anchor, fairlead) in enumerate(zip(np.asarray(load.anchor, float).T, np.asarray(load.fairlead, float).T), 1):
        name = f"line{i}"
        stiffness, length = float(load.stiffness[name]), float(load.unstretched_length[name])
        if length <= 0.0:
            text = f"A spring of {stiffness:.6g} N/m with an unstretched length of {length:.6g} m; MoorPy's are above 0."
            items.append(ConvertedItem(f"mooring.{name}", Treatment.LEFT_OUT, text, warning=True))
            continue
        axial = stiffness * length
        types[name] = LineType(name, 0.0, LIGHT * axial / (MOORPY_GRAVITY * length), axial)
        for end, attachment, point in (("anchor", Attachment.GROUND, anchor), ("fairlead", Attachment.PLATFORM, fairlead)):
            position = (float(point[0]), float(point[1]), float(point[2]))
            points[f"{end}{i}"] = MooringPoint(f"{end}{i}", attachment, position)
        lines[name] = MooringLine(name, (f"anchor{i}", f"fairlead{i}"), length, name)
    if not lines:
        return None, items
    text = (
        f"{len(lines)} straight springs as elastic lines whose weight is {LIGHT:g} of EA, since MoorPy has no lines without "
        "weight. `convert` reads them back as catenaries."
    )
    items.append(ConvertedItem("mooring", Treatment.APPROXIMATED, text))
    return _section(source, MooringSystem(source.seabed_depth, points, types, lines)), items


def _section(source: ExportSource, system: MooringSystem) -> dict[str, Any]:
    """Entries as MoorPy reads them: m, kg/m, N."""
    points = [
        {"name": point.name, "type": WORDS[point.attachment], "location": [tidy(value) for value in point.position]}
        for point in system.points.values()
    ]
    lines = [
        {
            "name": line.name,
            "endA": line.ends[0],
            "endB": line.ends[1],
            "type": line.line_type,
            "length": tidy(line.length),
        }
        for line in system.lines.values()
    ]
    types = [
        {
            "name": line_type.name,
            "diameter": tidy(line_type.diameter),
            "mass_density": tidy(line_type.mass_per_length),
            "stiffness": tidy(line_type.axial_stiffness),
        }
        for line_type in system.line_types.values()
    ]
    density = tidy(float(source.model.environment.density))
    return {"water_depth": tidy(system.depth), "rho": density, "points": points, "lines": lines, "line_types": types}
