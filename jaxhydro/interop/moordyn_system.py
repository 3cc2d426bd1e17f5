"""A mooring system as MoorDyn's file describes it: points, line types, lines."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum


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
        name: Its ID.
        attachment: What it is fixed to.
        place: From the origin at still water at the reference position, m.
        mass: kg.
        volume: m3.
    """

    name: str
    attachment: Attachment
    place: tuple[float, float, float]
    mass: float = 0.0
    volume: float = 0.0


@dataclass(frozen=True)
class LineType:
    """Properties of lines per length.

    Attributes:
        name: Its name.
        diameter: Of the displaced volume, m.
        mass: In air, kg/m.
        axial_stiffness: EA, N.
        damping: BA, N s; a negative number is minus the damping ratio.
        bending_stiffness: EI, N m2.
        drag: Transverse and tangential coefficients.
        added_mass: Transverse and tangential coefficients.
    """

    name: str
    diameter: float
    mass: float
    axial_stiffness: float
    damping: float = 0.0
    bending_stiffness: float = 0.0
    drag: tuple[float, float] = (0.0, 0.0)
    added_mass: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class MooringLine:
    """One line.

    Attributes:
        name: Its ID.
        kind: Name of its type.
        ends: Names of the points at ends A and B.
        unstretched_length: m.
        segments: Number of segments in MoorDyn.
    """

    name: str
    kind: str
    ends: tuple[str, str]
    unstretched_length: float
    segments: int


@dataclass(frozen=True)
class MooringSystem:
    """Points, line types and lines by name.

    Attributes:
        points: Points.
        types: Line types.
        lines: Lines.
    """

    points: Mapping[str, MooringPoint]
    types: Mapping[str, LineType]
    lines: Mapping[str, MooringLine]
