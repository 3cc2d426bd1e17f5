"""Masses of a RAFT design: members, rotors with nacelles, and point masses.

The mass of a member is that of its shell, caps and ballast.
"""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from jaxtyping import Float

from jaxhydro.hull.member import Member
from jaxhydro.interop.frustum import Moments, hollow_frustum, solid_frustum
from jaxhydro.interop.raft_member import RaftMember, cap_extent
from jaxhydro.interop.raft_schema import Effect, Turbine

Matrix3 = Float[np.ndarray, "3 3"]
SIDE = 1e-9  # of a member's length, by which a size is looked up before or after a step


def moments_of(member: RaftMember) -> Moments:
    """Mass of a member and its moments about rA: shell, caps and ballast.

    The shell reaches inwards from the outer size. Ballast fills a section from its lower station on. Caps lie within the
    shell and have its density (RAFT at e6cb69e, raft_member.py, getInertia). As there, ballast is not displaced by caps. At a
    step RAFT's code counts the inertia of the section before it once more, without its mass; here it counts once.

    Args:
        member: The member.

    Returns:
        Moments in the member's axes: kg, kg m, kg m².
    """
    distances, outer = member.along(member.stations), member.sizes()
    inner = outer - 2 * member.per_station("t")[:, None]
    fills, densities = member.per_section("l_fill") / (member.stations[-1] - member.stations[0]), member.per_section("rho_fill")
    total = Moments()
    for i in range(len(distances) - 1):
        if (length := float(distances[i + 1] - distances[i])) == 0.0:
            continue
        shell = hollow_frustum(outer[i], outer[i + 1], inner[i], inner[i + 1], length, member.circular)
        total += shell.times(member.rho_shell).shifted(float(distances[i]))
        if (fill := float(fills[i]) * member.length) > 0.0:
            top = inner[i] + (inner[i + 1] - inner[i]) * min(fill / length, 1.0)
            ballast = solid_frustum(inner[i], top, fill, member.circular)
            total += ballast.times(float(densities[i])).shifted(float(distances[i]))
    for cap in _caps(member, distances, inner):
        total += cap.times(member.rho_shell)
    return total


def _caps(member: RaftMember, distances: np.ndarray, inner: np.ndarray) -> Iterator[Moments]:
    """Volume and moments of each cap.

    A hole keeps its share of the inner size through the cap's thickness.

    Args:
        member: The member.
        distances: Distances of its stations from rA (m), (n,).
        inner: Inner sizes (m) at the stations, (n, 2).
    """

    def inner_size(position: float, side: float) -> np.ndarray:
        beside = position + side * SIDE * member.length
        return np.array([np.interp(beside, distances, inner[:, k]) for k in (0, 1)])

    thickness = member.cap_thicknesses()
    for i, (station, hole) in enumerate(zip(member.along(member.cap_stations), member.holes())):
        low, high = cap_extent(member, i, float(thickness[i]))
        if high <= low:
            continue
        first, last = inner_size(low, 1.0), inner_size(high, -1.0)
        named = first if station <= low else last if station >= high else 0.5 * (first + last)
        share = np.divide(hole, named, out=np.zeros(2), where=named > 0.0)
        yield hollow_frustum(first, last, share * first, share * last, high - low, member.circular).shifted(low)


def turned(heading: float) -> Matrix3:
    """Rotation about z by a heading (deg)."""
    c, s = math.cos(math.radians(heading)), math.sin(math.radians(heading))
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def member_axes(member: RaftMember) -> Matrix3:
    """Unit vectors, as columns, along the first and the second size and from rA to rB.

    They are those of the platform file's member with the same keys: see `twist`. RAFT's inertia of a level box has its two
    sides exchanged (raft_member.py at e6cb69e). Its getInertia has the first side along p1, calcHydroLinearization and plot
    along p2. Here the first side is horizontal, as it is in RAFT's drag and drawings.
    """
    a, b = np.array(member.rA), np.array(member.rB)
    stations, sizes = member.along(member.stations) / member.length, member.sizes()
    hull = Member(member.name, "", member.circular, a, b, stations, sizes, math.radians(twist(member)))
    return np.stack([*hull.directions, (b - a) / member.length], axis=1)


def twist(member: RaftMember) -> float:
    """Gamma (deg) of a member in the platform file.

    It is RAFT's, with the other sign where a column runs from top to bottom; 0 for a circle.
    """
    down = (member.rA[2] - member.rB[2]) / member.length
    return 0.0 if member.circular else -member.gamma if down > math.sqrt(0.5) else member.gamma


def part(name: str, mass: float, centre: np.ndarray, inertia: Matrix3) -> dict[str, Any]:
    """A part of the platform file's rigid body: kg, m, kg m² about its centre."""
    entries = {"Ixx": (0, 0), "Iyy": (1, 1), "Izz": (2, 2), "Ixy": (0, 1), "Ixz": (0, 2), "Iyz": (1, 2)}
    size = float(np.abs(np.diag(inertia)).max())
    values = {key: float(inertia[index]) for key, index in entries.items()}
    values = {key: value for key, value in values.items() if key[1] == key[2] or abs(value) > 1e-12 * size}
    return {"name": name, "mass": mass, "centre_of_mass": [round(float(x), 9) for x in centre], "inertia": values}


def member_parts(member: RaftMember, headings: list[float]) -> list[dict[str, Any]]:
    """A part for each copy of a member; none if it has no mass."""
    moments = moments_of(member)
    if moments.mass <= 0.0:
        return []
    axes = member_axes(member)
    centre = np.array(member.rA) + moments.centre * axes[:, 2]
    inertia = axes @ np.diag(moments.inertia()) @ axes.T
    parts = []
    for i, heading in enumerate(headings, 1):
        turn = turned(heading)
        name = member.name if len(headings) == 1 else f"{member.name} {i}"
        parts.append(part(name, moments.mass, turn @ centre, turn @ inertia @ turn.T))
    return parts


def rotor_parts(turbine: Turbine) -> list[dict[str, Any]]:
    """A part for each rotor with its nacelle.

    The shaft points along q = (cos tilt cos toe, cos tilt sin toe, sin tilt), downwind. The hub is `overhang` along q from the
    reference point of rotor and nacelle, the centre of mass xCG_RNA along q. IxRNA is about q, IrRNA across it (RAFT at
    e6cb69e, raft_rotor.py, Rotor.__init__ and setPosition; raft_fowt.py, calcStatics).
    """
    values = {key: turbine.per_rotor(key) for key in ("mRNA", "IxRNA", "IrRNA", "xCG_RNA", "overhang")}
    angles = {key: np.radians(turbine.per_rotor(key)) for key in ("shaft_tilt", "shaft_toe")}
    parts = []
    for i in range(turbine.nrotors):
        tilt, toe = float(angles["shaft_tilt"][i]), float(angles["shaft_toe"][i])
        q = np.array([math.cos(tilt) * math.cos(toe), math.cos(tilt) * math.sin(toe), math.sin(tilt)])
        point = np.array(turbine.rRNA[i] if turbine.rRNA is not None else (0.0, 0.0, 0.0))
        if turbine.hHub is not None:
            point[2] = turbine.per_rotor("hHub")[i] - q[2] * values["overhang"][i]
        if (mass := float(values["mRNA"][i])) <= 0.0:
            continue
        across = float(values["IrRNA"][i])
        inertia = across * np.eye(3) + (float(values["IxRNA"][i]) - across) * np.outer(q, q)
        name = "rotor and nacelle" if turbine.nrotors == 1 else f"rotor and nacelle {i + 1}"
        parts.append(part(name, mass, point + values["xCG_RNA"][i] * q, inertia))
    return parts


def effect_part(effect: Effect, number: int) -> dict[str, Any]:
    """Part of the platform file's rigid body from a point inertia.

    Its off-diagonal entries stand in the matrix as they are (RAFT, raft_fowt.py).
    """
    xx, yy, zz, xy, xz, yz = effect.moments_of_inertia
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return part(f"point inertia {number}", effect.mass, np.array(effect.location), inertia)
