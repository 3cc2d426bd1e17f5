"""Capytaine's datasets: added mass and radiation damping in NetCDF (https://capytaine.org, `assemble_dataset`)."""

from os import PathLike
from typing import Any

import numpy as np

from jaxhydro.environment import DOFS
from jaxhydro.interop.coefficients import RadiationCoefficients
from jaxhydro.problems import InputError, Problem, shown, suggest

FEWEST = 4  # frequencies
PAIR = ("radiating_dof", "influenced_dof")


def read_capytaine(path: str | PathLike[str]) -> RadiationCoefficients:
    """The coefficients in a dataset with `added_mass` and `radiation_damping` over omega (rad/s), radiating_dof and
    influenced_dof, as Capytaine writes it: dimensional already, of its own density, about the body's centre of rotation.

    Motions are Surge ... Yaw; those left out are zero. Frequencies may include 0 and infinity. Further dimensions (water
    depth, density) may have one entry only. Raises InputError.
    """
    import xarray as xr

    source = str(path)

    def wrong(where: str, expected: str, found: str, hint: str = "") -> InputError:
        return InputError(source, [Problem(where, expected, found, hint)])

    try:
        with xr.open_dataset(path) as opened:
            data = {name: opened[name].load() for name in ("added_mass", "radiation_damping") if name in opened}
            known = [str(name) for name in opened.variables]
    except FileNotFoundError:
        raise wrong("", "a NetCDF file of Capytaine", "no such file") from None
    except Exception as error:  # each of xarray's engines has its own
        raise wrong("", "a NetCDF file of Capytaine", shown(str(error))) from None
    if missing := [name for name in ("added_mass", "radiation_damping") if name not in data]:
        raise wrong(missing[0], "this variable", ", ".join(known) or "none", suggest(missing[0], known))
    mass, damping = (_cube(values, name, wrong) for name, values in data.items())
    omega = np.asarray(data["added_mass"].coords["omega"].values, float)
    order = np.argsort(omega)
    omega, mass, damping = omega[order], mass[order], damping[order]
    if np.isnan(omega).any() or (omega < 0).any() or (np.diff(omega) == 0).any():
        raise wrong("omega", "frequencies from 0 up, each once", shown(omega.tolist()))
    inner = (omega > 0) & np.isfinite(omega)
    if inner.sum() < FEWEST:
        raise wrong("omega", f"{FEWEST} finite frequencies above 0 or more", f"{inner.sum()}")
    for name, values in (("added_mass", mass), ("radiation_damping", damping[inner])):
        if not np.isfinite(values).all():
            raise wrong(name, "finite numbers", f"{values.size - np.isfinite(values).sum()} that are not")
    zero, infinite = ([m for m, w in zip(mass, omega) if w == at] for at in (0.0, np.inf))
    limits = (one[0] if one else None for one in (infinite, zero))
    return RadiationCoefficients(omega[inner], mass[inner], damping[inner], *limits)


def _cube(values: Any, name: str, wrong: Any) -> np.ndarray:
    """A variable by frequency, influenced and radiating motion."""
    if missing := [dim for dim in PAIR if dim not in values.dims or dim not in values.coords]:
        raise wrong(f"{name}.{missing[0]}", "a dimension with names", f"dimensions {', '.join(map(str, values.dims))}")
    if "omega" not in values.coords or values.coords["omega"].ndim != 1:
        raise wrong(f"{name}.omega", "a dimension of angular frequencies", f"dimensions {', '.join(map(str, values.dims))}")
    along = values.coords["omega"].dims[0]
    for dim in set(values.dims) - {along, *PAIR}:
        if values.sizes[dim] > 1:
            raise wrong(f"{name}.{dim}", "one entry", f"{values.sizes[dim]}")
        values = values.isel({dim: 0})
    cube = np.zeros((values.sizes[along], 6, 6))
    places = []
    for dim in reversed(PAIR):
        names = [(one.decode() if isinstance(one, bytes) else str(one)).strip().lower() for one in values.coords[dim].values]
        if unknown := [one for one in names if one not in DOFS]:
            among = f"motions among {', '.join(DOFS).title()}"
            raise wrong(f"{name}.{dim}", among, shown(unknown[0]), suggest(unknown[0], DOFS))
        places.append([DOFS.index(one) for one in names])
    ordered = np.asarray(values.transpose(along, *reversed(PAIR)).values)
    cube[np.ix_(range(len(cube)), *places)] = ordered
    return cube
