"""HydroDyn's coefficients of members: simple, by depth and by member.

References:
    OpenFAST v5.0.0 (2895884), HydroDyn_Input.f90 (columns and the keyword MCF), Morison.f90: SetDepthBasedCoefs_Cyl.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from jaxhydro.interop.openfast.hull_tables import HydroDynMember
from jaxhydro.interop.openfast.keyed_file import KeyedFile
from jaxhydro.interop.openfast.table_row import TableRow

SIMPLE, BY_DEPTH, BY_MEMBER = 1, 2, 3  # MCoefMod
MACCAMY_FUCHS = "mcf"
_CIRCLE = ["Cd", "Ca", "Cp", "AxCd", "AxCa", "AxCp", "Cb"]
_RECTANGLE = ["CdA", "CdB", "CaA", "CaB", "Cp", "AxCd", "AxCa", "AxCp", "Cb"]


def _versions(names: list[str]) -> list[list[str]]:
    """Coefficients of this version, of that without Cb, and of that without AxCd."""
    return [names, names[:-1], [name for name in names[:-1] if name != "AxCd"]]


def _grown(names: list[str], first: list[str], ends: Sequence[str] = ("",)) -> dict[int, list[str]]:
    columns = ([*first, *(f"{n}{g}{end}" for n in version for g in ("", "MG") for end in ends)] for version in _versions(names))
    return {len(layout): layout for layout in columns}


@dataclass(frozen=True)
class MemberCoefficients:
    """Coefficients of one member in HydroDyn's own definitions.

    Attributes:
        drag: Across the member along its local x and y, (2,).
        mass: Added mass alike, (2,).
        pressure: Cp, 1 for the keyword MCF.
        buoyancy: Cb.
        axial: AxCd and AxCa along the member, which act on tapers, (2,).
        axial_pressure: AxCp along the member.
        varying: Whether they vary along it, and were averaged.
        diffracting: Whether Cp is the keyword MCF.
    """

    drag: Float[np.ndarray, "2"]
    mass: Float[np.ndarray, "2"]
    pressure: float
    buoyancy: float
    axial: Float[np.ndarray, "2"]
    axial_pressure: float
    varying: bool
    diffracting: bool


class CoefficientTables:
    """All tables of coefficients of HydroDyn's file."""

    def __init__(self, file: KeyedFile, level: float) -> None:
        """Read the tables.

        Args:
            file: HydroDyn's file.
            level: Still water above mean sea level, m.

        Raises:
            InputError: A table is broken.
        """
        self.file, self.level = file, level
        both = (("circ", _CIRCLE, "Cyl", "SimplCd"), ("rect", _RECTANGLE, "Rec", "SimplCdA"))
        self.simple = {shape: file.table_under(header, _grown(names, [])) for shape, names, _, header in both}
        self.depths, self.members = {}, {}
        for shape, names, word, _ in both:
            older = shape == "circ"
            depth = (f"NCoefDpth{word}", "NCoefDpth") if older else f"NCoefDpth{word}"
            by_member = (f"NCoefMembers{word}", "NCoefMembers") if older else f"NCoefMembers{word}"
            self.depths[shape] = file.table(depth, _grown(names, ["Dpth"]))
            rows = file.table(by_member, _grown(names, ["MemberID"], ("1", "2")))
            self.members[shape] = {row.whole("MemberID"): row for row in rows}

    def of(self, member: HydroDynMember) -> MemberCoefficients:
        """Coefficients of a member, averaged over what is under still water.

        Raises:
            InputError: Its table is not there or has not its row.
        """
        if member.model == SIMPLE:
            if (row := self.simple[member.shape]) is None:
                raise member.row.wrong("simple coefficients in the file", "none")
            return _combined(member.shape, [row, row], ("", ""), np.array([0.5, 0.5]))
        if member.model == BY_DEPTH:
            if not (rows := self.depths[member.shape]):
                raise member.row.wrong("coefficients by depth in the file", "none")
            return _combined(member.shape, rows, [""] * len(rows), self._shares(member, rows))
        if member.model == BY_MEMBER:
            if (row := self.members[member.shape].get(member.number)) is None:
                raise member.row.wrong(f"a row of MemberID {member.number} in the coefficients by member", "none")
            ends = ("2", "1") if member.flipped else ("1", "2")
            return _combined(member.shape, [row, row], ends, _wet_shares(member))
        raise member.row.wrong("MCoefMod 1, 2 or 3", f"{member.model}")

    def _shares(self, member: HydroDynMember, rows: list[TableRow]) -> Float[np.ndarray, " n"]:
        """Share of every row of depths in the average over the wet length of a member."""
        depths = np.array([row.number("Dpth") for row in rows]) - self.level
        order = np.argsort(depths)
        low, high = (joint.position[2] for joint in member.joints)
        heights = np.linspace(low, max(low, min(high, 0.0)) if low < 0 else high, 201)
        weights = np.zeros(len(rows))
        for i in range(len(rows)):
            unit = np.zeros(len(rows))
            unit[i] = 1.0
            weights[i] = np.interp(heights, depths[order], unit[order]).mean()
        return weights


def _wet_shares(member: HydroDynMember) -> Float[np.ndarray, "2"]:
    """Share of both ends' values in the average over the wet length."""
    low, high = (joint.position[2] for joint in member.joints)
    wet = 1.0 if high <= 0.0 or low >= 0.0 else -low / (high - low)
    return np.array([1 - 0.5 * wet, 0.5 * wet])


def _combined(shape: str, rows: Sequence[TableRow], ends: Sequence[str], shares: Float[np.ndarray, " n"]) -> MemberCoefficients:
    varying = False

    def mean(name: str, absent: float | None = None) -> float:
        nonlocal varying
        values = np.array([row.number(f"{name}{end}", absent) for row, end in zip(rows, ends)])
        used = values[shares > 1e-12]
        varying = varying or bool(np.ptp(used) > 1e-12 * max(1.0, float(np.abs(used).max())))
        return float(used[0]) if np.ptp(used) == 0.0 else float(shares @ values)

    pairs = (("CdB", "CdA"), ("CaB", "CaA")) if shape == "rect" else (("Cd", "Cd"), ("Ca", "Ca"))
    drag, mass = (np.array([mean(name) for name in pair]) for pair in pairs)
    diffracting = any(row.cells[f"Cp{end}"].lower() == MACCAMY_FUCHS for row, end in zip(rows, ends))
    pressure = 1.0 if diffracting else mean("Cp")
    buoyancy, axial, axial_pressure = mean("Cb", 1.0), np.array([mean("AxCd", 0.0), mean("AxCa")]), mean("AxCp")
    return MemberCoefficients(drag, mass, pressure, buoyancy, axial, axial_pressure, varying, diffracting)
