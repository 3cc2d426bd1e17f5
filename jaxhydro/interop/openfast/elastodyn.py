"""Mass and inertia from ElastoDyn's file and the files of tower and blades that it names.

Everything is rigid, as with all of ElastoDyn's degrees of freedom off but the platform's. Tower and blades are cut as
ElastoDyn cuts them: TwrNodes and BldNodes elements of equal length, with the density at the middle of each.

References:
    OpenFAST v5.0.0 (2895884), ElastoDyn.f90: Init_ElastoDyn_Parameters (rZYzt, Nacd2Iner, Hubg1Iner), SetTowerParameters
    (MassT), SetBladeParameters (MassB), Coeff (TElmntMass, BElmntMass), CalculatePositions (rOP, rPQ, rQC).
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.openfast.deck_files import NOT_FILES, beside
from jaxhydro.interop.openfast.keyed_file import KeyedFile
from jaxhydro.interop.openfast.mass_parts import point_mass, rod
from jaxhydro.interop.openfast.open_file import read_keyed_file

TOWER_COLUMNS = {n: ["HtFract", "TMassDen", *map(str, range(n - 2))] for n in range(2, 11)}
BLADE_COLUMNS = {
    5: ["BlFract", "StrcTwst", "BMassDen", "FlpStff", "EdgStff"],
    6: ["BlFract", "PitchAxis", "StrcTwst", "BMassDen", "FlpStff", "EdgStff"],
    17: ["BlFract", "AeroCent", "StrcTwst", "BMassDen", *map(str, range(13))],
}
PLATFORM_INERTIA = {
    "Ixx": "PtfmRIner",
    "Iyy": "PtfmPIner",
    "Izz": "PtfmYIner",
    "Ixy": "PtfmXYIner",
    "Iyz": "PtfmYZIner",
    "Ixz": "PtfmXZIner",
}


@dataclass(frozen=True)
class TurbineParts:
    """Rigid parts of a deck.

    Attributes:
        parts: Entries of `rigid_body.parts`, with heights above still water, m.
        items: What became of ElastoDyn's file.
    """

    parts: list[dict[str, Any]]
    items: list[ConvertedItem]


def read_parts(file: KeyedFile, level: float) -> TurbineParts:
    """Platform, tower, yaw bearing, nacelle, hub and blades as rigid parts.

    Args:
        file: ElastoDyn's file.
        level: Still water above mean sea level, m.

    Raises:
        InputError: A key is missing or no number, or a table is broken.
    """
    items: list[ConvertedItem] = []
    parts = [*_platform(file, items), *_tower(file, items), *_nacelle(file, items), *_rotor(file, items)]
    for part in parts:
        x, y, z = part["centre_of_mass"]
        part["centre_of_mass"] = [x, y, z - level]
    if not parts:
        raise file.wrong(file.line_of("PtfmMass"), "a mass > 0 of the platform, the tower, the nacelle or the rotor", "0")
    return TurbineParts(parts, [*items, *_reference(file)])


def _item(file: KeyedFile, keys: str, treatment: Treatment, meaning: str, warning: bool = False) -> ConvertedItem:
    return ConvertedItem(f"{file.name}: {keys}", treatment, meaning, warning)


def _reference(file: KeyedFile) -> Iterator[ConvertedItem]:
    point = [file.number(key, 0.0) for key in ("PtfmRefxt", "PtfmRefyt", "PtfmRefzt")]
    where = "PtfmRefxt, PtfmRefyt, PtfmRefzt"
    if any(point):
        told = ", ".join(f"{value:g}" for value in point)
        meaning = (
            f"OpenFAST's motions are those of ({told}) m; here they are those of the origin at still water. Compare records "
            f"with `tracked_point: [{told}]`."
        )
        yield _item(file, where, Treatment.APPROXIMATED, meaning)
    else:
        yield _item(file, where, Treatment.TAKEN, "The reference point is the origin, as here.")
    starts = {
        key: value
        for key in ("PtfmSurge", "PtfmSway", "PtfmHeave", "PtfmRoll", "PtfmPitch", "PtfmYaw")
        if file.has(key) and (value := file.number(key))
    }
    if starts:
        releases = " ".join(f"--release {key.removeprefix('Ptfm').lower()}={value:g}" for key, value in starts.items())
        meaning = (
            f"The platform file holds no initial motion. To release from it: `jaxhydro simulate platform.yaml {releases}`."
        )
        yield _item(file, ", ".join(starts), Treatment.LEFT_OUT, meaning)


def _platform(file: KeyedFile, items: list[ConvertedItem]) -> Iterator[dict[str, Any]]:
    mass = file.number("PtfmMass")
    centre = [file.number(f"PtfmCM{axis}t") for axis in "xyz"]
    values = {name: file.number(key, 0.0 if len(set(name[1:])) > 1 else None) for name, key in PLATFORM_INERTIA.items()}
    inertia = {name: value for name, value in values.items() if value or name in ("Ixx", "Iyy", "Izz")}
    if mass < 0.0:
        raise file.wrong(file.line_of("PtfmMass"), "a number >= 0", f"{mass:g}", key="PtfmMass")
    if mass == 0.0:
        items.append(_item(file, "PtfmMass", Treatment.LEFT_OUT, "It is 0: no part `platform`."))
        return
    yield {"name": "platform", "mass": mass, "centre_of_mass": centre, "inertia": inertia}
    meaning = f"Part `platform`, {mass:.6g} kg, with the inertia about its own centre of mass."
    items.append(_item(file, "PtfmMass, PtfmCMzt, PtfmRIner, PtfmPIner, PtfmYIner", Treatment.TAKEN, meaning))


def _tower(file: KeyedFile, items: list[ConvertedItem]) -> Iterator[dict[str, Any]]:
    base, top, nodes = file.number("TowerBsHt"), file.number("TowerHt"), file.whole("TwrNodes")
    if nodes < 1 or top <= base:
        raise file.wrong(file.line_of("TwrNodes"), "1 node or more, and TowerHt above TowerBsHt", f"{nodes}")
    path = beside(file, "TwrFile")
    if file.word("TwrFile").lower() in NOT_FILES or not path.is_file():
        meaning = f"No such file: {file.word('TwrFile')}. The tower's mass is left out. Add it to `rigid_body.parts`."
        items.append(_item(file, "TwrFile", Treatment.LEFT_OUT, meaning, warning=True))
        return
    tower = read_keyed_file(path, "the tower's file")
    rows, factor = tower.table("NTwInpSt", TOWER_COLUMNS, "HtFract"), tower.number("AdjTwMa", 1.0)
    fractions = (np.arange(nodes) + 0.5) / nodes
    density = factor * np.interp(fractions, [row.number("HtFract") for row in rows], [row.number("TMassDen") for row in rows])
    masses = np.abs(density) * (top - base) / nodes
    points = np.stack([0 * fractions, 0 * fractions, base + fractions * (top - base)], axis=-1)
    if tower.has("NTwCMass") and tower.whole("NTwCMass"):
        items.append(_item(tower, "NTwCMass", Treatment.LEFT_OUT, "Masses concentrated at points of the tower are not read."))
    yield from _rigid(rod("tower", masses, points), f"{file.name}: TwrFile", items)


def _nacelle(file: KeyedFile, items: list[ConvertedItem]) -> Iterator[dict[str, Any]]:
    top = np.array([0.0, 0.0, file.number("TowerHt")])
    yield from _rigid(point_mass("yaw bearing", file.number("YawBrMass", 0.0), top), f"{file.name}: YawBrMass", items)
    mass, offset = file.number("NacMass"), np.array([file.number(f"NacCM{axis}n") for axis in "xyz"])
    inertia = np.zeros((3, 3))
    inertia[2, 2] = yaw_inertia = file.number("NacYIner") - mass * float(offset[:2] @ offset[:2])
    if yaw_inertia < -1e-6 * abs(file.number("NacYIner")):
        least = f"NacMass (NacCMxn^2 + NacCMyn^2) = {file.number('NacYIner') - yaw_inertia:.6g} or more"
        raise file.wrong(file.line_of("NacYIner"), least, f"{file.number('NacYIner'):g}", key="NacYIner")
    if file.has("NacYaw") and (yaw := file.number("NacYaw")):
        items.append(_item(file, "NacYaw", Treatment.LEFT_OUT, f"The nacelle is taken to look along x, not {yaw:g} deg off."))
    yield from _rigid(point_mass("nacelle", mass, top + offset, inertia), f"{file.name}: NacMass, NacYIner", items)


def _rotor(file: KeyedFile, items: list[ConvertedItem]) -> Iterator[dict[str, Any]]:
    tilt = math.radians(file.number("ShftTilt"))
    shaft = np.array([math.cos(tilt), 0.0, math.sin(tilt)])
    pin = np.array([0.0, 0.0, file.number("TowerHt") + file.number("Twr2Shft")]) + file.number("OverHang") * shaft
    count = file.whole("NumBl")
    apex = pin - (file.number("UndSling", 0.0) if count == 2 else 0.0) * shaft
    hub = point_mass(
        "hub", file.number("HubMass"), apex + file.number("HubCM") * shaft, file.number("HubIner") * np.outer(shaft, shaft)
    )
    yield from _rigid(hub, f"{file.name}: HubMass, HubIner", items)
    if file.number("GenIner", 0.0):
        meaning = "The generator turns on its own bearings; its inertia is left out."
        items.append(_item(file, "GenIner", Treatment.LEFT_OUT, meaning))
    across = np.array([-math.sin(tilt), 0.0, math.cos(tilt)])  # in the rotor's plane, upward
    side = np.cross(shaft, across)
    turn = math.radians(file.number("Azimuth", 0.0))
    for k in range(count):
        cone, angle = math.radians(file.number(f"PreCone({k + 1})")), turn + 2 * math.pi * k / count
        radial = math.cos(angle) * across + math.sin(angle) * side
        along = math.cos(cone) * radial + math.sin(cone) * shaft
        yield from _blade(file, k + 1, apex, along, items)


def _blade(
    file: KeyedFile, number: int, apex: Float[np.ndarray, "3"], along: Float[np.ndarray, "3"], items: list[ConvertedItem]
) -> Iterator[dict[str, Any]]:
    key = next((key for key in (f"BldFile{number}", f"BldFile({number})") if file.has(key)), f"BldFile{number}")
    tip, root = file.number("TipRad"), file.number("HubRad")
    yield from _rigid(
        point_mass(f"tip {number}", file.number(f"TipMass({number})", 0.0), apex + tip * along),
        f"{file.name}: TipMass({number})",
        items,
    )
    path = beside(file, key)
    if file.word(key).lower() in NOT_FILES or not path.is_file():
        meaning = f"No such file: {file.word(key)}. The blade's mass is left out. Add it to `rigid_body.parts`."
        items.append(_item(file, key, Treatment.LEFT_OUT, meaning, warning=True))
        return
    blade = read_keyed_file(path, "a blade's file")
    rows, nodes = blade.table("NBlInpSt", BLADE_COLUMNS, "BlFract"), file.whole("BldNodes")
    if nodes < 1 or tip <= root:
        raise file.wrong(file.line_of("BldNodes"), "1 node or more, and TipRad beyond HubRad", f"{nodes}")
    fractions = (np.arange(nodes) + 0.5) / nodes
    density = np.interp(fractions, [row.number("BlFract") for row in rows], [row.number("BMassDen") for row in rows])
    masses = blade.number("AdjBlMs", 1.0) * density * (tip - root) / nodes
    points = apex + (root + fractions[:, None] * (tip - root)) * along
    yield from _rigid(rod(f"blade {number}", masses, points), f"{file.name}: {key}", items)


def _rigid(part: dict[str, Any] | None, source: str, items: list[ConvertedItem]) -> Iterator[dict[str, Any]]:
    if part is None:
        return
    meaning = f"Part `{part['name']}`, {part['mass']:.6g} kg, rigid."
    items.append(ConvertedItem(source, Treatment.TAKEN, meaning))
    yield part
