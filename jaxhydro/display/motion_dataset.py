"""A motion as an xarray data set after the CF conventions."""

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from jaxhydro.display.data_frames import single
from jaxhydro.environment import DOFS
from jaxhydro.units import for_people

if TYPE_CHECKING:
    from jaxhydro.dynamics.response import Response

CF_VERSION = "CF-1.11"
DIRECTIONS = {
    "surge": "displacement along x",
    "sway": "displacement along y",
    "heave": "displacement along z, upwards",
    "roll": "rotation about x",
    "pitch": "rotation about y",
    "yaw": "rotation about z",
}


def response_dataset(response: "Response") -> xr.Dataset:
    """Position of the reference point over time, a variable for each motion, in m and degrees as in the package's files.

    The standard names are those without a sign convention: a moored platform has no forward direction. The attribute `comment`
    says which way the axes point.

    Args:
        response: The motion, (t, 6).

    Returns:
        Variables `surge` ... `yaw` with `units`, `long_name` and `standard_name`; coordinate `time` (s).

    Raises:
        ValueError: There are several motions in one, (..., t, 6).

    References:
        CF conventions, standard name table (platform_surge ... platform_yaw).
    """
    import jaxhydro

    data = {
        dof: (
            "time",
            for_people(dof, values),
            {
                "units": "m" if dof in DOFS[:3] else "degree",
                "long_name": f"{dof}: {DIRECTIONS[dof]}",
                "standard_name": f"platform_{dof}",
            },
        )
        for dof, values in single(response).items()
    }
    about = {
        "Conventions": CF_VERSION,
        "title": "Motion of a floating platform",
        "source": f"jaxhydro {jaxhydro.__version__}",
        "comment": (
            "Motion of the reference point from the reference position. Axes are right-handed, z upwards from still water; "
            "the rotation matrix is Rz(yaw) Ry(pitch) Rx(roll)."
        ),
    }
    # no standard name: that of CF is for times since a date
    time = ("time", np.asarray(response.time), {"units": "s", "long_name": "time", "axis": "T"})
    return xr.Dataset(data, {"time": time}, about)
