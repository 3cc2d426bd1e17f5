"""A mooring system as MoorDyn and MoorPy describe it, and as the platform file has it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

ON_BED = 1e-4  # of the water depth: how far from the sea bed a fixed point is on it


class Attachment(StrEnum):
    """What a point is fixed to."""

    PLATFORM = "platform"
    GROUND = "ground"
    FREE = "free"
    OTHER = "other"  # a rod, a body of its own, or a word that is not known


@dataclass(frozen=True)
class MooringPoint:
    """End of lines.

    Attributes:
        name: Its name.
        attachment: What it is fixed to.
        position: From the origin at still water, the platform at its reference position, m.
        mass: kg.
        volume: m3.
        row: Line of the file that states it, from 1, or None.
    """

    name: str
    attachment: Attachment
    position: tuple[float, float, float]
    mass: float = 0.0
    volume: float = 0.0
    row: int | None = None


@dataclass(frozen=True)
class LineType:
    """Properties of lines per length.

    Attributes:
        name: Its name.
        diameter: Of the displaced volume, m.
        mass_per_length: In air, kg/m.
        axial_stiffness: EA, N.
        row: Line of the file that states it, from 1, or None.
    """

    name: str
    diameter: float
    mass_per_length: float
    axial_stiffness: float
    row: int | None = None

    def weight_in_water(self, density: float, gravity: float) -> float:
        """Weight less buoyancy, N/m, in water of a density (kg/m³) and gravity (m/s²)."""
        return (self.mass_per_length - density * math.pi / 4 * self.diameter**2) * gravity


@dataclass(frozen=True)
class MooringLine:
    """Line between two points.

    Attributes:
        name: Its name.
        ends: Names of its two points.
        length: Unstretched, m.
        line_type: Name of its type.
        row: Line of the file that states it, from 1, or None.
    """

    name: str
    ends: tuple[str, str]
    length: float
    line_type: str
    row: int | None = None


@dataclass(frozen=True)
class MooringSystem:
    """Points, line types and lines by name.

    Attributes:
        depth: Of the sea bed under the lines, m.
        points: Points.
        line_types: Line types.
        lines: Lines.
    """

    depth: float
    points: Mapping[str, MooringPoint]
    line_types: Mapping[str, LineType]
    lines: Mapping[str, MooringLine]


class NoCatenaries(Exception):
    """A mooring that the platform file cannot have as catenaries; the text says why.

    Attributes:
        row: Line of the file at which it is so, from 1, or None.
    """

    def __init__(self, reason: str, row: int | None = None) -> None:
        super().__init__(reason)
        self.row = row


def catenary_section(system: MooringSystem, depth: float, density: float, gravity: float) -> dict[str, Any]:
    """Section `mooring` of the platform file, of kind `catenary`.

    Every line runs from its anchor to the platform, through free points.

    Args:
        system: The moorings.
        depth: Of the water that the platform file has, m.
        density: Of the water, kg/m³.
        gravity: m/s².

    Returns:
        The section.

    Raises:
        NoCatenaries: Lines float, branch, carry a mass or end elsewhere.
    """
    remaining = dict(system.lines)
    rows: list[dict[str, Any]] = []
    used: dict[str, None] = {}  # types in the order of the lines
    for anchor in (point for point in system.points.values() if point.attachment is Attachment.GROUND):
        while path := _path(system, remaining, anchor):
            fairlead, segments = path
            used |= dict.fromkeys(segment["type"] for segment in segments)
            rows.append({"anchor": [*anchor.position], "fairlead": [*fairlead.position], "segments": segments})
    if remaining:
        line = next(iter(remaining.values()))
        raise NoCatenaries(f"line {line.name} does not run from the ground to the platform", line.row)
    types = {}
    for name in used:
        kind = system.line_types[name]
        if (weight := kind.weight_in_water(density, gravity)) <= 0.0:
            raise NoCatenaries(f"lines of type {name} float: {weight:.4g} N/m in water", kind.row)
        of_volume = {"mass_per_length": kind.mass_per_length, "diameter": kind.diameter}
        types[name] = {"axial_stiffness": kind.axial_stiffness} | (of_volume if kind.diameter else {"submerged_weight": weight})
    section = {"kind": "catenary", "line_types": types, "lines": rows}
    return section if system.depth == depth else {**section, "seabed": {"depth": system.depth}}


def _path(
    system: MooringSystem, remaining: dict[str, MooringLine], anchor: MooringPoint
) -> tuple[MooringPoint, list[dict[str, Any]]] | None:
    """Fairlead and segments of one of the remaining lines at an anchor; None where there is none.

    Its parts are taken out of `remaining`.

    Raises:
        NoCatenaries: It does not end on the platform, or a point between two lines has a mass or a volume.
    """
    point, segments, row = anchor, list[dict[str, Any]](), None
    while line := next((line for line in remaining.values() if point.name in line.ends), None):
        del remaining[line.name]
        row = line.row
        segments.append({"type": line.line_type, "length": line.length})
        point = system.points[line.ends[1] if line.ends[0] == point.name else line.ends[0]]
        if point.attachment is Attachment.PLATFORM:
            return point, segments
        meeting = sum(point.name in each_line.ends for each_line in system.lines.values())
        if point.attachment is not Attachment.FREE or meeting != 2:
            break
        if point.mass or point.volume:
            raise NoCatenaries(f"point {point.name} between two lines has a mass or a volume", point.row)
    if not segments:
        return None
    raise NoCatenaries(f"the line from point {anchor.name} ends at point {point.name}, which is not on the platform", row)
