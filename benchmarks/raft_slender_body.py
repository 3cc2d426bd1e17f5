"""Makes benchmarks/raft/slender_body.json: RAFT's difference-frequency forces on single members.

    python -m benchmarks.raft_slender_body RAFT_FOLDER [--out FILE]

RAFT_FOLDER is a copy of WISDEM/RAFT, which is no dependency of the project. Of RAFT only the class of a member is used, so
empty modules stand in for the packages that other parts of it import. Members are held, or move as `MOTION` says. One line of
RAFT is changed before it is run: at e6cb69e `f_transv`, the transverse force on ends, is the complex conjugate of what the
real product of its factors has at the difference frequency. RAFT leaves out the pressure -rho u²/2 of the undisturbed waves on
ends; so does the comparison (`tests/jaxhydro/test_slender_body_forces.py`).
"""

import argparse
import json
import sys
from pathlib import Path
from types import ModuleType
from typing import Any
from unittest.mock import MagicMock

import numpy as np

OUT = Path(__file__).with_name("raft") / "slender_body.json"
STRIP = 0.05  # m, the longest strip: RAFT loads each at its middle
DEPTH, DENSITY, GRAVITY = 200.0, 1025.0, 9.81
FREQUENCY = [0.09, 0.115]  # Hz
ABSENT = ("moorpy", "moorpy.helpers", "wisdem", "wisdem.commonse", "wisdem.commonse.utilities")
COLUMN = {"shape": "circ", "d": 10.0, "rA": [30.0, 0.0, -20.0], "rB": [30.0, 0.0, 10.0], "Ca": 0.8, "CaEnd": 0.6}
BARE = COLUMN | {"Ca": 0.0, "CaEnd": 0.0}
MOTION = {"surge": [0.7 - 0.4j, 0.3 + 0.5j], "sway": [0.1 + 0.3j, -0.2j], "heave": [0.4 + 0.2j, -0.3 + 0.3j]}
CASES: dict[str, dict[str, Any]] = {
    "held, no added mass": {"member": BARE},
    "held": {"member": COLUMN},
    "moving, no added mass": {"member": BARE, "motion": MOTION},
    "moving": {"member": COLUMN, "motion": MOTION},
}


def motions(case: dict[str, Any]) -> np.ndarray:
    """Complex amplitudes (m, rad) of the six motions per metre of both waves, (6, 2)."""
    amplitudes, order = np.zeros((6, 2), complex), ("surge", "sway", "heave", "roll", "pitch", "yaw")
    for motion, values in case.get("motion", {}).items():
        amplitudes[order.index(motion)] = values
    return amplitudes


def member_class(folder: Path) -> Any:
    """RAFT's class of a member, with the one line changed."""
    for name in ABSENT:
        sys.modules.setdefault(name, MagicMock())
    package = ModuleType("raft")
    package.__path__ = [str(folder / "raft")]
    sys.modules["raft"] = package
    source = (folder / "raft" / "raft_member.py").read_text("utf-8")
    line = "(np.conj(u1_aux)*nodeV_axial_rel[i2, il] + u2_aux*np.conj(nodeV_axial_rel[i1, il]))"
    if source.count(line) != 1:
        raise SystemExit("this version of RAFT has another f_transv: look at it first")
    mended = source.replace(line, "(u1_aux*np.conj(nodeV_axial_rel[i2, il]) + np.conj(u2_aux)*nodeV_axial_rel[i1, il])")
    module = ModuleType("raft.raft_member")
    exec(compile(mended, "raft_member.py", "exec"), module.__dict__)
    return module.Member


def forces(Member: Any, case: dict[str, Any]) -> np.ndarray:
    """Complex amplitude (N, N m) at the difference frequency per metre of both waves, (6,)."""
    from raft.helpers import waveNumber

    own = case["member"]
    description = {
        "name": "member",
        "type": "rigid",
        "stations": [0, 1],
        "dlsMax": STRIP,
        "t": 0.05,
        **{key: own[key] for key in ("shape", "d", "rA", "rB", "Ca", "CaEnd")},
    }
    member = Member(description, 2)
    member.setPosition()
    member.calcHydroConstants(rho=DENSITY, g=GRAVITY)
    omega = 2 * np.pi * np.array(FREQUENCY)
    wavenumber = np.array([waveNumber(w, DEPTH, e=1e-12) for w in omega])
    qtf = member.calcQTF_slenderBody(motions(case), 0.0, omega, wavenumber, DEPTH, rho=DENSITY, g=GRAVITY)
    return 2 * qtf[0, 1]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--out", type=Path, default=OUT)
    options = parser.parse_args()
    Member = member_class(options.folder)
    rows = {name: forces(Member, case) for name, case in CASES.items()}
    text = {name: {"real": row.real.tolist(), "imaginary": row.imag.tolist()} for name, row in rows.items()}
    options.out.write_text(json.dumps({"source": "WISDEM/RAFT e6cb69e", "forces": text}, indent=1) + "\n", "utf-8")


if __name__ == "__main__":
    main()
