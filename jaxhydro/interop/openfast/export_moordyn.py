"""MoorDyn's file from catenary lines.

A line type's mass in air is that which weighs as much in water as here. Drag and added mass are those of the public deck of
the IEA 15 MW platform: the catenaries have none, and MoorDyn's search for its initial state needs drag.

References:
    MoorDyn documentation, The MoorDyn input file; OpenFAST v5.0.0 (2895884), MoorDyn.f90 (options, WtrDpth);
    IEA-15-240-RWT-UMaineSemi_MoorDyn.dat (IEAWindTask37).
"""

import math

import numpy as np

from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.openfast.export_source import ExportSource, digits, filled, row
from jaxhydro.loads import CatenaryLines
from jaxhydro.loads.catenary.catenary_lines import segment_names

STEEL = 7850.0  # kg/m3, of lines without a declared diameter
DAMPING = -1.0  # BA/-zeta: critical
HYDRODYNAMICS = (0.0, 2.0, 0.82, 0.4, 0.27)  # EI, Cd, Ca, CdAx, CaAx
SEGMENT, FEWEST = 20.0, 10  # m, and the least number, of a line's elements


def moordyn_file(source: ExportSource, load: CatenaryLines) -> tuple[str, list[ConvertedItem]]:
    """Text of MoorDyn's file, and what became of the lines.

    Args:
        source: The platform.
        load: Its lines.
    """
    water = source.model.environment
    density, gravity = float(water.density), float(water.gravity)
    types, items = [], []
    for kind, value in load.submerged_weight.items():
        weight = float(value) / gravity  # kg/m in water
        if (diameter := source.line_diameters.get(kind)) is None:
            diameter = math.sqrt(4 * weight / (math.pi * (STEEL - density)))
            text = (
                f"The diameter of its volume, {diameter:.4g} m, is that of steel, as none is declared: MoorDyn needs its mass."
            )
            items.append(ConvertedItem(f"mooring.line_types.{kind}", Treatment.APPROXIMATED, text))
        mass = weight + density * math.pi / 4 * float(diameter) ** 2
        name = _word(kind, list(load.submerged_weight))
        types.append(row(name, float(diameter), mass, float(load.axial_stiffness[kind]), DAMPING, *HYDRODYNAMICS))
    anchors, fairleads = _anchors(load), np.asarray(load.fairlead).T
    points, lines, tensions = list[str](), list[str](), list[int]()
    for i, kinds in enumerate(load.types):
        lengths = [float(load.unstretched_length[name]) for name in segment_names(i, len(kinds))]
        along = np.concatenate([[0.0], np.cumsum(lengths)]) / sum(lengths)
        for k, at in enumerate(along):
            state = "Fixed" if k == 0 else "Vessel" if k == len(kinds) else "Free"
            place = anchors[i] + at * (fairleads[i] - anchors[i])
            points.append(
                row(len(points) + 1, state, *(place if state == "Free" else (anchors[i], fairleads[i])[k > 0]), 0, 0, 0, 0)
            )
            if k:
                name = _word(kinds[k - 1], list(load.submerged_weight))
                count = max(FEWEST, math.ceil(lengths[k - 1] / SEGMENT))
                lines.append(row(len(lines) + 1, name, len(points) - 1, len(points), lengths[k - 1], count, "-"))
        tensions.append(len(lines))
    text = (
        "moordyn.dat: lines with weight and axial stiffness as here. MoorDyn adds their inertia, drag and damping, which the "
        "tuned model has not: Cd 2.0, Ca 0.82, CdAx 0.4 and CaAx 0.27 are those of the public IEA 15 MW deck."
    )
    items.append(ConvertedItem("mooring", Treatment.APPROXIMATED, text))
    if float(load.seabed_friction):
        text = f"MoorDyn's friction is of another law: {float(load.seabed_friction):g} is not in the deck."
        items.append(ConvertedItem("mooring.seabed.friction", Treatment.LEFT_OUT, text))
    values = {"types": types, "points": points, "lines": lines, "fairleads": tensions}
    return filled("moordyn.dat", name=source.name, depth=digits(source.seabed_depth), **values), items


def _anchors(load: CatenaryLines) -> np.ndarray:
    """Anchors (m), shifted away from the platform as `anchor_shift` says, (n, 3)."""
    anchors, fairleads = np.asarray(load.anchor, float).T.copy(), np.asarray(load.fairlead, float).T
    for i in range(len(anchors)):
        radial = (anchors[i] - fairleads[i])[:2]
        if shift := float(load.anchor_shift[f"line{i + 1}"]):
            anchors[i, :2] += shift * radial / np.linalg.norm(radial)
    return anchors


def _word(kind: str, kinds: list[str]) -> str:
    """Name of a line type as one word; its number where letters would be lost."""
    return kind if kind.isidentifier() and kind.isascii() else f"type{kinds.index(kind) + 1}"
