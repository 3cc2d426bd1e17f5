"""Nemoh's case folder: Nemoh.cal, results and mesh."""

from pathlib import Path

import numpy as np

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.conversion import Treatment
from jaxhydro.interop.nemoh_case import CASE_FILE, case_of
from jaxhydro.interop.nemoh_hydrostatics import read_nemoh_hydrostatics
from jaxhydro.interop.nemoh_tables import nemoh_headings, read_nemoh_excitation, read_nemoh_radiation
from jaxhydro.interop.panel_results.panel_case import PanelCase

RADIATION, FORCE, STIFFNESS, STATICS = "RadiationCoefficients.tec", "ExcitationForce.tec", "KH.dat", "Hydrostatics.dat"
PARTS = (".", "results", "mesh", "mechanics")  # folders of a case, in upper or lower case
OTHERS = {
    "CA.dat": "the tables of RadiationCoefficients.tec with fewer digits",
    "CM.dat": "the tables of RadiationCoefficients.tec with fewer digits",
    "Fe.dat": "the tables of ExcitationForce.tec with fewer digits",
    "DiffractionForce.tec": "a part of the wave force, which is taken whole",
    "FKForce.tec": "a part of the wave force, which is taken whole",
    "IRF.tec": "retardation functions, which are fitted anew",
    "RAO.dat": "motions in waves",
    "Inertia.dat": "a mass matrix of Nemoh's: state `rigid_body` by hand",
    "Inertia_hull.dat": "a mass matrix of the wetted shell: state `rigid_body` by hand",
}


def case_file(folder: Path) -> Path | None:
    """Nemoh.cal of a folder, in upper or lower case; None where there is none."""
    return next((path for path in sorted(folder.iterdir()) if path.name.lower() == CASE_FILE.lower()), None)


def read_nemoh_folder(folder: Path) -> PanelCase:
    """Case of a folder of Nemoh (v2 and v3).

    Args:
        folder: The folder that holds Nemoh.cal, or its folder of results.

    Raises:
        InputError: A file is broken, there is neither radiation nor excitation, or the case has several bodies.
    """
    folder = folder if case_file(folder) else folder.parent
    path = case_file(folder)
    if path is None:
        raise InputError(str(folder), [Problem("", CASE_FILE, "no such file")])
    if path.name != CASE_FILE:
        raise InputError(str(path), [Problem("", f"the name {CASE_FILE}", path.name, "Rename it.")])
    files = _files(folder)
    if not {RADIATION, FORCE} & set(files):
        raise InputError(str(folder), [Problem("", f"results/{RADIATION} or results/{FORCE}", "neither")])
    case = PanelCase("Nemoh", folder.resolve().name)
    water = case_of(files.get(RADIATION, files.get(FORCE, path)), 1)
    case.density, case.gravity, case.depth = water.density, water.gravity, water.depth
    case.files[CASE_FILE] = path
    case.say(CASE_FILE, Treatment.TAKEN, "`water`; the point that motions are about, and where waves have phase 0.")
    notes: list[str] = []
    if source := files.get(RADIATION):
        case.coefficients = read_nemoh_radiation(source, notes=notes)
        case.keys["radiation"], case.files[RADIATION] = {"file": RADIATION}, source
        text = f"`radiation`: added mass and damping at {len(case.coefficients.omega)} frequencies."
        case.say(RADIATION, Treatment.TAKEN, text)
    if source := files.get(FORCE):
        headings = nemoh_headings(source)
        case.force = read_nemoh_excitation(source, heading=float(headings[0]))
        case.keys["excitation"], case.files[FORCE] = {"file": FORCE}, source
        case.say(FORCE, Treatment.TAKEN, f"`excitation`: first-order wave forces; headings: {len(headings)}.")
    if STIFFNESS in files and STATICS in files:
        statics = read_nemoh_hydrostatics(files[STIFFNESS], density=water.density, gravity=water.gravity, notes=notes)
        case.volume = statics.volume
        case.centre = None if statics.centre_of_mass is None else np.array([0.0, 0.0, statics.centre_of_mass])
        case.keys["hydrostatics"] = {"file": STIFFNESS, "linear": True}
        case.files |= {STIFFNESS: files[STIFFNESS], STATICS: files[STATICS]}
        text = "`hydrostatics`: volume and stiffness. The weight in C44 and C55 is replaced by that of `rigid_body`."
        case.say(f"{STIFFNESS}, {STATICS}", Treatment.TAKEN, text)
    for note in dict.fromkeys(notes):
        case.say("tables", Treatment.TAKEN, f"{note}.")
    for name, what in OTHERS.items():
        if name in files:
            case.say(name, Treatment.LEFT_OUT, f"It holds {what}.")
    if any((folder / part / "QTF").is_dir() for part in ("results", "Results")):
        case.say("results/QTF", Treatment.LEFT_OUT, "Nemoh's quadratic transfer functions are not read.", warning=True)
    return case


def _files(folder: Path) -> dict[str, Path]:
    """Files of a case by name, the known ones spelled as Nemoh spells them."""
    spelled = {name.lower(): name for name in (RADIATION, FORCE, STIFFNESS, STATICS, *OTHERS)}
    parts = [folder, *(path for path in sorted(folder.iterdir()) if path.is_dir() and path.name.lower() in PARTS)]
    files: dict[str, Path] = {}
    for part in parts:
        for path in sorted(part.iterdir()):
            if path.is_file() and path.name.lower() in spelled:
                files.setdefault(spelled[path.name.lower()], path)
    return files
