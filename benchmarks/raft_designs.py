"""RAFT's designs, read as platform files, against RAFT itself and against the built-in platforms.

    python -m benchmarks.raft_designs RAFT_FOLDER [--only DESIGN ...]

RAFT_FOLDER is a copy of WISDEM/RAFT (at e6cb69e). RAFT's own numbers are those of `benchmarks.raft_statics`, in
benchmarks/raft/statics.json. Raw results go to benchmarks/raft/converted.json, the text to benchmarks/results-raft-designs.md.
"""

import argparse
import json
import math
import tempfile
from collections import Counter
from pathlib import Path
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from ruamel.yaml import YAML

import jaxhydro as jh
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.statics import linearised
from jaxhydro.interop.conversion import Conversion
from jaxhydro.interop.raft_design import read_raft_design

FOLDER = Path(__file__).with_name("raft")
STATICS, RAW, TEXT = FOLDER / "statics.json", FOLDER / "converted.json", Path(__file__).with_name("results-raft-designs.md")
BUILT_IN = {  # the same hull by hand
    "tests/test_data/OC3spar.yaml": "oc3-hywind",
    "tests/test_data/OC4semi-WAMIT_Coefs.yaml": "oc4-deepcwind",
    "tests/test_data/VolturnUS-S.yaml": "volturnus-s",
}
SHOWN = ("surge", "heave", "pitch", "yaw")


def model_of(conversion: Conversion) -> Model:
    """Model of a conversion, by way of its file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "platform.yaml"
        YAML().dump(conversion.platform, path)
        return jh.build(jh.load_platform(path))


def stiffness_of_lines(model: Model) -> list[list[float]] | None:
    """Stiffness (6, 6) of catenaries at the reference position; None without them."""
    loads = tuple(load for load in model.loads if not isinstance(load, jh.loads.CatenaryLines))
    if len(loads) == len(model.loads):
        return None
    without = eqx.tree_at(lambda m: m.loads, model, loads)
    whole, without_lines = (jax.jacfwd(lambda q, m=m: m.force_at_rest(q))(jnp.zeros(6)) for m in (model, without))
    return (-np.asarray(whole - without_lines)).tolist()


def periods(mass: np.ndarray, stiffness: np.ndarray) -> dict[str, float]:
    """Natural periods (s) of the six modes, each under the motion that is largest in it, rotations at 50 m."""
    values, vectors = np.linalg.eig(np.linalg.solve(mass, stiffness))
    weight = np.abs(vectors) * np.array([1, 1, 1, 50, 50, 50])[:, None]
    by_motion: dict[str, float] = {}
    for i in np.argsort(-weight.max(axis=0) / weight.sum(axis=0)):
        dof = next(jh.DOFS[j] for j in np.argsort(-weight[:, i]) if jh.DOFS[j] not in by_motion)
        by_motion[dof] = 2 * math.pi / math.sqrt(values[i].real) if values[i].real > 0 else math.nan
    return by_motion


def worked_out(model: Model, at_rest: bool) -> dict[str, Any]:
    """Mass, hydrostatics, added mass and periods of a model at its reference position; and `at_rest`, in equilibrium."""
    body, weight = model.body, model.environment.density * model.environment.gravity
    mass, stiffness = (np.asarray(x) for x in linearised(model, jnp.zeros(6)))
    equilibrium = jh.equilibrium(model) if at_rest else None
    own = next(load for load in model.loads if isinstance(load, jh.loads.Buoyancy)).upright(weight)
    values: dict[str, Any] = {
        "M_struc": np.asarray(body.mass_matrix()).tolist(),
        "added_mass": (mass - np.asarray(body.mass_matrix())).tolist(),
    }
    values |= {"volume": own["displaced_volume"], "stiffness": stiffness.tolist(), "periods": periods(mass, stiffness)}
    values["unbalanced"] = np.asarray(model.force_at_rest(jnp.zeros(6))).tolist()
    if equilibrium is not None:
        values["rest"] = np.asarray(equilibrium).tolist()
        values["periods_at_rest"] = periods(*(np.asarray(x) for x in linearised(model, equilibrium)))
    return values


def of_raft(statics: dict[str, Any]) -> dict[str, float]:
    """Natural periods (s) of RAFT's own matrices at the reference position (raft_fowt.py, solveEigen)."""
    stiffness = np.array(statics["C_struc"]) + np.array(statics["C_hydro"])
    stiffness = stiffness + np.array(statics.get("mooring_stiffness", np.zeros((6, 6))))
    stiffness[5, 5] += statics["yaw_stiffness"]
    return periods(np.array(statics["M_struc"]) + np.array(statics["A_hydro_morison"]), stiffness)


def ratio(ours: float, reference: float) -> str:
    """A relative difference as people read it."""
    if not (math.isfinite(ours) and math.isfinite(reference)) or abs(reference) < 1e-9:
        return "-"
    return f"{100 * (ours / reference - 1):+.2f} %" if abs(ours / reference - 1) >= 5e-5 else "< 0.005 %"


def table(head: tuple[str, ...], rows: list[list[str]]) -> str:
    """A table in Markdown."""
    return "\n".join(f"| {' | '.join(row)} |" for row in (head, ["---"] * len(head), *rows))


def text(results: dict[str, Any], raft: dict[str, Any]) -> str:
    """The page from the raw results alone."""
    statics, modes, hands = [], [], []
    for name, design in results.items():
        own, raft_design = design["converted"], raft.get(name)
        m, a = np.array(own["M_struc"]), np.array(own["added_mass"])
        title = f"{Path(name).parent.name}/{Path(name).stem}"
        if raft_design:
            structural, added = np.array(raft_design["M_struc"]), np.array(raft_design["A_hydro_morison"])
            hydro = np.array(raft_design["C_hydro"]) + np.array(raft_design["C_struc"])
            moor = np.array(design["mooring_stiffness"] or np.zeros((6, 6)))
            yaw = design["yaw_stiffness"] * np.eye(6)[5][:, None] * np.eye(6)[5]
            floating = np.array(own["stiffness"]) - moor - yaw
            row = [title, f"{m[0, 0] / 1e3:.2f}", ratio(m[0, 0], structural[0, 0])]
            row += [ratio(m[i, i], structural[i, i]) for i in (3, 5)]
            row += [f"{own['volume']:.2f}", ratio(own["volume"], raft_design["volume"])]
            row += [ratio(floating[i, i], hydro[i, i]) for i in (2, 4)]
            row += [ratio(a[i, i], added[i, i]) for i in (0, 2, 4)]
            statics.append(row)
            expected = of_raft(raft_design)
            row = [title]
            for dof in SHOWN:
                row += [f"{own['periods'][dof]:.2f}", ratio(own["periods"][dof], expected[dof])]
            lines = np.array(raft_design.get("mooring_stiffness", np.zeros((6, 6))))
            row += [ratio(moor[i, i], lines[i, i]) for i in (0, 2, 4)]
            modes.append([*row, f"{own['unbalanced'][2] / (9.81 * m[0, 0]):+.4f}"])
        if hand := design.get("built_in"):
            for dof in SHOWN:
                ours, by_hand = own["periods_at_rest"][dof], hand["periods_at_rest"][dof]
                hands.append([title, f"{dof} period (s)", f"{ours:.2f}", f"{by_hand:.2f}", ratio(ours, by_hand)])
            for label, ours, by_hand in (
                ("mass (t)", m[0, 0] / 1e3, np.array(hand["M_struc"])[0, 0] / 1e3),
                ("pitch inertia about the reference point (10^9 kg m²)", m[4, 4] / 1e9, np.array(hand["M_struc"])[4, 4] / 1e9),
                ("displaced volume of members (m³)", own["volume"], hand["volume"]),
            ):
                hands.append([title, label, f"{ours:.2f}", f"{by_hand:.2f}", ratio(ours, by_hand)])
    head = ("design", "mass (t)", "mass", "M44", "M66", "volume (m³)", "volume", "C33", "C55", "A11", "A33", "A55")
    tail = (
        "design",
        *(word for dof in SHOWN for word in (f"{dof} (s)", "difference")),
        "line C11",
        "line C33",
        "line C55",
        "net lift over weight",
    )
    treated = [
        f"- {Path(name).parent.name}/{Path(name).stem}: "
        + ", ".join(f"{count} {word}" for word, count in Counter(item["treatment"] for item in design["items"]).items())
        for name, design in results.items()
    ]
    return (
        "\n\n".join(
            [
                "# RAFT's designs as platform files",
                "Made by `python -m benchmarks.raft_designs RAFT_FOLDER` from RAFT at e6cb69e. Differences are from RAFT's own "
                "matrices (`benchmarks/raft/statics.json`), about the reference point, at the reference position, with "
                "strips of 0.25 m. Here strips are those of the platform file's default.",
                "## Mass, hydrostatics and added mass",
                table(head, statics),
                (
                    "- VolturnUS-S: RAFT's inertia of a level box has its sides exchanged (`raft_masses.member_axes`). "
                    "With them exchanged here, M44, M55 and M66 agree to 1e-11.\n"
                    "- OC4: at a step RAFT counts the inertia of the section before it twice. "
                    "That is 99.94 % of the difference in M44.\n"
                    "- RM1_Floating: the nacelle's 38.6 m³ are not in RAFT's run. Two braces that cross the surface have their "
                    "upper end first: RAFT takes the length from there to the surface as under water (29.5 m³ less), and their "
                    "waterplane as negative (C33). It counts the tops of the heave plates whole, under the columns too: "
                    "219.8 t of A33.\n"
                    "- FOCTT_example: its buoyant lines come to the surface and are left out. "
                    "The row of its lines and periods is without them."
                ),
                "## Natural periods and moorings",
                "Net lift is buoyancy less weight and the lines' pull, at the reference position.",
                table(tail, modes),
                "## Against the built-in platforms",
                table(("design", "quantity", "converted", "by hand", "difference"), hands),
                "## What became of the designs' items",
                "\n".join(treated),
            ]
        )
        + "\n"
    )


def main() -> None:
    """Read all designs that RAFT's results have, and write raw results and text."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="a copy of WISDEM/RAFT")
    parser.add_argument("--only", nargs="+", metavar="DESIGN", help="work out these, and keep the raw results of the others")
    given = parser.parse_args()
    raft = json.loads(STATICS.read_text("utf-8"))
    results = json.loads(RAW.read_text("utf-8")) if given.only else {}
    for name in given.only or raft:
        conversion = read_raft_design(given.folder / name)
        model = model_of(conversion)
        design: dict[str, Any] = {"converted": worked_out(model, name in BUILT_IN)}
        design["mooring_stiffness"] = stiffness_of_lines(model)
        design["yaw_stiffness"] = conversion.platform.get("stiffness", {}).get("C66", 0.0)
        design["items"] = [{"source": i.source, "treatment": i.treatment.value, "meaning": i.meaning} for i in conversion.items]
        if name in BUILT_IN:
            design["built_in"] = worked_out(jh.build(jh.load_platform(BUILT_IN[name])), True)
        results[name] = design
        print(name, flush=True)
        RAW.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    TEXT.write_text(text(results, raft), encoding="utf-8")
    print(TEXT)


if __name__ == "__main__":
    main()
