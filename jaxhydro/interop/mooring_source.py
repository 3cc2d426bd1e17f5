"""Mooring lines as section `mooring` of a platform file: on their own, or in the platform of another source."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from jaxhydro.environment import STANDARD_GRAVITY
from jaxhydro.errors import InputError, Problem
from jaxhydro.input_schema import read_yaml
from jaxhydro.interop.conversion import Conversion, ConvertedItem, Treatment
from jaxhydro.interop.mooring_file import DENSITY, MooringFile, first_line, is_mooring_yaml, read_mooring_file
from jaxhydro.interop.mooring_system import ON_BED, Attachment, MooringSystem, NoCatenaries, catenary_section
from jaxhydro.interop.openfast.moordyn_tables import is_moordyn
from jaxhydro.interop.openfast.open_file import read_keyed_file
from jaxhydro.interop.raft_design import read_raft_design

PLACE = "mooring"  # key of the platform file, and of the item that asks for it
REPLACED = ("mooring", "external stiffness")  # items that lines of another file make void
REPLACED_KEYS = (": mooring.file", ": CompMooring")  # likewise, by the end of their name
DECK_FILES = "Of an OpenFAST deck name the main file"


def read_moordyn(path: Path) -> Conversion:
    """Sections `water` and `mooring` of a text file, which has to be MoorDyn's.

    Args:
        path: The file.

    Raises:
        InputError: It is another program's, or cannot be used.
    """
    file = read_keyed_file(path, "a MoorDyn file")
    if not is_moordyn(file):
        from jaxhydro.interop.converters import readable

        mains = sorted(path.parent.glob("*.fst"))
        hint = f"{DECK_FILES}, {mains[0].name}." if mains else ""
        raise InputError(str(path), [Problem("", readable(), first_line(file), hint)])
    return convert_mooring(path)


def read_yaml_model(path: Path) -> Conversion:
    """Conversion of a YAML file: a MoorPy system, or a RAFT design.

    Args:
        path: The file.

    Raises:
        InputError: It cannot be used.
    """
    return convert_mooring(path) if is_mooring_yaml(read_yaml(path)) else read_raft_design(path)


def convert_mooring(path: Path) -> Conversion:
    """Sections `water` and `mooring` of a platform file.

    Args:
        path: A MoorDyn file, or a MoorPy system in YAML.

    Raises:
        InputError: It cannot be read, or its lines cannot be catenaries from the sea bed to the platform.
    """
    source = read_mooring_file(path)
    density, gravity = source.density or DENSITY, source.gravity or STANDARD_GRAVITY
    section, items = _section(source, source.system.depth, density, gravity)
    told = [name for name, value in (("density", source.density), ("gravity", source.gravity)) if value is None]
    text = f"`water`: {density:g} kg/m³, {gravity:g} m/s², {source.system.depth:g} m."
    text += f" The file does not state {' and '.join(told)}." if told else ""
    items.insert(0, ConvertedItem(f"{path.name}: water", Treatment.APPROXIMATED if told else Treatment.TAKEN, text))
    water = {"density": density, "depth": source.system.depth, "gravity": gravity}
    return Conversion({"water": water, PLACE: section}, tuple(items), whole=False)


def with_mooring(conversion: Conversion, file: MooringFile, source: str) -> Conversion:
    """A platform with the lines of another file.

    Args:
        conversion: The platform, which has no mooring of its own, or one that is to be filled in by hand.
        file: The lines.
        source: Name of the file that the platform is of, for messages.

    Raises:
        InputError: The platform has a mooring, or the lines cannot be catenaries from the sea bed to it.
    """
    if not conversion.whole:
        raise InputError(source, [Problem("", "a platform beside --mooring", "a file of mooring lines")])
    to_fill_in = any(item.source == PLACE and item.treatment is Treatment.TO_FILL_IN for item in conversion.items)
    present = conversion.platform.get(PLACE, {"kind": "none"})
    if present["kind"] != "none" and not to_fill_in:
        found = f"a mooring of kind {present['kind']}"
        raise InputError(source, [Problem("--mooring", "a source without a mooring", found, "Leave out --mooring.")])
    path, water = file.path, conversion.platform["water"]
    section, items = _section(file, water["depth"], water["density"], water["gravity"])
    for key, stated, unit in (("density", file.density, "kg/m³"), ("gravity", file.gravity, "m/s²")):
        if stated is not None and stated != water[key]:
            text = f"{stated:g} {unit} is left out: the lines are in the platform's water, {water[key]:g} {unit}."
            items.append(ConvertedItem(f"{path.name}: {key}", Treatment.LEFT_OUT, text))
    if (bed := file.system.depth) != water["depth"]:
        text = (
            f"`mooring.seabed.depth`: lines are in {bed:g} m, the platform's water is {water['depth']:g} m deep. Mend either."
        )
        items.append(ConvertedItem(f"{path.name}: sea bed", Treatment.APPROXIMATED, text, warning=True))
    if present["kind"] != "none":
        text = f"A mooring of kind {present['kind']} is replaced by the lines of {path.name}."
        items.append(ConvertedItem("external stiffness", Treatment.LEFT_OUT, text))
    void = [item for item in conversion.items if item.source in REPLACED or item.source.endswith(REPLACED_KEYS)]
    kept = [item for item in conversion.items if item not in void]
    return replace(conversion, platform=conversion.platform | {PLACE: section}, items=(*kept, *items))


def _section(source: MooringFile, depth: float, density: float, gravity: float) -> tuple[dict[str, Any], list[ConvertedItem]]:
    """Section `mooring` in water of a depth (m), density (kg/m³) and gravity (m/s²), and what became of the file."""
    system, name = source.system, source.path.name
    try:
        section = catenary_section(system, depth, density, gravity)
    except NoCatenaries as error:
        where = f"line {error.row}" if error.row else ""
        expected = "lines that sink and run from fixed points to the platform, without masses between"
        raise InputError(str(source.path), [Problem(where, expected, str(error))]) from None
    used = section["line_types"]
    items = [
        ConvertedItem(f"{name}: line types {', '.join(used)}", Treatment.TAKEN, "Stiffness EA, mass and diameter."),
        ConvertedItem(f"{name}: points", Treatment.TAKEN, _counted(system)),
        ConvertedItem(
            f"{name}: lines {', '.join(system.lines)}",
            Treatment.APPROXIMATED,
            "`mooring`: elastic catenaries in static balance. Their drag, inertia, damping and bending are left out.",
        ),
    ]
    if spare := [kind for kind in system.line_types if kind not in used]:
        items.append(ConvertedItem(f"{name}: line types {', '.join(spare)}", Treatment.LEFT_OUT, "No line is of these types."))
    held = {end for line in system.lines.values() for end in line.ends}
    if idle := [point for point in system.points if point not in held]:
        text = f"No line is at points {', '.join(idle)}."
        items.append(ConvertedItem(f"{name}: points without a line", Treatment.LEFT_OUT, text, warning=True))
    if not source.depth_stated:
        text = f"The file states no depth: {system.depth:g} m is assumed, at which the deepest fixed point is on the sea bed."
        items.append(ConvertedItem(f"{name}: water depth", Treatment.APPROXIMATED, text))
    bed = system.depth * (1 - ON_BED)
    fixed = {key: point for key, point in system.points.items() if point.attachment is Attachment.GROUND}
    if above := [key for key, point in fixed.items() if point.position[2] > -bed]:
        text = f"Fixed points {', '.join(above)} are above the sea bed at {system.depth:g} m: their lines do not rest on it."
        items.append(ConvertedItem(f"{name}: points above the sea bed", Treatment.APPROXIMATED, text, warning=True))
    return section, [*items, *source.items]


def _counted(system: MooringSystem) -> str:
    words = {Attachment.GROUND: "fixed", Attachment.PLATFORM: "on the platform", Attachment.FREE: "free"}
    counts = {word: sum(point.attachment is kind for point in system.points.values()) for kind, word in words.items()}
    return f"{', '.join(f'{count} {word}' for word, count in counts.items() if count)}."
