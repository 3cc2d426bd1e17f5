"""Members and coefficients of the platform file from HydroDyn's members.

Every number that is not copied is converted as docs/conventions.md says: added mass of rectangles, axial coefficients.

References:
    OpenFAST v5.0.0 (2895884), Morison.f90: SetMemberProperties_Cyl, SetMemberProperties_Rec, GetDistDrag_Rec,
    Morison_DirCosMtrx_Spin (Side A lies along the local x: horizontal, and along x for an upright member).
"""

import math
from collections.abc import Callable, Sequence
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
BOX_SIDES = math.sqrt(math.pi) / 2  # Ca_z over AxCa on the sides of a tapered rectangle
SLICE, SLICE_OF_SIZE, MAX_SLICE = 0.01, 0.02, 0.25  # of a length, of a size over the length, and at most: see `_spans`


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


def tapers(member: HydroDynMember) -> bool:
    """Whether a member's section changes along it."""
    return bool(np.ptp(member.sizes, axis=0).any())


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
    if tapers(member):
        _tell_taper(member, coefficients, say)
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
    if (least := float(np.min([coefficients.drag, coefficients.mass, coefficients.axial]))) < 0:
        raise member.row.wrong("coefficients >= 0", f"{least:g}")


def _tell_taper(member: HydroDynMember, coefficients: MemberCoefficients, say: Callable[[str, Treatment, str], None]) -> None:
    """Note what becomes of the axial coefficients along a taper."""
    if coefficients.axial.any() and is_column(member):
        mass = "Ca_z = 0, as potential flow stands for it" if member.potential else "Ca_z = AxCa"
        mass += "" if member.shape == "circ" or member.potential else " sqrt(pi) / 2"
        say("AxCd, AxCa of members", Treatment.TAKEN, f"On the sides of a tapered member Cd_z = AxCd / 2 and {mass}.")
    elif coefficients.axial.any():
        text = "The sides of a tapered member flatter than 45 deg have wave pressure only, along the member."
        say("AxCd, AxCa of members", Treatment.LEFT_OUT, text)
    if coefficients.axial_pressure != 1.0 and not member.potential:
        text = f"The waves' pressure acts on the sides of a tapered member with AxCp = 1, not {coefficients.axial_pressure:g}."
        say("AxCp of members", Treatment.APPROXIMATED, text)


def _along_taper(member: HydroDynMember, coefficients: MemberCoefficients) -> EndCoefficients:
    """Axial coefficients of the sides of a tapered member in this program's definitions.

    HydroDyn has 1/2 AxCd rho pi r |dr| for the drag and 2 AxCa rho pi r² |dr| for the added mass of a circle. Here they are
    1/2 Cd_z rho |dA| and Ca_z rho r |dA|, with A = pi r². HydroDyn's added mass of a rectangle is 1/2 AxCa rho A^(1/2) |dA|.

    References:
        OpenFAST v5.0.0 (2895884), Morison.f90: Morison_CalcOutput (f_hydro, Am), GetDistDrag_Rec.
    """
    drag, mass = coefficients.axial
    mass *= 0.0 if member.potential else 1.0 if member.shape == "circ" else BOX_SIDES
    return EndCoefficients(0.5 * float(drag), float(mass), None)


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
    """Add a member, in parts where their axial coefficients differ."""
    across = _across(member, coefficients, notes)
    if not is_column(member):
        _add(hull, member, coefficients, f"member{member.number}", hull.group("pontoon", across), (0.0, 1.0))
        return
    mine = [ends.get((member.number, end)) for end in (0, 1)]
    for name, axial, span in _spans(member, coefficients, mine, notes):
        group = hull.group("column", _with_ends(across, axial))
        _add(hull, member, coefficients, f"member{member.number}{name}", group, span)


def _spans(
    member: HydroDynMember, coefficients: MemberCoefficients, ends: Sequence[EndCoefficients | None], notes: MemberNotes
) -> list[tuple[str, EndCoefficients, tuple[float, float]]]:
    """Parts of a steep member by axial coefficients: ending of the name, coefficients, fractions of the length."""
    stated = [axial for axial in ends if axial is not None]
    if not tapers(member):
        if len(stated) == 2 and stated[0] != stated[1]:
            text = "Its ends have different axial coefficients: it is cut into halves at its middle."
            notes.add(member.number, "JointAxID", Treatment.TAKEN, text)
            return [("_lower", stated[0], (0.0, 0.5)), ("_upper", stated[1], (0.5, 1.0))]
        return [("", stated[0] if stated else EndCoefficients(0.0, 0.0, None), (0.0, 1.0))]
    along = _along_taper(member, coefficients)
    lower, upper = (axial if axial is not None and not _alike(axial, along) else None for axial in ends)
    if lower is None and upper is None:
        return [("", along, (0.0, 1.0))]
    joints = [joint.position for joint in member.joints]
    slice_ = min(
        MAX_SLICE, max(SLICE, SLICE_OF_SIZE * float(member.sizes.max()) / float(np.linalg.norm(joints[1] - joints[0])))
    )
    text = f"Ends with other axial coefficients than the tapered sides have a slice of {100 * slice_:.2g} % of the length."
    notes.add(member.number, "JointAxID", Treatment.APPROXIMATED, text)
    low, high = 0.0 if lower is None else slice_, 1.0 if upper is None else 1.0 - slice_
    parts = [("_lower", lower, (0.0, low)), ("", along, (low, high)), ("_upper", upper, (high, 1.0))]
    return [(name, axial, span) for name, axial, span in parts if axial is not None]


def _alike(end: EndCoefficients, side: EndCoefficients) -> bool:
    """Whether coefficients of an end and of the sides are the same but for rounding."""
    return end.law == side.law and np.allclose([end.drag, end.mass], [side.drag, side.mass], rtol=_SAME, atol=0.0)


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
