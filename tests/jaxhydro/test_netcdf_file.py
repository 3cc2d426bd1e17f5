"""NetCDF files written without xarray are those that xarray writes."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import xarray as xr

from jaxhydro.netcdf_file import COMPRESSION, DataSet, write_netcdf

TIME = np.linspace(0.0, 5.0, 11)
MOTION = np.stack([TIME, np.where(TIME > 4, np.nan, TIME)])
NAMES = np.array(["surge", "yaw"], dtype=object)
DATA = DataSet(
    {
        "motion": (
            ("channel", "time"),
            np.stack([TIME, np.where(TIME > 4, np.nan, TIME)]),
            {"units": "m", "long_name": "motion"},
        ),
        "scored": (("channel",), np.array([1, 0], dtype="int8"), {"units": "1"}),
        "wave": ("time", np.sin(TIME), {}),
    },
    {
        "time": ("time", TIME, {"units": "s"}),
        "channel": ("channel", NAMES, {"long_name": "motion"}),
        "unit": ("channel", np.array(["m", "°"], dtype=object), {}),
        "about": ("channel", np.array(["", "b"], dtype=object), {}),
    },
    {"title": "Motion in °", "order": 2, "height": 3.5},
)


def structure(path: Path) -> dict[str, Any]:
    """Type, storage and attributes of each variable, those of the netCDF library aside."""
    with h5py.File(path) as file:
        return {
            name: (
                *(data.shape, str(data.dtype), data.compression, data.compression_opts, data.chunks, str(data.fillvalue)),
                {key: str(value) for key, value in data.attrs.items() if key.islower() or key == "_FillValue"},
            )
            for name, data in file.items()
        }


def test_the_file_is_that_of_xarray(tmp_path: Path) -> None:
    ours, theirs = tmp_path / "ours.nc", tmp_path / "theirs.nc"
    write_netcdf(DATA, ours, {"motion": COMPRESSION})
    packed = {"motion": {"zlib": True, "complevel": COMPRESSION}}
    xr.Dataset(*DATA).to_netcdf(theirs, engine="h5netcdf", encoding=packed)
    with xr.open_dataset(ours) as read, xr.open_dataset(theirs) as expected:
        xr.testing.assert_identical(read.load(), expected.load())
        assert list(read.variables) == list(expected.variables) and list(read.attrs) == list(expected.attrs)
    assert structure(ours) == structure(theirs)
