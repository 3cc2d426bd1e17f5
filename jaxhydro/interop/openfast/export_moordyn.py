"""MoorDyn's file from catenary lines, for OpenFAST and on its own.

A line type's mass in air gives the same weight in water as here. Drag and added mass are those of the public deck of the
IEA 15 MW platform. The catenaries have none, and MoorDyn's search for its initial state needs drag.

References:
    MoorDyn documentation, The MoorDyn input file; OpenFAST v5.0.0 (2895884), MoorDyn.f90 (options, WtrDpth);
    IEA-15-240-RWT-UMaineSemi_MoorDyn.dat (IEAWindTask37).
"""

import math

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.export_effects import plain_load
from jaxhydro.interop.export_source import ExportedModel, ExportSource
from jaxhydro.interop.exported_lines import mooring_system_of
from jaxhydro.interop.mooring_system import Attachment
from jaxhydro.interop.openfast.export_text import digits, filled, row
from jaxhydro.loads import CatenaryLines

STEEL = 7850.0  # kg/m3, of lines without a declared diameter
DAMPING = -1.0  # BA/-zeta: critical
HYDRODYNAMICS = (0.0, 2.0, 0.82, 0.4, 0.27)  # EI, Cd, Ca, CdAx, CaAx
SEGMENT, FEWEST = 20.0, 10  # m, and the least number, of a line's elements
IN_OPENFAST, ALONE = "moordyn.dat", "lines.txt"
WORDS = {Attachment.GROUND: "Fixed", Attachment.PLATFORM: "Vessel", Attachment.FREE: "Free"}


def export_lines(source: ExportSource) -> ExportedModel:
    """MoorDyn's file of a platform's lines alone, for MoorDyn 2 in other programs.

    Args:
        source: The platform.

    Returns:
        Text of lines.txt, and what became of the platform.

    Raises:
        InputError: The platform has no catenary lines.
    """
    load = next((load for load in map(plain_load, source.model.loads) if isinstance(load, CatenaryLines)), None)
    if load is None:
        hint = "MoorDyn's file has lines with weight; --format openfast and --format raft write other moorings."
        found = "a platform without catenary lines"
        raise InputError(source.name, [Problem("mooring", "lines of `kind: catenary`", found, hint)])
    text, items = moordyn_file(source, load, ALONE)
    water = source.model.environment
    told = f"g, WtrDnsty and WtrDpth: {float(water.gravity):g} m/s², {float(water.density):g} kg/m³, {source.seabed_depth:g} m."
    rest = "A MoorDyn file has the lines alone. MoorDyn gets the motion of the fairleads from the program that runs it."
    around = [
        ConvertedItem("water", Treatment.TAKEN, told),
        ConvertedItem("all but the mooring", Treatment.LEFT_OUT, rest),
    ]
    return ExportedModel({ALONE: text}, (*items, *around))


def moordyn_file(source: ExportSource, load: CatenaryLines, name: str) -> tuple[str, list[ConvertedItem]]:
    """Text of MoorDyn's file, and what became of the lines.

    Args:
        source: The platform.
        load: Its lines.
        name: Name of the file. That of `IN_OPENFAST` has no gravity and density: OpenFAST states them.
    """
    system = mooring_system_of(source, load, STEEL)
    kinds, point_names = list(system.line_types), list(system.points)
    items = [
        ConvertedItem(f"mooring.line_types.{kind}", Treatment.APPROXIMATED, _told_diameter(line_type.diameter))
        for kind, line_type in system.line_types.items()
        if kind not in source.line_diameters
    ]
    types = [
        row(
            _word(kind, kinds),
            line_type.diameter,
            line_type.mass_per_length,
            line_type.axial_stiffness,
            DAMPING,
            *HYDRODYNAMICS,
        )
        for kind, line_type in system.line_types.items()
    ]
    points = [
        row(number, WORDS[point.attachment], *point.position, 0, 0, 0, 0)
        for number, point in enumerate(system.points.values(), 1)
    ]
    lines, fairleads = list[str](), list[int]()
    for number, line in enumerate(system.lines.values(), 1):
        ends = [point_names.index(end) + 1 for end in line.ends]
        count = max(FEWEST, math.ceil(line.length / SEGMENT))
        lines.append(row(number, _word(line.line_type, kinds), *ends, line.length, count, "-"))
        if system.points[line.ends[1]].attachment is Attachment.PLATFORM:
            fairleads.append(number)
    text = (
        f"{name}: lines with weight and axial stiffness as here. MoorDyn adds their inertia, drag and damping, which the "
        "tuned model has not: they damp slow motions. Cd 2.0, Ca 0.82, CdAx 0.4 and CaAx 0.27 are those of the public deck "
        "of the IEA 15 MW platform."
    )
    items.append(ConvertedItem("mooring", Treatment.APPROXIMATED, text))
    if float(load.seabed_friction):
        text = f"MoorDyn's friction is of another law: {float(load.seabed_friction):g} is not in the file."
        items.append(ConvertedItem("mooring.seabed.friction", Treatment.LEFT_OUT, text))
    water = source.model.environment
    values = {"types": types, "points": points, "lines": lines, "fairleads": fairleads, "alone": name != IN_OPENFAST}
    values |= {key: digits(getattr(water, key)) for key in ("gravity", "density")}
    return filled("moordyn.dat", name=source.name, depth=digits(system.depth), **values), items


def _told_diameter(diameter: float) -> str:
    return f"The diameter of its volume, {diameter:.4g} m, is that of steel, as none is declared: MoorDyn needs its mass."


def _word(kind: str, kinds: list[str]) -> str:
    """Name of a line type as one word; its number where letters would be lost."""
    return kind if kind.isidentifier() and kind.isascii() else f"type{kinds.index(kind) + 1}"
