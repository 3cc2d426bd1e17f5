"""A motion as an xarray data set after the CF conventions."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from jaxhydro.display.data_frames import single
from jaxhydro.environment import DOFS
from jaxhydro.units import for_people
from jaxhydro.waves.sea import elevation_at_origin

if TYPE_CHECKING:
    from jaxhydro.dynamics.response import Response
    from jaxhydro.waves.sea import AbstractSea

CF_VERSION = "CF-1.8"
ELEVATION = "elevation of the water above still water at the reference position"
DIRECTIONS = {
    "surge": "displacement along x",
    "sway": "displacement along y",
    "heave": "displacement along z, upwards",
    "roll": "rotation about x",
    "pitch": "rotation about y",
    "yaw": "rotation about z",
}


def response_dataset(response: "Response", platform: str | None = None, sea: "AbstractSea | None" = None) -> xr.Dataset:
    """Position of the reference point over time as an xarray data set, in m and degrees.

    It has a variable for each motion. Units are those of the package's files.

    Args:
        response: The motion, (t, 6).
        platform: Name of the platform, or None.
        sea: The sea whose elevation is added, or None.

    Returns:
        As of `motion_dataset`.

    Raises:
        ValueError: There are several motions in one, (..., t, 6).
    """
    import jaxhydro

    motions = {dof: for_people(dof, values) for dof, values in single(response).items()}
    wave = None if sea is None else elevation_at_origin(sea, response.time)
    about = {
        "title": f"Motion of {platform or 'a floating platform'}",
        "source": f"jaxhydro {jaxhydro.__version__}",
        "platform": platform,
    }
    return motion_dataset(np.asarray(response.time), motions, wave, about)


def motion_dataset(
    time: np.ndarray, motions: Mapping[str, np.ndarray], wave: np.ndarray | None, about: Mapping[str, Any]
) -> xr.Dataset:
    """A motion of the reference point over time, a variable for each degree of freedom.

    The standard names are those without a sign convention: a moored platform has no forward direction. The attribute `comment`
    says which way the axes point.

    Args:
        time: Times (s), (t,).
        motions: Positions by degree of freedom (m, deg), (t,).
        wave: Elevation at the reference position (m), (t,); None where there are no waves.
        about: Further attributes of the data set, such as title, platform and sea; None is left out.

    Returns:
        Variables `surge` ... `yaw` and `wave` with `units`, `long_name` and `standard_name`; coordinate `time` (s).

    References:
        CF conventions 1.8; standard name table (platform_surge ... platform_yaw, water_surface_height_above_reference_datum).
    """
    data = {
        dof: (
            "time",
            values,
            {
                "units": "m" if dof in DOFS[:3] else "degree",
                "long_name": f"{dof}: {DIRECTIONS[dof]}",
                "standard_name": f"platform_{dof}",
            },
        )
        for dof, values in motions.items()
    }
    if wave is not None:
        name = "water_surface_height_above_reference_datum"
        data["wave"] = ("time", wave, {"units": "m", "long_name": ELEVATION, "standard_name": name})
    attributes = {
        "Conventions": CF_VERSION,
        **{name: value for name, value in about.items() if value is not None},
        "comment": (
            "Motion of the reference point from the reference position. Axes are right-handed, z upwards from still water; "
            "the rotation matrix is Rz(yaw) Ry(pitch) Rx(roll)."
        ),
    }
    # no standard name: that of CF is for times since a date
    return xr.Dataset(data, {"time": ("time", time, {"units": "s", "long_name": "time", "axis": "T"})}, attributes)
