"""OpenFAST's strip model of VolturnUS-S, and its free decays beside this package's."""

import json
from typing import Any

import numpy as np

from benchmarks.evidence.common import SHARED

FOLDER = SHARED / "reference" / "openfast"
DECAYS = ("surge", "heave", "pitch")


def platform(setup: dict[str, Any]) -> dict[str, Any]:
    """Platform file of OpenFAST's strip model of VolturnUS-S.

    Args:
        setup: Content of the run's setup.json. The README of the runs has the other numbers.
    """
    column = {"Ca_t": 1.5, "Ca_z": 0.12, "Cd_t": 2.09, "Cd_z": 2.23}
    pontoon = {"Ca_t": 0.11, "Ca_z": 1.87, "Cd_t": 1.84, "Cd_z": 4.96}
    around = {"heading": [60, 180, 300]}
    return {
        "name": "VolturnUS-S as in OpenFAST",
        "water": {"density": 1025.0, "depth": 200.0, "gravity": 9.81},
        "rigid_body": {
            "mass": setup["mass"],
            "centre_of_mass": [0, 0, setup["zcg"]],
            "inertia": {k: setup[k] for k in ("Ixx", "Iyy", "Izz")},
        },
        "members": [
            {"name": "centre", "group": "column", "shape": "circ", "d": 10.0, "rA": [0, 0, -20], "rB": [0, 0, 15]},
            {
                "name": "outer",
                "group": "column",
                "shape": "circ",
                "d": 12.5,
                "rA": [51.75, 0, -20],
                "rB": [51.75, 0, 15],
                **around,
            },
            # lengthened there, so that the strips displace 20206.35 m3
            {
                "name": "pontoon",
                "group": "pontoon",
                "shape": "rect",
                "d": [12.5, 7.0],
                "rA": [3.778677, 0, -16.5],
                "rB": [46.721323, 0, -16.5],
                **around,
            },
        ],
        "coefficients": {"column": column, "pontoon": pontoon},
        "linear_damping": {"B11": 4.4e4, "B22": 4.4e4, "B33": 1.6e5, "B44": 3.63e8, "B55": 3.63e8},
        "mooring": {"kind": "stiffness_matrix", "stiffness": setup["AddCLin"], "preload": [0, 0, setup["AddF0"][2], 0, 0, 0]},
    }


def decay(dof: str) -> dict[str, Any]:
    """OpenFAST's decay and the package's at the same times (m, deg)."""
    import jax.numpy as jnp
    import pandas as pd

    import jaxhydro as jh

    folder = FOLDER / f"decay_{dof}_strip"
    setup = json.loads((folder / "setup.json").read_text())
    columns = pd.read_csv(folder / "out.csv.gz", skiprows=[1]).astype(float)
    model = jh.build(jh.Platform.model_validate(platform(setup)))
    start = np.array(setup["q0"], float)
    start[3:] = np.radians(start[3:])
    time = columns["Time"].to_numpy()
    motion = np.asarray(jh.simulate(model, time, position=jnp.asarray(start), step=0.25)[dof])
    reference = columns[f"Ptfm{dof.capitalize()}"].to_numpy()
    motion = np.degrees(motion) if dof == "pitch" else motion
    return {"time": time.tolist(), "openfast": reference.tolist(), "jaxhydro": motion.tolist()}
