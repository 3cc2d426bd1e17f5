"""A RAFT design file as a platform file.

RAFT (WISDEM/RAFT, read at e6cb69e) describes a floating turbine in one YAML file: `site`, `turbine`, `platform` and `mooring`.
What its keys mean is in its source: raft_member.py (members), raft_rotor.py (rotor and nacelle), raft_fowt.py (the sum of all),
helpers.py (shapes and defaults). The mooring section is MoorPy's (1.3.0, system.py, parseYAML).
"""

from os import PathLike
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel

from jaxhydro.errors import InputError, Problem, shown, suggest
from jaxhydro.input_schema import read_yaml, validate
from jaxhydro.interop.conversion import Conversion, ConvertedItem, Treatment
from jaxhydro.interop.mooring_system import NoCatenaries, catenary_section
from jaxhydro.interop.raft_hull import HullMember, hull_member
from jaxhydro.interop.raft_masses import effect_part, member_parts, rotor_parts
from jaxhydro.interop.raft_member import RaftMember
from jaxhydro.interop.raft_mooring import MooringSection
from jaxhydro.interop.raft_schema import RaftDesign

TAKEN, APPROXIMATED, LEFT_OUT = Treatment.TAKEN, Treatment.APPROXIMATED, Treatment.LEFT_OUT
DRY_TOWER = "its mass is a part of the rigid body; it is above the water, so that it is no member of the hull"
AERODYNAMICS = ("blade", "airfoils", "aeroServoMod", "pitch_control", "torque_control", "wt_ops", "Fthrust", "I_drivetrain")
RUN_KEYS = ("settings", "cases", "array", "array_mooring", "joints")  # of the file, beside what is the platform
WITHOUT_MEANING = {"type", "comments", "name"}
MESH_KEYS = {"min_freq_BEM", "dz_BEM", "da_BEM", "dlsMax", "intersectMesh", "outFolderQTF"}
MESH_KEYS |= {"characteristic_length_min", "characteristic_length_max", "extensionA", "extensionB", "headings"}
MODULI = {"E", "G"}  # of flexible members, which are rigid here

M = TypeVar("M", bound=BaseModel)


def read_raft_design(path: str | PathLike[str]) -> Conversion:
    """Platform of a RAFT design file.

    Lengths are in m, masses in kg, forces in N, angles in degrees, in the design and in the platform file.

    Args:
        path: The design, a YAML file with `site`, `platform`, and `turbine` and `mooring` where it has them.

    Returns:
        The contents of `platform.yaml`, and what became of each item of the design. There are no files beside it.

    Raises:
        InputError: The file cannot be read, or has mistakes; all of them are listed.
    """
    source, data = str(path), read_yaml(path)
    if "platform" not in data and "platforms" in data:
        raise InputError(source, [Problem("platform", "one platform", "platforms, a farm", "Write one of them as a design.")])
    design = validate(RaftDesign, data, source)
    _names_once(source, design)
    return _Converter(Path(path).name, design, _mooring_of(source, design)).conversion(Path(path).stem)


def _names_once(source: str, design: RaftDesign) -> None:
    names = [member.name for member in design.platform.members]
    problems = [
        Problem(f"platform.members[{i}].name", "each name once", shown(name))
        for i, name in enumerate(names)
        if name in names[:i]
    ]
    if problems:
        raise InputError(source, problems)


def _mooring_of(source: str, design: RaftDesign) -> MooringSection | None:
    """The mooring section; None where there is none, or where it only names a file."""
    section = design.mooring
    if not section or section.get("file"):
        return None
    try:
        return validate(MooringSection, section, source)
    except InputError as error:
        problems = [
            Problem(f"mooring.{p.where}" if p.where else "mooring", p.expected, p.found, p.hint) for p in error.problems
        ]
        raise InputError(source, problems) from None


class _Converter:
    """Collects the platform file and the items of one design."""

    def __init__(self, file: str, design: RaftDesign, mooring: MooringSection | None) -> None:
        self.file, self.design, self.mooring = file, design, mooring
        self.items: list[ConvertedItem] = []
        self.hull: list[HullMember] = []
        self.parts: list[dict[str, Any]] = []

    def tell(self, key: str, treatment: Treatment, meaning: str, warning: bool = False) -> None:
        """Note what became of an item."""
        self.items.append(ConvertedItem(f"{self.file}: {key}", treatment, meaning, warning))

    def conversion(self, stem: str) -> Conversion:
        """The whole platform file."""
        design, site = self.design, self.design.site
        self.tell("site", TAKEN, "depth, density and gravity of the water; RAFT's gravity is 9.81 m/s2 unless the file says")
        self._members()
        self._turbine()
        self._effects()
        platform: dict[str, Any] = {
            "name": design.name or stem,
            "water": {"density": site.rho_water, "depth": site.water_depth, "gravity": site.g},
            "rigid_body": {"parts": self.parts},
        }
        if not self.parts:
            where = "platform.members"
            raise InputError(self.file, [Problem(where, "members with a shell thickness or ballast", "no mass at all")])
        platform |= self._hull()
        if design.platform.yaw_stiffness:
            platform["stiffness"] = {"C66": design.platform.yaw_stiffness}
            self.tell("platform.yaw_stiffness", TAKEN, "stiffness C66")
        if design.platform.potSecOrder == 1:
            platform["second_order_forces"] = "slender_body"
            meaning = (
                "second_order_forces: slender_body; RAFT adds Kim and Yue's correction to members with MCF, which is left out"
            )
            self.tell("platform.potSecOrder", APPROXIMATED, meaning)
        elif design.platform.potSecOrder == 2:
            self.tell("platform.potSecOrder", LEFT_OUT, "second-order forces of a file: name it in drift")
        platform |= self._mooring()
        self._rest()
        return Conversion(platform, tuple(self.items))

    def _members(self) -> None:
        platform = self.design.platform
        for i, member in enumerate(platform.members):
            computed = platform.potModMaster in (2, 3) or (platform.potModMaster == 0 and member.potMod)
            self._member(member, f"platform.members[{i}]", "member", computed, massive=True)

    def _member(self, member: RaftMember, where: str, name: str, computed: bool, massive: bool) -> None:
        headings = [float(x) for x in (member.heading if isinstance(member.heading, tuple) else (member.heading,))]
        parts = member_parts(member, headings) if massive else []
        self.parts += parts
        added = hull_member(member, headings, computed, f"{self.file}: {where}")
        self.hull.append(added)
        mass = sum(part["mass"] for part in parts)
        content = "shell, caps and ballast are parts" if mass else "without mass"
        self.tell(where, TAKEN, f"{name} {member.name}, {content}" + (f": {mass:.6g} kg" if mass else ""))
        self.items += added.items
        unknown = sorted(set(member.model_extra or ()) - MESH_KEYS - MODULI)
        for key in unknown:
            hint = suggest(key, RaftMember.model_fields)
            self.tell(f"{where}.{key}", LEFT_OUT, f"no key of RAFT. {hint}".strip(), warning=True)

    def _turbine(self) -> None:
        turbine = self.design.turbine
        if turbine is None:
            return
        for i, tower in enumerate(turbine.tower):
            where = f"turbine.tower[{i}]" if len(turbine.tower) > 1 else "turbine.tower"
            if min(tower.rA[2], tower.rB[2]) >= 0.0:
                self.parts += member_parts(tower, [0.0])
                self.tell(where, TAKEN, DRY_TOWER)
            else:
                self._member(tower, where, "tower under water,", False, massive=True)
        rotors = rotor_parts(turbine)
        self.parts += rotors
        mass = sum(part["mass"] for part in rotors)
        self.tell("turbine.mRNA, IxRNA, IrRNA, xCG_RNA", TAKEN, f"rotor and nacelle are parts: {mass:.6g} kg")
        for i, nacelle in enumerate(turbine.nacelle):
            where = f"turbine.nacelle[{i}]" if len(turbine.nacelle) > 1 else "turbine.nacelle"
            if min(nacelle.rA[2], nacelle.rB[2]) < 0.0:
                self._member(nacelle, where, "nacelle under water,", False, massive=False)
            else:
                self.tell(where, LEFT_OUT, "it is above the water, and its mass is in mRNA")
        omitted = [key for key in AERODYNAMICS if key in (turbine.model_extra or {})]
        if omitted:
            self.tell(f"turbine: {', '.join(omitted)}", LEFT_OUT, "aerodynamics and control; the rotor is a rigid mass")
        if any(part["centre_of_mass"][2] < 0.0 for part in rotors):
            self.tell("turbine.blade", LEFT_OUT, "buoyancy and added mass of blades under water")

    def _effects(self) -> None:
        for i, effect in enumerate(self.design.platform.additional_effects):
            where = f"platform.additional_effects[{i}]"
            if effect.type == "mean_load":
                if any(effect.load):
                    self.tell(where, LEFT_OUT, "a constant load has no key in the platform file")
            elif effect.mass > 0.0:
                self.parts.append(effect_part(effect, i + 1))
                self.tell(where, TAKEN, f"point inertia, a part: {effect.mass:.6g} kg")
            else:
                self.tell(where, LEFT_OUT, "inertia without mass; a part has mass")

    def _hull(self) -> dict[str, Any]:
        """Members in groups of equal coefficients, named after the first of each."""
        groups: dict[str, tuple[bool, dict[str, float]]] = {}
        members = []
        for converted in self.hull:
            same = (converted.column, converted.coefficients)
            group = next((name for name, row in groups.items() if row == same), converted.entry["name"])
            groups.setdefault(group, same)
            members.append(
                {
                    "name": converted.entry["name"],
                    **({"group": group} if group != converted.entry["name"] else {}),
                    **converted.entry,
                }
            )
        if len(groups) < len(members):
            self.tell(
                "platform.members", TAKEN, "members with the same coefficients share a group, named after the first of them"
            )
        entries: dict[str, Any] = {"members": members, "coefficients": {name: row for name, (_, row) in groups.items()}}
        if any(member["shape"] == "rect" for member in members):
            entries["drag_speed"] = "component"
        return entries

    def _mooring(self) -> dict[str, Any]:
        section, site = self.design.mooring, self.design.site
        if self.mooring is None:
            if section and section.get("file"):
                meaning = f"lines of another program's file, {shown(section['file'])}; of a MoorDyn file give it by --mooring"
                self.tell("mooring.file", LEFT_OUT, meaning, warning=True)
            return {}
        system = self.mooring.system(site.water_depth, site.rho_water)
        try:
            catenaries = catenary_section(system, site.water_depth, site.rho_water, site.g)
        except NoCatenaries as error:
            self.tell("mooring", LEFT_OUT, f"nothing holds the platform: {error}", warning=True)
            return {}
        self.tell("mooring", TAKEN, f"{len(catenaries['lines'])} elastic catenaries in static balance, as MoorPy has them")
        return {"mooring": catenaries}

    def _rest(self) -> None:
        platform, design = self.design.platform, self.design
        if platform.hydroPath is not None:
            meaning = f"computed coefficients {shown(platform.hydroPath)}; name them in radiation, excitation and drift"
            self.tell("platform.hydroPath", LEFT_OUT, meaning)
        for key in sorted(set(platform.model_extra or ()) - MESH_KEYS):
            self.tell(f"platform.{key}", LEFT_OUT, "an option of RAFT's computation")
        for key in sorted(set(design.model_extra or ()) - WITHOUT_MEANING):
            is_run_key = key in RUN_KEYS
            self.tell(
                key,
                LEFT_OUT,
                "not the platform: a run of RAFT, or a farm" if is_run_key else "no part of a design that is read",
            )
