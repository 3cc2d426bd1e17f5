"""Tables from data files: text, MATLAB .mat, NetCDF, Excel, OpenFAST .out and .outb.

The content decides the format, then the ending. Text with another ending is read as delimited text. `read_table` is the only
public name. Columns keep the file's names and their order; a text file without a header gets "0", "1", ... Values are as
written: no units, no signs, no repairs.
"""

from __future__ import annotations

import csv
import re
import struct
from collections import Counter
from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from jaxhydro.errors import InputError
from jaxhydro.interop.delimited_text import decoded, parse, reason, wrong
from jaxhydro.interop.matlab import mat73, matlab, side_by_side
from jaxhydro.interop.spreadsheet import workbook
from jaxhydro.interop.stated_units import stated_unit


def read_table(path: str | Path, keep_text: bool = False) -> pd.DataFrame:
    """Table of a data file, one row per sample.

    `attrs` of the table may have `stated`, the units that the file states, by column. `times` are the columns that were
    written as times of day or time stamps and are now seconds. `row` is the number of the first row of a text file.
    `not_numbers` has the mistakes of columns of numbers with text among them, by column number.

    Args:
        path: The file.
        keep_text: Whether a column of numbers with text among them stays text. Else it is an error.

    Raises:
        InputError: The file is absent, unreadable or not a table of numbers. It names the row (counted from 1, as an editor
            does) and the column where known.
    """
    path = Path(path)
    try:
        table = _reader(path)(path)
    except (OSError, ValueError) as error:  # ValueError: a null character in the name
        raise wrong(path, "file", "a file that can be read", reason(error)) from error
    except (csv.Error, MemoryError) as error:
        raise wrong(path, "file", "a table of a sensible size", reason(error)) from error
    if not len(table):
        raise wrong(path, "file", "rows of numbers", "no rows")
    numeric = any(kind.kind == "f" for kind in table.dtypes)
    if (mistakes := table.attrs.get("not_numbers")) and not (keep_text and numeric):
        raise InputError(str(path), [problem for problems in mistakes.values() for problem in problems])
    if not numeric:
        raise wrong(path, "file", "a numeric column", "only text, in " + ", ".join(map(str, table.columns[:10])))
    stated = {str(name): stated_unit(str(name), table.attrs.get("units", {})) for name in table.columns}
    table.attrs["stated"] = {name: unit for name, unit in stated.items() if unit is not None}
    return table


def _reader(path: Path) -> Callable[[Path], pd.DataFrame]:
    """Reader for a file, by its first bytes, then by its ending.

    Raises:
        InputError: It is no data file.
    """
    ending = path.suffix.lower()
    if ending in _NO_DATA:
        raise wrong(path, "file name", _DATA, f"one that ends in {ending}")
    with path.open("rb") as file:
        start = file.read(8)
    if start.startswith(b"\x89HDF\r\n\x1a\n"):
        return matlab if ending == ".mat" else _netcdf
    if start.startswith(b"\xd0\xcf\x11\xe0") or ending == ".xls":
        raise wrong(path, "file", _DATA, "an old Excel workbook (.xls)", "Save it as .xlsx or CSV.")
    for first, read in _STARTS.items():
        if start.startswith(first):
            return read
    if ending not in _READERS and _outb_size(path) == path.stat().st_size > 0:
        return _openfast_binary
    return _READERS.get(ending, _text)


def _text(path: Path) -> pd.DataFrame:
    return parse(path, decoded(path).split("\n"))


def _netcdf(path: Path) -> pd.DataFrame:
    """The one-dimensional variables along the dimension that has most of them."""
    import xarray as xr

    with path.open("rb") as file:  # a missing file is told as such
        hdf5 = file.read(8) == b"\x89HDF\r\n\x1a\n"
    try:
        if hdf5:
            import h5py

            with h5py.File(path) as file5:  # a damaged one is refused here: h5netcdf would leave a traceback
                scales = [name for name, item in file5.items() if item.attrs.get("CLASS") == b"DIMENSION_SCALE"]
                if not scales and "_NCProperties" not in file5.attrs:
                    return mat73(path)  # HDF5 of another kind
        with xr.open_dataset(path, engine="h5netcdf" if hdf5 else "scipy", decode_times=False) as data:
            flat = {str(name): v for name, v in data.variables.items() if v.ndim == 1 and v.dtype.kind in "iufb"}
            along = [name for name, _ in Counter(item.dims[0] for item in flat.values()).most_common(1)]
            series = {name: item.to_numpy() for name, item in flat.items() if item.dims[0] in along}
            units = {name: str(flat[name].attrs["units"]) for name in series if "units" in flat[name].attrs}
            held = [str(name) for name in data.variables]
    except InputError:
        raise
    except Exception as error:  # each of xarray's engines has its own
        raise wrong(path, "file", "a NetCDF file", reason(error)) from error
    times = [name for name, unit in units.items() if name in series and _SINCE.fullmatch(unit)]
    for name in times:  # a date in the unit: seconds from the first row
        moments = np.asarray(series[name] - series[name][:1], float)
        match = _SINCE.fullmatch(units.pop(name))
        series[name] = moments * _CF_UNITS[match[1][:3].lower()] if match else moments
    table = side_by_side(path, series, held)
    table.attrs |= {"units": units, "times": times}
    return table


_CF_UNITS = {"nan": 1e-9, "mic": 1e-6, "mil": 1e-3, "sec": 1.0, "min": 60.0, "hou": 3600.0, "day": 86400.0}  # s
_SINCE = re.compile(r"((?:nano|micro|milli)?seconds?|minutes?|hours?|days?) since .*", re.IGNORECASE)


def _openfast_reader(name: str, path: Path) -> Callable[..., Any]:
    """A function of openfast_io. Raises InputError where that is not installed."""
    try:
        module = import_module("openfast_io.FAST_output_reader")
    except ImportError as error:
        raise wrong(
            path,
            "file",
            "the library openfast_io, which reads OpenFAST outputs",
            "it is not installed",
            'pip install "jaxhydro[openfast]"',
        ) from error
    return getattr(module, name)  # type: ignore[no-any-return]


def _openfast_text(path: Path) -> pd.DataFrame:
    lines = decoded(path).split("\n")
    units = next(
        (
            i
            for i, line in enumerate(lines[:20])
            if i and line.split() and all(cell[0] == "(" and cell[-1] == ")" for cell in line.split())
        ),
        None,
    )
    if units is None:  # another program's
        table = parse(path, lines)
        if any(kind.kind == "f" for kind in table.dtypes) or table.attrs["not_numbers"]:
            return table
        raise wrong(path, "file", "an OpenFAST output: a row of units, (s) (m) (deg), near the top", "no such row")
    load = _openfast_reader("load_ascii_output", path)
    try:
        data, info = load(str(path), headerLines=units + 1, descriptionLine=0, attributeLine=units - 1, unitLine=units)
        return _with_units(pd.DataFrame(data, columns=info["attribute_names"], dtype=float), info)
    except Exception:
        return parse(path, lines[units - 1 :], first=units)  # which says what is wrong, and in which row


def _with_units(table: pd.DataFrame, info: Mapping[str, Any]) -> pd.DataFrame:
    table.attrs["units"] = dict(zip(info["attribute_names"], info["attribute_units"]))
    return table


def _openfast_binary(path: Path) -> pd.DataFrame:
    load = _openfast_reader("load_binary_output", path)
    size, expected = path.stat().st_size, _outb_size(path)
    if size < expected or not expected:  # the library would reserve whatever memory the header asks for
        raise wrong(
            path,
            "file",
            "a whole OpenFAST binary output (.outb)",
            f"{size} bytes" + (f" where {expected} are announced" if expected else " that are not one"),
        )
    try:
        with np.errstate(all="ignore"):  # a constant channel may have a scale of zero
            data, info, _ = load(str(path))
        return _with_units(pd.DataFrame(data, columns=info["attribute_names"], dtype=float), info)
    except Exception as error:
        raise wrong(path, "file", "an OpenFAST binary output (.outb)", reason(error)) from error


def _outb_size(path: Path) -> int:
    """Size (bytes) that an .outb file's header states; 0 for a header that cannot be."""
    with path.open("rb") as file:

        def integer(kind: str) -> int:
            return int(struct.unpack(kind, file.read(struct.calcsize(kind)).ljust(struct.calcsize(kind), b"\0"))[0])

        kind = integer("<h")
        width = integer("<h") if kind == 4 else 10
        channels, samples = integer("<i"), integer("<i")
        if kind not in (1, 2, 3, 4) or min(width, channels, samples) < 1:
            return 0
        file.seek(16 + (0 if kind == 3 else 8 * channels), 1)
        description = integer("<i")
        names, clock = 2 * width * (channels + 1), 4 * samples * (kind == 1)
        return (
            file.tell() + description + names + clock + channels * samples * (8 if kind == 3 else 2) if description >= 0 else 0
        )


_DATA = "a data file: text (.csv, .txt, .dat, ...), .mat, .nc, .xlsx, .out or .outb"
_NO_DATA = {".yaml", ".yml", ".json", ".toml", ".py", ".m", ".md", ".html", ".xml", ".pdf", ".docx", ".png", ".jpg", ".zip"}
_STARTS = {b"MATLAB ": matlab, b"CDF\x01": _netcdf, b"CDF\x02": _netcdf, b"CDF\x05": _netcdf, b"PK\x03\x04": workbook}
_READERS: dict[str, Callable[[Path], pd.DataFrame]] = {
    ".mat": matlab,
    ".nc": _netcdf,
    ".xlsx": workbook,
    ".xlsm": workbook,
    ".outb": _openfast_binary,
    ".out": _openfast_text,
}
