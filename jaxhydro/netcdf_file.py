"""NetCDF files of variables as xarray takes them, written without xarray: its import takes as long as a short simulation."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

COMPRESSION = 4  # level, of series


class DataSet(NamedTuple):
    """Arguments of `xarray.Dataset`.

    Attributes:
        variables: Dimension or dimensions, values and attributes of each variable, by name.
        coordinates: The same of each coordinate.
        attributes: Attributes of the data set.
    """

    variables: Mapping[str, tuple[str | tuple[str, ...], np.ndarray, Mapping[str, Any]]]
    coordinates: Mapping[str, tuple[str | tuple[str, ...], np.ndarray, Mapping[str, Any]]]
    attributes: Mapping[str, Any]


def write_netcdf(data: DataSet, path: Path, levels: Mapping[str, int]) -> None:
    """Write what `xarray.Dataset(*data).to_netcdf(path, engine="h5netcdf")` does: netCDF-4, missing numbers as nan.

    Args:
        data: The data set. Its variables are arrays of numbers or of text.
        path: The file.
        levels: Levels of compression by variable, from 1 to 9; of others the values are written as they are.
    """
    import h5netcdf  # here, so that commands that write nothing do without
    import h5py

    coordinates = {name: _dimensions(of[0]) for name, of in data.coordinates.items()}
    with h5netcdf.File(path, "w") as file:
        file.attrs.update(data.attributes)
        for name, (dimensions, values, about) in {**data.variables, **data.coordinates}.items():
            along = _dimensions(dimensions)
            for dimension, size in zip(along, values.shape, strict=True):
                if dimension not in file.dimensions:
                    file.dimensions[dimension] = size
            kind = h5py.string_dtype() if values.dtype == object else values.dtype
            missing = np.nan if values.dtype.kind == "f" else None
            packed = {"compression": "gzip", "compression_opts": levels[name]} if name in levels else {}
            variable = file.create_variable(name, along, kind, fillvalue=missing, **packed)
            variable[...] = values
            variable.attrs.update(about)
            beside = [other for other, its in coordinates.items() if (other,) != its and set(its) <= set(along)]
            if name in data.variables and beside:
                variable.attrs["coordinates"] = " ".join(sorted(beside))


def _dimensions(names: str | tuple[str, ...]) -> tuple[str, ...]:
    return (names,) if isinstance(names, str) else names
