"""A platform from an OpenFAST deck: ElastoDyn, HydroDyn, SeaState and MoorDyn.

The files are read by their keys, by a reader of our own: `openfast_io` reads by line number, so that decks of other versions
and decks without their blade files stop it.
"""

from os import PathLike
from pathlib import Path
from typing import Any

from jaxhydro.interop.conversion import Conversion, ConvertedItem, Treatment
from jaxhydro.interop.mooring_system import NoCatenaries, catenary_section
from jaxhydro.interop.openfast.added_terms import AddedTerms, matrix_entries, read_added_terms
from jaxhydro.interop.openfast.ballast import ballast_parts, drop_restoring
from jaxhydro.interop.openfast.coefficient_tables import CoefficientTables
from jaxhydro.interop.openfast.deck_current import read_current
from jaxhydro.interop.openfast.deck_files import DeckFiles, WaterColumn, module_items, open_deck, water_of
from jaxhydro.interop.openfast.deck_sea import sea_items
from jaxhydro.interop.openfast.elastodyn import read_parts
from jaxhydro.interop.openfast.hull_tables import read_fill_groups, read_joints, read_members
from jaxhydro.interop.openfast.key_items import key_items
from jaxhydro.interop.openfast.keyed_file import KeyedFile
from jaxhydro.interop.openfast.mass_parts import tidy
from jaxhydro.interop.openfast.moordyn_file import read_mooring_system
from jaxhydro.interop.openfast.potential_flow import PotentialFlow, read_potential_flow
from jaxhydro.interop.openfast.strip_members import convert_members

POTENTIAL_FLOW = 1  # PotMod


def read_openfast_deck(path: str | PathLike[str]) -> Conversion:
    """Platform of an OpenFAST deck, and what became of each item of it.

    Args:
        path: The deck's main file, `.fst`.

    Returns:
        Contents of a platform file, with heights above still water, in SI units.

    Raises:
        InputError: A file is missing or broken; file and line are named.
    """
    deck = open_deck(Path(path))
    water = water_of(deck)
    items = [_water_item(deck, water), *module_items(deck.main)]
    turbine = read_parts(deck.elastodyn, water.level)
    parts, items = list(turbine.parts), [*items, *turbine.items]
    platform: dict[str, Any] = {
        "name": deck.main.path.resolve().parent.name if deck.main.path.stem.lower() == "main" else deck.main.path.stem,
        "water": {"density": water.density, "depth": water.depth, "gravity": water.gravity},
        "rigid_body": {},
    }
    terms, flow = AddedTerms(), PotentialFlow()
    if deck.hydrodyn is not None:
        ballast, terms, flow = _hydrodyn(deck, deck.hydrodyn, water, platform, items)
        parts += ballast
    platform["rigid_body"] |= _body(parts)
    platform |= {"linear_damping": terms.linear} if terms.linear else {}
    platform |= {"quadratic_damping": terms.quadratic} if terms.quadratic else {}
    platform |= {key: flow.keys[key] for key in ("added_mass",) if key in flow.keys}
    platform |= _mooring(deck, water, terms, items)
    platform |= {key: value for key, value in flow.keys.items() if key != "added_mass"}
    platform |= _forms(deck, platform, items)
    if deck.waves is not None:
        current, current_items = read_current(deck.waves, water.depth)
        platform["water"] |= {"current": current} if current else {}
        items += [*sea_items(deck.waves), *current_items]
    items += [item for file in deck.all() for item in key_items(file)]
    return Conversion(platform, tuple(items), flow.files)


def _hydrodyn(
    deck: DeckFiles, file: KeyedFile, water: WaterColumn, platform: dict[str, Any], items: list[ConvertedItem]
) -> tuple[list[dict[str, Any]], AddedTerms, PotentialFlow]:
    """Add members and coefficients to a platform; ballast, additional terms and potential flow."""
    members = read_members(file, read_joints(file, water.level))
    mode = file.whole("PotMod")
    hull = convert_members(members, CoefficientTables(file, water.level), mode == POTENTIAL_FLOW)
    items += hull.items
    platform |= {"members": hull.members, "coefficients": hull.coefficients} if hull.members else {}
    platform["diffraction"] = "maccamy_fuchs" if hull.diffracting else "none"
    groups = read_fill_groups(file, water.level, water.density, members)
    ballast, ballast_items = ballast_parts(groups, members, file.name)
    items += ballast_items
    if file.has("NMGDepths") and file.whole("NMGDepths"):
        text = "Marine growth has no counterpart: neither its mass nor its thickness nor its coefficients."
        items.append(ConvertedItem(f"{file.name}: NMGDepths", Treatment.LEFT_OUT, text))
    terms = read_added_terms(file, mode == POTENTIAL_FLOW)
    if not file.has("NBody"):  # OpenFAST 2.5 and older
        drop_restoring(ballast, terms, water.gravity, file.name)
    items += terms.items
    flow = PotentialFlow()
    if mode == POTENTIAL_FLOW:
        wet = any(not member.potential and member.joints[0].position[2] < 0.0 for member in members)
        flow = read_potential_flow(file, water.density, wet)
        items += flow.items
    elif mode:
        items.append(ConvertedItem(f"{file.name}: PotMod", Treatment.LEFT_OUT, f"Potential flow of PotMod {mode} is not read."))
    return ballast, terms, flow


def _water_item(deck: DeckFiles, water: WaterColumn) -> ConvertedItem:
    text = f"`water`: {water.density:g} kg/m³, {water.depth:g} m, {water.gravity:g} m/s²."
    if water.level:
        text += f" Heights were counted from mean sea level, {water.level:g} m below still water, and are now from still water."
    return ConvertedItem(f"{deck.main.name}: WtrDens, WtrDpth, Gravity, MSL2SWL", Treatment.TAKEN, text)


def _body(parts: list[dict[str, Any]]) -> dict[str, Any]:
    """`rigid_body`: of one part its own mass, centre and inertia."""
    if len(parts) == 1 and "inertia" in parts[0]:
        return {key: parts[0][key] for key in ("mass", "centre_of_mass", "inertia")}
    return {"parts": parts}


def _mooring(deck: DeckFiles, water: WaterColumn, terms: AddedTerms, items: list[ConvertedItem]) -> dict[str, Any]:
    """Section `mooring`: MoorDyn's lines as catenaries, or HydroDyn's stiffness and preload alone.

    HydroDyn's additional stiffness stands beside catenaries.
    """
    if lines := _lines(deck, water, items):
        if terms.preload.any():
            text = "A constant force beside catenaries has no counterpart."
            items.append(ConvertedItem(f"{deck.main.name}: AddF0", Treatment.LEFT_OUT, text, warning=True))
        return {"mooring": lines} | ({"stiffness": matrix_entries("C", terms.stiffness)} if terms.stiffness.any() else {})
    if not terms.preload.any() and not terms.stiffness.any():
        return {}
    rows = [[tidy(value) for value in row] for row in terms.stiffness]
    return {"mooring": {"kind": "stiffness_matrix", "stiffness": rows, "preload": [tidy(value) for value in terms.preload]}}


def _lines(deck: DeckFiles, water: WaterColumn, items: list[ConvertedItem]) -> dict[str, Any] | None:
    if (file := deck.moordyn) is None:
        return None
    system, line_items = read_mooring_system(file, water.level, water.depth)
    items += line_items
    where = f"{file.name}: LINES {', '.join(system.lines)}"
    try:
        section = catenary_section(system, water.depth, water.density, water.gravity)
    except NoCatenaries as error:
        text = f"The mooring is left out: {error}. Give `mooring` by hand."
        items.append(ConvertedItem(where, Treatment.LEFT_OUT, text, warning=True))
        return None
    text = "`mooring`: elastic catenaries in static balance. Their drag, inertia, damping and bending are left out."
    items.append(ConvertedItem(where, Treatment.APPROXIMATED, text))
    return section


def _forms(deck: DeckFiles, platform: dict[str, Any], items: list[ConvertedItem]) -> dict[str, Any]:
    """Forms of the loads of strips and tables as HydroDyn has them."""
    file, strips = deck.hydrodyn, bool(platform.get("members"))
    tables = bool({"added_mass", "radiation", "excitation"} & set(platform))
    if file is None or not (strips or tables):
        return {}
    text = "`directions: earth`: HydroDyn has strips, added mass and radiation along the axes of the upright platform."
    items.append(ConvertedItem(f"{file.name}: axes", Treatment.TAKEN, text))
    forms = {"directions": "earth"} | _waves_at(file, strips, "excitation" in platform, items)
    if not strips:
        return forms
    stretching = deck.waves.whole("WaveStMod", 0) if deck.waves is not None else 0
    wetting = "instantaneous" if stretching else "mean"
    where = f"{(deck.waves or file).name}: WaveStMod"
    items.append(ConvertedItem(where, Treatment.TAKEN, f"`wetting: {wetting}`."))
    return {"wetting": wetting} | forms


def _waves_at(file: KeyedFile, strips: bool, excitation: bool, items: list[ConvertedItem]) -> dict[str, str]:
    """Where waves are met: by ExctnDisp where tables have the wave forces, else by WaveDisp."""
    modes = [key for key, used in (("ExctnDisp", excitation), ("WaveDisp", strips and file.has("WaveDisp"))) if used]
    modes = modes or ["ExctnDisp"]
    places = ["displaced" if file.whole(mode, 0) > 0 else "mean" for mode in modes]
    text = f"`waves_at: {places[0]}`."
    if len(set(places)) > 1:
        text += f" {modes[1]} has the waves of strips elsewhere ({places[1]}): there is one key for both."
        items.append(ConvertedItem(f"{file.name}: {', '.join(modes)}", Treatment.APPROXIMATED, text))
    else:
        items.append(ConvertedItem(f"{file.name}: {', '.join(modes)}", Treatment.TAKEN, text))
    return {"waves_at": places[0]}
