"""Capytaine's NetCDF datasets (`assemble_dataset`): opened, and one of their bodies chosen."""

from os import PathLike
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from jaxtyping import Float

from jaxhydro.errors import InputError, Problem, shown, suggest
from jaxhydro.interop.computed_water import density_scale
from jaxhydro.interop.reference_point import rigid_shift

HDF5 = b"\x89HDF\r\n\x1a\n"  # how a file of NetCDF-4 begins
PAIR = ("radiating_dof", "influenced_dof")
BODY_SEPARATOR = "__"  # a body's name and its motion, in datasets of several bodies: buoy__Heave
BODY = ("body", "body_name")  # dimensions along which datasets of several bodies may be put together
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
            data = data.sel({dim: [name for name in data[dim].values if text_of(name) == body]}).squeeze(dim, drop=True)
    for dim in PAIR:
        if dim in data.coords and data[dim].ndim == 1:
            mine = [name for name in data[dim].values if text_of(name).rpartition(BODY_SEPARATOR)[0] in ("", body)]
            if len(mine) < data.sizes[dim]:
                notes = [f"{source}: {body} of {len(names)} bodies: the others are held still, what they radiate is left out"]
                data = data.sel({dim: mine})
    origin, shift = _reference(data, wrong, source, len(names) > 1, notes)
    return Dataset(data, source, body, origin, shift, notes)


def text_of(name: Any) -> str:
    """Name of a body or motion as text; some files have bytes."""
    return name.decode() if isinstance(name, bytes) else str(name)


def _bodies(data: Any) -> list[str]:
    """Names of the bodies of a dataset, in order."""
    bodies: dict[str, None] = {}
    for dim in PAIR:
        if dim in data.coords:
            prefixed = [text_of(name).rpartition(BODY_SEPARATOR) for name in np.atleast_1d(data[dim].values)]
            bodies |= {name: None for name, between, _ in prefixed if between}
    for dim in BODY:
        if not bodies and dim in data.coords:
            bodies |= {text_of(name): None for name in np.atleast_1d(data[dim].values)}
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
