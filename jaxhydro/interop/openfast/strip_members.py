"""Members and coefficients of the platform file from HydroDyn's members.

Every number that is not copied is converted as docs/conventions.md says: added mass of rectangles, axial coefficients.

References:
    OpenFAST v5.0.0 (2895884), Morison.f90: SetMemberProperties_Cyl, SetMemberProperties_Rec, GetDistDrag_Rec,
    Morison_DirCosMtrx_Spin (Side A lies along the local x: horizontal, and along x for an upright member).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.openfast.coefficient_tables import CoefficientTables, MemberCoefficients
from jaxhydro.interop.openfast.end_coefficients import EndCoefficients, is_column, wet_end_coefficients
from jaxhydro.interop.openfast.hull_tables import HydroDynMember
from jaxhydro.interop.openfast.mass_parts import tidy
from jaxhydro.interop.openfast.member_notes import MemberNotes

_SAME = 1e-6  # relative difference of coefficients that counts as none


@dataclass
class ConvertedHull:
    """Members of the platform file.

    Attributes:
        members: Entries of `members`.
        coefficients: Entries of `coefficients`.
        items: What became of HydroDyn's members.
        diffracting: Whether a member diffracts as MacCamy and Fuchs have it.
    """

    members: list[dict[str, Any]] = field(default_factory=list)
    coefficients: dict[str, dict[str, Any]] = field(default_factory=dict)
    items: list[ConvertedItem] = field(default_factory=list)
    diffracting: bool = False

    def group(self, kind: str, values: dict[str, Any]) -> str:
        """Name of the group with these coefficients; a new one where there is none."""
        names = [name for name in self.coefficients if name.rstrip("0123456789") == kind]
        for name in names:
            if self.coefficients[name] == values:
                return name
        name = kind if not names else f"{kind}{len(names) + 1}"
        self.coefficients[name] = values
        return name


def convert_members(members: Sequence[HydroDynMember], tables: CoefficientTables, potential_flow: bool) -> ConvertedHull:
    """Members and coefficients of the platform file.

    Args:
        members: HydroDyn's members.
        tables: Its coefficients.
        potential_flow: Whether potential flow is on (PotMod = 1).

    Raises:
        InputError: A member's coefficients are not there, or negative.
    """
    source = tables.file.name
    notes, joints, hull = MemberNotes(source), MemberNotes(source), ConvertedHull()
    ends = wet_end_coefficients(members, joints)
    coefficients = {member.number: tables.of(member) for member in members}
    hull.diffracting = any(entry.diffracting for entry in coefficients.values())
    for member in members:
        if member.potential and not potential_flow:
            raise member.row.wrong("PropPot FALSE, as PotMod is not 1", "TRUE")
        _tell(member, coefficients[member.number], notes)
        _place(member, coefficients[member.number], ends, hull, notes)
    if members:
        text = f"{len(members)} members, and their joints and property sets, as `members` and `coefficients`."
        hull.items.append(ConvertedItem(f"{source}: NMembers", Treatment.TAKEN, text))
        text = "The length of strips is chosen anew (`elements` of a member sets it)."
        hull.items.append(ConvertedItem(f"{source}: MDivSize", Treatment.LEFT_OUT, text))
    hull.items += [*notes.items(), *joints.items("joints")]
    return hull


def _tell(member: HydroDynMember, coefficients: MemberCoefficients, notes: MemberNotes) -> None:
    """Note where the platform file's member is not as in HydroDyn."""

    def say(keys: str, treatment: Treatment, meaning: str) -> None:
        notes.add(member.number, keys, treatment, meaning)

    if coefficients.varying:
        text = "Coefficients vary along the member; the mean over what is under still water was taken."
        say("Cd, Ca", Treatment.APPROXIMATED, text)
    if coefficients.pressure != 1.0 and not member.potential:
        say("Cp", Treatment.APPROXIMATED, f"The waves' pressure acts with Cp = 1, not {coefficients.pressure:g}.")
    if coefficients.buoyancy != 1.0 and not member.potential:
        say("Cb", Treatment.LEFT_OUT, f"Buoyancy is that of the section, not {coefficients.buoyancy:g} times it.")
    if coefficients.axial and np.ptp(member.sizes, axis=0).any():
        text = "The sides of a tapered member take the axial coefficients of its end, not AxCd and AxCa along it."
        say("AxCd, AxCa of members", Treatment.APPROXIMATED, text)
    if coefficients.diffracting:
        text = "`maccamy_fuchs: true`. OpenFAST drops the phase lag and second-order accelerations; here both are kept."
        say("MCF", Treatment.APPROXIMATED, text)
    if member.row.whole("MHstLMod", 1) == 0 and not member.potential:
        text = "HydroDyn computes no buoyancy of it; here it has its own. Declare `hydrostatics` to change that."
        say("MHstLMod", Treatment.APPROXIMATED, text)
    if member.potential:
        text = "Potential flow stands for it: `Ca_t` and `Ca_z` are 0, drag is kept."
        say("PropPot", Treatment.TAKEN, text)
    if member.shape == "rect" and (mode := member.row.whole("FDMod", 0)):
        text = "Drag by the flow at four faces, and its filter, has no counterpart; the vector of the flow decides here."
        say(f"FDMod {mode}", Treatment.APPROXIMATED, text)
    if (coefficients.drag < 0).any() or (coefficients.mass < 0).any():
        raise member.row.wrong("coefficients >= 0", f"{min(coefficients.drag.min(), coefficients.mass.min()):g}")


def _across(member: HydroDynMember, coefficients: MemberCoefficients, notes: MemberNotes) -> dict[str, float]:
    """Ca and Cd across a member, on displaced volume and on its sides."""
    drag, mass = coefficients.drag.copy(), np.zeros(2) if member.potential else coefficients.mass.copy()
    if member.shape == "rect":
        ratios = member.sizes[:, 1] / member.sizes[:, 0]
        if np.ptp(ratios) > _SAME * ratios.max():
            text = "The sides taper differently; added mass is right for their mean ratio."
            notes.add(member.number, "CaA, CaB", Treatment.APPROXIMATED, text)
        ratio = float(member.sizes[:, 1].mean() / member.sizes[:, 0].mean())
        mass = mass * math.pi / 4 * np.array([ratio, 1 / ratio])
    if is_column(member):
        for keys, pair in (("CdA, CdB", drag), ("CaA, CaB", mass)):
            if np.ptp(pair) > _SAME * pair.max():
                text = "A steep member has one coefficient for both directions: the mean of both was taken."
                notes.add(member.number, keys, Treatment.APPROXIMATED, text)
        return {"Ca_t": tidy(float(mass.mean())), "Cd_t": tidy(float(drag.mean()))}
    return {"Ca_t": tidy(float(mass[0])), "Ca_z": tidy(float(mass[1])), "Cd_t": tidy(drag[0]), "Cd_z": tidy(drag[1])}


def _place(
    member: HydroDynMember,
    coefficients: MemberCoefficients,
    ends: dict[tuple[int, int], EndCoefficients],
    hull: ConvertedHull,
    notes: MemberNotes,
) -> None:
    """Add a member, in two halves where its ends have different coefficients."""
    across = _across(member, coefficients, notes)
    if not is_column(member):
        _add(hull, member, coefficients, f"member{member.number}", hull.group("pontoon", across), (0.0, 1.0))
        return
    mine = [ends.get((member.number, end)) for end in (0, 1)]
    stated = [axial for axial in mine if axial is not None]
    if len(stated) == 2 and stated[0] != stated[1]:
        text = "Its ends have different axial coefficients: it is cut into halves at its middle."
        notes.add(member.number, "JointAxID", Treatment.TAKEN, text)
        for name, axial, span in (("lower", stated[0], (0.0, 0.5)), ("upper", stated[1], (0.5, 1.0))):
            group = hull.group("column", _with_ends(across, axial))
            _add(hull, member, coefficients, f"member{member.number}_{name}", group, span)
        return
    group = hull.group("column", _with_ends(across, stated[0] if stated else EndCoefficients(0.0, 0.0, None)))
    _add(hull, member, coefficients, f"member{member.number}", group, (0.0, 1.0))


def _with_ends(across: dict[str, float], end: EndCoefficients) -> dict[str, Any]:
    law = {} if end.law is None else {"drag_z": end.law}
    entries = {"Ca_t": across["Ca_t"], "Ca_z": tidy(end.mass), "Cd_t": across["Cd_t"], "Cd_z": tidy(end.drag)}
    return entries | law


def _add(
    hull: ConvertedHull,
    member: HydroDynMember,
    coefficients: MemberCoefficients,
    name: str,
    group: str,
    span: tuple[float, float],
) -> None:
    low, high = (joint.position for joint in member.joints)
    points = [low + fraction * (high - low) for fraction in span]
    sizes = [member.sizes[0] + fraction * (member.sizes[1] - member.sizes[0]) for fraction in span]
    listed = [[tidy(size[0])] if member.shape == "circ" else [tidy(value) for value in size] for size in sizes]
    plain = [size[0] if member.shape == "circ" else size for size in listed]
    entry: dict[str, Any] = {"name": name, "group": group, "shape": member.shape}
    entry |= {"d": plain[0]} if plain[0] == plain[1] else {"stations": [0.0, 1.0], "d": plain}
    entry |= {"rA": [tidy(value) for value in points[0]], "rB": [tidy(value) for value in points[1]]}
    if member.spin:
        entry["gamma"] = tidy(member.spin)
    if hull.diffracting:
        entry["maccamy_fuchs"] = coefficients.diffracting and member.shape == "circ" and not member.potential
    hull.members.append(entry)
