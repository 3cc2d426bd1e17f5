"""Mooring lines of VolturnUS-S at rest, held at offsets in surge."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from jaxhydro.platform.schema import Platform

MOORDYN = Path(__file__).parents[1] / "moordyn" / "statics.json"  # made by benchmarks.moordyn_statics
OFFSETS = (0.0, 10.0, 20.0)  # m, in surge
SEGMENTS = (20, 40, 80)  # of a line in MoorDyn
BED = 3.0e6  # Pa/m, MoorDyn's default stiffness of the bed
FINEST_RUN, STIFF_RUN = (20.0, 160, BED), (20.0, 40, 10 * BED)  # offset, segments, bed stiffness
RUNS = (*((offset, segments, BED) for segments in SEGMENTS for offset in OFFSETS), STIFF_RUN, FINEST_RUN)
CHAIN = {"axial_stiffness": 3.27e9, "mass_per_length": 685.0, "diameter": 0.333}  # NREL/TP-5000-76773, table 8
LINE = {"anchor": [-837.6, 0.0, -200.0], "fairlead": [-58.0, 0.0, -14.0], "heading": [0.0, 120.0, 240.0]}
LENGTH = 850.0  # m, unstretched


def platform() -> Platform:
    """VolturnUS-S on the three chains of its report."""
    from jaxhydro.platform.schema import Platform, load_platform

    line = LINE | {"segments": [{"type": "chain", "length": LENGTH}]}
    mooring = {"kind": "catenary", "line_types": {"chain": CHAIN}, "lines": [line]}
    return Platform.model_validate(load_platform("volturnus-s").model_dump(exclude_unset=True) | {"mooring": mooring})


def weight(moored: Platform) -> float:
    """Weight of the chain in water (N/m), of a platform on such chains."""
    return float(moored.mooring.line_types["chain"].weight(moored.water.density, moored.water.gravity))


def worked_out() -> dict[str, Any]:
    """Statics of the lines by jaxhydro.

    The tension at the anchor is that at the fairlead less what the suspended part weighs; there is no friction.

    Returns:
        `weight` of the chain (N/m); and by offset (m) the states of the `lines` (N, m) and their `force` (N).
    """
    from jaxhydro.dynamics.static_forces import forces_by_load, line_states
    from jaxhydro.platform.build import build

    moored = platform()
    model, heavy = build(moored), weight(moored)
    offsets = []
    for offset in OFFSETS:
        position = np.array([offset, 0.0, 0.0, 0.0, 0.0, 0.0])
        lines = []
        for line in line_states(model, position):
            along, down = line.tension * math.cos(line.angle), line.tension * math.sin(line.angle)
            lifted = down - heavy * (LENGTH - line.on_seabed)
            lines.append({"fairlead": line.tension, "anchor": math.hypot(along, lifted), "on_seabed": line.on_seabed})
        force = forces_by_load(model, position)["catenary lines"]
        offsets.append({"offset": offset, "lines": lines, "force": force[:3].tolist()})
    return {"weight": heavy, "offsets": offsets}
