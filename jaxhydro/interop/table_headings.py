"""Wave headings that a table of another program has."""

import math
from functools import lru_cache
from os import PathLike
from pathlib import Path

import numpy as np
from jaxtyping import Float

from jaxhydro.interop import wamit_drift, wamit_excitation
from jaxhydro.interop.capytaine_dataset import open_capytaine
from jaxhydro.interop.capytaine_waves import capytaine_headings
from jaxhydro.interop.nemoh_tables import nemoh_headings
from jaxhydro.interop.wamit_tables import headings_in, table_of
from jaxhydro.waves.heading_interpolation import HeadingInterpolation


def table_headings(
    path: str | PathLike[str], kind: str, by: str = "period", body: int | str | None = None
) -> Float[np.ndarray, " d"]:
    """Headings (deg) of the waves that a table was computed for, once each, ascending from -180.

    Args:
        path: The file.
        kind: "wamit" for `.3`, "wamit drift" for `.12d`, "capytaine" for a dataset, "nemoh" for its .tec file.
        by: What the first column of a WAMIT file is: "period" (s), "rad/s" or "Hz".
        body: Number or name of the body, where the file has several.

    Raises:
        InputError: The file cannot be read.
    """
    file = Path(path)
    return _found(str(path), file.stat().st_mtime_ns if file.is_file() else 0, kind, by, body)


def covers(headings: Float[np.ndarray, " d"], heading: float) -> bool:
    """Whether a heading (deg) lies within the headings (deg) of a table.

    Where the headings go round the whole circle, all others are between them.
    """
    none = np.zeros(len(headings), complex)
    return bool(HeadingInterpolation.of(np.radians(headings), none).covers(math.radians(heading)))


def spoken(headings: Float[np.ndarray, " d"]) -> str:
    """Headings (deg) in words: all of a few, or the first and the last."""
    if len(headings) <= 4:
        return ", ".join(f"{round(float(heading), 6) + 0.0:g}" for heading in headings)
    table = HeadingInterpolation.of(np.radians(headings), np.zeros(len(headings), complex))
    first, last = (math.degrees(float(table.heading[i])) for i in (0, -1))
    return f"{first:.6g} to {last:.6g}"


@lru_cache(maxsize=32)
def _found(path: str, stamp: int, kind: str, by: str, body: int | str | None) -> Float[np.ndarray, " d"]:
    if kind == "capytaine":
        assert not isinstance(body, int)
        return capytaine_headings(open_capytaine(path, (), body))
    assert not isinstance(body, str)
    if kind == "nemoh":
        return nemoh_headings(path)
    if kind == "wamit":
        rows = table_of(path, ".3", wamit_excitation.COLUMNS, slice(0, 1), 2, by, body)
        return headings_in(rows, slice(1, 2))
    rows = table_of(path, ".12d", wamit_drift.COLUMNS, slice(0, 2), 4, by, body)
    return headings_in(rows, slice(2, 4))
