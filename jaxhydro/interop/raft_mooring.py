"""Mooring section of a RAFT design: points, line types and lines, as MoorPy reads them."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, field_validator

from jaxhydro.errors import Consistent, Faults, NonNegative, Positive, Problem, Schema, Vector, shown, suggest
from jaxhydro.interop.raft_member import OPEN, Name


class PointKind(StrEnum):
    """What holds a point of a mooring."""

    FIXED = "fixed"
    FAIRLEAD = "fairlead"
    FREE = "free"


WORDS = {  # parts of MoorPy's words for types of points (MoorPy 1.3.0, system.py, parseYAML)
    PointKind.FIXED: ("anch", "fix"),
    PointKind.FAIRLEAD: ("fair", "ves", "body", "coupled"),
    PointKind.FREE: ("con", "free"),
}


@dataclass(frozen=True)
class MooringPoint:
    """End of lines.

    Attributes:
        name: Its name.
        kind: Fixed in the earth, a fairlead of the platform, or free.
        position: m, in the axes of the platform file, the platform at its reference position.
    """

    name: str
    kind: PointKind
    position: tuple[float, float, float]


@dataclass(frozen=True)
class LineType:
    """Section of a line.

    Attributes:
        name: Its name.
        diameter: Of the displaced volume, m.
        mass_per_length: kg/m.
        axial_stiffness: EA, N.
    """

    name: str
    diameter: float
    mass_per_length: float
    axial_stiffness: float

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
    """

    name: str
    ends: tuple[str, str]
    length: float
    line_type: str


@dataclass(frozen=True)
class MooringSystem:
    """Moorings of one platform.

    Attributes:
        depth: Of the sea bed under the lines, m.
        points: By name.
        line_types: By name.
        lines: In the order of the file.
        density: Of the water that the section states, kg/m³, or None.
    """

    depth: float
    points: dict[str, MooringPoint]
    line_types: dict[str, LineType]
    lines: tuple[MooringLine, ...]
    density: float | None = None


def _kind(value: Any) -> Any:
    word = value.lower() if isinstance(value, str) else ""
    return next((kind for kind, parts in WORDS.items() if any(part in word for part in parts)), value)


class _Point(Schema):
    model_config = OPEN
    name: Name
    type: Annotated[PointKind, BeforeValidator(_kind)]
    location: Vector


class _LineType(Schema):
    model_config = OPEN
    name: Name
    diameter: NonNegative
    mass_density: NonNegative
    stiffness: Positive


class _Line(Schema):
    model_config = OPEN
    name: Name = ""
    endA: Name
    endB: Name
    type: Name
    length: Positive


class MooringSection(Consistent):
    """Mooring section of a design; sizes in m, mass_density in kg/m, stiffness (EA) in N."""

    model_config = OPEN

    water_depth: Positive | None = None
    water_density: Positive | None = None
    rho: Positive | None = None
    points: Annotated[tuple[_Point, ...], Field(min_length=2)]
    lines: Annotated[tuple[_Line, ...], Field(min_length=1)]
    line_types: Annotated[tuple[_LineType, ...], Field(min_length=1)]

    @field_validator("points", "line_types")
    @classmethod
    def _names_once(cls, rows: Any) -> Any:
        names = [row.name for row in rows]
        twice = [i for i, name in enumerate(names) if name in names[:i]]
        if twice:
            raise Faults(*(Problem(f"[{i}].name", "each name once", shown(names[i])) for i in twice))
        return rows

    def _faults(self) -> Iterator[Problem]:
        points, types = [point.name for point in self.points], [kind.name for kind in self.line_types]
        for i, line in enumerate(self.lines):
            for key, known, what in (("endA", points, "point"), ("endB", points, "point"), ("type", types, "line type")):
                if (value := getattr(line, key)) not in known:
                    expected = f"the name of a {what} ({', '.join(known)})"
                    yield Problem(f"lines[{i}].{key}", expected, shown(value), suggest(value, known))
            if line.endA == line.endB:
                yield Problem(f"lines[{i}].endB", "a point that is not endA", shown(line.endB))

    def system(self, depth: float) -> MooringSystem:
        """The moorings, in water of a depth (m) unless the section has one."""
        points = {p.name: MooringPoint(p.name, p.type, p.location) for p in self.points}
        types = {t.name: LineType(t.name, t.diameter, t.mass_density, t.stiffness) for t in self.line_types}
        lines = tuple(
            MooringLine(line.name or f"line{i}", (line.endA, line.endB), line.length, line.type)
            for i, line in enumerate(self.lines, 1)
        )
        return MooringSystem(self.water_depth or depth, points, types, lines, self.rho or self.water_density)
