"""First-order wave forces and hydrostatics from Capytaine's datasets."""

from collections.abc import Sequence
from os import PathLike
from typing import Any

import numpy as np
from jaxtyping import Complex, Float

from jaxhydro.environment import STANDARD_GRAVITY
from jaxhydro.errors import shown
from jaxhydro.interop.capytaine_radiation import PAIR, Dataset, along_omega, computed, motions, open_capytaine, single
from jaxhydro.interop.computed_water import water_notes, wave_phase
from jaxhydro.interop.wamit_hydrostatics import FileHydrostatics
from jaxhydro.interop.wamit_tables import distinct, same_heading
from jaxhydro.waves.excitation import DirectionalExcitation, Excitation

WHOLE = "excitation_force"
PARTS = ("Froude_Krylov_force", "diffraction_force")
REAL, IMAGINARY = "re", "im"  # along the dimension `complex` of files, which NetCDF has no numbers for
VOLUME = ("disp_volume", "displaced_volume")


def read_capytaine_excitation(
    path: str | PathLike[str],
    *,
    heading: float = 0.0,
    body: str | None = None,
    density: float | None = None,
    gravity: float | None = None,
    depth: float | None = None,
    notes: list[str] | None = None,
) -> Excitation:
    """Read the excitation of a dataset: `excitation_force`, or the sum of `Froude_Krylov_force` and `diffraction_force`.

    Capytaine's quantities go with exp(-i omega t) and its incident wave is exp(i (k x - omega t)) (Capytaine's documentation,
    "Conventions"; `airy_waves`). X is therefore the complex conjugate, for waves Re A exp(i (omega t - k x)) as in
    `Excitation`. Directions are in rad, where waves run to. Phases are those of waves at the origin.

    Args:
        path: The file.
        heading: Where waves run to, deg.
        body: Name of the body, where the dataset has several.
        density: Of the platform's water, kg/m3, to which forces are scaled.
        gravity: Of the platform, m/s2, to compare.
        depth: Of the platform's water, m, to compare.
        notes: What is left out, moved, scaled or different is appended here.

    Raises:
        InputError: With the variable or frequencies that are wrong, or the headings that the dataset has.
    """
    omega, (force,), one = _forces(path, body, [heading], density, gravity, depth)
    if notes is not None:
        notes += one.notes
    return Excitation.of(omega, force)


def read_capytaine_directions(
    path: str | PathLike[str],
    *,
    body: str | None = None,
    density: float | None = None,
    gravity: float | None = None,
    depth: float | None = None,
    notes: list[str] | None = None,
) -> DirectionalExcitation:
    """Read the excitation of a dataset for waves of all its headings, as `read_capytaine_excitation` does for one.

    Args:
        path: The file.
        body: Name of the body, where the dataset has several.
        density: Of the platform's water, kg/m3, to which forces are scaled.
        gravity: Of the platform, m/s2, to compare.
        depth: Of the platform's water, m, to compare.
        notes: What is left out, moved, scaled or different is appended here.

    Raises:
        InputError: As `read_capytaine_excitation`.
    """
    omega, forces, one = _forces(path, body, None, density, gravity, depth)
    if notes is not None:
        notes += one.notes
    headings = capytaine_headings(one)
    return DirectionalExcitation.of(np.radians(headings), [Excitation.of(omega, force) for force in forces])


def capytaine_headings(one: Dataset) -> Float[np.ndarray, " d"]:
    """Headings (deg) of a dataset's excitation, once each, ascending from -180."""
    name = WHOLE if WHOLE in one.data else PARTS[0]
    if name not in one.data or "wave_direction" not in one.data[name].coords:
        raise one.wrong(f"{name}.wave_direction", "this dimension, in rad", "none")
    return distinct(np.degrees(np.atleast_1d(one.data[name].coords["wave_direction"].values).astype(float)))


def _forces(
    path: str | PathLike[str],
    body: str | None,
    headings: Sequence[float] | None,
    density: float | None,
    gravity: float | None,
    depth: float | None,
) -> tuple[Float[np.ndarray, " w"], list[Complex[np.ndarray, "6 w"]], Dataset]:
    """Frequencies (rad/s), forces of waves of each heading (deg), all where None is asked for, and the dataset."""
    one = open_capytaine(path, (), body)
    names = (WHOLE,) if WHOLE in one.data else PARTS
    if missing := [name for name in names if name not in one.data]:
        known = ", ".join(str(name) for name in one.data.variables) or "none"
        raise one.wrong(WHOLE, f"this variable, or {' and '.join(PARTS)}", f"no {missing[0]} among {known}")
    wanted = capytaine_headings(one) if headings is None else headings
    tables = [np.sum([_of_heading(one, name, heading) for name in names], axis=0) for heading in wanted]
    omega = np.asarray(one.data[names[0]].coords["omega"].values, float)
    order = np.argsort(omega)
    inner = order[(omega[order] > 0) & np.isfinite(omega[order])]
    omega = omega[inner]
    kept = np.isin(omega, computed(one, {" + ".join(names): (omega, np.hstack([table[inner] for table in tables]))}))
    if kept.sum() < 2 or (np.diff(omega[kept]) == 0).any():
        raise one.wrong("omega", "two finite frequencies above 0 or more, each once", shown(omega[kept].tolist()))
    one.notes.extend(water_notes(one.source, (one.number("g"), _depth(one)), gravity, depth, float(omega[kept][0])))
    scale = one.scale(density)
    water = (one.number("water_depth") or np.inf, one.number("g") or STANDARD_GRAVITY)
    # from waves at the dataset's origin to those at the reference point, which is `one.origin` from it
    forces = [
        scale * one.shift.T @ np.conj(table[inner][kept]).T * wave_phase(omega[kept], -one.origin, heading, *water)
        for heading, table in zip(wanted, tables)
    ]
    return omega[kept], forces, one


def _depth(one: Dataset) -> float | None:
    """Depth of the dataset (m), infinite in deep water; None where it does not say."""
    if "water_depth" not in one.data.variables or one.data["water_depth"].size != 1:
        return None
    return float(one.data["water_depth"].values.reshape(()))


def _of_heading(one: Dataset, name: str, heading: float) -> Complex[np.ndarray, "w 6"]:
    """A variable by frequency and motion, of waves of one heading (deg)."""
    along, rows = along_omega(one, name), motions(one, name, "influenced_dof")
    values = single(one, name, (along, "influenced_dof", "wave_direction", "complex"))
    if "wave_direction" not in values.coords:
        raise one.wrong(f"{name}.wave_direction", "this dimension, in rad", f"{', '.join(map(str, values.dims))}")
    known = np.degrees(np.atleast_1d(values.coords["wave_direction"].values).astype(float))
    mine = np.flatnonzero(same_heading(known, heading))
    if not mine.size:
        there = ", ".join(f"{beta:.6g}" for beta in known)
        raise one.wrong("wave_direction", f"waves of heading {heading:g} deg", f"{there} deg (in the file in rad)")
    if "wave_direction" in values.dims:
        values = values.isel(wave_direction=int(mine[0]))
    if "complex" in values.dims:
        labels = [str(x) for x in np.atleast_1d(values.coords["complex"].values)] if "complex" in values.coords else []
        if labels and not {REAL, IMAGINARY} <= set(labels):
            raise one.wrong(f"{name}.complex", f"{REAL} and {IMAGINARY}", ", ".join(labels))
        if not labels and values.sizes["complex"] != 2:
            raise one.wrong(f"{name}.complex", f"{REAL} and {IMAGINARY}", f"{values.sizes['complex']} entries")
        at = [labels.index(part) for part in (REAL, IMAGINARY)] if labels else [0, 1]
        values = values.isel(complex=at[0]) + 1j * values.isel(complex=at[1])
    elif not np.iscomplexobj(values.values):
        raise one.wrong(name, "complex numbers, or a dimension complex with re and im", "real numbers")
    table = np.zeros((values.sizes[along], 6), complex)
    table[:, rows] = np.asarray(values.transpose(along, "influenced_dof").values)
    return table


def read_capytaine_hydrostatics(
    path: str | PathLike[str],
    *,
    body: str | None = None,
    density: float | None = None,
    gravity: float | None = None,
    notes: list[str] | None = None,
) -> FileHydrostatics:
    """Read `hydrostatic_stiffness` (N/m, N, N m) and the displaced volume (`disp_volume`, or `disp_mass` over the density).

    Capytaine's stiffness includes the weight, of the displaced mass at `center_of_mass` (its documentation, "Hydrostatics").

    Args:
        path: The file.
        body: Name of the body, where the dataset has several.
        density: Of the platform's water, kg/m3, to which the stiffness is scaled.
        gravity: Of the platform, m/s2, to which the stiffness is scaled.
        notes: What is moved or scaled is appended here.

    Raises:
        InputError: With the variable that is wrong.
    """
    one = open_capytaine(path, ("hydrostatic_stiffness",), body)
    name = "hydrostatic_stiffness"
    rows = [motions(one, name, dim) for dim in reversed(PAIR)]
    values = np.asarray(single(one, name, PAIR).transpose(*reversed(PAIR)).values, float)
    if not np.isfinite(values).all():
        raise one.wrong(name, "finite numbers", f"{values.size - np.isfinite(values).sum()} that are not")
    matrix = np.zeros((6, 6))
    matrix[np.ix_(*rows)] = values
    own = one.number("g")
    scale = one.scale(density) * (gravity / own if gravity is not None and own is not None else 1.0)
    volume = next((v for key in VOLUME if (v := one.number(key)) is not None), None)
    if volume is None and (mass := one.number("disp_mass")) is not None and (rho := one.number("rho")) is not None:
        volume = mass / rho
    centre: Any = None
    if "center_of_mass" in one.data.variables and one.data["center_of_mass"].size == 3:
        centre = np.asarray(one.data["center_of_mass"].values, float).reshape(3)
        centre = centre if np.isfinite(centre).all() else None
    if notes is not None:
        notes += one.notes
    return FileHydrostatics(scale * one.shift.T @ matrix @ one.shift, volume, None if centre is None else float(centre[2]))
