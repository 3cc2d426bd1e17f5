"""Mooring section of a RAFT design: points, line types and lines, as MoorPy reads them."""

import math
from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, field_validator

from jaxhydro.errors import Faults, Problem, shown, suggest
from jaxhydro.input_schema import Consistent, NonNegative, Positive, Schema, Vector
from jaxhydro.interop.mooring_system import Attachment, LineType, MooringLine, MooringPoint, MooringSystem
from jaxhydro.interop.raft_member import OPEN, Name

WORDS = {  # parts of MoorPy's words for types of points (MoorPy 1.3.0, system.py, parseYAML)
    Attachment.GROUND: ("anch", "fix"),
    Attachment.PLATFORM: ("fair", "ves", "body", "coupled"),
    Attachment.FREE: ("con", "free"),
}


def _attachment(value: Any) -> Attachment:
    word = value.lower() if isinstance(value, str) else ""
    for kind, parts in WORDS.items():
        if any(part in word for part in parts):
            return kind
    raise Faults(Problem("", "one of fixed, fairlead, free", shown(value)))


class _Point(Schema):
    model_config = OPEN
    name: Name
    type: Annotated[Attachment, BeforeValidator(_attachment)]
    location: Vector
    mass: NonNegative = 0.0
    volume: NonNegative = 0.0


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
            for key, names, noun in (("endA", points, "point"), ("endB", points, "point"), ("type", types, "line type")):
                if (value := getattr(line, key)) not in names:
                    expected = f"the name of a {noun} ({', '.join(names)})"
                    yield Problem(f"lines[{i}].{key}", expected, shown(value), suggest(value, names))
            if line.endA == line.endB:
                yield Problem(f"lines[{i}].endB", "a point that is not endA", shown(line.endB))

    def system(self, depth: float, density: float) -> MooringSystem:
        """The moorings, in water of a depth (m) unless the section has one, and of a density (kg/m³).

        Where the section has another density, the mass of lines is that which gives the same weight in this water.
        """
        less = (self.rho or self.water_density or density) - density
        points = {p.name: MooringPoint(p.name, p.type, p.location, p.mass, p.volume) for p in self.points}
        types = {
            t.name: LineType(t.name, t.diameter, t.mass_density - less * math.pi / 4 * t.diameter**2, t.stiffness)
            for t in self.line_types
        }
        named = [(line.name or f"line{i}", line) for i, line in enumerate(self.lines, 1)]
        lines = {name: MooringLine(name, (line.endA, line.endB), line.length, line.type) for name, line in named}
        return MooringSystem(self.water_depth or depth, points, types, lines)
