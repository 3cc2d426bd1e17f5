"""Slow motions on catenaries in OpenFAST: the same deck in the same sea, with MoorDyn's lines in three forms.

    python -m benchmarks.openfast_lines OPENFAST DECK FOLDER

DECK is the main file of a deck with MoorDyn and the SeaState file ss.dat, and the components of its waves beside it, in
components.csv (columns index, amp_m and phase_rad; frequencies are index / 4096 s). It is converted, exported and run:

- `moordyn`: lines as exported, with drag, added mass and inertia
- `thin`: lines of the same weight in water and stiffness, without drag and added mass
- `matrix`: no lines, but their pull and stiffness at the reference position (AddF0, AddCLin)

Beside them are this package's motions with catenaries and with the same matrix, and those of the deck itself (out.csv, where it
is beside the deck). Decks stay in FOLDER: a deck that has run is not run again. Raw results go to
benchmarks/results-openfast-lines.json; benchmarks.openfast_decks puts them into its page.
"""

import argparse
import dataclasses
import json
import math
import re
import shutil
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import numpy as np
import pandas as pd
from jaxtyping import Float
from ruamel.yaml import YAML

import jaxhydro as jh
from benchmarks.openfast_decks_export import read_back, written
from benchmarks.openfast_decks_run import TEXT_OUTPUT, edit, outcome, run
from jaxhydro.dynamics.static_forces import forces_by_load, mooring_stiffness
from jaxhydro.waves.components import components

RAW = Path(__file__).with_name("results-openfast-lines.json")
DURATION, TRANSIENT, PERIOD = 3900.0, 300.0, 4096.0  # s; the last is that of the waves
SPLIT = 0.05  # Hz, between slow motions and those at the waves' frequencies
SEGMENTS, LINE_STEP = 15, {"moordyn": 0.01, "thin": 0.005}  # of each line in MoorDyn, and dtM (s)
THIN = 0.01  # m, diameter of lines that displace next to nothing
STEP = 0.05  # s, DT
DOFS = ("surge", "heave", "pitch")


def matrix_mooring(model: jh.Model) -> dict[str, Any]:
    """The pull and stiffness of a model's catenaries at the reference position, as a platform file has them."""
    lines = dataclasses.replace(model, loads=tuple(load for load in model.loads if isinstance(load, jh.loads.CatenaryLines)))
    pull = sum(forces_by_load(lines, jnp.zeros(6)).values(), np.zeros(6))
    stiffness = np.asarray(mooring_stiffness(lines, jnp.zeros(6)))
    return {"kind": "stiffness_matrix", "stiffness": stiffness.tolist(), "preload": np.asarray(pull).tolist()}


def coarse(lines: str) -> str:
    """MoorDyn's text with `SEGMENTS` segments a line."""
    return re.sub(r"(?m)^(\d+ \S+ \d+ \d+ \S+) \d+ -$", rf"\1 {SEGMENTS} -", lines)


def thin(lines: str, density: float) -> str:
    """MoorDyn's text with line types of the same weight in water and stiffness, without drag and added mass.

    Args:
        lines: Text of moordyn.dat.
        density: Of the water, kg/m3.
    """

    def changed(row: re.Match[str]) -> str:
        diameter, mass = float(row[2]), float(row[3])
        mass += 0.25 * math.pi * density * (THIN**2 - diameter**2)
        return f"{row[1]} {THIN} {mass:.9g} {row[4]} -1.0 0.0 0.0 0.0 0.0 0.0"

    return re.sub(r"(?m)^(\S+) ([\d.]+) ([\d.]+) ([\d.e+]+) -1\.0( \S+){5}$", changed, lines)


def parts(times: Float[np.ndarray, " t"], motion: Float[np.ndarray, "3 t"]) -> dict[str, Any]:
    """Mean of surge (m), and standard deviations (m, deg) of slow motions and of wave-frequency motions."""
    late = motion[:, times >= TRANSIENT]
    spectrum = np.fft.rfft(late - late.mean(axis=1, keepdims=True))
    slow = np.fft.rfftfreq(late.shape[1], float(np.diff(times).mean())) < SPLIT
    low = np.fft.irfft(np.where(slow, spectrum, 0.0), late.shape[1]).std(axis=1)
    high = np.fft.irfft(np.where(slow, 0.0, spectrum), late.shape[1]).std(axis=1)
    return {"mean_surge": float(late[0].mean()), "slow": low.tolist(), "waves": high.tolist()}


def shown(position: Float[np.ndarray, "6 t"]) -> Float[np.ndarray, "3 t"]:
    """Surge, heave (m) and pitch (deg) of motions (m, rad)."""
    return np.stack([position[0], position[2], np.degrees(position[4])])


def sea_of(deck: Path, environment: jh.Environment) -> jh.IrregularSea:
    """The deck's waves, from its components.csv."""
    table = pd.read_csv(deck.with_name("components.csv"), comment="#")
    index, amplitude, phase = (table[key].to_numpy() for key in ("index", "amp_m", "phase_rad"))
    omega = 2 * math.pi * index / PERIOD
    waves = components(jnp.array(amplitude), jnp.array(omega), environment, phase=jnp.array(phase), first=int(index[0]))
    return jh.IrregularSea(waves, environment, stretching="none")


def main() -> None:
    """Run the decks that have not run yet, and write the raw results."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("openfast", help="executable of OpenFAST 5")
    parser.add_argument("deck", type=Path, help="main file of the deck")
    parser.add_argument("folder", type=Path, help="where the decks are run")
    given = parser.parse_args()
    own, results = given.folder / "converted", dict[str, Any]()
    shutil.rmtree(own, ignore_errors=True)
    given.folder.mkdir(parents=True, exist_ok=True)
    model = read_back(given.deck, own)
    raw = YAML(typ="safe").load((own / "platform.yaml").read_text("utf-8"))
    YAML().dump(raw | {"mooring": matrix_mooring(model)}, own / "matrix.yaml")
    platforms = {name: jh.load_platform(own / f"{name}.yaml") for name in ("platform", "matrix")}
    if (original := given.deck.with_name("out.csv")).is_file():
        table = pd.read_csv(original, skiprows=[1]).astype(float)
        motion = table[["PtfmSurge", "PtfmHeave", "PtfmPitch"]].to_numpy().T
        results["original"] = parts(table["Time"].to_numpy(), motion)
    for name in ("moordyn", "thin", "matrix"):
        folder = given.folder / name
        if not (folder / "main.out").exists():
            shutil.rmtree(folder, ignore_errors=True)
            written(platforms["matrix" if name == "matrix" else "platform"], folder)
            shutil.copyfile(given.deck.with_name("ss.dat"), folder / "seastate.dat")
            edit(folder, {"main.fst": TEXT_OUTPUT | {"TMax": DURATION, "DT": STEP}})
            if name != "matrix":
                text = coarse((folder / "moordyn.dat").read_text("utf-8"))
                text = thin(text, float(model.environment.density)) if name == "thin" else text
                (folder / "moordyn.dat").write_text(text, encoding="utf-8")
                edit(folder, {"moordyn.dat": {"dtM": LINE_STEP[name]}})
            print(name, run(given.openfast, folder).status, flush=True)
        result = outcome(folder, 0)
        results[name] = parts(result.times, shown(result.motion))
    sea, times = sea_of(given.deck, model.environment), np.arange(0.0, DURATION + 0.05, 0.1)
    for name, platform in platforms.items():
        response = jh.simulate(jh.build(platform), times, sea, position=jnp.zeros(6))
        results[f"here_{name}"] = parts(times, shown(np.asarray(response.position).T))
    RAW.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    print(RAW)


if __name__ == "__main__":
    main()
