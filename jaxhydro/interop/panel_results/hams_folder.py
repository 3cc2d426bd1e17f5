"""HAMS's case folder: tables in WAMIT's format, ControlFile.in and Hydrostatic.in."""

from pathlib import Path

import numpy as np

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.conversion import Treatment
from jaxhydro.interop.panel_results.fixed_text import matrix_after, numbers_after, text_of
from jaxhydro.interop.panel_results.panel_case import PanelCase
from jaxhydro.interop.panel_results.rigid_mass import is_rigid
from jaxhydro.interop.panel_results.wamit_tables_case import add_tables

CONTROL, HYDROSTATIC = "ControlFile.in", "Hydrostatic.in"
COLUMNS = {3: "rad/s", 4: "period"}  # Output_frequency_type
TABLES = ("Output/Wamit_format", "Wamit_format", ".")
INPUTS = ("Input", ".", "../Input", "../../Input")
DENSITY, GRAVITY = 1025.0, 9.807  # kg/m3, m/s2: constants of HAMS


def control_file(folder: Path) -> Path | None:
    """HAMS's control file of a case folder, or of a folder in it; None where there is none."""
    return next((path for part in INPUTS if (path := (folder / part / CONTROL)).is_file()), None)


def read_hams_folder(folder: Path, root: str | None = None) -> PanelCase:
    """Case of a folder of HAMS.

    Args:
        folder: The case's folder, its folder Output, or Wamit_format in that.
        root: Name of the tables without ending; None: the folder has one of each.

    Raises:
        InputError: A file is broken or missing, the reference is not at the origin, or the first column is no frequency.

    References:
        HAMS, SourceCode/HAMS_Prog.f90 and CertTest (YingyiLiu/HAMS on GitHub).
    """
    control = control_file(folder)
    if control is None:
        raise InputError(str(folder), [Problem("", CONTROL, "no such file")])
    tables = next((path for part in TABLES if (path := folder / part).is_dir() and _has_tables(path)), None)
    if tables is None:
        raise InputError(str(folder), [Problem("", "Output/Wamit_format with Buoy.1 and Buoy.3", "none")])
    case = PanelCase("HAMS", control.parent.parent.resolve().name, DENSITY, GRAVITY)
    length, by = _by_control(case, control)
    add_tables(case, tables, root, length, by)
    if (path := control.with_name(HYDROSTATIC)).is_file():
        _by_hydrostatic(case, path)
    return case


def _has_tables(folder: Path) -> bool:
    return any(path.suffix in (".1", ".3") for path in folder.iterdir())


def _by_control(case: PanelCase, path: Path) -> tuple[float, str]:
    """Unit of length (m) and first column of the tables."""
    text = text_of(path, "HAMS's ControlFile.in")

    def value(title: str, count: int = 1) -> list[float]:
        values = numbers_after(path, text, title, count)
        if values is None:
            raise InputError(str(path), [Problem(title, "a line that begins with it", "none")])
        return values

    (depth,), (kind,), (length,) = value("Waterdepth"), value("Output_frequency_type"), value("Reference_body_length")
    centre = value("Reference_body_center", 3)
    if int(kind) not in COLUMNS:
        expected = "3 (rad/s) or 4 (periods)"
        hint = "The tables have wave numbers or lengths. Let HAMS write frequencies or periods."
        raise InputError(str(path), [Problem("Output_frequency_type", expected, f"{kind:g}", hint)])
    if any(centre):
        found = ", ".join(f"{x:g}" for x in centre)
        hint = "The tables are about that point. Let HAMS compute about the origin at still water."
        raise InputError(str(path), [Problem("Reference_body_center", "0, 0, 0", found, hint)])
    case.depth = depth if depth > 0 else np.inf
    case.say(path.name, Treatment.TAKEN, f"`water.depth`; the first column of the tables: {COLUMNS[int(kind)]}.")
    meaning = f"`water`: {DENSITY:g} kg/m³ and {GRAVITY:g} m/s², which are constants of HAMS."
    case.say("density, gravity", Treatment.TAKEN, meaning)
    return length, COLUMNS[int(kind)]


def _by_hydrostatic(case: PanelCase, path: Path) -> None:
    """Add mass, damping and stiffness, which HAMS takes about its reference point."""
    text = text_of(path, "HAMS's Hydrostatic.in")
    mass = matrix_after(path, text, "Body Mass Matrix")
    if mass is not None and is_rigid(mass):
        case.mass = mass
    elif mass is not None:
        case.say(f"{path.name}: mass", Treatment.LEFT_OUT, "It is not that of a rigid body: an estimate is taken.")
    case.linear = matrix_after(path, text, "External Linear Damping Matrix")
    case.quadratic = matrix_after(path, text, "External Quadratic Damping Matrix")
    case.stiffness = matrix_after(path, text, "External Restoring Matrix")
