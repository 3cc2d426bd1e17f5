"""Members of a RAFT design from those of a platform.

The counterpart of `raft_hull`, which has the table of coefficients. Sizes, stations and coefficients are the platform's.
Shells have no thickness, so that members have no mass.

References:
    RAFT at e6cb69e, raft_member.py: __init__ (stations, headings, no end at z = 0), setPosition (p1, p2),
    calcHydroConstants and calcHydroLinearization (reference volumes and areas), getHydrostatics; helpers.py, getFromDict (a
    coefficient by direction is a pair for each station).
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from jaxhydro.hull.member import Member
from jaxhydro.interop.export_source import ExportSource
from jaxhydro.interop.openfast.mass_parts import tidy
from jaxhydro.interop.raft_export_notes import RaftNotes
from jaxhydro.interop.raft_hull import end_volume_ratio
from jaxhydro.interop.raft_masses import turned
from jaxhydro.interop.raft_member import RaftMember

STEP = 1e-5  # of a member's length: stations that are closer are a step in size
OFF_WATERPLANE = 1e-3  # m, by which an end at z = 0 is moved up: RAFT refuses it
UPRIGHT = 1 - 1e-9  # z of the unit vector along an upright member


@dataclass(frozen=True)
class _Copies:
    """A declared member.

    Attributes:
        member: Its first copy.
        headings: Of its copies, deg.
        free: Fractions of the area and of the reference volume of both ends of the first copy that no other column covers.
    """

    member: Member
    headings: tuple[float, ...]
    free: Float[np.ndarray, "2 2"]


def raft_members(source: ExportSource, notes: RaftNotes) -> list[dict[str, Any]]:
    """Entries of `platform.members`.

    Args:
        source: The platform.
        notes: Collects what became of the members.
    """
    entries: list[dict[str, Any]] = []
    for copies in _declared(source):
        entry = _geometry(copies, notes)
        names = [earlier["name"] for earlier in entries]
        if (name := entry["name"]) in names:
            entry["name"] = next(numbered for i in range(2, len(names) + 3) if (numbered := f"{name} {i}") not in names)
        entry |= _coefficients(source, copies, entry, notes)
        if copies.member.diffracts and source.model.conventions.diffraction != "none":
            entry["MCF"] = True
            notes.diffraction(source.model.conventions.diffraction, entry["name"])
        entries.append(entry)
    return entries


def _declared(source: ExportSource) -> Iterator[_Copies]:
    ends, first = source.model.hull.ends, 0
    area, facing, radius, volume = (np.asarray(values, float) for values in (ends.area, ends.facing, ends.radius, ends.volume))
    for headings in source.headings:
        rows = slice(2 * first, 2 * first + 2)
        whole = np.stack([area[rows], 2 / 3 * math.pi * radius[rows] ** 3])
        free = np.divide(np.stack([facing[rows], volume[rows]]), whole, out=np.ones((2, 2)), where=whole > 0.0)
        yield _Copies(source.members[first], headings, free)
        first += len(headings)


def _geometry(copies: _Copies, notes: RaftNotes) -> dict[str, Any]:
    """Name, shape, ends, stations and sizes of a member, its lower end first if it is a column."""
    member, headings = copies.member, copies.headings
    back = turned(-headings[0])
    stations, sizes = _merged(np.asarray(member.stations, float)), np.asarray(member.sizes, float)
    ends = [_above_waterplane(back @ end, member, notes) for end in (member.a, member.b)]
    if _reversed(member):
        ends, stations, sizes = ends[::-1], 1.0 - stations[::-1], sizes[::-1]
    length = float(np.linalg.norm(ends[1] - ends[0]))
    name = member.name.removesuffix("_1") if len(headings) > 1 else member.name
    entry: dict[str, Any] = {"name": name, "type": "rigid", "shape": "circ" if member.circular else "rect"}
    entry |= {"rA": _row(ends[0]), "rB": _row(ends[1])}
    shown = [tidy(size[0]) if member.circular else _row(size) for size in sizes]
    entry |= {"stations": _row(stations * length), "d": shown if np.ptp(sizes, axis=0).any() else shown[0], "t": 0.0}
    if headings != (0.0,):
        entry["heading"] = [float(heading) for heading in headings]
    twist = math.degrees(member.twist) - (headings[0] if _upright(member) else 0.0)
    if not member.circular and abs(twist) > 1e-9:
        entry["gamma"] = tidy(twist)
    if member.pierced:
        notes.pierced(name)
    if member.column and _tapers_at_waterline(ends, stations, sizes):
        notes.tapered_waterline(name)
    if member.column and not member.circular and np.ptp(sizes, axis=0).any():
        notes.tapered_box(name)
    return entry


def _coefficients(source: ExportSource, copies: _Copies, entry: dict[str, Any], notes: RaftNotes) -> dict[str, Any]:
    """Ca, Cd, CaEnd and CdEnd of a member."""
    member, count = copies.member, len(entry["stations"])
    values = {name: tidy(source.coefficient(member, name)) for name in ("Ca_t", "Ca_z", "Cd_t", "Cd_z")}
    if not member.column:
        pairs = {symbol: (values[f"{symbol}_z"], values[f"{symbol}_t"]) for symbol in ("Ca", "Cd")}
        equal = {symbol: first == second for symbol, (first, second) in pairs.items()}
        coefficients: dict[str, Any] = {
            symbol: pairs[symbol][0] if equal[symbol] else [list(pairs[symbol]) for _ in range(count)] for symbol in pairs
        }
        return coefficients | {"CaEnd": 0.0, "CdEnd": 0.0}
    coefficients = {"Ca": values["Ca_t"], "Cd": values["Cd_t"]}
    sides = RaftMember.model_validate(entry).sizes()
    if not member.circular and _upright(member) and np.ptp(sides, axis=1).any():
        # RAFT multiplies the coefficient along a side of an upright box by that side, not by the one across the flow
        ratio = sides[:, 1] / sides[:, 0]
        coefficients["Cd"] = [_row(values["Cd_t"] * np.array([side_ratio, 1 / side_ratio])) for side_ratio in ratio]
        notes.drag_of_boxes(entry["name"])
    free = copies.free[:, ::-1] if _reversed(member) else copies.free
    volume = values["Ca_z"] / (1.0 if member.circular else end_volume_ratio(RaftMember.model_validate(entry)))
    if not member.circular and volume:
        notes.end_volumes(entry["name"])
    coefficients |= {"CaEnd": _at_ends(tidy(volume), free[1], count), "CdEnd": _at_ends(values["Cd_z"], free[0], count)}
    if (free < 1.0).any() and (values["Ca_z"] or values["Cd_z"]):
        notes.covered_ends(entry["name"])
    return coefficients


def _at_ends(value: float, free: Float[np.ndarray, "2"], count: int) -> float | list[float]:
    """A coefficient of ends; a list over the stations where another column covers a part of an end."""
    if (free == 1.0).all():
        return value
    return _row(value * np.array([free[0], *[1.0] * (count - 2), free[1]]))


def _merged(stations: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
    """Stations (fractions of the length) with both sides of a step in size at one place."""
    merged = stations.copy()
    for i in np.flatnonzero(np.diff(stations) < STEP):
        merged[i : i + 2] = 0.5 * (stations[i] + stations[i + 1])
    return merged


def _above_waterplane(end: Float[np.ndarray, "3"], member: Member, notes: RaftNotes) -> Float[np.ndarray, "3"]:
    if tidy(end[2]) != 0.0:
        return end
    notes.moved_end(member.name, OFF_WATERPLANE)
    return end + np.array([0.0, 0.0, OFF_WATERPLANE])


def _tapers_at_waterline(
    ends: Sequence[Float[np.ndarray, "3"]], stations: Float[np.ndarray, " n"], sizes: Float[np.ndarray, "n 2"]
) -> bool:
    heights = ends[0][2] + stations * (ends[1][2] - ends[0][2])
    cut = (heights[:-1] <= 0.0) & (heights[1:] >= 0.0)
    return bool((np.diff(sizes, axis=0)[cut] != 0.0).any())


def _upright(member: Member) -> bool:
    return abs(member.axis[2]) > UPRIGHT


def _reversed(member: Member) -> bool:
    """Whether a column is declared from its upper to its lower end."""
    return member.column and bool(member.a[2] > member.b[2])


def _row(values: Sequence[float] | Float[np.ndarray, " n"]) -> list[float]:
    size = float(np.abs(np.asarray(values)).max())
    return [tidy(value) if abs(value) > 1e-12 * size else 0.0 for value in values]
