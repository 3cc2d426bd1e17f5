"""Data files to tables: delimited text, MATLAB .mat, NetCDF, OpenFAST .out and .outb. The ending says which.

`read_table` is the only public name. Columns keep the file's names and their order; a text file without a header gets
"0", "1", ... Values are as written: no units, no signs, no repairs.
"""

from __future__ import annotations

import csv
import struct
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from calibration.delimited import decoded, parse, reason, wrong
from calibration.matlab import matlab, side_by_side


def read_table(path: str | Path) -> pd.DataFrame:
    """The table in a data file, one row per sample.

    Raises InputError, and nothing else, for a file that is absent, unreadable or not a table of numbers; it names the
    row (counted from 1, as an editor does) and the column where that can be said.
    """
    path = Path(path)
    reader = next((read for ending, read in _READERS.items() if path.name.lower().endswith(ending)), None)
    if reader is None:
        raise wrong(path, "file name", "one of the endings " + ", ".join(_READERS), path.suffix or "no ending")
    try:
        table = reader(path)
    except (OSError, ValueError) as error:       # ValueError: a null character in the name
        raise wrong(path, "file", "a file that can be read", reason(error)) from error
    except (csv.Error, MemoryError) as error:
        raise wrong(path, "file", "a table of a sensible size", reason(error)) from error
    if not len(table):
        raise wrong(path, "file", "rows of numbers", "no rows")
    if not any(kind.kind == "f" for kind in table.dtypes):
        raise wrong(path, "file", "a numeric column", "only text, in " + ", ".join(map(str, table.columns[:10])))
    return table


def _text(path: Path) -> pd.DataFrame:
    return parse(path, decoded(path).split("\n"))


def _netcdf(path: Path) -> pd.DataFrame:
    """The one-dimensional variables along the dimension that has most of them."""
    import xarray as xr
    with path.open("rb") as file:                # a missing file is told as such
        hdf5 = file.read(8) == b"\x89HDF\r\n\x1a\n"
    try:
        if hdf5:
            import h5py
            with h5py.File(path) as file5:       # a damaged one is refused here: h5netcdf would leave a traceback
                file5.attrs.get("_nc3_strict")
        with xr.open_dataset(path, engine="h5netcdf" if hdf5 else "scipy", decode_times=False) as data:
            flat = {str(name): v for name, v in data.variables.items() if v.ndim == 1 and v.dtype.kind in "iufb"}
            along = [name for name, _ in Counter(item.dims[0] for item in flat.values()).most_common(1)]
            found = {name: item.to_numpy() for name, item in flat.items() if item.dims[0] in along}
            held = [str(name) for name in data.variables]
    except Exception as error:                   # each of xarray's engines has its own
        raise wrong(path, "file", "a NetCDF file", reason(error)) from error
    return side_by_side(path, found, held)


def _openfast(path: Path) -> pd.DataFrame:
    try:
        from openfast_io.FAST_output_reader import load_ascii_output, load_binary_output
    except ImportError as error:
        raise wrong(path, "file", "the library openfast_io, which reads OpenFAST outputs", "it is not installed",
                    'pip install "jaxhydro[openfast]"') from error
    return _outb(path, load_binary_output) if path.name.lower().endswith("b") else _out(path, load_ascii_output)


def _out(path: Path, load: Callable[..., Any]) -> pd.DataFrame:
    lines = decoded(path).split("\n")
    units = next((i for i, line in enumerate(lines[:20]) if i and line.split()
                  and all(cell[0] == "(" and cell[-1] == ")" for cell in line.split())), None)
    if units is None:
        raise wrong(path, "file", "an OpenFAST output: a row of units, (s) (m) (deg), near the top", "no such row")
    try:
        data, info = load(str(path), headerLines=units + 1, descriptionLine=0, attributeLine=units - 1, unitLine=units)
        return pd.DataFrame(data, columns=info["attribute_names"], dtype=float)
    except Exception:
        return parse(path, lines[units - 1:], first=units)        # which says what is wrong, and in which row


def _outb(path: Path, load: Callable[..., Any]) -> pd.DataFrame:
    found, expected = path.stat().st_size, _outb_size(path)
    if found < expected or not expected:         # the library would reserve whatever memory the header asks for
        raise wrong(path, "file", "a whole OpenFAST binary output (.outb)",
                    f"{found} bytes" + (f" where {expected} are announced" if expected else " that are not one"))
    try:
        with np.errstate(all="ignore"):          # a constant channel may have a scale of zero
            data, info, _ = load(str(path))
        return pd.DataFrame(data, columns=info["attribute_names"], dtype=float)
    except Exception as error:
        raise wrong(path, "file", "an OpenFAST binary output (.outb)", reason(error)) from error


def _outb_size(path: Path) -> int:
    """What an .outb file's header says its size is, in bytes; 0 for a header that cannot be."""
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
        return file.tell() + description + names + clock + channels * samples * (8 if kind == 3 else 2) \
            if description >= 0 else 0


_READERS: dict[str, Callable[[Path], pd.DataFrame]] = {
    ".csv": _text, ".txt": _text, ".dat": _text, ".tsv": _text,
    ".csv.gz": _text, ".txt.gz": _text, ".dat.gz": _text, ".tsv.gz": _text,
    ".mat": matlab, ".nc": _netcdf, ".outb": _openfast, ".out": _openfast,
}
