"""Added mass, radiation damping and first-order wave forces from Nemoh's Tecplot files.

References:
    Nemoh v2.03 and v3.0.2, Common/Results.f90: SaveTResults; Common/Environment.f90: Compute_Wave.
"""

import re
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Complex, Float

from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError, Problem, shown
from jaxhydro.interop.computed_water import density_scale, water_notes, wave_phase
from jaxhydro.interop.nemoh_case import case_of
from jaxhydro.interop.radiation_coefficients import RadiationCoefficients
from jaxhydro.interop.wamit_tables import distinct, same_heading, to_omega
from jaxhydro.waves.excitation import DirectionalExcitation, Excitation

MIN_FREQUENCIES = 4  # of radiation
UNITS = {"rad/s": "rad/s", "Hz": "Hz", "s": "period"}  # of the first column, as `to_omega` has them
_UNIT = re.compile(r"VARIABLES\s*=\s*\"[^(\"]*\(([^)]*)\)", re.IGNORECASE)
_COLUMN = re.compile(r"\"(A|abs\(F)\s*(\d+)\s+(\d+)\)?\"")
_MOTION = re.compile(r"Motion of body\s*(\d+)\s*in DoF\s*(\d+)", re.IGNORECASE)
_HEADING = re.compile(r"force - beta =\s*([-+.\dE]+)\s*deg", re.IGNORECASE)
_NO_LETTER = re.compile(r"(\d)([-+]\d{3})\b")  # Fortran leaves the E out where an exponent has three digits


class _Zone(NamedTuple):
    """A zone of a file: its title, and its rows of a frequency and pairs of numbers."""

    title: str
    rows: Float[np.ndarray, "n c"]


class _File(NamedTuple):
    """Tecplot file.

    Attributes:
        by: Kind of the first column: "period", "rad/s" or "Hz".
        forces: Body and number of each force.
        zones: Zones.
    """

    by: str
    forces: list[tuple[int, int]]
    zones: list[_Zone]


def read_nemoh_radiation(
    path: str | PathLike[str], *, body: int | None = None, density: float | None = None, notes: list[str] | None = None
) -> RadiationCoefficients:
    """Read RadiationCoefficients.tec: A (kg, kg m, kg m²) and B (N s/m, N s, N m s) by motion and force.

    Coefficients about another point, which Nemoh.cal says, are moved to the reference point.

    Args:
        path: The file.
        body: Number of the body, from 1; None: the file has one.
        density: Of the platform's water (kg/m³), to which forces are scaled; None: Nemoh's own.
        notes: What is moved or scaled is appended here.

    Raises:
        InputError: With what is wrong, in this file or in Nemoh.cal.
    """
    file = _read(path)
    mine, columns = _columns(path, file, body)
    case = case_of(Path(path), mine)
    titles = [_MOTION.search(zone.title) for zone in file.zones]
    zones = {(int(match[1]), int(match[2])): zone for match, zone in zip(titles, file.zones) if match}
    if missing := [dof for i, dof in enumerate(DOFS, 1) if (mine, i) not in zones]:
        raise _wrong(path, f"a zone of motion in {', '.join(missing)} of body {mine}", f"{len(zones)} zones of motions")
    order, omega = _frequencies(path, file, zones[mine, 1].rows[:, 0], MIN_FREQUENCIES)
    rows = np.stack([zones[mine, i].rows[order] for i in range(1, 7)], axis=2)  # frequency, column, motion
    remarks = list(case.notes)
    scale = density_scale(str(path), case.density, density, remarks)
    added, damping = (scale * case.shift.T @ rows[:, [c + part for c in columns], :] @ case.shift for part in (0, 1))
    if notes is not None:
        notes += remarks
    return RadiationCoefficients(omega, added, damping)


def read_nemoh_excitation(
    path: str | PathLike[str],
    *,
    heading: float = 0.0,
    body: int | None = None,
    density: float | None = None,
    gravity: float | None = None,
    depth: float | None = None,
    notes: list[str] | None = None,
) -> Excitation:
    """Read ExcitationForce.tec for waves of one heading.

    Nemoh's quantities go with exp(-i omega t), and its incident wave is exp(i k (x - x_eff)). The file has F = abs exp(i angle)
    with angles in rad. X is the complex conjugate of F, for waves Re A exp(i (omega t - k x)). Directions are where waves run
    to.

    Args:
        path: The file.
        heading: Where waves run to (deg).
        body: Number of the body, from 1; None: the file has one.
        density: Of the platform's water (kg/m³), to which forces are scaled.
        gravity: Of the platform (m/s²), to compare.
        depth: Of the platform's water (m), to compare.
        notes: What is moved, scaled or different is appended here.

    Raises:
        InputError: With what is wrong, or the headings that the file has.
    """
    omega, (force,) = _forces(path, [heading], body, density, (gravity, depth), notes)
    return Excitation.of(omega, force)


def read_nemoh_directions(
    path: str | PathLike[str],
    *,
    body: int | None = None,
    density: float | None = None,
    gravity: float | None = None,
    depth: float | None = None,
    notes: list[str] | None = None,
) -> DirectionalExcitation:
    """Read ExcitationForce.tec for waves of all its headings, as `read_nemoh_excitation` does for one.

    Args:
        path: The file.
        body: Number of the body, from 1; None: the file has one.
        density: Of the platform's water (kg/m³), to which forces are scaled.
        gravity: Of the platform (m/s²), to compare.
        depth: Of the platform's water (m), to compare.
        notes: What is moved, scaled or different is appended here.

    Raises:
        InputError: As `read_nemoh_excitation`.
    """
    headings = nemoh_headings(path)
    omega, forces = _forces(path, list(headings), body, density, (gravity, depth), notes)
    return DirectionalExcitation.of(np.radians(headings), [Excitation.of(omega, force) for force in forces])


def nemoh_headings(path: str | PathLike[str]) -> Float[np.ndarray, " d"]:
    """Headings (deg) of ExcitationForce.tec, once each, ascending from -180.

    Raises:
        InputError: The file is wrong.
    """
    return distinct(np.array([heading for heading, _ in _by_heading(path, _read(path))]))


def _forces(
    path: str | PathLike[str],
    headings: list[float],
    body: int | None,
    density: float | None,
    water: tuple[float | None, float | None],
    notes: list[str] | None,
) -> tuple[Float[np.ndarray, " w"], list[Complex[np.ndarray, "6 w"]]]:
    """Frequencies (rad/s), and forces of waves of each heading (deg)."""
    file = _read(path)
    mine, columns = _columns(path, file, body)
    case, zones = case_of(Path(path), mine), _by_heading(path, file)
    order, omega = _frequencies(path, file, zones[0][1].rows[:, 0], 2)
    remarks = list(case.notes)
    scale = density_scale(str(path), case.density, density, remarks)
    remarks += water_notes(str(path), (case.gravity, case.depth), *water, float(omega[0]))
    forces = []
    for heading in headings:
        rows = next((zone.rows[order] for beta, zone in zones if same_heading(beta, heading)), None)
        if rows is None:
            listed = ", ".join(f"{beta:g}" for beta, _ in zones)
            raise _wrong(path, f"waves of heading {heading:g} deg", f"{listed} deg", "beta")
        force = rows[:, columns] * np.exp(-1j * rows[:, [c + 1 for c in columns]])  # the conjugate
        forces.append(scale * case.shift.T @ force.T * wave_phase(omega, case.wave_origin, heading, case.depth, case.gravity))
    if notes is not None:
        notes += remarks
    return omega, forces


def _by_heading(path: str | PathLike[str], file: _File) -> list[tuple[float, _Zone]]:
    """Zones of wave forces, by their heading (deg)."""
    titles = [_HEADING.search(zone.title) for zone in file.zones]
    zones = [(float(match[1]), zone) for match, zone in zip(titles, file.zones) if match]
    if not zones:
        raise _wrong(path, "zones of an excitation force, by beta", f"{len(file.zones)} others")
    return zones


def _columns(path: str | PathLike[str], file: _File, body: int | None) -> tuple[int, list[int]]:
    """Number of the body, and the first column of each of its six forces."""
    bodies = sorted({number for number, _ in file.forces})
    if body is None and len(bodies) > 1:
        hint = f"A file of {len(bodies)} bodies: say which, as `body: 1`."
        raise _wrong(path, "the forces of one body", f"{len(bodies)} bodies", hint=hint)
    mine = bodies[0] if body is None else body
    columns = [1 + 2 * i for i, (number, _) in enumerate(file.forces) if number == mine]
    if len(columns) != len(DOFS):
        raise _wrong(path, f"six forces of body {mine}", f"{len(columns)}", "body" if body else "VARIABLES")
    return mine, columns


def _frequencies(
    path: str | PathLike[str], file: _File, column: Float[np.ndarray, " n"], least: int
) -> tuple[np.ndarray, Float[np.ndarray, " n"]]:
    """Order of the rows by frequency, and frequencies (rad/s)."""
    if any(not np.array_equal(zone.rows[:, 0], column) for zone in file.zones):
        raise _wrong(path, "the same frequencies in all zones", "others")
    if len(column) < least or (column <= 0).any() or len(np.unique(column)) < len(column):
        found = f"{len(column)}: {shown(column[:8].tolist())}"
        raise _wrong(path, f"{least} frequencies above 0 or more, each once", found)
    omega = to_omega(column, file.by)
    order = np.argsort(omega)
    return order, omega[order]


def _read(path: str | PathLike[str]) -> _File:
    try:
        text = Path(path).read_text(encoding="utf-8", errors="replace")
    except (OSError, ValueError) as error:
        found = "no such file" if isinstance(error, FileNotFoundError) else str(getattr(error, "strerror", None) or error)
        raise _wrong(path, "a .tec file of Nemoh", found) from None
    head, *parts = re.split(r"^\s*zone\b", text, flags=re.IGNORECASE | re.MULTILINE)
    unit, forces = _UNIT.search(head), [(int(body), int(number)) for _, body, number in _COLUMN.findall(head)]
    if unit is None or unit[1] not in UNITS or not forces or not parts:
        expected = 'VARIABLES="w (rad/s)", columns of A and B or abs(F) and angle(F), and zones'
        raise _wrong(path, expected, shown(text[:60]))
    return _File(UNITS[unit[1]], forces, [_zone(path, part, 1 + 2 * len(forces)) for part in parts])


def _zone(path: str | PathLike[str], part: str, width: int) -> _Zone:
    title, _, body = part.partition("\n")
    title = title.strip()
    words = _NO_LETTER.sub(r"\1E\2", body).upper().replace("D", "E").split()
    try:
        values = np.array([float(word) for word in words])
    except ValueError as error:
        raise _wrong(path, "numbers", str(error), title) from None
    if not values.size or values.size % width or not np.isfinite(values).all():
        found = f"{values.size} numbers, {np.isfinite(values).sum()} of them finite"
        raise _wrong(path, f"rows of {width} finite numbers", found, title)
    return _Zone(title, values.reshape(-1, width))


def _wrong(path: str | PathLike[str], expected: str, found: str, where: str = "", hint: str = "") -> InputError:
    return InputError(str(path), [Problem(where, expected, found, hint)])
