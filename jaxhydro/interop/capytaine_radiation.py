"""Added mass and radiation damping from Capytaine's NetCDF datasets (`assemble_dataset`).

Capytaine: https://capytaine.org.
"""

from os import PathLike
from typing import Any

import numpy as np
from jaxtyping import Float

from jaxhydro.environment import DOFS
from jaxhydro.errors import shown, suggest
from jaxhydro.interop.capytaine_dataset import BODY_SEPARATOR, PAIR, Dataset, open_capytaine, text_of
from jaxhydro.interop.radiation_coefficients import RadiationCoefficients

MIN_FREQUENCIES = 4  # frequencies
MAX_LISTED_FREQUENCIES = 8  # frequencies that a note names


def read_capytaine(
    path: str | PathLike[str], *, body: str | None = None, density: float | None = None, notes: list[str] | None = None
) -> RadiationCoefficients:
    """Read added mass and radiation damping of a Capytaine dataset.

    They are dimensional already. Motions are Surge ... Yaw; those left out are zero. Frequencies may include 0 and infinity.
    Further dimensions (water depth, density) may have one entry only. Frequencies at which nothing was computed, all NaN,
    are left out with a note: Capytaine skips those it cannot solve, such as k h < 0.1 in finite depth.

    Args:
        path: The file.
        body: Name of the body, where the dataset has several.
        density: Of the platform's water, kg/m3, to which forces are scaled; None: the dataset's own.
        notes: What is left out, moved or scaled is appended here.

    Raises:
        InputError: With the variable that is wrong, and frequencies at which only a part was computed.
    """
    dataset = open_capytaine(path, ("added_mass", "radiation_damping"), body)
    mass, damping = (_cube(dataset, name) for name in ("added_mass", "radiation_damping"))
    omega = np.asarray(dataset.data["added_mass"].coords["omega"].values, float)
    order = np.argsort(omega)
    omega, mass, damping = omega[order], mass[order], damping[order]
    if np.isnan(omega).any() or (omega < 0).any() or (np.diff(omega) == 0).any():
        raise dataset.wrong("omega", "frequencies from 0 up, each once", shown(omega.tolist()))
    inner = (omega > 0) & np.isfinite(omega)
    solved = computed(dataset, {"added_mass": (omega, mass), "radiation_damping": (omega[inner], damping[inner])})
    inner &= np.isin(omega, solved)
    if inner.sum() < MIN_FREQUENCIES:
        raise dataset.wrong("omega", f"{MIN_FREQUENCIES} finite frequencies above 0 or more", f"{inner.sum()}")
    scale = dataset.scale(density)

    def about(matrix: np.ndarray) -> np.ndarray:
        return scale * dataset.shift.T @ np.nan_to_num(matrix) @ dataset.shift

    zero, infinite = ([about(m) for m, w in zip(mass, omega) if w == frequency and w in solved] for frequency in (0.0, np.inf))
    limits = (matrices[0] if matrices else None for matrices in (infinite, zero))
    if notes is not None:
        notes += dataset.notes
    return RadiationCoefficients(omega[inner], about(mass[inner]), about(damping[inner]), *limits)


def computed(dataset: Dataset, variables: dict[str, tuple[np.ndarray, np.ndarray]]) -> Float[np.ndarray, " n"]:
    """Frequencies (rad/s) at which all variables were computed; a note names the others.

    Entries of motions that the dataset lacks are 0, and do not count. A variable's NaN are looked for where any other
    frequency has a number.

    Raises:
        InputError: A variable is NaN only in part at a frequency, or not all variables were computed there.
    """
    lost: dict[float, None] = {}
    solved: dict[float, None] = {}
    for name, (omega, values) in variables.items():
        flat = values.reshape(len(omega), -1)
        present = ~(flat == 0).all(axis=0)
        missing = ~np.isfinite(flat)
        whole = missing[:, present].all(axis=1) & present.any()
        partly = missing.any(axis=1) & ~whole
        if partly.any():
            count = int(missing[partly].sum())
            raise dataset.wrong(
                name,
                "finite numbers",
                f"{count} that are not, at omega {listed(omega[partly])} rad/s",
                "Where all of a frequency is NaN, it is left out.",
            )
        lost |= dict.fromkeys(omega[whole].tolist())
        solved |= dict.fromkeys(omega[~whole].tolist())
    if mixed := [w for w in lost if w in solved and np.isfinite(w) and w > 0]:
        names = " and ".join(variables)
        raise dataset.wrong(names, "numbers for both at each frequency", f"one alone at omega {listed(np.array(mixed))} rad/s")
    finite = np.array(sorted(w for w in lost if np.isfinite(w) and w > 0))
    if finite.size:
        many = "frequencies" if finite.size > 1 else "frequency"
        where = f"at which nothing was computed (NaN): omega {listed(finite)} rad/s"
        dataset.notes.append(f"{dataset.source}: {finite.size} {many} left out, {where}")
    return np.array([w for w in solved if w not in lost])


def listed(omega: Float[np.ndarray, " n"]) -> str:
    """Frequencies as a message names them."""
    text = ", ".join(f"{w:.4g}" for w in omega[:MAX_LISTED_FREQUENCIES])
    return text + (f" ... {omega[-1]:.4g}" if len(omega) > MAX_LISTED_FREQUENCIES else "")


def single(dataset: Dataset, name: str, apart: tuple[str, ...]) -> Any:
    """A variable without its dimensions other than `apart`, which may have one entry only."""
    values = dataset.data[name]
    for dim in [dim for dim in values.dims if dim not in apart]:
        if values.sizes[dim] > 1:
            raise dataset.wrong(f"{name}.{dim}", "one entry", f"{values.sizes[dim]}")
        values = values.isel({dim: 0})
    return values


def along_omega(dataset: Dataset, name: str) -> str:
    """The dimension of a variable that omega runs along."""
    values = dataset.data[name]
    if "omega" not in values.coords or values.coords["omega"].ndim != 1:
        dims = f"dimensions {', '.join(map(str, values.dims))}"
        raise dataset.wrong(f"{name}.omega", "a dimension of angular frequencies", dims)
    return str(values.coords["omega"].dims[0])


def motions(dataset: Dataset, name: str, dim: str) -> list[int]:
    """The motions, from 0, that a variable's dimension names."""
    values = dataset.data[name]
    if dim not in values.dims or dim not in values.coords:
        raise dataset.wrong(f"{name}.{dim}", "a dimension with names", f"dimensions {', '.join(map(str, values.dims))}")
    names = [text_of(label).rpartition(BODY_SEPARATOR)[2].strip().lower() for label in values.coords[dim].values]
    if unknown := [label for label in names if label not in DOFS]:
        among = f"motions among {', '.join(DOFS).title()}"
        raise dataset.wrong(f"{name}.{dim}", among, shown(unknown[0]), suggest(unknown[0], DOFS))
    if len(set(names)) < len(names):
        twice = next(label for label in names if names.count(label) > 1)
        raise dataset.wrong(f"{name}.{dim}", "each motion once", f"{twice} {names.count(twice)} times")
    return [DOFS.index(label) for label in names]


def _cube(dataset: Dataset, name: str) -> Float[np.ndarray, "w 6 6"]:
    """A variable by frequency, influenced and radiating motion."""
    rows = [motions(dataset, name, dim) for dim in reversed(PAIR)]
    along = along_omega(dataset, name)
    values = single(dataset, name, (along, *PAIR))
    cube = np.zeros((values.sizes[along], 6, 6))
    cube[np.ix_(range(len(cube)), *rows)] = np.asarray(values.transpose(along, *reversed(PAIR)).values)
    return cube
