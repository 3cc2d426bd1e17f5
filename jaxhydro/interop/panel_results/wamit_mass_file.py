"""WAMIT's .mmx file: volume, centres and mass matrix of a body, with external damping and stiffness."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxhydro.errors import InputError, Problem, shown
from jaxhydro.interop.conversion import Treatment
from jaxhydro.interop.panel_results.fixed_text import numbers_after, text_of, to_float
from jaxhydro.interop.panel_results.panel_case import PanelCase
from jaxhydro.interop.panel_results.rigid_mass import MAX_RATIO, is_rigid
from jaxhydro.interop.panel_results.wamit_tables_case import with_ending
from jaxhydro.interop.wamit_hydrostatics import VOLUMES

NORMALIZED, EXTERNAL = "Normalized mass matrix", "External force matrices"
COLUMNS = {NORMALIZED: ("MASS(I,J)/RHO",), EXTERNAL: ("MASS(I,J)", "DAMP(I,C)", "STIF(I,J)")}
OF_ONE_BODY = "Name the tables and `body` in a platform file by hand (docs/formats.md)."
SAME = 1e-3  # relative difference of two files' volumes or masses that are of one run
MIN_OFFSET = 1e-3  # of the cube root of the volume, from which a centre of buoyancy is off the axis
Matrix6 = Float[np.ndarray, "6 6"]


class MassFile(NamedTuple):
    """Contents of an .mmx file. All but volume and gravity are about the origin of the body's axes.

    Attributes:
        path: The file.
        gravity: Acceleration g (m/s²).
        length: Unit of length L, WAMIT's ULEN (m).
        volume: Displaced volume (m³).
        buoyancy: Centre of buoyancy (m).
        gravity_centre: Centre of mass of the weight in WAMIT's C44 and C55 (m).
        mass: Mass matrix (kg, kg m, kg m²), or over the density (m³, m⁴, m⁵).
        normalized: Whether the mass matrix is over the density: then it is that of the displaced water's mass.
        damping: External damping (N s/m, N s, N m s), or None.
        stiffness: External stiffness (N/m, N, N m), or None.
    """

    path: Path
    gravity: float
    length: float
    volume: float
    buoyancy: Float[np.ndarray, "3"]
    gravity_centre: Float[np.ndarray, "3"]
    mass: Matrix6
    normalized: bool
    damping: Matrix6 | None = None
    stiffness: Matrix6 | None = None


def read_mass_file(path: Path) -> MassFile:
    """Read WAMIT's .mmx file of one body.

    With IALTFRC 1 it has the mass matrix over the density. With IALTFRC 2 it has mass, damping and stiffness of the force
    control file, in that file's units.

    Args:
        path: The file.

    Returns:
        Its contents.

    Raises:
        InputError: With the line that is wrong, or the number of bodies.

    References:
        WAMIT user manual, sections 4.3 and 4.4 (the two forms of the force control file).
    """
    text = text_of(path, "WAMIT's .mmx file")

    def numbers(title: str, count: int) -> list[float]:
        values = numbers_after(path, text, title, count)
        if values is None:
            raise InputError(str(path), [Problem("", f"a line with {title.rstrip(':')}", "none")])
        return values

    bodies = max(text.count(VOLUMES), int((numbers_after(path, text, "NBODY =", 1) or [1.0])[0]))
    if bodies > 1:
        raise InputError(str(path), [Problem("", "results of one body", f"{bodies} bodies", OF_ONE_BODY)])
    (gravity,), (length,) = numbers("Gravity:", 1), numbers("Length scale:", 1)
    volume = float(np.median(numbers(VOLUMES, 3)))
    for name, value in (("Gravity", gravity), ("Length scale", length), (VOLUMES, volume)):
        if value <= 0:
            raise InputError(str(path), [Problem(name, "a number above 0", f"{value:g}")])
    buoyancy, centre = np.array(numbers("(Xb,Yb,Zb)", 3)), np.array(numbers("(Xg,Yg,Zg)", 3))
    if buoyancy[2] >= 0:
        hint = "The body's axes are below still water. Let WAMIT compute about the origin at still water."
        raise InputError(str(path), [Problem("Zb", "a centre of buoyancy below 0", f"{buoyancy[2]:g}", hint)])
    lines = text.splitlines()
    first, title = next(
        ((i, title) for i, line in enumerate(lines) for title in COLUMNS if title.lower() in line.lower()), (len(lines), "")
    )
    if not title:
        raise InputError(str(path), [Problem("", f"a table {NORMALIZED} or {EXTERNAL}", "none")])
    tables = _tables(path, lines, first + 2, len(COLUMNS[title]))
    return MassFile(path, gravity, length, volume, buoyancy, centre, tables[0], title == NORMALIZED, *tables[1:])


def _tables(path: Path, lines: list[str], first: int, count: int) -> list[Matrix6]:
    """Matrices of rows I, J and `count` numbers, from the line with index `first` to the end."""
    names = COLUMNS[NORMALIZED if count == 1 else EXTERNAL]
    tables = np.full((count, 6, 6), np.nan)
    for number, line in enumerate(lines[first:], first + 1):
        if not (words := line.split()):
            continue
        where, values = f"line {number}", [to_float(word) for word in words]
        if len(words) != 2 + count or not np.isfinite(values).all():
            raise InputError(str(path), [Problem(where, f"numbers I J {' '.join(names)}", shown(line.strip()[:60]))])
        if not (words[0].isdigit() and words[1].isdigit() and 1 <= int(words[0]) <= 6 and 1 <= int(words[1]) <= 6):
            hint = "More are motions of further bodies or generalized modes." if min(values[:2]) > 0 else ""
            raise InputError(str(path), [Problem(where, "motions I and J from 1 to 6", " ".join(words[:2]), hint)])
        i, j = int(words[0]) - 1, int(words[1]) - 1
        if not np.isnan(tables[0, i, j]):
            raise InputError(str(path), [Problem(where, "each pair I J once", f"{i + 1} {j + 1} again")])
        tables[:, i, j] = values[2:]
    if missing := int(np.isnan(tables[0]).sum()):
        raise InputError(str(path), [Problem(names[0], "36 rows, I and J from 1 to 6", f"{36 - missing} rows")])
    return list(tables)


def find_mass_file(folder: Path, root: str | None) -> MassFile | None:
    """Contents of the folder's .mmx file, with a root name where one is given; None without such a file.

    Raises:
        InputError: There are several, or it is broken.
    """
    path = with_ending(folder, ".mmx", root)
    return read_mass_file(path) if path else None


def add_mass_file(case: PanelCase, file: MassFile) -> None:
    """Add to a case what the .mmx file says and the .out file does not.

    Args:
        case: The case, with its water and what the .out file says.
        file: Contents of the .mmx file.

    Raises:
        InputError: The .out file has another volume or mass, or the mass does not go with the volume.
    """
    path, (density, _) = file.path, case.water()
    mass = file.mass * (density if file.normalized else 1.0)
    if case.volume is not None:
        _compare(path, "volume (m³)", file.volume, case.volume)
    if case.mass is not None and mass[0, 0] > 0:
        _compare(path, "MASS(1,1) (kg)", mass[0, 0], case.mass[0, 0])
    ratio = mass[0, 0] / (density * file.volume)
    if file.normalized and abs(ratio - 1) > 0.01:
        expected = f"the volume, {file.volume:g} m³, as the mass is that of the displaced water"
        raise InputError(str(path), [Problem("MASS(1,1)/RHO", expected, f"{file.mass[0, 0]:g}")])
    if mass[0, 0] > 0 and not 1 / MAX_RATIO < ratio < MAX_RATIO:
        expected = f"a mass near that of the displaced water, {density * file.volume:.4g} kg"
        hint = "The file is in the units of RHO of the .frc file. Add the .out file, which has that density."
        raise InputError(str(path), [Problem("MASS(1,1)", expected, f"{mass[0, 0]:.4g} kg", hint)])
    case.gravity = file.gravity if case.gravity is None else case.gravity
    text = f"Displaced volume {file.volume:g} m³, its centre at {', '.join(f'{x:g}' for x in file.buoyancy)} m."
    case.say(f"{path.name}: volume", Treatment.TAKEN, text)
    case.volume = file.volume if case.volume is None else case.volume
    if np.abs(file.buoyancy[:2]).max() > MIN_OFFSET * file.volume ** (1 / 3):
        text = "It is off the vertical axis: its moment is left out. The platform rests upright in balance with it."
        case.say(f"{path.name}: centre of buoyancy", Treatment.LEFT_OUT, text, warning=True)
    _add_mass(case, file, mass)
    for name, matrix in (("linear", file.damping), ("stiffness", file.stiffness)):
        if getattr(case, name) is None:
            setattr(case, name, matrix)


def _compare(path: Path, what: str, value: float, other: float) -> None:
    """Refuse a value that differs from the .out file's."""
    if abs(value - other) > SAME * abs(other):
        hint = "The two files are not of one run. Remove the old one."
        raise InputError(str(path), [Problem(what, f"that of the .out file, {other:g}", f"{value:g}", hint)])


def _add_mass(case: PanelCase, file: MassFile, mass: Matrix6) -> None:
    """Add the mass matrix where it is that of a rigid body, else what it has."""
    name, (density, _) = file.path.name, case.water()
    if case.mass is not None:
        case.say(f"{name}: mass matrix", Treatment.LEFT_OUT, "That of the .out file is taken, which is the same.")
    elif is_rigid(mass):
        case.mass, case.centre = mass, None
        if file.normalized:
            how = f"IALTFRC 1: MASS/RHO times {density:g} kg/m³ is the mass of the displaced water."
            text = f"{how} Subtract the pull of the moorings."
            case.say("rigid_body.mass", Treatment.TO_FILL_IN, text)
    else:
        case.centre = file.gravity_centre if case.centre is None else case.centre
        why = "It has no inertia" if mass[0, 0] > 0 and not mass[3:, 3:].any() else "It is not that of a rigid body"
        text = f"{why}: volume and centre of mass are taken, and an inertia is estimated."
        case.say(f"{name}: mass matrix", Treatment.LEFT_OUT, text)
