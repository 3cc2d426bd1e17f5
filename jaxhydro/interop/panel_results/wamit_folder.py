"""WAMIT's result folder: its tables, and water, volume, mass and body's place by the .out and .mmx files."""

import re
from pathlib import Path

import numpy as np

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.conversion import Treatment
from jaxhydro.interop.panel_results.fixed_text import matrix_after, numbers_after, text_of, to_float
from jaxhydro.interop.panel_results.panel_case import PanelCase
from jaxhydro.interop.panel_results.rigid_mass import is_rigid
from jaxhydro.interop.panel_results.wamit_mass_file import add_mass_file, find_mass_file
from jaxhydro.interop.panel_results.wamit_tables_case import add_tables, with_ending
from jaxhydro.interop.wamit_hydrostatics import VOLUMES, read_hydrostatics

MASS = "Global body and external mass matrix"
DAMPING = "Global external damping matrix"
STIFFNESS = "Global external stiffness matrix"
COLUMNS = {1: "period", 2: "rad/s"}  # IPEROUT
_PERIODS = re.compile(r"^\s*IPEROUT\s*=\s*(\d+)", re.IGNORECASE | re.MULTILINE)


def read_wamit_folder(folder: Path, root: str | None = None) -> PanelCase:
    """Case of a folder of WAMIT's results.

    Args:
        folder: The folder.
        root: Name of the tables without ending; None: the folder has one of each.

    Raises:
        InputError: A file is broken, the body is not at the origin, or the first column is a wave number.
    """
    case = PanelCase("WAMIT", root or "")
    length = _by_out(case, folder)
    masses = find_mass_file(folder, root)
    if masses is not None:
        add_mass_file(case, masses)
        length = length or masses.length
    length = length or _by_gdf(case, folder) or 1.0
    if case.depth is None:
        _by_pot(case, folder)
    add_tables(case, folder, root, length, _column(case, folder), None if masses is None else float(masses.gravity_centre[2]))
    return case


def _by_out(case: PanelCase, folder: Path) -> float | None:
    """Add what the .out file says; its unit of length (m), or None without such a file."""
    texts = {path: text_of(path, "WAMIT's .out file") for path in sorted(folder.iterdir()) if _is_out(path)}
    texts = {path: text for path, text in texts.items() if VOLUMES in text}
    if not texts:
        return None
    path = max(texts, key=lambda one: MASS in texts[one])  # the first that has a mass matrix, else the first
    text = texts[path]
    for other in texts:
        if other != path:
            case.say(other.name, Treatment.LEFT_OUT, f"Water, hydrostatics and mass are those of {path.name}.")
    if text.count(VOLUMES) > 1:
        hint = "Name the tables and `body` in a platform file by hand (docs/formats.md)."
        raise InputError(str(path), [Problem("", "results of one body", f"{text.count(VOLUMES)} bodies", hint)])
    place = numbers_after(path, text, "XBODY =", 1), numbers_after(path, text, "YBODY =", 1)
    height, turn = numbers_after(path, text, "ZBODY =", 1), numbers_after(path, text, "PHIBODY =", 1)
    moved = [values[0] for values in (*place, height, turn) if values]
    if any(moved):
        found = ", ".join(f"{value:g}" for value in moved)
        hint = "The tables are about that point. Let WAMIT compute about the origin at still water."
        raise InputError(str(path), [Problem("XBODY(1-4)", "0, 0, 0, 0", found, hint)])
    gravity, length = numbers_after(path, text, "Gravity:", 1), numbers_after(path, text, "Length scale:", 1)
    density = numbers_after(path, text, "Water density:", 1)
    depth = re.search(r"Water depth:\s*(\S+)", text)
    case.gravity, case.density = gravity[0] if gravity else None, density[0] if density else None
    if depth:
        value = to_float(depth[1])
        case.depth = value if value > 0 else np.inf  # the word "infinite" is NaN
    unit = length[0] if length else 1.0
    case.say(path.name, Treatment.TAKEN, "`water`: density, gravity and depth; the body is at the origin.")
    statics = read_hydrostatics(path, *case.water(), length=unit)
    case.volume, case.mass = statics.volume, matrix_after(path, text, MASS)
    centre = numbers_after(path, text, "Center of Gravity  (Xg,Yg,Zg):", 3)
    case.centre = None if centre is None or case.mass is not None else np.array(centre)
    name = path.name if path.suffix.lower() == ".out" else f"{path.name.split('.')[0]}.out"
    case.files[name] = path
    case.keys["hydrostatics"] = {"file": name} | ({"length": unit} if unit != 1.0 else {}) | {"linear": True}
    meaning = "`hydrostatics`: volume and stiffness. The weight in C44 and C55 is replaced by that of `rigid_body`."
    case.say(f"{path.name}: restoring", Treatment.TAKEN, meaning)
    if case.mass is not None and not is_rigid(case.mass):
        case.say(f"{path.name}: {MASS}", Treatment.LEFT_OUT, "It is not that of a rigid body: an estimate is taken.")
        case.mass = None
    case.linear, case.stiffness = matrix_after(path, text, DAMPING), matrix_after(path, text, STIFFNESS)
    return unit


def _is_out(path: Path) -> bool:
    """Whether a name is that of WAMIT's .out file; public decks call it hull.out.wamit."""
    return path.is_file() and ".out" in (suffix.lower() for suffix in path.suffixes)


def _by_gdf(case: PanelCase, folder: Path) -> float | None:
    """Unit of length (m) by the geometry file, whose second line is ULEN and GRAV; None without such a file."""
    if (path := with_ending(folder, ".gdf")) is None:
        return None
    lines = text_of(path, "WAMIT's .gdf file").splitlines()
    values = [to_float(word) for word in (lines[1].split() if len(lines) > 1 else [])[:2]]
    if len(values) < 2 or not np.isfinite(values).all() or min(values) <= 0:
        found = lines[1][:60] if len(lines) > 1 else "the end of the file"
        raise InputError(str(path), [Problem("line 2", "ULEN and GRAV, both above 0", found)])
    case.gravity = values[1]
    case.say(path.name, Treatment.TAKEN, f"Unit of length {values[0]:g} m, gravity {values[1]:g} m/s².")
    return values[0]


def _by_pot(case: PanelCase, folder: Path) -> None:
    """Depth by the potential control file, whose second line begins with HBOT."""
    if (path := with_ending(folder, ".pot")) is None:
        return
    lines = text_of(path, "WAMIT's .pot file").splitlines()
    word = lines[1].split()[:1] if len(lines) > 1 else []
    value = to_float(word[0]) if word else np.nan
    if not np.isfinite(value):
        raise InputError(str(path), [Problem("line 2", "HBOT, the depth of the water", word[0] if word else "nothing")])
    case.depth = value if value > 0 else np.inf
    case.say(path.name, Treatment.TAKEN, "`water.depth`.")


def _column(case: PanelCase, folder: Path) -> str:
    """What the first column of the tables is, by IPEROUT of the .cfg file."""
    if (path := with_ending(folder, ".cfg")) is None:
        return "period"
    match = _PERIODS.search(text_of(path, "WAMIT's .cfg file"))
    kind = int(match[1]) if match else 1
    if kind not in COLUMNS:
        raise InputError(str(path), [Problem("IPEROUT", "1 (periods) or 2 (rad/s)", f"{kind}, a wave number")])
    if match:
        case.say(f"{path.name}: IPEROUT", Treatment.TAKEN, f"The first column of the tables: {COLUMNS[kind]}.")
    return COLUMNS[kind]
