"""Makes benchmarks/raft/statics.json: what RAFT itself gives for designs: mass, hydrostatics, added mass, moorings.

    python -m benchmarks.raft_statics RAFT_FOLDER DESIGN [DESIGN ...] [--out FILE]

RAFT_FOLDER is a copy of WISDEM/RAFT; designs are paths in it. RAFT and MoorPy, which are no dependencies of the project, are
needed (RAFT_FOLDER and MoorPy on PYTHONPATH). WISDEM is not: statics need no aerodynamics, so an empty module stands in for it.
Blades are left out, and so is a nacelle: RAFT at e6cb69e refuses RM1_Floating with one. Every member has strip coefficients
(potModMaster 1), and types of members are written as this version has them. Strips are short (dlsMax), as RAFT loads each at
its middle: with those of 5 m that the designs ask for, Vertical_cylinder has no added mass.
"""

import argparse
import contextlib
import io
import json
import sys
from pathlib import Path
from typing import Any
from unittest.mock import MagicMock

import numpy as np

OUT = Path(__file__).with_name("raft") / "statics.json"
STRIP = 0.25  # m, the longest strip
ABSENT = ("wisdem", "wisdem.ccblade", "wisdem.ccblade.ccblade", "wisdem.commonse", "wisdem.commonse.utilities")
MATRICES = ("M_struc", "C_struc", "C_hydro", "A_hydro_morison")


def prepared(design: dict[str, Any]) -> dict[str, Any]:
    """A design that this version of RAFT runs without aerodynamics, potential flow and farm."""
    platform, turbine = design["platform"], design.get("turbine") or {}
    for key in ("array", "array_mooring"):
        design.pop(key, None)
    turbine.pop("nacelle", None)
    if turbine:
        turbine["aeroServoMod"] = 0
    platform |= {"potModMaster": 1, "potFirstOrder": 0, "potSecOrder": 0}
    towers = turbine.get("tower") or []
    for member in (*platform["members"], *([towers] if isinstance(towers, dict) else towers)):
        member["dlsMax"] = STRIP
        if member.get("type") != "beam":
            member["type"] = "rigid"
    return design


def statics(path: Path) -> dict[str, Any]:
    """Matrices (6, 6) about the reference point, volume (m³), and moorings, all at the reference position."""
    import raft.raft_rotor
    import yaml
    from raft.raft_model import Model

    raft.raft_rotor.Rotor.bladeGeometry2Member = lambda self: setattr(self, "bladeMemberList", [])
    with contextlib.redirect_stdout(io.StringIO()):
        unit = Model(prepared(yaml.safe_load(path.read_text("utf-8")))).fowtList[0]
        unit.setPosition(np.zeros(unit.nDOF))
        unit.calcStatics()
        unit.calcHydroConstants()
        values = {key: np.asarray(getattr(unit, key)).tolist() for key in MATRICES}
        values |= {"volume": float(unit.V), "yaw_stiffness": float(unit.yawstiff)}
        if unit.ms:
            unit.ms.bodyList[0].setPosition(np.zeros(6))
            unit.ms.solveEquilibrium()
            values["mooring_force"] = unit.ms.getForces(DOFtype="coupled", lines_only=True).tolist()
            values["mooring_stiffness"] = unit.ms.getCoupledStiffnessA(lines_only=True).tolist()
    return values


def main() -> None:
    """Write the results of all designs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("designs", nargs="+")
    parser.add_argument("--out", type=Path, default=OUT)
    given = parser.parse_args()
    sys.modules.update({name: MagicMock() for name in ABSENT})
    sys.path.insert(0, str(given.folder))
    results = {design: statics(given.folder / design) for design in given.designs}
    given.out.parent.mkdir(exist_ok=True)
    given.out.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    print(f"{given.out}: {len(results)} designs")


if __name__ == "__main__":
    main()
