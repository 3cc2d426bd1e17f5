"""Axial coefficients at the ends of HydroDyn's members.

HydroDyn adds the end areas of all members at a joint as vectors, and applies the joint's coefficients to the sum. Here every
steep member has coefficients of its own at its ends, and two that meet on one axis leave the ring between them (`hull.ends`).

References:
    OpenFAST v5.0.0 (2895884), Morison.f90: AM_End, DragConst_End, Morison_CalcOutput. The factor 1/4 of the drag, so that
    Cd_z = AxCd / 2, is in docs/conventions.md.
"""

import math
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from jaxhydro.hull.member import COLUMN_SLOPE
from jaxhydro.interop.conversion import Treatment
from jaxhydro.interop.openfast.hull_tables import HydroDynMember, Joint
from jaxhydro.interop.openfast.member_notes import MemberNotes
from jaxhydro.loads.drag.velocity_filters import MAX_CUTOFF, MAX_SLOW_SHARE

_ALIGNED = 1.0 - 1e-6


@dataclass(frozen=True)
class EndCoefficients:
    """Axial coefficients of a member's end in this program's definitions.

    Attributes:
        drag: Cd_z.
        mass: Ca_z.
        law: The drag law as in `drag_z`, or None for a constant coefficient.
    """

    drag: float
    mass: float
    law: dict[str, Any] | None


def is_column(member: HydroDynMember) -> bool:
    """Whether a member is steeper than 45 degrees."""
    axis = member.joints[1].position - member.joints[0].position
    return bool(abs(axis[2]) > COLUMN_SLOPE * np.linalg.norm(axis))


def end_area(member: HydroDynMember, end: int) -> float:
    """Area (m2) of a member's section at an end, 0 or 1."""
    return float(np.prod(member.sizes[end])) * (math.pi / 4 if member.shape == "circ" else 1.0)


def wet_end_coefficients(members: Iterable[HydroDynMember], joints: MemberNotes) -> dict[tuple[int, int], EndCoefficients]:
    """Axial coefficients of the ends that count.

    These are ends of steep members, under still water, that are not covered by another member.

    Args:
        members: All members.
        joints: Where to say what became of joints.

    Returns:
        Coefficients by MemberID and end, 0 below and 1 above.
    """
    by_joint: dict[int, list[tuple[HydroDynMember, int]]] = defaultdict(list)
    for member in members:
        for end in (0, 1):
            by_joint[member.joints[end].number].append((member, end))
    coefficients = {}
    for meeting in by_joint.values():
        joint = meeting[0][0].joints[meeting[0][1]]
        if joint.position[2] >= 0.0:
            _tell_dry(joint, joints)
            continue
        _tell_wet(joint, meeting, joints)
        for member, end in meeting:
            if is_column(member) and _uncovered(member, end, meeting):
                coefficients[member.number, end] = _converted(joint, member.potential, joints)
    return coefficients


def _uncovered(member: HydroDynMember, end: int, meeting: list[tuple[HydroDynMember, int]]) -> bool:
    """Whether part of an end is free: the larger of two that meet on one axis keeps the ring."""
    direction, area = _outward(member, end), end_area(member, end)
    for other, other_end in meeting:
        facing = other is not member and float(direction @ _outward(other, other_end)) < -_ALIGNED
        if facing and area <= end_area(other, other_end) * (1 + 1e-9):
            return False
    return True


def _outward(member: HydroDynMember, end: int) -> np.ndarray:
    along = member.joints[1].position - member.joints[0].position
    return (along if end else -along) / np.linalg.norm(along)


def _acts(joint: Joint) -> bool:
    return joint.axial.number("AxCd") != 0.0 or joint.axial.number("AxCa") != 0.0


def _tell_dry(joint: Joint, joints: MemberNotes) -> None:
    if _acts(joint):
        meaning = "Ends above still water have the axial coefficients of their member's lower end, should they get wet."
        joints.add(joint.number, "AxCd, AxCa", Treatment.APPROXIMATED, meaning)


def _tell_wet(joint: Joint, meeting: list[tuple[HydroDynMember, int]], joints: MemberNotes) -> None:
    if joint.axial.number("AxCp") != 1.0:
        meaning = "The waves' pressure acts on the whole area of ends here, as with AxCp = 1."
        joints.add(joint.number, "AxCp", Treatment.APPROXIMATED, meaning)
    if not _acts(joint):
        return
    directions = [_outward(member, end) for member, end in meeting]
    if any(abs(float(directions[0] @ other)) < _ALIGNED for other in directions[1:]):
        meaning = (
            "Members of different directions meet. HydroDyn adds their end areas as vectors; here every steep member has the "
            "coefficients on its own end."
        )
        joints.add(joint.number, "AxCd, AxCa", Treatment.APPROXIMATED, meaning)
    if not all(is_column(member) for member, _ in meeting):
        meaning = "Ends of members flatter than 45 deg have wave pressure only."
        joints.add(joint.number, "AxCd, AxCa", Treatment.LEFT_OUT, meaning)


def _converted(joint: Joint, potential: bool, joints: MemberNotes) -> EndCoefficients:
    axial = joint.axial
    drag, mass = 0.5 * axial.number("AxCd"), 0.0 if potential else axial.number("AxCa")
    for name, value in (("AxCd", drag), ("AxCa", mass)):
        if value < 0.0:
            raise axial.wrong(f"a number >= 0 for {name}", f"{value:g}")
    cutoff, share = axial.number("AxVnCOff", -1.0), axial.number("AxFDLoFSc", 1.0)
    suction = axial.whole("AxFDMod", 0) == 1
    if drag == 0.0:
        return EndCoefficients(drag, mass, None)
    if cutoff > 0.0 and share != 1.0:
        if cutoff > MAX_CUTOFF or not 0.0 <= share <= MAX_SLOW_SHARE:
            meaning = f"A filter of more than {MAX_CUTOFF:g} Hz, or a share beyond 0 to {MAX_SLOW_SHARE:g}, is not taken."
            joints.add(joint.number, "AxVnCOff, AxFDLoFSc", Treatment.LEFT_OUT, meaning)
        else:
            law = {"law": "high_pass", "cutoff": cutoff, "low_share": share}
            return EndCoefficients(drag, mass, law | ({"suction": 1.0} if suction else {}))
    return EndCoefficients(drag, mass, {"law": "suction_side"} if suction else None)
