"""Spectra of waves from files: CSV and NetCDF in the conventions of wavespectra, NDBC's text, SWAN and WAVEWATCH III.

Tables have efth over freq and dir.
"""

import math
from datetime import datetime
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from jaxtyping import Float

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.ndbc_spectra import BuoySpectrum, is_ndbc, read_ndbc
from jaxhydro.waves.tabulated_sea import TabulatedDirections, TabulatedFrequencies

FREQUENCY, DIRECTION, DENSITY, TIME = "freq", "dir", "efth", "time"
NAMES = (FREQUENCY, DIRECTION, DENSITY)
MAX_UNEVENNESS = 1e-3  # of a bin of directions
BUOY_BINS = 72  # of directions, for a buoy's spectrum: 5 deg each
UNITS = ("m2 s degree-1", "m^{2}.s.degree^{-1}", "m2/Hz/degree", "m2/Hz/deg", "m2 Hz-1 degree-1", "m2 Hz-1 deg-1")
EXPECTED = "a CSV, NetCDF, NDBC or SWAN file"
INSTALL = "pip install 'jaxhydro[spectra]'"


class _Table(NamedTuple):
    frequency: Float[np.ndarray, " n"]  # Hz
    direction: Float[np.ndarray, " d"]  # deg
    density: Float[np.ndarray, "n d"]  # m2/Hz/deg


def read_sea_file(
    path: str | PathLike[str], x_bearing: float = 0.0, time: datetime | None = None
) -> TabulatedDirections | TabulatedFrequencies:
    """Read a spectrum of waves, with directions where the file has them.

    - CSV and NetCDF: as `read_directional_spectrum`.
    - NDBC's text: spectral densities, with directions of the four files beside it, by maximum entropy. Without these it has
      the heading 0 and is long-crested.
    - SWAN's spectra, and WAVEWATCH III's NetCDF: by wavespectra.

    Args:
        path: The file.
        x_bearing: Compass bearing of the platform's x axis (deg).
        time: Time of the spectrum (UTC); None: the file has one.

    Returns:
        The spectrum.

    Raises:
        InputError: With the file and what is wrong in it, or the times that it has.
    """
    if not is_ndbc(path):
        return read_directional_spectrum(path, x_bearing, time)
    buoy = read_ndbc(path, time)
    if (buoy.density < 0).any() or not buoy.density.any():
        found = f"{buoy.density.min():g}" if (buoy.density < 0).any() else "zeros only"
        raise InputError(str(path), [Problem("", "densities that are not negative, with energy", found)])
    if buoy.first is None:
        return TabulatedFrequencies(2 * math.pi * buoy.frequency, buoy.density / (2 * math.pi))
    return _spectrum(path, _of_buoy(buoy), x_bearing)


def read_directional_spectrum(
    path: str | PathLike[str], x_bearing: float = 0.0, time: datetime | None = None
) -> TabulatedDirections:
    """Read a directional spectrum: `efth` (m²/Hz/deg) over `freq` (Hz) and `dir` (deg).

    As in wavespectra and WAVEWATCH III, `dir` is where waves come from, clockwise from north. A wave from `dir` travels to
    the compass bearing dir + 180; its heading is x_bearing - dir - 180, from x towards y, seen from above.

    - CSV: three columns freq, dir, efth, a row for each pair; lines from # on are comments.
    - NetCDF: a variable efth of dimensions freq and dir, and time; others of length 1.

    Args:
        path: The file: `.csv`, a spectrum of SWAN, or NetCDF.
        x_bearing: Compass bearing of the platform's x axis (deg).
        time: Time of the spectrum (UTC); None: the file has one.

    Returns:
        The spectrum.

    Raises:
        InputError: With the file and what is wrong in it, or the times that it has.
    """
    if Path(path).suffix.lower() in (".csv", ".txt"):
        if time is not None:
            raise InputError(str(path), [Problem("time", "a file with times", "a table of one spectrum, without --sea-time")])
        return _spectrum(path, _from_csv(path), x_bearing)
    return _spectrum(path, _from_dataset(path, time), x_bearing)


def _spectrum(path: str | PathLike[str], table: _Table, x_bearing: float) -> TabulatedDirections:
    """Spectrum of a table, over headings. Raises InputError."""

    def wrong(where: str, expected: str, found: str) -> InputError:
        return InputError(str(path), [Problem(where, expected, found)])

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
        raise wrong("", EXPECTED, "no such file") from None
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


def _of_buoy(buoy: BuoySpectrum) -> _Table:
    """Table of a buoy's spectrum, with directions by maximum entropy."""
    from jaxhydro.interop.buoy_directions import maximum_entropy

    assert buoy.first is not None and buoy.second is not None
    distribution = maximum_entropy(buoy.first, buoy.second, BUOY_BINS)
    direction = np.arange(BUOY_BINS) * 360 / BUOY_BINS
    return _Table(buoy.frequency, direction, buoy.density[:, None] * distribution * math.radians(1))


def _dataset(path: str | PathLike[str]) -> Any:
    """Dataset (xarray) of a NetCDF file or of a spectrum of SWAN."""
    import xarray as xr

    def wrong(expected: str, found: str, hint: str = "") -> InputError:
        return InputError(str(path), [Problem("", expected, found, hint)])

    try:
        with open(path, "rb") as file:
            swan = file.read(4) == b"SWAN"
        if not swan:
            with xr.open_dataset(path) as opened:
                data = opened.load()
            if DENSITY not in data.variables or not {"frequency", "direction"} <= {*data[DENSITY].dims}:
                return data
    except OSError as error:
        found = "no such file" if isinstance(error, FileNotFoundError) else str(error).splitlines()[0]
        raise wrong(EXPECTED, found) from None
    except Exception as error:  # each of xarray's engines has its own
        raise wrong("a NetCDF file with efth over freq and dir", str(error).splitlines()[0]) from None
    try:
        import wavespectra
    except ImportError:
        what = "SWAN's text" if swan else "efth over frequency and direction, as WAVEWATCH III writes it"
        raise wrong("efth over freq and dir, or wavespectra installed", what, INSTALL) from None
    try:
        return (wavespectra.read_swan if swan else wavespectra.read_ww3)(str(path)).load()
    except Exception as error:  # wavespectra has no errors of its own
        raise wrong(f"a spectrum of {'SWAN' if swan else 'WAVEWATCH III'}", str(error).splitlines()[0] or "another") from None


def _at_time(path: str | PathLike[str], values: Any, time: datetime | None) -> Any:
    """The spectrum of a time, of one without a time dimension too. Raises InputError."""
    if TIME not in values.dims or (time is None and values.sizes[TIME] == 1):
        if time is not None:
            raise InputError(str(path), [Problem("time", "a file with times", "one spectrum, without --sea-time")])
        return values
    if values[TIME].dtype.kind != "M":
        raise InputError(str(path), [Problem("time", "one spectrum, or dates", f"{values.sizes[TIME]} that are no dates")])
    times = pd.DatetimeIndex(values[TIME].values).round("min")
    if time is not None and time in times:
        return values.isel({TIME: [int(np.flatnonzero(times == pd.Timestamp(time))[0])]})
    form = "%Y-%m-%dT%H:%M"
    wanted = "one spectrum" if time is None else f"a spectrum of {time.strftime(form)}"
    found = f"{len(times)}, from {times.min().strftime(form)} to {times.max().strftime(form)}"
    raise InputError(str(path), [Problem("time", wanted, found, "--sea-time says which (UTC).")])


def _from_dataset(path: str | PathLike[str], time: datetime | None) -> _Table:
    def wrong(where: str, expected: str, found: str) -> InputError:
        return InputError(str(path), [Problem(where, expected, found)])

    data = _dataset(path)
    if DENSITY not in data.variables:
        raise wrong("", f"a variable {DENSITY}", ", ".join(map(str, data.variables)) or "none")
    values = data[DENSITY]
    for name in (FREQUENCY, DIRECTION):
        if name not in values.dims or name not in values.coords:
            raise wrong(DENSITY, f"a dimension {name} with its values", ", ".join(map(str, values.dims)) or "none")
    values = _at_time(path, values, time)
    if many := [f"{dim} of {size}" for dim, size in values.sizes.items() if dim not in NAMES and size != 1]:
        raise wrong(DENSITY, "one spectrum: other dimensions of length 1", ", ".join(many))
    unit = values.attrs.get("units")
    if unit is not None and unit not in UNITS:
        raise wrong(f"{DENSITY}.units", UNITS[0], str(unit))
    table = values.squeeze([dim for dim in values.dims if dim not in NAMES]).transpose(FREQUENCY, DIRECTION).sortby(FREQUENCY)
    frequency, direction = (np.asarray(table[name].values, float) for name in (FREQUENCY, DIRECTION))
    return _Table(frequency, direction, np.asarray(table.values, float))
