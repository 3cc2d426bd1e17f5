"""Platform file of a panel program's results, with what has to be filled in by hand."""

import math
from typing import Any

import numpy as np
from jaxtyping import Float

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.conversion import Conversion, Treatment
from jaxhydro.interop.openfast.added_terms import matrix_entries
from jaxhydro.interop.openfast.mass_parts import tidy
from jaxhydro.interop.panel_results.infinite_added_mass import infinite_added_mass
from jaxhydro.interop.panel_results.panel_case import DENSITY, GRAVITY, PanelCase
from jaxhydro.interop.panel_results.rigid_mass import centre_of, inertia_of, long_wave_mass

DEEP_KH = 2 * math.pi  # k h from which on no wave of the tables feels the bed
MAX_DEPTH = 10_000.0  # m, of a depth that is assumed
MAX_SPREAD = 0.1  # of the added mass of infinite frequency over frequency, above which it is warned of
LEAST_SIZE = 0.01  # of the largest motion's own square root, with which rounding is compared
MIN_SHARE = 1e-6  # of two motions' own, below which a coupling is rounding


def platform_skeleton(case: PanelCase, depth: float | None = None) -> Conversion:
    """Conversion of a case: tables and water, estimates of mass, and what to fill in.

    Args:
        case: The case.
        depth: Of the water where the case states none, m: that of the mooring lines. None: it is assumed.

    Raises:
        InputError: Nothing tells the mass, or no state space follows the damping.
    """
    if case.depth is None and depth is not None:
        case.depth = depth
        text = f"Results do not say it: {depth:g} m is taken, the depth of the mooring lines."
        case.say("water.depth", Treatment.TO_FILL_IN, text)
    platform: dict[str, Any] = {"name": case.name, "water": _water(case)}
    platform["rigid_body"] = _rigid_body(case)
    platform |= _matrices(case)
    if "hydrostatics" not in case.keys:
        text = "There is none: nothing restores heave, roll and pitch. Give displaced_volume, C33, C44 and C55."
        case.say("hydrostatics", Treatment.TO_FILL_IN, text, warning=True)
    if "radiation" in case.keys:
        platform |= _added_mass(case)
    else:
        text = "There is no radiation: give `added_mass` and `linear_damping`."
        case.say("radiation", Treatment.TO_FILL_IN, text, warning=True)
    if "excitation" not in case.keys:
        case.say("excitation", Treatment.TO_FILL_IN, "There are no wave forces: the platform does not move in waves.")
    platform |= {key: case.keys[key] for key in ("hydrostatics", "radiation", "excitation", "drift") if key in case.keys}
    text = "`directions: earth`: tables act along the axes of the upright platform."
    case.say("axes", Treatment.TAKEN, text)
    text = "Tables have no viscous damping. Give linear_damping and quadratic_damping, or members with Cd."
    case.say("quadratic_damping", Treatment.TO_FILL_IN, text)
    return Conversion(platform | {"directions": "earth"}, tuple(case.items), case.files)


def _water(case: PanelCase) -> dict[str, float]:
    """Section `water`, with assumed values where results do not say."""
    for key, value, usual, unit in (
        ("density", case.density, DENSITY, "kg/m³"),
        ("gravity", case.gravity, GRAVITY, "m/s²"),
    ):
        if value is None:
            case.say(f"water.{key}", Treatment.TO_FILL_IN, f"Results do not say it: {usual:g} {unit} is assumed.")
    density, gravity = case.water()
    depth = case.depth
    if depth is None or not math.isfinite(depth):
        depth, given = _deep(case, gravity), case.depth is not None
        why = "Results are for deep water" if given else "Results do not say it"
        text = f"{why}: {depth:g} m is assumed, in which no wave of the tables feels the bed. Moorings need the true depth."
        case.say("water.depth", Treatment.TO_FILL_IN, text)
    return {"density": tidy(density), "depth": tidy(depth), "gravity": tidy(gravity)}


def _deep(case: PanelCase, gravity: float) -> float:
    """A depth (m), with two digits, in which the longest wave of the tables is one of deep water."""
    tables = [table.omega for table in (case.force, case.coefficients) if table is not None]
    omega = min(float(np.asarray(table)[0]) for table in tables)
    depth = min(MAX_DEPTH, DEEP_KH * gravity / omega**2)
    digit = 10.0 ** (math.floor(math.log10(depth)) - 1)
    return math.ceil(depth / digit) * digit


def _rigid_body(case: PanelCase) -> dict[str, Any]:
    """Section `rigid_body`: of a mass matrix, or an estimate."""
    if case.mass is not None:
        inertia = inertia_of(case.mass)
        case.say("mass matrix", Treatment.TAKEN, "`rigid_body`: mass, centre and inertia.")
        return _section(float(case.mass[0, 0]), centre_of(case.mass), inertia)
    density, _ = case.water()
    if case.volume is not None:
        mass, how = density * case.volume, "the displaced mass is taken. Subtract the vertical pull of the moorings."
    elif (estimate := long_wave_mass(case)) is not None:
        mass, how = estimate, "the displaced mass is estimated by the force of the longest wave."
    elif case.coefficients is not None:
        mass = float(np.diag(case.coefficients.added_mass[0])[:2].max())
        how = "the added mass in surge is taken. The true mass may be three times as large."
    else:
        expected = "a file that tells the mass or the volume: hydrostatics with the volume, or radiation"
        raise InputError(case.name, [Problem("rigid_body.mass", expected, f"none among {case.program}'s results")])
    case.say("rigid_body.mass", Treatment.TO_FILL_IN, f"Results do not have it: {how}")
    if case.centre is None:
        text = "Results do not have it: the reference point is assumed."
    else:
        text = "That of the program's input is taken, which may be the origin or the centre of the displaced water."
    case.say("rigid_body.centre_of_mass", Treatment.TO_FILL_IN, text)
    radius = (mass / density) ** (1 / 3)
    text = f"Results do not have it: radii of gyration of {radius:.3g} m, the cube root of the volume, are assumed."
    case.say("rigid_body.inertia", Treatment.TO_FILL_IN, text)
    centre = np.zeros(3) if case.centre is None else case.centre
    return _section(mass, centre, mass * radius**2 * np.eye(3))


def _section(mass: float, centre: Float[np.ndarray, "3"], inertia: Float[np.ndarray, "3 3"]) -> dict[str, Any]:
    """Section `rigid_body` of numbers; products of inertia and offsets that are rounding are left out."""
    length = math.sqrt(np.trace(inertia) / mass)
    centre = np.where(np.abs(centre) > MIN_SHARE * length, centre, 0.0)
    entries = {
        f"I{a}{b}": inertia[i, j] for (i, a), (j, b) in ((p, q) for p in enumerate("xyz") for q in enumerate("xyz")) if i <= j
    }
    sizable = {
        key: tidy(value) for key, value in entries.items() if key[1] == key[2] or abs(value) > MIN_SHARE * np.trace(inertia)
    }
    ordered = {key: sizable[key] for key in ("Ixx", "Iyy", "Izz", "Ixy", "Ixz", "Iyz") if key in sizable}
    return {"mass": tidy(mass), "centre_of_mass": [tidy(x) for x in centre], "inertia": ordered}


def _matrices(case: PanelCase) -> dict[str, Any]:
    """Damping and stiffness that stand beside the tables."""
    sections: dict[str, Any] = {}
    if case.linear is not None and case.linear.any():
        sections["linear_damping"] = matrix_entries("B", 0.5 * (case.linear + case.linear.T))
        case.say("external damping", Treatment.TAKEN, "`linear_damping`.")
    if case.quadratic is not None and case.quadratic.any():
        diagonal = np.diag(np.diag(case.quadratic))
        sections["quadratic_damping"] = matrix_entries("B", diagonal)
        whole = np.array_equal(diagonal, case.quadratic)
        text = "`quadratic_damping`." if whole else "`quadratic_damping` of the diagonal; couplings are left out."
        case.say("external quadratic damping", Treatment.TAKEN if whole else Treatment.APPROXIMATED, text)
    return sections | {"mooring": _mooring(case)}


def _mooring(case: PanelCase) -> dict[str, Any]:
    """Section `mooring`: a stiffness that was stated beside the tables, with the pull that balances the platform, or none."""
    if case.stiffness is None or not case.stiffness.any():
        text = "There is none: nothing holds the platform in surge, sway and yaw. Give `mooring`."
        case.say("mooring", Treatment.TO_FILL_IN, text)
        return {"kind": "none"}
    symmetric = 0.5 * (case.stiffness + case.stiffness.T)
    density, gravity = case.water()
    pull = 0.0
    if case.mass is not None and case.volume is not None:
        pull = gravity * (float(case.mass[0, 0]) - density * case.volume)
    same = np.array_equal(symmetric, case.stiffness)
    text = f"`mooring`: the stiffness, and the pull of {pull:.4g} N that lets the platform rest where the tables have it."
    text += "" if same else " Of mirrored entries the mean is taken."
    case.say("external stiffness", Treatment.APPROXIMATED, text)
    case.say("mooring", Treatment.TO_FILL_IN, "It is linear: give lines in its place where they are known.")
    rows = [[tidy(value) for value in row] for row in symmetric]
    return {"kind": "stiffness_matrix", "stiffness": rows, "preload": [0.0, 0.0, tidy(pull), 0.0, 0.0, 0.0]}


def _added_mass(case: PanelCase) -> dict[str, Any]:
    """Added mass of infinite frequency: the file's, or by its damping."""
    assert case.coefficients is not None
    file = case.keys["radiation"]["file"]
    if case.coefficients.infinite is not None:
        case.keys["radiation"]["added_mass"] = "file"
        case.say(f"{file}: infinite frequency", Treatment.TAKEN, "`radiation.added_mass: file`.")
        return {}
    matrix, spread = infinite_added_mass(case.coefficients, str(case.files[file]))
    size = np.sqrt(np.abs(np.diag(matrix)))
    size = np.maximum(size, LEAST_SIZE * np.repeat([size[:3].max(), size[3:].max()], 3))
    matrix[np.abs(matrix) <= MIN_SHARE * np.outer(size, size)] = 0.0
    text = (
        "`added_mass`: the file lacks infinite frequency. It is the added mass less that of the damping's memory (Kramers and "
        f"Kronig), constant over frequency within {100 * spread:.2g} %."
    )
    case.say(f"{file}: infinite frequency", Treatment.APPROXIMATED, text, warning=spread > MAX_SPREAD)
    return {"added_mass": matrix_entries("A", matrix)}
