"""Mooring system of a platform's catenary lines, as MoorDyn and MoorPy describe it."""

import math

import numpy as np
from jaxtyping import Float

from jaxhydro.interop.export_source import ExportSource
from jaxhydro.interop.mooring_system import Attachment, LineType, MooringLine, MooringPoint, MooringSystem
from jaxhydro.loads import CatenaryLines
from jaxhydro.loads.catenary.catenary_lines import segment_names


def mooring_system_of(source: ExportSource, load: CatenaryLines, solid_density: float | None = None) -> MooringSystem:
    """Points, line types and lines of a platform's catenary lines, with calibrated values.

    Every line runs from its anchor to its fairlead. A line type's mass in air gives the same weight in water as here.

    Args:
        source: The platform.
        load: Its lines.
        solid_density: Density (kg/m³) of line types without a declared diameter. None: their diameter is 0.

    Returns:
        The system. Free points between segments are on the straight line from anchor to fairlead.
    """
    water = source.model.environment
    density, gravity = float(water.density), float(water.gravity)
    types = {}
    for kind, value in load.submerged_weight.items():
        mass_in_water = float(value) / gravity  # kg/m
        solid = 0.0 if solid_density is None else math.sqrt(4 * mass_in_water / (math.pi * (solid_density - density)))
        diameter = float(source.line_diameters.get(kind, solid))
        mass = mass_in_water + density * math.pi / 4 * diameter**2
        types[kind] = LineType(kind, diameter, mass, float(load.axial_stiffness[kind]))
    points: dict[str, MooringPoint] = {}
    lines: dict[str, MooringLine] = {}
    anchors, fairleads = shifted_anchors(load), np.asarray(load.fairlead, float).T
    for i, kinds in enumerate(load.types):
        lengths = [float(load.unstretched_length[name]) for name in segment_names(i, len(kinds))]
        along = np.concatenate([[0.0], np.cumsum(lengths)]) / sum(lengths)
        for k, fraction in enumerate(along):
            attachment = Attachment.GROUND if k == 0 else Attachment.PLATFORM if k == len(kinds) else Attachment.FREE
            middle = anchors[i] + fraction * (fairleads[i] - anchors[i])
            position = {Attachment.GROUND: anchors[i], Attachment.PLATFORM: fairleads[i]}.get(attachment, middle)
            name = f"point{len(points) + 1}"
            points[name] = MooringPoint(name, attachment, (float(position[0]), float(position[1]), float(position[2])))
            if k:
                line = f"line{len(lines) + 1}"
                lines[line] = MooringLine(line, (f"point{len(points) - 1}", name), lengths[k - 1], kinds[k - 1])
    return MooringSystem(source.seabed_depth, points, types, lines)


def shifted_anchors(load: CatenaryLines) -> Float[np.ndarray, "l 3"]:
    """Anchors (m), shifted away from the platform as `anchor_shift` says."""
    anchors, fairleads = np.asarray(load.anchor, float).T.copy(), np.asarray(load.fairlead, float).T
    for i in range(len(anchors)):
        radial = (anchors[i] - fairleads[i])[:2]
        if shift := float(load.anchor_shift[f"line{i + 1}"]):
            anchors[i, :2] += shift * radial / np.linalg.norm(radial)
    return anchors
