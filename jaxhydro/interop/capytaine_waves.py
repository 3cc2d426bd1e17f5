"""First-order wave forces and hydrostatics from Capytaine's datasets."""

from collections.abc import Sequence
from os import PathLike
from typing import Any

import numpy as np
from jaxtyping import Complex, Float

from jaxhydro.environment import STANDARD_GRAVITY
from jaxhydro.errors import shown
from jaxhydro.interop.capytaine_dataset import PAIR, Dataset, open_capytaine
from jaxhydro.interop.capytaine_radiation import along_omega, computed, motions, single
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
    """Read the excitation of a dataset for waves of one heading.

    It is `excitation_force`, or the sum of `Froude_Krylov_force` and `diffraction_force`.

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
    omega, (force,), dataset = _forces(path, body, [heading], density, gravity, depth)
    if notes is not None:
        notes += dataset.notes
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
    """Read the excitation of a dataset for waves of all its headings.

    Conventions are those of `read_capytaine_excitation`, which does so for one heading.

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
    omega, forces, dataset = _forces(path, body, None, density, gravity, depth)
    if notes is not None:
        notes += dataset.notes
    headings = capytaine_headings(dataset)
    return DirectionalExcitation.of(np.radians(headings), [Excitation.of(omega, force) for force in forces])


def capytaine_headings(dataset: Dataset) -> Float[np.ndarray, " d"]:
    """Headings (deg) of a dataset's excitation, once each, ascending from -180."""
    name = WHOLE if WHOLE in dataset.data else PARTS[0]
    if name not in dataset.data or "wave_direction" not in dataset.data[name].coords:
        raise dataset.wrong(f"{name}.wave_direction", "this dimension, in rad", "none")
    return distinct(np.degrees(np.atleast_1d(dataset.data[name].coords["wave_direction"].values).astype(float)))


def _forces(
    path: str | PathLike[str],
    body: str | None,
    headings: Sequence[float] | None,
    density: float | None,
    gravity: float | None,
    depth: float | None,
) -> tuple[Float[np.ndarray, " w"], list[Complex[np.ndarray, "6 w"]], Dataset]:
    """Frequencies (rad/s), forces of waves of each heading (deg), and the dataset.

    All headings of the dataset are taken where `headings` is None.
    """
    dataset = open_capytaine(path, (), body)
    names = (WHOLE,) if WHOLE in dataset.data else PARTS
    if missing := [name for name in names if name not in dataset.data]:
        variables = ", ".join(str(name) for name in dataset.data.variables) or "none"
        raise dataset.wrong(WHOLE, f"this variable, or {' and '.join(PARTS)}", f"no {missing[0]} among {variables}")
    wanted = capytaine_headings(dataset) if headings is None else headings
    tables = [np.sum([_of_heading(dataset, name, heading) for name in names], axis=0) for heading in wanted]
    omega = np.asarray(dataset.data[names[0]].coords["omega"].values, float)
    order = np.argsort(omega)
    inner = order[(omega[order] > 0) & np.isfinite(omega[order])]
    omega = omega[inner]
    solved = np.isin(omega, computed(dataset, {" + ".join(names): (omega, np.hstack([table[inner] for table in tables]))}))
    if solved.sum() < 2 or (np.diff(omega[solved]) == 0).any():
        raise dataset.wrong("omega", "two finite frequencies above 0 or more, each once", shown(omega[solved].tolist()))
    dataset.notes.extend(
        water_notes(dataset.source, (dataset.number("g"), _depth(dataset)), gravity, depth, float(omega[solved][0]))
    )
    scale = dataset.scale(density)
    water = (dataset.number("water_depth") or np.inf, dataset.number("g") or STANDARD_GRAVITY)
    # from waves at the dataset's origin to those at the reference point, which is `dataset.origin` from it
    forces = [
        scale * dataset.shift.T @ np.conj(table[inner][solved]).T * wave_phase(omega[solved], -dataset.origin, heading, *water)
        for heading, table in zip(wanted, tables)
    ]
    return omega[solved], forces, dataset


def _depth(dataset: Dataset) -> float | None:
    """Depth of the dataset (m), infinite in deep water; None where it does not say."""
    if "water_depth" not in dataset.data.variables or dataset.data["water_depth"].size != 1:
        return None
    return float(dataset.data["water_depth"].values.reshape(()))


def _of_heading(dataset: Dataset, name: str, heading: float) -> Complex[np.ndarray, "w 6"]:
    """A variable by frequency and motion, of waves of one heading (deg)."""
    along, rows = along_omega(dataset, name), motions(dataset, name, "influenced_dof")
    values = single(dataset, name, (along, "influenced_dof", "wave_direction", "complex"))
    if "wave_direction" not in values.coords:
        raise dataset.wrong(f"{name}.wave_direction", "this dimension, in rad", f"{', '.join(map(str, values.dims))}")
    headings = np.degrees(np.atleast_1d(values.coords["wave_direction"].values).astype(float))
    mine = np.flatnonzero(same_heading(headings, heading))
    if not mine.size:
        listed = ", ".join(f"{beta:.6g}" for beta in headings)
        raise dataset.wrong("wave_direction", f"waves of heading {heading:g} deg", f"{listed} deg (in the file in rad)")
    if "wave_direction" in values.dims:
        values = values.isel(wave_direction=int(mine[0]))
    if "complex" in values.dims:
        labels = [str(x) for x in np.atleast_1d(values.coords["complex"].values)] if "complex" in values.coords else []
        if labels and not {REAL, IMAGINARY} <= set(labels):
            raise dataset.wrong(f"{name}.complex", f"{REAL} and {IMAGINARY}", ", ".join(labels))
        if not labels and values.sizes["complex"] != 2:
            raise dataset.wrong(f"{name}.complex", f"{REAL} and {IMAGINARY}", f"{values.sizes['complex']} entries")
        indices = [labels.index(part) for part in (REAL, IMAGINARY)] if labels else [0, 1]
        values = values.isel(complex=indices[0]) + 1j * values.isel(complex=indices[1])
    elif not np.iscomplexobj(values.values):
        raise dataset.wrong(name, "complex numbers, or a dimension complex with re and im", "real numbers")
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
    """Read the hydrostatic stiffness (N/m, N, N m) and the displaced volume of a dataset.

    They are `hydrostatic_stiffness`, and `disp_volume` or `disp_mass` over the density. Capytaine's stiffness includes the
    weight, of the displaced mass at `center_of_mass` (its documentation, "Hydrostatics").

    Args:
        path: The file.
        body: Name of the body, where the dataset has several.
        density: Of the platform's water, kg/m3, to which the stiffness is scaled.
        gravity: Of the platform, m/s2, to which the stiffness is scaled.
        notes: What is moved or scaled is appended here.

    Raises:
        InputError: With the variable that is wrong.
    """
    dataset = open_capytaine(path, ("hydrostatic_stiffness",), body)
    name = "hydrostatic_stiffness"
    rows = [motions(dataset, name, dim) for dim in reversed(PAIR)]
    values = np.asarray(single(dataset, name, PAIR).transpose(*reversed(PAIR)).values, float)
    if not np.isfinite(values).all():
        raise dataset.wrong(name, "finite numbers", f"{values.size - np.isfinite(values).sum()} that are not")
    matrix = np.zeros((6, 6))
    matrix[np.ix_(*rows)] = values
    file_gravity = dataset.number("g")
    scale = dataset.scale(density) * (gravity / file_gravity if gravity is not None and file_gravity is not None else 1.0)
    volume = next((v for key in VOLUME if (v := dataset.number(key)) is not None), None)
    if volume is None and (mass := dataset.number("disp_mass")) is not None and (rho := dataset.number("rho")) is not None:
        volume = mass / rho
    centre: Any = None
    if "center_of_mass" in dataset.data.variables and dataset.data["center_of_mass"].size == 3:
        centre = np.asarray(dataset.data["center_of_mass"].values, float).reshape(3)
        centre = centre if np.isfinite(centre).all() else None
    if notes is not None:
        notes += dataset.notes
    return FileHydrostatics(
        scale * dataset.shift.T @ matrix @ dataset.shift, volume, None if centre is None else float(centre[2])
    )
