"""Tables from MATLAB .mat files: version 7.3 (HDF5) and earlier ones."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.delimited_text import reason, wrong

_MATRIX, _COMPRESSED = 14, 15
_ELEMENTS = {1, 2, 3, 4, 5, 6, 7, 9, 12, 13, _MATRIX, _COMPRESSED, 16, 17, 18}
_OPAQUE = 17  # a class of its own layout


def matlab(path: Path) -> pd.DataFrame:
    """The numeric vectors of a .mat file, at its top or one struct down. Raises InputError or OSError."""
    with path.open("rb") as file:
        start = file.read(128)
    if b"MATLAB 7.3" in start or start[:8] == b"\x89HDF\r\n\x1a\n":
        return mat73(path)
    from scipy.io import loadmat

    try:
        if not _sound(path.read_bytes()):
            raise ValueError("damaged, or cut short")
        content = loadmat(path, squeeze_me=True, struct_as_record=False)
    except Exception as error:  # scipy raises whatever the rubbish leads it to
        raise wrong(path, "file", "a MATLAB .mat file", reason(error)) from error
    content = {name: item for name, item in content.items() if not name.startswith("__")}
    structs = [
        {field: getattr(item, field) for field in item._fieldnames} for item in content.values() if hasattr(item, "_fieldnames")
    ]
    vectors: dict[str, np.ndarray] = {}
    for group in (content, *structs):
        vectors |= {name: values for name, values in _vectors(group).items() if name not in vectors}
    return side_by_side(path, vectors, content)


def _vectors(group: Mapping[str, Any]) -> dict[str, np.ndarray]:
    """Numeric vectors of one level, and the columns of its matrices.

    A cell array of as many names as a matrix has columns names these.
    """
    arrays = {name: np.asarray(v) for name, v in group.items() if not hasattr(v, "_fieldnames")}
    labels = [v for v in arrays.values() if v.ndim == 1 and v.dtype.kind in "OU"]
    numeric = {name: v for name, v in arrays.items() if v.dtype.kind in "iufb"}
    vectors = {name: v for name, v in numeric.items() if v.ndim == 1}
    for name, matrix in numeric.items():
        if matrix.ndim != 2:
            continue
        label = next((v for v in labels if len(v) in matrix.shape), None)
        columns = matrix if label is not None and len(label) != matrix.shape[1] else matrix.T
        names = [f"{name}[{i}]" for i in range(len(columns))] if label is None else [str(v).strip() for v in label]
        vectors |= dict(zip(names, columns))
    return vectors


def mat73(path: Path) -> pd.DataFrame:
    """Numeric vectors of a version 7.3 file (HDF5), at its top or in one level of groups (a struct)."""
    import h5py

    vectors: dict[str, np.ndarray] = {}
    try:
        with h5py.File(path) as file:
            held = list(file)
            structs = [item for name, item in file.items() if isinstance(item, h5py.Group) and name[0] != "#"]
            for group in (file, *structs):
                for name, item in group.items():
                    if not isinstance(item, h5py.Dataset) or item.dtype.kind not in "iuf":
                        continue
                    if max(item.shape, default=0) == item.size and item.attrs.get("MATLAB_class") != b"char":
                        vectors.setdefault(name, np.ravel(item[()]))
    except Exception as error:
        raise wrong(path, "file", "a MATLAB 7.3 file", reason(error), "save it again with -v7, or as CSV") from error
    return side_by_side(path, vectors, held)


def side_by_side(path: Path, series: Mapping[str, np.ndarray], held: Iterable[str]) -> pd.DataFrame:
    """Vectors of the longest length, put side by side.

    Vectors of less than half that length are constants of the file, and left out.

    Raises:
        InputError: There is no vector of two values or more, or one is shorter than the longest, but at least half as long.
    """
    length = max((len(values) for values in series.values()), default=0)
    if length < 2:
        raise wrong(
            path,
            "file",
            "numeric vectors of equal length, time among them",
            "none; it holds " + (", ".join(list(held)[:10]) or "nothing"),
        )
    odd = [(name, len(values)) for name, values in series.items() if length / 2 <= len(values) < length]
    if odd:
        raise InputError(
            str(path),
            [Problem(f"variable {name}", f"{length} values, as the longest has", f"{count}", "") for name, count in odd[:5]],
        )
    return pd.DataFrame({name: np.asarray(v, float) for name, v in series.items() if len(v) == length})


def _sound(data: bytes) -> bool:
    """Whether the elements of a version 5 file nest as they say they do.

    scipy takes their word for it, and the process dies where they do not. Other versions pass: they are left to scipy.

    References:
        MathWorks, MAT-File Format, chapter 1.
    """
    marks = {b"IM": "<", b"MI": ">"}
    return data[126:128] not in marks or _nested(data[128:], marks[data[126:128]])


def _nested(data: bytes, order: str, depth: int = 0) -> bool:
    children: list[tuple[int, bytes]] = []
    offset = 0
    while offset + 8 <= len(data):
        kind, size = struct.unpack_from(order + "2I", data, offset)
        if kind >> 16:  # a small element: its size and its four bytes are in the tag
            kind, size, start, offset = kind & 0xFFFF, kind >> 16, offset + 4, offset + 8
            inside = size <= 4
        else:
            start, offset = offset + 8, offset + 8 + size + (0 if kind == _COMPRESSED else -size % 8)
            inside = start + size <= len(data)
        if kind not in _ELEMENTS or not inside or depth > 20:
            return False
        content = data[start : start + size]
        if kind == _COMPRESSED:
            content = zlib.decompress(content)
        deeper = depth + 1 if kind == _MATRIX else 0
        if kind in (_MATRIX, _COMPRESSED) and content and not _nested(content, order, deeper):
            return False
        children.append((kind, content))
    return depth == 0 or _matrix(children, order)


def _matrix(children: list[tuple[int, bytes]], order: str) -> bool:
    """Whether a matrix has flags, dimensions, name, and the parts that these ask for."""
    if len(children) < 3 or children[0][0] != 6 or children[1][0] not in (5, 6) or len(children[0][1]) != 8:
        return bool(children) and _class(children, order)[0] == _OPAQUE
    (sort, flags), bounds = _class(children, order), children[1][1]
    if len(bounds) % 4 or len(bounds) < 8:
        return False
    sizes = struct.unpack(f"{order}{len(bounds) // 4}i", bounds)
    count, parts = int(np.prod(sizes, dtype=float)), children[3:]
    if min(sizes) < 0 or count > 1e9:
        return False
    if sort in (2, 3):  # a struct, an object: the length of a field's name, the names
        parts = parts[sort - 2 :]
        length = int.from_bytes(parts[0][1], "little" if order == "<" else "big") if parts else 0
        if len(parts) < 2 or not 0 < length <= 1000:
            return False
        count, parts = count * (len(parts[1][1]) // length), parts[2:]
    if sort == 16:  # a function: one matrix, whatever the dimensions
        count = len(parts)
    if sort in (1, 2, 3, 16):
        return len(parts) == count and all(kind == _MATRIX for kind, _ in parts)
    if sort == 4 or sort >= 6:  # text, numbers
        return len(parts) == 1 + bool(flags & 8) and all(
            kind not in (_MATRIX, _COMPRESSED) and (len(content) >= count or sort == 4) for kind, content in parts
        )
    return True


def _class(children: list[tuple[int, bytes]], order: str) -> tuple[int, int]:
    word = struct.unpack(order + "I", children[0][1][:4].ljust(4, b"\0"))[0]
    return word & 0xFF, word >> 8 & 0xFF
