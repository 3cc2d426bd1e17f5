"""Directional spectra from CSV and NetCDF files, in the conventions of wavespectra.

The files have efth over freq and dir.
"""

import math
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
from jaxtyping import Float

from jaxhydro.errors import InputError, Problem
from jaxhydro.waves.directional_spectrum import TabulatedDirections

FREQUENCY, DIRECTION, DENSITY = "freq", "dir", "efth"
NAMES = (FREQUENCY, DIRECTION, DENSITY)
MAX_UNEVENNESS = 1e-3  # of a bin of directions
UNITS = ("m2 s degree-1", "m^{2}.s.degree^{-1}", "m2/Hz/degree", "m2/Hz/deg", "m2 Hz-1 degree-1", "m2 Hz-1 deg-1")


class _Table(NamedTuple):
    frequency: Float[np.ndarray, " n"]  # Hz
    direction: Float[np.ndarray, " d"]  # deg
    density: Float[np.ndarray, "n d"]  # m2/Hz/deg


def read_directional_spectrum(path: str | PathLike[str], x_bearing: float = 0.0) -> TabulatedDirections:
    """Read a directional spectrum: `efth` (m²/Hz/deg) over `freq` (Hz) and `dir` (deg).

    As in wavespectra and WAVEWATCH III, `dir` is where waves come from, clockwise from north. A wave from `dir` travels to
    the compass bearing dir + 180; its heading is x_bearing - dir - 180, from x towards y, seen from above.

    - CSV: three columns freq, dir, efth, a row for each pair; lines from # on are comments.
    - NetCDF: a variable efth of dimensions freq and dir, others of length 1.

    Args:
        path: The file: `.csv`, or NetCDF with any other ending.
        x_bearing: Compass bearing of the platform's x axis (deg).

    Returns:
        The spectrum.

    Raises:
        InputError: With the file and what is wrong in it.
    """

    def wrong(where: str, expected: str, found: str) -> InputError:
        return InputError(str(path), [Problem(where, expected, found)])

    read = _from_csv if Path(path).suffix.lower() in (".csv", ".txt") else _from_netcdf
    table = read(path)
    for name, values in zip(NAMES, table):
        if bad := int((~np.isfinite(values)).sum()):
            raise wrong(name, "finite numbers", f"{bad} that are not")
    if table.frequency.size < 2 or not (np.diff(table.frequency) > 0).all() or table.frequency[0] < 0:
        raise wrong(FREQUENCY, "two frequencies (Hz) or more, from 0 on", f"{table.frequency.size} of them")
    if (table.density < 0).any() or not table.density.any():
        found = f"{table.density.min():g}" if (table.density < 0).any() else "zeros only"
        raise wrong(DENSITY, "densities that are not negative, with energy", found)
    # headings ascend as directions descend; begin after the largest gap
    heading = np.mod(x_bearing - table.direction - 180, 360)
    order = np.argsort(heading)
    heading = heading[order]
    if heading.size < 2 or (np.diff(heading) < 1e-6).any():
        raise wrong(DIRECTION, "two directions (deg) or more, each once", f"{heading.size}, or one twice")
    gaps = np.diff(np.r_[heading, heading[0] + 360])
    begin = (int(np.argmax(gaps)) + 1) % heading.size
    order, heading = np.roll(order, -begin), np.unwrap(np.roll(heading, -begin), period=360)
    steps = np.diff(heading)
    if np.ptp(steps) > MAX_UNEVENNESS * steps.mean():
        raise wrong(DIRECTION, "even steps", f"steps from {steps.min():g} to {steps.max():g} deg")
    values = table.density[:, order] / (2 * math.pi) / math.radians(1)
    return TabulatedDirections(2 * math.pi * table.frequency, np.radians(heading), values)


def _from_csv(path: str | PathLike[str]) -> _Table:
    def wrong(where: str, expected: str, found: str) -> InputError:
        return InputError(str(path), [Problem(where, expected, found)])

    try:
        rows = pd.read_csv(path, comment="#", skipinitialspace=True)
    except FileNotFoundError:
        raise wrong("", "a CSV or NetCDF file", "no such file") from None
    except (OSError, ValueError) as error:
        raise wrong("", "a CSV file with columns freq, dir, efth", str(error).splitlines()[0]) from None
    rows.columns = [str(name).strip().lower() for name in rows.columns]
    for name in NAMES:
        if name not in rows.columns:
            raise wrong("", f"a column {name}, beside {' and '.join(n for n in NAMES if n != name)}", ", ".join(rows.columns))
        if rows[name].dtype.kind not in "fiu":
            raise wrong(f"column {name}", "numbers", "text")
    if rows.duplicated([FREQUENCY, DIRECTION]).any():
        raise wrong("", "each pair of freq and dir once", f"{int(rows.duplicated([FREQUENCY, DIRECTION]).sum())} twice")
    wide = rows.pivot(index=FREQUENCY, columns=DIRECTION, values=DENSITY)
    if lost := int(wide.isna().to_numpy().sum()):
        raise wrong(DENSITY, "a number for each freq with each dir", f"{lost} of {wide.size} that are missing")
    return _Table(*(np.asarray(x, float) for x in (wide.index, wide.columns, wide.to_numpy())))


def _from_netcdf(path: str | PathLike[str]) -> _Table:
    import xarray as xr

    def wrong(where: str, expected: str, found: str) -> InputError:
        return InputError(str(path), [Problem(where, expected, found)])

    try:
        with xr.open_dataset(path) as opened:
            data = opened.load()
    except FileNotFoundError:
        raise wrong("", "a CSV or NetCDF file", "no such file") from None
    except Exception as error:  # each of xarray's engines has its own
        raise wrong("", "a NetCDF file with efth over freq and dir", str(error).splitlines()[0]) from None
    if DENSITY not in data.variables:
        raise wrong("", f"a variable {DENSITY}", ", ".join(map(str, data.variables)) or "none")
    values = data[DENSITY]
    for name in (FREQUENCY, DIRECTION):
        if name not in values.dims or name not in values.coords:
            raise wrong(DENSITY, f"a dimension {name} with its values", ", ".join(map(str, values.dims)) or "none")
    if many := [f"{dim} of {size}" for dim, size in values.sizes.items() if dim not in NAMES and size != 1]:
        raise wrong(DENSITY, "one spectrum: other dimensions of length 1", ", ".join(many))
    unit = values.attrs.get("units")
    if unit is not None and unit not in UNITS:
        raise wrong(f"{DENSITY}.units", UNITS[0], str(unit))
    table = values.squeeze([dim for dim in values.dims if dim not in NAMES]).transpose(FREQUENCY, DIRECTION).sortby(FREQUENCY)
    frequency, direction = (np.asarray(table[name].values, float) for name in (FREQUENCY, DIRECTION))
    return _Table(frequency, direction, np.asarray(table.values, float))
