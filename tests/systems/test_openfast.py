"""Free decays of the strip-theory hull against OpenFAST v5, an independent program with the same coefficients."""

import json
from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pandas as pd
import pytest

import jaxhydro as jh
from jaxhydro.dynamics.response import decay_cycles

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "reference" / "openfast"
pytestmark = pytest.mark.skipif(not FOLDER.exists(), reason=f"OpenFAST's runs are not at {FOLDER}")


def platform(setup: dict) -> jh.Platform:
    """The platform of OpenFAST's decks; the pontoons reach into the columns as far as its volume says."""
    preload = [0, 0, setup["AddF0"][2], 0, 0, 0]
    column = {"group": "column", "shape": "circ"}
    return jh.Platform.model_validate(
        {
            "name": "of",
            "water": {"density": 1025.0, "depth": 200.0, "gravity": 9.81},
            "rigid_body": {
                "mass": setup["mass"],
                "centre_of_mass": [0, 0, setup["zcg"]],
                "inertia": {key: setup[key] for key in ("Ixx", "Iyy", "Izz")},
            },
            "members": [
                column | {"name": "centre", "d": 10.0, "rA": [0, 0, -20], "rB": [0, 0, 15]},
                column | {"name": "outer", "d": 12.5, "rA": [51.75, 0, -20], "rB": [51.75, 0, 15], "heading": [60, 180, 300]},
                {
                    "name": "pontoon",
                    "shape": "rect",
                    "d": [12.5, 7.0],
                    "rA": [3.778677, 0, -16.5],
                    "rB": [46.721323, 0, -16.5],
                    "heading": [60, 180, 300],
                },
            ],
            "coefficients": {
                "column": {"Ca_t": 1.5, "Ca_z": 0.12, "Cd_t": 2.09, "Cd_z": 2.23},
                "pontoon": {"Ca_t": 0.11, "Ca_z": 1.87, "Cd_t": 1.84, "Cd_z": 4.96},
            },
            "linear_damping": {"B11": 4.4e4, "B22": 4.4e4, "B33": 1.6e5, "B44": 3.63e8, "B55": 3.63e8},
            "mooring": {"kind": "stiffness_matrix", "stiffness": setup["AddCLin"], "preload": preload},
        }
    )


@pytest.mark.slow
@pytest.mark.parametrize("dof, channel", [("surge", "PtfmSurge"), ("heave", "PtfmHeave"), ("pitch", "PtfmPitch")])
def test_decay_against_openfast(dof: str, channel: str) -> None:
    """Periods within half a per cent and the motion within 2 % of its start over ten cycles, time steps apart."""
    folder = FOLDER / f"decay_{dof}_strip"
    setup = json.loads((folder / "setup.json").read_text(encoding="utf-8"))
    table = pd.read_csv(folder / "out.csv.gz", skiprows=[1]).astype(float)
    times, motion = table["Time"].to_numpy(), table[channel].to_numpy()
    start = np.array(setup["q0"], dtype=float)
    start[3:] = np.radians(start[3:])
    motion = np.radians(motion) if dof == "pitch" else motion

    reference = decay_cycles(times, motion)
    ten = times <= reference.time[0] + 10 * reference.period[0]
    times, motion = times[ten], motion[ten]
    response = jh.simulate(jh.build(platform(setup)), times, position=jnp.asarray(start), step=0.5)
    simulated = decay_cycles(times, np.asarray(response[dof]))

    cycles = min(len(simulated.period), 18)
    assert cycles >= 15
    assert np.abs(simulated.period[:cycles] / reference.period[:cycles] - 1).max() < 5e-3
    assert np.abs(np.asarray(response[dof]) - motion).max() < 0.02 * np.abs(start).max()
