"""Schema of catenary mooring lines, in SI, headings in degrees."""

import math
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

from jaxhydro.errors import Problem, shown, suggest
from jaxhydro.input_schema import Consistent, NonNegative, Positive, Schema, Text
from jaxhydro.platform.anchored_line import AnchoredLine

MAX_STRAIN = 0.25  # of a line in the reference position: twice that at which polyester ropes break
ON_SEABED = 1e-4  # of the water depth: how far from the seabed an anchor is on it


class LineType(Consistent):
    """Axial stiffness EA (N) and weight in water (N/m) of a chain, wire or rope.

    In place of `submerged_weight`: `mass_per_length` in air (kg/m) and `diameter` (m) of a cylinder that displaces as much
    water. For studless chain that is 1.8 times the nominal diameter.
    """

    axial_stiffness: Positive
    submerged_weight: Positive | None = None
    mass_per_length: Positive | None = None
    diameter: Positive | None = None

    def _faults(self) -> Iterator[Problem]:
        pair = {key: getattr(self, key) for key in ("mass_per_length", "diameter")}
        stated = [key for key, value in pair.items() if value is not None]
        either = "either submerged_weight, or mass_per_length and diameter"
        if self.submerged_weight is not None and stated:
            yield Problem("", either, ", ".join(["submerged_weight", *stated]))
        elif self.submerged_weight is None and not stated:
            yield Problem("", either, "neither")
        elif len(stated) == 1:
            (lacking,) = set(pair) - set(stated)
            yield Problem(lacking, f"a number, since {stated[0]} is given", "nothing")

    def weight(self, density: float, gravity: float) -> float:
        """Weight in water (N/m) of a density (kg/m³), by gravity (m/s²)."""
        if self.submerged_weight is not None:
            return self.submerged_weight
        assert self.mass_per_length is not None and self.diameter is not None
        return (self.mass_per_length - density * math.pi / 4 * self.diameter**2) * gravity


class Segment(Schema):
    """Part of a line: its type and unstretched length (m)."""

    type: Text
    length: Positive


class CatenaryLine(AnchoredLine):
    """Line from anchor to fairlead (m), copied to each `heading` (deg) about the z axis.

    Its segments are in this order.
    """

    segments: Annotated[tuple[Segment, ...], Field(min_length=1)]

    def length(self) -> float:
        """Unstretched length (m)."""
        return sum(segment.length for segment in self.segments)


class Seabed(Schema):
    """Friction coefficient (-) between lines and the seabed, and the seabed's depth (m).

    Without a depth it is the water's.
    """

    friction: NonNegative = 0.0
    depth: Positive | None = None


class Catenary(Consistent):
    """Mooring of elastic lines with weight, which may rest on the seabed."""

    kind: Literal["catenary"]
    line_types: Annotated[dict[Text, LineType], Field(min_length=1)]
    lines: Annotated[tuple[CatenaryLine, ...], Field(min_length=1)]
    seabed: Seabed = Seabed()

    def _faults(self) -> Iterator[Problem]:
        names, used = ", ".join(self.line_types), {segment.type for line in self.lines for segment in line.segments}
        for i, line in enumerate(self.lines):
            for k, segment in enumerate(line.segments):
                if segment.type not in self.line_types:
                    where, hint = f"lines[{i}].segments[{k}].type", suggest(segment.type, self.line_types)
                    yield Problem(where, f"a type of `line_types` ({names})", shown(segment.type), hint)
            if line.distance() > (1 + MAX_STRAIN) * line.length():
                expected = (
                    f"at least {line.distance() / (1 + MAX_STRAIN):.6g} m, as the fairlead is {line.distance():.6g} m from "
                )
                hint = "Segments and coordinates are in m; a line stretches by its axial stiffness."
                yield Problem(f"lines[{i}].segments", f"{expected}the anchor", f"{line.length():.6g} m", hint)
        for name in self.line_types:
            if name not in used and not suggest(name, used - set(self.line_types)):
                yield Problem(f"line_types.{name}", f"a type that a line has ({', '.join(sorted(used))})", shown(name))

    def seabed_depth(self, water_depth: float) -> float:
        """Depth (m) of the seabed under the lines, in water of a depth (m)."""
        return water_depth if self.seabed.depth is None else self.seabed.depth

    def on_seabed(self, line: CatenaryLine, water_depth: float) -> bool:
        """Whether a line's anchor is on the seabed, so that the line may rest there; of a water depth (m)."""
        return line.anchor[2] <= -self.seabed_depth(water_depth) * (1 - ON_SEABED)

    def water_faults(self, density: float, water_depth: float, gravity: float) -> Iterator[Problem]:
        """Mistakes with respect to the water: points under the seabed, and types that float."""
        depth = self.seabed_depth(water_depth)
        for i, line in enumerate(self.lines):
            for end in ("anchor", "fairlead"):
                if (z := getattr(line, end)[2]) < -depth * (1 + ON_SEABED):
                    expected = f"a point on or above the sea bed, z = {-depth:g} m"
                    yield Problem(f"mooring.lines[{i}].{end}", expected, f"z = {z:g} m")
        for name, kind in self.line_types.items():
            if (weight := kind.weight(density, gravity)) <= 0:
                hint = "A line that floats is not modelled; `diameter` is that of the displaced water."
                yield Problem(f"mooring.line_types.{name}", "a line that sinks", f"{weight:.4g} N/m in water", hint)
