"""Added mass and radiation damping from Capytaine's NetCDF datasets (`assemble_dataset`).

Capytaine: https://capytaine.org.
"""

from os import PathLike
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from jaxtyping import Float

from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError, Problem, shown, suggest
from jaxhydro.interop.computed_water import density_scale
from jaxhydro.interop.radiation_coefficients import RadiationCoefficients
from jaxhydro.interop.reference_point import rigid_shift

MIN_FREQUENCIES = 4  # frequencies
HDF5 = b"\x89HDF\r\n\x1a\n"  # how a file of NetCDF-4 begins
PAIR = ("radiating_dof", "influenced_dof")
BODY_SEPARATOR = "__"  # a body's name and its motion, in datasets of several bodies: buoy__Heave
BODY = ("body", "body_name")  # dimensions along which datasets of several bodies may be put together
MAX_LISTED_FREQUENCIES = 8  # frequencies that a note names
ORIGIN_TOLERANCE = 1e-6  # m


class Dataset(NamedTuple):
    """Capytaine dataset of one body: its variables (xarray), file, body name ("" where none), and notes.

    `origin` (x, y; m) is the platform's reference point in the dataset, at still water level. `shift` (6, 6) maps velocities
    of that point to those of the point that the dataset's motions are about.
    """

    data: Any
    source: str
    body: str
    origin: Float[np.ndarray, "2"]
    shift: Float[np.ndarray, "6 6"]
    notes: list[str]

    def wrong(self, where: str, expected: str, found: str, hint: str = "") -> InputError:
        """The error of a variable."""
        return InputError(self.source, [Problem(where, expected, found, hint)])

    def scale(self, density: float | None) -> float:
        """Factor from forces in the dataset's water to forces in water of another density (kg/m³)."""
        return density_scale(self.source, self.number("rho"), density, self.notes)

    def number(self, name: str) -> float | None:
        """Scalar of the dataset; None where it has none."""
        if name not in self.data.variables or self.data[name].size != 1:
            return None
        value = float(self.data[name].values.reshape(()))
        return value if np.isfinite(value) else None


def open_capytaine(path: str | PathLike[str], needed: tuple[str, ...], body: str | None = None) -> Dataset:
    """Open a dataset and choose a body by its name.

    Args:
        path: The file.
        needed: Variables that it has to have.
        body: Name of the body; None where the dataset has one only.

    Raises:
        InputError: With the variable that is missing, or the names of the bodies where none of them is chosen.
    """
    import xarray as xr

    source = str(path)

    def wrong(where: str, expected: str, found: str, hint: str = "") -> InputError:
        return InputError(source, [Problem(where, expected, found, hint)])

    try:
        with Path(path).open("rb") as file:
            engine: Literal["h5netcdf", "scipy"] = "h5netcdf" if file.read(8) == HDF5 else "scipy"
        with xr.open_dataset(path, engine=engine) as opened:  # else xarray would take a folder for a zarr store, too
            data = opened.load()
    except FileNotFoundError:
        raise wrong("", "a NetCDF file of Capytaine", "no such file") from None
    except Exception as error:  # each of xarray's engines has its own
        raise wrong("", "a NetCDF file of Capytaine", shown(str(error))) from None
    variables = [str(name) for name in data.variables]
    if missing := [name for name in needed if name not in data]:
        raise wrong(missing[0], "this variable", ", ".join(variables) or "none", suggest(missing[0], variables))
    names = _bodies(data)
    if body is None and len(names) > 1:
        raise wrong("", "the name of a body in `body`", "none", f"The dataset has {', '.join(names)}.")
    if body is not None and body not in names:
        raise wrong(
            "body", f"one of {', '.join(names) or 'a body without a name: leave `body` out'}", shown(body), suggest(body, names)
        )
    body = body or (names[0] if names else "")
    notes = []
    for dim in BODY:
        if dim in data.dims and dim in data.coords:
            data = data.sel({dim: [name for name in data[dim].values if _text(name) == body]}).squeeze(dim, drop=True)
    for dim in PAIR:
        if dim in data.coords and data[dim].ndim == 1:
            mine = [name for name in data[dim].values if _text(name).rpartition(BODY_SEPARATOR)[0] in ("", body)]
            if len(mine) < data.sizes[dim]:
                notes = [f"{source}: {body} of {len(names)} bodies: the others are held still, what they radiate is left out"]
                data = data.sel({dim: mine})
    origin, shift = _reference(data, wrong, source, len(names) > 1, notes)
    return Dataset(data, source, body, origin, shift, notes)


def _text(name: Any) -> str:
    return name.decode() if isinstance(name, bytes) else str(name)


def _bodies(data: Any) -> list[str]:
    """Names of the bodies of a dataset, in order."""
    bodies: dict[str, None] = {}
    for dim in PAIR:
        if dim in data.coords:
            prefixed = [_text(name).rpartition(BODY_SEPARATOR) for name in np.atleast_1d(data[dim].values)]
            bodies |= {name: None for name, between, _ in prefixed if between}
    for dim in BODY:
        if not bodies and dim in data.coords:
            bodies |= {_text(name): None for name in np.atleast_1d(data[dim].values)}
    return list(bodies)


def _reference(
    data: Any, wrong: Any, source: str, several: bool, notes: list[str]
) -> tuple[Float[np.ndarray, "2"], Float[np.ndarray, "6 6"]]:
    """`origin` and `shift` of a `Dataset`, by its centre of rotation.

    The reference point is the dataset's origin; of one among several bodies it is above or below its own centre.
    """
    origin, shift = np.zeros(2), np.eye(6)
    if "rotation_center" not in data.variables:
        return origin, shift
    centre = np.asarray(data["rotation_center"].values, float).squeeze()
    if centre.shape != (3,) or not np.isfinite(centre).all():
        raise wrong("rotation_center", "three numbers", shown(np.asarray(data["rotation_center"].values).tolist()))
    if several and np.abs(centre[:2]).max() > ORIGIN_TOLERANCE:
        origin = centre[:2]
        notes.append(f"{source}: the platform's reference point is at ({origin[0]:g}, {origin[1]:g}, 0) m of the dataset")
    point = centre - np.append(origin, 0.0)
    if np.abs(point).max() > ORIGIN_TOLERANCE:
        shift = rigid_shift(point)
        coordinates = ", ".join(f"{x:g}" for x in centre)
        notes.append(f"{source}: computed about ({coordinates}) m: moved to the platform's reference point")
    return origin, shift


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
    names = [_text(label).rpartition(BODY_SEPARATOR)[2].strip().lower() for label in values.coords[dim].values]
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
