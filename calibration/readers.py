"""Data files to tables: delimited text, MATLAB .mat, NetCDF, OpenFAST .out and .outb. The ending says which.

`read_table` is the only public name. Columns keep the file's names and their order; a text file without a header gets
"0", "1", ... Values are as written: no units, no signs, no repairs.
"""

from __future__ import annotations

import csv
import struct
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from calibration.delimited import decoded, parse, wrong
from jaxhydro.problems import InputError, Problem


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
        raise wrong(path, "file", "a file that can be read", _reason(error)) from error
    except (csv.Error, MemoryError) as error:
        raise wrong(path, "file", "a table of a sensible size", _reason(error)) from error
    if not len(table):
        raise wrong(path, "file", "rows of numbers", "no rows")
    if not any(kind.kind == "f" for kind in table.dtypes):
        raise wrong(path, "file", "a numeric column", "only text, in " + ", ".join(map(str, table.columns[:10])))
    return table


def _reason(error: BaseException) -> str:
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return f"{type(error).__name__}: {' '.join(str(error).split())[:200]}"


def _text(path: Path) -> pd.DataFrame:
    return parse(path, decoded(path).split("\n"))


def _frame(path: Path, series: Mapping[str, np.ndarray], held: Iterable[str]) -> pd.DataFrame:
    """Vectors of the longest length, put side by side; much shorter ones are constants of the file and left out."""
    length = max((len(values) for values in series.values()), default=0)
    if length < 2:
        raise wrong(path, "file", "numeric vectors of equal length, time among them",
                    "none; it holds " + (", ".join(list(held)[:10]) or "nothing"))
    odd = [(name, len(values)) for name, values in series.items() if length / 2 <= len(values) < length]
    if odd:
        raise InputError(str(path), [Problem(f"variable {name}", f"{length} values, as the longest has", f"{found}", "")
                                     for name, found in odd[:5]])
    return pd.DataFrame({name: np.asarray(v, float) for name, v in series.items() if len(v) == length})


def _mat(path: Path) -> pd.DataFrame:
    with path.open("rb") as file:
        start = file.read(128)
    if b"MATLAB 7.3" in start or start[:8] == b"\x89HDF\r\n\x1a\n":
        return _mat73(path)
    from scipy.io import loadmat
    try:
        content = loadmat(path, squeeze_me=True, struct_as_record=False)
    except Exception as error:                   # scipy raises whatever the rubbish leads it to
        raise wrong(path, "file", "a MATLAB .mat file", _reason(error)) from error
    content = {name: item for name, item in content.items() if not name.startswith("__")}
    structs = [{field: getattr(item, field) for field in item._fieldnames}
               for item in content.values() if hasattr(item, "_fieldnames")]
    found: dict[str, np.ndarray] = {}
    for group in (content, *structs):
        found |= {name: values for name, values in _vectors(group).items() if name not in found}
    return _frame(path, found, content)


def _vectors(group: Mapping[str, Any]) -> dict[str, np.ndarray]:
    """The numeric vectors of one level, and the columns of matrices; a cell array of as many names names these."""
    arrays = {name: np.asarray(v) for name, v in group.items() if not hasattr(v, "_fieldnames")}
    labels = [v for v in arrays.values() if v.ndim == 1 and v.dtype.kind in "OU"]
    numeric = {name: v for name, v in arrays.items() if v.dtype.kind in "iufb"}
    found = {name: v for name, v in numeric.items() if v.ndim == 1}
    for name, matrix in numeric.items():
        if matrix.ndim != 2:
            continue
        label = next((v for v in labels if len(v) in matrix.shape), None)
        columns = matrix if label is not None and len(label) != matrix.shape[1] else matrix.T
        names = [f"{name}[{i}]" for i in range(len(columns))] if label is None else [str(v).strip() for v in label]
        found |= dict(zip(names, columns))
    return found


def _mat73(path: Path) -> pd.DataFrame:
    """Version 7.3 is HDF5: vectors at the top, or in one level of groups (a struct)."""
    import h5py
    found: dict[str, np.ndarray] = {}
    try:
        with h5py.File(path) as file:
            held = list(file)
            structs = [item for name, item in file.items() if isinstance(item, h5py.Group) and name[0] != "#"]
            for group in (file, *structs):
                for name, item in group.items():
                    if not isinstance(item, h5py.Dataset) or item.dtype.kind not in "iuf":
                        continue
                    if max(item.shape, default=0) == item.size and item.attrs.get("MATLAB_class") != b"char":
                        found.setdefault(name, np.ravel(item[()]))
    except Exception as error:
        raise wrong(path, "file", "a MATLAB 7.3 file", _reason(error), "save it again with -v7, or as CSV") from error
    return _frame(path, found, held)


def _netcdf(path: Path) -> pd.DataFrame:
    """The one-dimensional variables along the dimension that has most of them."""
    import xarray as xr
    path.open("rb").close()                      # so that a missing file is told as such
    try:
        with xr.open_dataset(path, decode_times=False) as data:
            flat = {str(name): v for name, v in data.variables.items() if v.ndim == 1 and v.dtype.kind in "iufb"}
            along = [name for name, _ in Counter(item.dims[0] for item in flat.values()).most_common(1)]
            found = {name: item.to_numpy() for name, item in flat.items() if item.dims[0] in along}
            held = [str(name) for name in data.variables]
    except Exception as error:                   # each of xarray's engines has its own
        raise wrong(path, "file", "a NetCDF file", _reason(error)) from error
    return _frame(path, found, held)


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
    size = path.stat().st_size
    with path.open("rb") as file:
        start = file.read(12).ljust(12, b"\0")
    kind, = struct.unpack("<h", start[:2])
    channels, samples = struct.unpack("<2i", start[4:12] if kind == 4 else start[2:10])
    least = channels * samples * (8 if kind == 3 else 2) + 12
    if kind not in (1, 2, 3, 4) or channels < 1 or samples < 1 or size < least:
        raise wrong(path, "file", "a whole OpenFAST binary output (.outb)", f"{size} bytes that are not one")
    try:
        with np.errstate(all="ignore"):          # a constant channel may have a scale of zero
            data, info, _ = load(str(path))
        return pd.DataFrame(data, columns=info["attribute_names"], dtype=float)
    except Exception as error:
        raise wrong(path, "file", "an OpenFAST binary output (.outb)", _reason(error)) from error


_READERS: dict[str, Callable[[Path], pd.DataFrame]] = {
    ".csv": _text, ".txt": _text, ".dat": _text, ".tsv": _text,
    ".csv.gz": _text, ".txt.gz": _text, ".dat.gz": _text, ".tsv.gz": _text,
    ".mat": _mat, ".nc": _netcdf, ".outb": _openfast, ".out": _openfast,
}
