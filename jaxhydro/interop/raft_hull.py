"""Members and coefficients of a platform file from those of a RAFT design.

RAFT's coefficients (raft_member.py at e6cb69e) and the platform file's:

| RAFT | acts on | of a column | of a pontoon |
|---|---|---|---|
| Ca (calcHydroConstants) | displaced volume | Ca_t, both directions | p1: Ca_z, p2: Ca_t |
| Cd (calcHydroLinearization) | size (p1: first, p2: second) times length | Cd_t, both directions | p1: Cd_z, p2: Cd_t |
| CaEnd (calcHydroConstants) | pi/12 d^3, d the mean side; of a ring the difference | Ca_z, on 2/3 pi r^3 | none |
| CdEnd (calcHydroLinearization) | area of the end or ring | Cd_z | none |

p2 is horizontal on a member that is not vertical, p1 across it (setPosition).
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from jaxhydro.hull.member import COLUMN_SLOPE
from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.raft_masses import twist
from jaxhydro.interop.raft_member import RaftMember

EQUAL = 1e-9  # relative, up to which two coefficients are the same


@dataclass(frozen=True)
class HullMember:
    """A member of the platform file.

    Attributes:
        entry: Its keys in the platform file, without `group`.
        column: Whether it is steeper than 45 degrees.
        coefficients: Ca_t, Ca_z, Cd_t, Cd_z.
        items: What became of its keys.
    """

    entry: dict[str, Any]
    column: bool
    coefficients: dict[str, float]
    items: tuple[ConvertedItem, ...]


def hull_member(member: RaftMember, headings: list[float], computed: bool, where: str) -> HullMember:
    """The platform file's member and coefficients.

    Args:
        member: Member of the design.
        headings: Of its copies, deg.
        computed: Whether RAFT takes potential flow for it.
        where: File and key of the member, for what is told.
    """
    column = abs(member.rB[2] - member.rA[2]) > COLUMN_SLOPE * member.length
    items: list[ConvertedItem] = []

    def approximated(key: str, meaning: str, treatment: Treatment = Treatment.APPROXIMATED) -> None:
        items.append(ConvertedItem(f"{where}.{key}", treatment, meaning))

    entry: dict[str, Any] = {"name": member.name, "shape": member.shape, "rA": list(member.rA), "rB": list(member.rB)}
    sizes = member.sizes()
    shown = sizes[:, 0] if member.circular else sizes
    if np.ptp(sizes, axis=0).max() == 0.0:
        entry["d"] = shown[0].tolist()
    else:
        entry |= {"stations": list(member.stations), "d": shown.tolist()}
    if headings != [0.0]:
        entry["heading"] = headings if len(headings) > 1 else headings[0]
    if gamma := twist(member):
        entry["gamma"] = gamma
    if member.circular and not computed:
        entry["maccamy_fuchs"] = member.MCF
    if member.type == "beam":
        approximated("type", "a flexible member (beam) is rigid here")
    if computed:
        approximated("potMod", "RAFT takes potential flow for it; here it has its strip coefficients Ca and CaEnd")
    for key in ("Ca_q", "Cd_q"):
        if np.any(np.array(getattr(member, key)) != 0.0):
            approximated(key, "strips have no coefficient along the member", Treatment.LEFT_OUT)
    coefficients = _transverse(member, column, approximated) | {"Ca_z": 0.0, "Cd_z": 0.0} if column else {}
    if column:
        coefficients |= _axial(member, approximated)
    else:
        coefficients = _transverse(member, column, approximated)
        if np.any(np.array(member.CaEnd) != 0.0) or np.any(np.array(member.CdEnd) != 0.0):
            approximated(
                "CaEnd", "ends of members flatter than 45 deg have wave pressure only, no CaEnd and CdEnd", Treatment.LEFT_OUT
            )
    order = ("Ca_t", "Ca_z", "Cd_t", "Cd_z")
    return HullMember(entry, column, {key: round(coefficients[key], 12) for key in order}, tuple(items))


def _transverse(member: RaftMember, column: bool, approximated: Any) -> dict[str, float]:
    coefficients: dict[str, float] = {}
    for key, power in (("Ca", 2), ("Cd", 1)):
        value = getattr(member, key)
        if np.ndim(value) == 1 and len(value) > 2:
            approximated(
                key, f"RAFT's code takes the first two of {len(value)} numbers as two directions at every station; so here"
            )
        means = []
        along = member.directions(key)
        if key == "Cd" and _refers_to_other_side(member):
            ratio = member.sizes()[:, 0] / member.sizes()[:, 1]
            along = along * np.stack([ratio, 1 / ratio])
            approximated(
                key,
                "RAFT refers drag to the side along the flow, the platform file to the side across it: it is converted",
                Treatment.TAKEN,
            )
        for values in along:
            mean, spread = _mean_over_wet_length(member, values, power)
            if spread:
                approximated(key, f"one value for the whole member, the mean over its wet length: {mean:.4g}")
            means.append(mean)
        first, second = means
        if not column:
            coefficients |= {f"{key}_t": second, f"{key}_z": first}
            continue
        if abs(first - second) > EQUAL * max(first, second):
            approximated(key, f"a column has one {key}_t for both directions: the mean of {first:.4g} and {second:.4g}")
        coefficients[f"{key}_t"] = 0.5 * (first + second)
    return coefficients


def _refers_to_other_side(member: RaftMember) -> bool:
    """Whether RAFT's drag refers to the other side than the platform file's drag does.

    It does so for an upright box with unequal sides.
    """
    upright = abs(member.rB[2] - member.rA[2]) > (1 - 1e-9) * member.length
    return upright and not member.circular and bool(np.ptp(member.sizes(), axis=1).any())


def _mean_over_wet_length(member: RaftMember, values: np.ndarray, power: int) -> tuple[float, bool]:
    """Mean of a coefficient over the wet length, weighted by a power of the size; and whether it varies."""
    if np.ptp(values) <= EQUAL * np.abs(values).max():
        return float(values[0]), False
    distances = member.along(member.stations)
    fraction = np.linspace(0.0, member.length, 2001)
    middle = 0.5 * (fraction[1:] + fraction[:-1])
    z = member.rA[2] + (member.rB[2] - member.rA[2]) * middle / member.length
    size = np.interp(middle, distances, np.sqrt(member.sizes().prod(axis=1))) ** power
    weight = np.where(z < 0.0, size, 0.0)
    weight = weight if weight.any() else size
    return float((np.interp(middle, distances, values) * weight).sum() / weight.sum()), True


def _axial(member: RaftMember, approximated: Any) -> dict[str, float]:
    """Ca_z and Cd_z of a column.

    They are RAFT's added mass and drag of the column's wet ends and rings, over the platform file's references.
    """
    rows = list(_faces(member))
    wet = [row for row in rows if row[0] < 0.0] or rows
    coefficients = {}
    for name, key, theirs, ours in (("Ca_z", "CaEnd", 1, 2), ("Cd_z", "CdEnd", 3, 3)):
        values = np.array([np.interp(row[4], *_increasing(member, key)) for row in wet])
        reference = sum(row[ours] for row in wet)
        if np.ptp(values) > EQUAL * max(values.max(), 1e-300):
            approximated(key, "one value for all ends and rings of the column, their mean")
        coefficients[name] = float(sum(value * row[theirs] for value, row in zip(values, wet)) / reference)
    if not member.circular and coefficients["Ca_z"]:
        approximated(
            "CaEnd",
            f"Ca_z {coefficients['Ca_z']:.4g}: RAFT refers it to a sphere on the mean side, here on the circle of equal area",
        )
    return coefficients


def end_volume_ratio(member: RaftMember) -> float:
    """RAFT's reference volume of a column's wet ends and rings over the platform file's."""
    rows = list(_faces(member))
    wet = [row for row in rows if row[0] < 0.0] or rows
    return sum(row[1] for row in wet) / sum(row[2] for row in wet)


def _increasing(member: RaftMember, key: str) -> tuple[np.ndarray, np.ndarray]:
    return member.along(member.stations), member.per_station(key)


def _faces(member: RaftMember) -> Iterator[tuple[float, float, float, float, float]]:
    """Ends and rings of a member.

    Yields:
        z (m), RAFT's and the platform file's reference volume (m³), area (m²), and distance from rA (m).
    """
    distances, sizes = member.along(member.stations), member.sizes()
    theirs = math.pi / 12 * sizes.mean(axis=1) ** 3
    area = sizes.prod(axis=1) * (math.pi / 4 if member.circular else 1.0)
    ours = 2 / 3 * math.pi * (area / math.pi) ** 1.5
    slope = (member.rB[2] - member.rA[2]) / member.length
    for i in (0, len(distances) - 1):
        yield member.rA[2] + slope * distances[i], theirs[i], ours[i], area[i], distances[i]
    for i, j in pairwise(range(len(distances))):
        if ours[i] != ours[j]:
            middle = 0.5 * (distances[i] + distances[j])
            yield (
                member.rA[2] + slope * middle,
                abs(theirs[j] - theirs[i]),
                abs(ours[j] - ours[i]),
                abs(area[j] - area[i]),
                middle,
            )
