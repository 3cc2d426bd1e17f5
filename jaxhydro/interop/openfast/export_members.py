"""HydroDyn's tables of joints, sections, members and their coefficients.

Numbers that are not copied are converted as docs/conventions.md says: added mass of rectangles, axial coefficients.

References:
    OpenFAST v5.0.0 (2895884), Morison.f90: SetMemberProperties_Cyl (limits of the keyword MCF and of MHstLMod 1),
    SetMemberProperties_Rec (0.25 pi side^2 of CaA and CaB), DragConst_End (the factor 1/4, so that AxCd = 2 Cd_z), AM_End.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from jaxhydro.hull.member import COLUMN_SPACING, PONTOON_SPACING
from jaxhydro.interop.conversion import Treatment
from jaxhydro.interop.export_source import ExportSource
from jaxhydro.interop.openfast.export_pieces import Piece, PieceJoint, all_at_surface, joints_of, pieces_of
from jaxhydro.interop.openfast.export_text import row
from jaxhydro.interop.openfast.member_notes import MemberNotes
from jaxhydro.interop.openfast.strip_members import BOX_SIDES

BY_MEMBER = 3  # MCoefMod
WALL = 0.01  # PropThck over the size: HydroDyn uses it for ballast alone, and there is none
MCF_TOLERANCE = 0.09  # of the diameter; HydroDyn stops at 0.1
MCF_LEAN = math.cos(math.radians(9.9))  # HydroDyn stops at 10 deg


@dataclass
class MemberTables:
    """Rows of HydroDyn's tables.

    Attributes:
        rows: Rows by the name that the template has for the table.
        diameter: Of the members with the keyword MCF (MCFD), m; 0 without any.
        notes: What became of members.
    """

    rows: dict[str, list[str]] = field(default_factory=dict)
    diameter: float = 0.0
    notes: MemberNotes = field(default_factory=lambda: MemberNotes("members"))


def member_tables(source: ExportSource, buoyant: bool, potential: bool) -> MemberTables:
    """Rows of joints, sections, coefficients and members.

    Args:
        source: The platform.
        buoyant: Whether HydroDyn computes the buoyancy of members; else its tables do.
        potential: Whether potential flow stands for the members (PropPot), so that drag alone is left to them.
    """
    afloat = all_at_surface(source.members)
    tables, pieces = MemberTables(), pieces_of(source.members, float(source.model.environment.depth))
    joints, joint_at = joints_of(pieces)
    axial = [_axial(source, joint, tables.notes) for joint in joints]
    kinds = list(dict.fromkeys(axial))
    tables.rows["axial"] = [row(i, *values) for i, values in enumerate(kinds, 1)]
    tables.rows["joints"] = [
        row(joint.number, *joint.position, kinds.index(values) + 1, 0) for joint, values in zip(joints, axial, strict=True)
    ]
    tables.diameter, diffracting = (0.0, set[int]()) if potential else _diffracting(source, pieces, tables.notes)
    circles, boxes = _sections(pieces, True), _sections(pieces, False)
    tables.rows["circles"] = [row(i, size[0], WALL * size[0]) for size, i in circles.items()]
    tables.rows["boxes"] = [row(i, *size, WALL * min(size)) for size, i in boxes.items()]
    of_circles, of_boxes, rows = list[str](), list[str](), list[str]()
    for piece in pieces:
        circular = piece.member.circular
        coefficients = _coefficients(source, piece, piece.number in diffracting, afloat, tables.notes)
        (of_circles if circular else of_boxes).append(row(piece.number, *coefficients))
        sections = [(circles if circular else boxes)[_size(piece, end)] for end in (0, 1)]
        spacing = float(source.model.size) * (COLUMN_SPACING if piece.member.column else PONTOON_SPACING)
        ends = [joint_at[piece.number, end] for end in (0, 1)]
        hydrostatics = _hydrostatics(piece) if buoyant else 0
        shape = 1 if circular else 2
        tail = (shape, piece.spin, spacing, BY_MEMBER, hydrostatics, "TRUE" if potential else "FALSE")
        rows.append(row(piece.number, *ends, *sections, *tail))
        _tell(source, piece, tables.notes)
    tables.rows |= {"of_circles": of_circles, "of_boxes": of_boxes, "members": rows}
    return tables


def _size(piece: Piece, end: int) -> tuple[float, float]:
    return float(piece.sizes[end, 0]), float(piece.sizes[end, 1])


def _sections(pieces: Sequence[Piece], circular: bool) -> dict[tuple[float, float], int]:
    """Numbers of property sets by size."""
    sizes = dict.fromkeys(_size(p, end) for p in pieces if p.member.circular is circular for end in (0, 1))
    return {size: i for i, size in enumerate(sizes, 1)}


def _axial(source: ExportSource, joint: PieceJoint, notes: MemberNotes) -> tuple[Any, ...]:
    """AxCd, AxCa, AxCp, AxFDMod, AxVnCOff and AxFDLoFSc of a joint."""
    piece, _ = joint.largest()
    if not piece.member.column:
        return 0.0, 0.0, 1.0, 0, 0.0, 1.0
    law = source.drag_laws.get(source.label(piece.member, "Cd_z"), {})
    drag, mass = source.coefficient(piece.member, "Cd_z"), source.coefficient(piece.member, "Ca_z")
    return 2 * drag, mass, 1.0, *_axial_law(law, piece, notes)


def _axial_law(law: Mapping[str, Any], piece: Piece, notes: MemberNotes) -> tuple[int, float, float]:
    kind, suction = law.get("law", "constant"), float(law.get("suction") or 0.0)
    if suction not in (0.0, 1.0):
        text = f"A suction of {suction:g} is neither 0 nor 1, the values that AxFDMod has: the nearer was taken."
        notes.add(piece.number, "drag_z", Treatment.APPROXIMATED, text)
    mode = int(suction >= 0.5)
    if kind == "high_pass":
        notes.add(piece.number, "drag_z", Treatment.TAKEN, "`high_pass` as AxVnCOff (Hz) and AxFDLoFSc.")
        cutoff = float(law["cutoff"])
        return mode, cutoff, float(law["low_share"]) if cutoff else 1.0
    if kind == "suction_side":
        notes.add(piece.number, "drag_z", Treatment.TAKEN, "`suction_side` as AxFDMod = 1.")
    elif kind != "constant":
        notes.add(piece.number, "drag_z", Treatment.LEFT_OUT, f"HydroDyn has no law {kind}; Cd_z is constant in the deck.")
    return mode, 0.0, 1.0


def _coefficients(source: ExportSource, piece: Piece, diffracting: bool, afloat: bool, notes: MemberNotes) -> list[Any]:
    """Coefficients of a member at both ends, the same with marine growth, of which there is none.

    Those of added mass are 0 where all members are `afloat`: their added mass is in the table of radiation.
    """
    member = piece.member
    drag, mass = (
        [source.coefficient(member, f"{symbol}_{kind}") for kind in ("tt" if member.column else "tz")]
        for symbol in ("Cd", "Ca")
    )
    mass = [0.0, 0.0] if afloat else mass
    if member.circular:
        for name, pair in (("Cd_t, Cd_z", drag), ("Ca_t, Ca_z", mass)):
            if pair[0] != pair[1]:
                text = "HydroDyn has one coefficient across a circle: the mean of both directions was taken."
                notes.add(piece.number, name, Treatment.APPROXIMATED, text)
        across = [[sum(drag) / 2] * 2, [sum(mass) / 2] * 2]
    else:
        ratio = piece.sizes[:, 1] / piece.sizes[:, 0]
        factor = 4 / math.pi
        across = [[drag[1]] * 2, [drag[0]] * 2, list(mass[1] * factor * ratio), list(mass[0] * factor / ratio)]
        if np.ptp(ratio) > 1e-9 * ratio.max():
            text = "The sides taper differently: CaA and CaB are right at both ends and vary linearly between."
            notes.add(piece.number, "Ca_t, Ca_z", Treatment.APPROXIMATED, text)
    axial = [source.coefficient(member, name) if member.column and piece.tapers else 0.0 for name in ("Cd_z", "Ca_z")]
    pressure = ["MCF"] * 2 if diffracting else [1.0] * 2
    axial_mass = axial[1] if member.circular else axial[1] / BOX_SIDES
    ends = [*across, pressure, [2 * axial[0]] * 2, [axial_mass] * 2, [1.0] * 2, [1.0] * 2]
    return [value for pair in ends for value in (*pair, *pair)]


def _diffracting(source: ExportSource, pieces: Sequence[Piece], notes: MemberNotes) -> tuple[float, set[int]]:
    """Diameter (m) and members with the keyword MCF: HydroDyn has one diameter for all of them."""
    if source.model.conventions.diffraction == "none":
        return 0.0, set()
    wanted = [piece for piece in pieces if piece.member.diffracts]
    able = [piece for piece in wanted if _can_diffract(piece)]
    volumes = [
        sum(piece.area(0) * -piece.ends[0, 2] for piece in able if _fits(piece, float(reference.sizes[0, 0])))
        for reference in able
    ]
    diameter = float(able[int(np.argmax(volumes))].sizes[0, 0]) if able else 0.0
    chosen = {piece.number for piece in able if _fits(piece, diameter)}
    for piece in wanted:
        if piece.number in chosen:
            text = f"MCF, with MCFD = {diameter:g} m. OpenFAST drops the phase lag and second-order accelerations."
            notes.add(piece.number, "diffraction", Treatment.APPROXIMATED, text)
        else:
            text = (
                "HydroDyn has MCF only for upright circles through still water, at least as deep as their radius, and for one "
                "diameter within 10 %. These members have Morison's 1 + Ca in place of diffraction."
            )
            notes.add(piece.number, "diffraction", Treatment.LEFT_OUT, text)
    return diameter, chosen


def _can_diffract(piece: Piece) -> bool:
    low, high = piece.ends[:, 2]
    upright = piece.member.circular and piece.axis[2] > MCF_LEAN
    return bool(upright and low < 0.0 <= high and -low >= 0.5 * piece.sizes[0, 0] and _fits(piece, float(piece.sizes[0, 0])))


def _fits(piece: Piece, diameter: float) -> bool:
    return bool(np.abs(piece.sizes - diameter).max() <= MCF_TOLERANCE * diameter)


def _hydrostatics(piece: Piece) -> int:
    """MHstLMod: 1 for circles whose ends are clear of still water, 2 for others."""
    lean = math.hypot(piece.axis[0], piece.axis[1])
    clear = all(abs(piece.ends[end, 2]) > piece.radius(end) * lean for end in (0, 1))
    return 1 if piece.member.circular and clear else 2


def _tell(source: ExportSource, piece: Piece, notes: MemberNotes) -> None:
    member = piece.member
    for name in ("Cd_t",) if member.column else ("Cd_t", "Cd_z"):
        law = source.drag_laws.get(source.label(member, name), {}).get("law", "constant")
        if law != "constant":
            key = f"drag_{name[-1]}"
            notes.add(piece.number, key, Treatment.LEFT_OUT, f"HydroDyn has no law {law} here; {name} is constant in the deck.")
    if piece.tapers and member.column:
        factor = "" if member.circular else " 2 / sqrt(pi)"
        text = f"Along a taper AxCd = 2 Cd_z, AxCa = Ca_z{factor} and AxCp = 1."
        notes.add(piece.number, "Ca_z, Cd_z", Treatment.TAKEN, text)
    if member.floats and (piece.ends[:, 2] > 0.0).all():
        text = (
            "Its axis is above still water, and HydroDyn loads nodes under water alone. In OpenFAST it has no drag and no wave "
            f"force{'' if all_at_surface(source.members) else ', and no added mass'}. Wave forces need a table of excitation."
        )
        notes.add(piece.number, "coefficients", Treatment.LEFT_OUT, text)
    elif member.pierced:
        text = (
            "Still water cuts it lengthwise: HydroDyn loads the whole section of nodes under water, and of others none. Wave "
            "forces need a table of excitation."
        )
        notes.add(piece.number, "coefficients", Treatment.APPROXIMATED, text)
