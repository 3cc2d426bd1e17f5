"""A dataset of Capytaine (NetCDF) as a case."""

from pathlib import Path

import numpy as np

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.capytaine_dataset import PAIR, Dataset, open_capytaine
from jaxhydro.interop.capytaine_radiation import motions, read_capytaine, single
from jaxhydro.interop.capytaine_waves import (
    PARTS,
    WHOLE,
    capytaine_headings,
    read_capytaine_excitation,
    read_capytaine_hydrostatics,
)
from jaxhydro.interop.conversion import Treatment
from jaxhydro.interop.panel_results.panel_case import PanelCase
from jaxhydro.interop.panel_results.rigid_mass import is_rigid

INERTIA = "inertia_matrix"


def read_capytaine_file(path: Path) -> PanelCase:
    """Case of a dataset of one body.

    Args:
        path: The file.

    Raises:
        InputError: It is broken, has several bodies, or has neither radiation nor excitation.
    """
    dataset = open_capytaine(path, ())
    variables, notes = set(map(str, dataset.data.variables)), list[str]()
    case = PanelCase("Capytaine", path.stem, dataset.number("rho"), dataset.number("g"), _depth(dataset))
    case.files[path.name] = path
    if "added_mass" in variables:
        case.coefficients = read_capytaine(path, notes=notes)
        case.keys["radiation"] = {"file": path.name}
        text = f"`radiation`: added mass and damping at {len(case.coefficients.omega)} frequencies."
        case.say("added_mass, radiation_damping", Treatment.TAKEN, text)
    if WHOLE in variables or set(PARTS) <= variables:
        headings = capytaine_headings(dataset)
        case.force = read_capytaine_excitation(path, heading=float(headings[0]), notes=notes)
        case.keys["excitation"] = {"file": path.name}
        case.say(WHOLE, Treatment.TAKEN, f"`excitation`: first-order wave forces; headings: {len(headings)}.")
    if not case.keys:
        expected = f"added_mass and radiation_damping, or {WHOLE}"
        raise InputError(str(path), [Problem("", expected, ", ".join(sorted(variables)) or "no variables")])
    if "hydrostatic_stiffness" in variables:
        _hydrostatics(case, path, notes)
    if INERTIA in variables:
        case.mass = _mass(dataset)
        if case.mass is None:
            case.say(INERTIA, Treatment.LEFT_OUT, "It is not that of a rigid body in six motions: an estimate is taken.")
    for note in dict.fromkeys(notes):
        case.say("dataset", Treatment.TAKEN, f"{note.removeprefix(f'{path}: ')}.")
    return case


def _hydrostatics(case: PanelCase, path: Path, notes: list[str]) -> None:
    """Add the hydrostatics of a dataset."""
    statics = read_capytaine_hydrostatics(path, notes=notes)
    case.volume = statics.volume
    case.centre = None if statics.centre_of_mass is None else np.array([0.0, 0.0, statics.centre_of_mass])
    case.keys["hydrostatics"] = {"file": path.name, "linear": True}
    text = "`hydrostatics`: volume and stiffness. The weight in C44 and C55 is replaced by that of `rigid_body`."
    case.say("hydrostatic_stiffness", Treatment.TAKEN, text)
    if statics.volume is None or statics.centre_of_mass is None:
        case.keys["hydrostatics"]["weight"] = "included"


def _depth(dataset: Dataset) -> float | None:
    """Depth of the water (m), infinity where it is deep; None where the dataset does not say."""
    if "water_depth" not in dataset.data.variables or dataset.data["water_depth"].size != 1:
        return None
    return float(dataset.data["water_depth"].values.reshape(()))


def _mass(dataset: Dataset) -> np.ndarray | None:
    """Mass matrix about the reference point (kg, kg m, kg m²); None where it is not that of a rigid body."""
    rows = [motions(dataset, INERTIA, dim) for dim in reversed(PAIR)]
    if any(len(row) < 6 for row in rows):
        return None
    values = np.asarray(single(dataset, INERTIA, PAIR).transpose(*reversed(PAIR)).values, float)
    matrix = np.zeros((6, 6))
    matrix[np.ix_(*rows)] = values
    matrix = dataset.shift.T @ matrix @ dataset.shift
    return matrix if is_rigid(matrix) else None
