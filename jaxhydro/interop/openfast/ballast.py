"""Ballast in HydroDyn's filled members as rigid parts.

HydroDyn adds the weight and the inertia of what fills its members to the mass in ElastoDyn. It takes the fill as fixed to the
member: from the lower end up to FillFSLoc, inside PropThck.

References:
    OpenFAST v5.0.0 (2895884), Morison.f90: FloodedBallastPartSegmentCyl, FloodedBallastPartSegmentRec, Morison_CalcOutput.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.openfast.added_terms import AddedTerms
from jaxhydro.interop.openfast.hull_tables import FillGroup, HydroDynMember
from jaxhydro.interop.openfast.mass_parts import point_mass, spread_inertia

MIN_RESIDUAL = 0.01  # of the ballast's restoring: what is left of AddCLin below it is rounding
_ORDER = 5  # Gauss points: exact for polynomials of the ninth degree


def ballast_parts(
    groups: Sequence[FillGroup], members: Sequence[HydroDynMember], source: str
) -> tuple[list[dict[str, Any]], list[ConvertedItem]]:
    """Entries of `rigid_body.parts` for the fill groups.

    Args:
        groups: The groups.
        members: HydroDyn's members.
        source: Name of HydroDyn's file.

    Raises:
        InputError: A wall is thicker than its member.
    """
    parts, items = [], []
    by_number = {member.number: member for member in members}
    for i, group in enumerate(groups, 1):
        masses, points, own_inertia = [], [], np.zeros((3, 3))
        for number in group.members:
            mass, position, inertia = _filled(by_number[number], group)
            masses.append(mass)
            points.append(position)
            own_inertia = own_inertia + inertia
        weights, positions = np.concatenate(masses), np.concatenate(points)
        total = float(weights.sum())
        numbers = ", ".join(map(str, group.members))
        where = f"{source}: NFillGroups, group {i} (members {numbers})"
        if total == 0.0:
            items.append(ConvertedItem(where, Treatment.LEFT_OUT, "It holds nothing."))
            continue
        centre = weights @ positions / total
        part = point_mass(f"ballast {i}", total, centre, own_inertia + spread_inertia(weights, positions - centre))
        assert part is not None
        parts.append(part)
        meaning = f"Part `ballast {i}`, {total:.6g} kg, rigid: HydroDyn adds it to ElastoDyn's mass."
        items.append(ConvertedItem(where, Treatment.TAKEN, meaning))
    return parts, items


def drop_restoring(ballast: Sequence[Mapping[str, Any]], terms: AddedTerms, gravity: float, source: str) -> None:
    """Take the restoring of ballast out of AddCLin in a deck of OpenFAST 2.5 or older.

    There the weight of ballast does not move with the platform, and AddCLin stands for its restoring in roll and pitch. A
    rigid part has it by itself. A deck whose AddCLin has none is left as it is.

    Args:
        ballast: Entries of `rigid_body.parts`.
        terms: HydroDyn's additional terms; the stiffness and the items are changed.
        gravity: m/s2.
        source: Name of HydroDyn's file.

    References:
        OpenFAST, issue 1022, comment of 2022-03-08.
    """
    restoring = -gravity * sum(part["mass"] * part["centre_of_mass"][2] for part in ballast)
    stated = np.diag(terms.stiffness)[3:5]
    if restoring <= 0.0 or not stated.all():
        return
    residual = stated - restoring
    residual[np.abs(residual) < MIN_RESIDUAL * restoring] = 0.0
    terms.stiffness[[3, 4], [3, 4]] = residual
    meaning = f"C44 and C55 are less by {restoring:.6g} N m/rad: in this version they hold the ballast's restoring."
    terms.items.append(ConvertedItem(f"{source}: AddCLin", Treatment.APPROXIMATED, meaning))


def _filled(member: HydroDynMember, group: FillGroup) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Masses (kg) and positions (m) of slices of a member's fill, and the sum of their inertia (kg m²).

    The inertia of each slice is that about its own centre.
    """
    low, high = (joint.position for joint in member.joints)
    along = high - low
    share = 1.0 if group.surface >= high[2] else max(0.0, (group.surface - low[2]) / max(along[2], 1e-12))
    inner = member.sizes - 2 * member.walls[:, None]
    if inner.min() < 0.0:
        raise member.row.wrong("PropThck of at most half the size", f"{member.walls.max():g} m")
    point, weight = np.polynomial.legendre.leggauss(_ORDER)
    fractions = 0.5 * share * (1 + point)
    size = inner[0] + fractions[:, None] * (inner[1] - inner[0])
    length = float(np.linalg.norm(along))
    area = size[:, 0] * size[:, 1] * (math.pi / 4 if member.shape == "circ" else 1.0)
    mass = group.density * area * 0.5 * share * weight * length
    x, y = _axes(along / length, math.radians(member.spin))
    factor = 1 / 16 if member.shape == "circ" else 1 / 12  # of a thin slice: m d^2 / 16, m a^2 / 12
    second = factor * np.einsum("n,ni->i", mass, size**2)  # integrals of x^2 and y^2
    spread = second[0] * np.outer(x, x) + second[1] * np.outer(y, y)
    return mass, low + fractions[:, None] * along, np.trace(spread) * np.eye(3) - spread


def _axes(axis: np.ndarray, spin: float) -> tuple[np.ndarray, np.ndarray]:
    """HydroDyn's local x and y of a member (Morison_DirCosMtrx_Spin)."""
    level = math.hypot(axis[0], axis[1])
    first = np.array([1.0, 0.0, 0.0]) if level < 1e-9 else np.array([axis[1], -axis[0], 0.0]) / level
    second = np.cross(axis, first)
    return math.cos(spin) * first + math.sin(spin) * second, math.cos(spin) * second - math.sin(spin) * first
