"""Spectra of NDBC's wave buoys from their text files: densities, and directions where their files lie beside."""

import gzip
import re
from datetime import datetime
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Complex, Float

from jaxhydro.errors import InputError, Problem, shown

HEADER = re.compile(r"^#?\s*YY(YY)?\s+MM\s+DD\s+hh(\s+mm)?\s+(?P<rest>.*)$")
OTHERS = {"swdir": "d", "swdir2": "i", "swr1": "j", "swr2": "k"}  # ending of recent files -> letter in names of historical ones
MEANING = {"swdir": "alpha1", "swdir2": "alpha2", "swr1": "r1", "swr2": "r2"}
HISTORICAL = re.compile(r"^(?P<station>\w{5})w(?P<rest>\d{4}\w*\.txt(\.gz)?)$")
MISSING = 999.0  # mark of a value that is missing; in recent files also MM
HUNDREDTHS = 1.5  # r above it: historical files have r1 and r2 in hundredths
MAX_UNKNOWN = 0.05  # of the energy, without directions
EXPECTED = "NDBC's spectral wave data: a header #YY MM DD hh mm, then a row for each time"


class BuoySpectrum(NamedTuple):
    """Spectrum of a buoy at one time.

    Attributes:
        frequency: Frequencies (Hz), ascending, (n,).
        density: Spectral density (m²/Hz), (n,).
        first: Mean of exp(i a) at each frequency, with a where waves come from, clockwise from north; None: not measured.
        second: Mean of exp(2 i a), likewise.
    """

    frequency: Float[np.ndarray, " n"]
    density: Float[np.ndarray, " n"]
    first: Complex[np.ndarray, " n"] | None = None
    second: Complex[np.ndarray, " n"] | None = None


def is_ndbc(path: str | PathLike[str]) -> bool:
    """Whether a file begins as NDBC's text files do. A file that cannot be read does not."""
    try:
        with _opened(Path(path)) as file:
            return HEADER.match(file.readline()) is not None
    except (OSError, UnicodeDecodeError):
        return False


def read_ndbc(path: str | PathLike[str], time: datetime | None = None) -> BuoySpectrum:
    """Read NDBC's spectral wave data: recent (`.data_spec`, `.swden`) or historical (41010w2019.txt), also with `.gz`.

    The four files of directions lie beside: `.swdir`, `.swdir2`, `.swr1`, `.swr2` of the same name, or 41010d2019.txt and
    the letters i, j and k. Without all of them there are no directions.

    Args:
        path: The file of spectral densities.
        time: Time of the spectrum (UTC), to the minute; None: the file has one.

    Returns:
        The spectrum.

    Raises:
        InputError: With the file and the row that is wrong, or the times that the file has.

    References:
        NDBC, Measurement Descriptions and Units (ndbc.noaa.gov/measdes.shtml).
    """
    path = Path(path)
    number, frequency, density, time = _row(path, time)
    if bad := int((~np.isfinite(density)).sum()):
        raise InputError(str(path), [Problem(f"line {number}", "densities (m²/Hz)", f"{bad} that are missing")])
    files = _others(path)
    missing = [file.name for file in files.values() if not file.is_file()]
    if len(missing) == len(files):
        return BuoySpectrum(frequency, density)
    if missing:
        expected = f"all files of directions beside it: {', '.join(file.name for file in files.values())}"
        raise InputError(str(path), [Problem("", expected, f"none named {', '.join(missing)}")])
    values: dict[str, np.ndarray] = {}
    for key, file in files.items():
        line, other, read, _ = _row(file, time)
        if other.shape != frequency.shape or not np.allclose(other, frequency, atol=1e-6):
            found = f"{other.size}, from {other[0]:g} to {other[-1]:g} Hz" if other.size else "none"
            raise InputError(str(file), [Problem(f"line {line}", f"the {frequency.size} frequencies of {path.name}", found)])
        if key in ("swr1", "swr2") and np.nanmax(read, initial=0.0) > HUNDREDTHS:
            read = read / 100
        limit = 1.01 if key in ("swr1", "swr2") else 360.0
        if ((read < 0) | (read > limit)).any():
            worst = read[(read < 0) | (read > limit)][0]
            expected = f"{MEANING[key]} from 0 to {'1, or to 100 in hundredths' if limit < 2 else '360 deg'}"
            raise InputError(str(file), [Problem(f"line {line}", expected, f"{worst:g}")])
        values[key] = read
    return BuoySpectrum(frequency, density, *_coefficients(path, number, density, values))


def _coefficients(
    path: Path, number: int, density: np.ndarray, values: dict[str, np.ndarray]
) -> tuple[Complex[np.ndarray, " n"], Complex[np.ndarray, " n"]]:
    """Fourier coefficients; frequencies without directions take those of the nearest that has them."""
    complete = np.all([np.isfinite(column) for column in values.values()], axis=0)
    if density.sum() > 0 and density[~complete].sum() > MAX_UNKNOWN * density.sum():
        found = f"none for {density[~complete].sum() / density.sum():.0%} of it"
        raise InputError(str(path), [Problem(f"line {number}", f"directions for {1 - MAX_UNKNOWN:.0%} of the energy", found)])
    places = np.flatnonzero(complete)
    if not places.size:
        raise InputError(str(path), [Problem(f"line {number}", "waves with directions", "none")])
    nearest = places[np.argmin(np.abs(np.arange(len(density))[:, None] - places), axis=1)]
    angle1, angle2, r1, r2 = (values[key][nearest] for key in OTHERS)
    return r1 * np.exp(1j * np.radians(angle1)), r2 * np.exp(2j * np.radians(angle2))


def _opened(path: Path):
    """Text file, unpacked where its name ends in .gz."""
    return gzip.open(path, "rt", encoding="utf-8") if path.suffix == ".gz" else open(path, encoding="utf-8")


def _others(path: Path) -> dict[str, Path]:
    """Files of directions that belong to a file of densities."""
    if match := HISTORICAL.match(path.name):
        return {key: path.with_name(f"{match['station']}{letter}{match['rest']}") for key, letter in OTHERS.items()}
    return {key: path.with_suffix(f".{key}") for key in OTHERS}


def _row(path: Path, time: datetime | None) -> tuple[int, Float[np.ndarray, " n"], Float[np.ndarray, " n"], datetime]:
    """Number of the line of a time, frequencies (Hz), values (NaN where missing), and the time."""
    try:
        with _opened(path) as file:
            lines = file.read().splitlines()
    except (OSError, UnicodeDecodeError) as error:
        found = "no such file" if isinstance(error, FileNotFoundError) else str(error)
        raise InputError(str(path), [Problem("", EXPECTED, found)]) from None
    header = HEADER.match(lines[0]) if lines else None
    if header is None:
        raise InputError(str(path), [Problem("line 1", EXPECTED, shown(lines[0][:60]) if lines else "an empty file")])
    minutes = header[2] is not None
    rows = [(number, line.split()) for number, line in enumerate(lines, 1) if line.strip() and not line.startswith("#")]
    rows = rows if lines[0].startswith("#") else rows[1:]
    times = [_time(path, number, words, minutes) for number, words in rows]
    chosen = [i for i, stamp in enumerate(times) if stamp == time] if time else range(len(times))
    if len(chosen) != 1:
        raise _not_one(path, times, len(chosen), time)
    (number, words), time = rows[chosen[0]], times[chosen[0]]
    words = words[4 + minutes :]
    if header["rest"].rstrip().endswith(">"):
        odd = len(words) % 2  # the separation frequency comes first
        words, places = words[odd::2], [word.strip("()") for word in words[odd + 1 :: 2]]
    else:
        places = header["rest"].split()
    numbers = [_numbers(path, number, some) for some in (places, words)]
    if len(numbers[0]) != len(numbers[1]) or len(numbers[0]) < 2:
        raise InputError(str(path), [Problem(f"line {number}", f"{len(numbers[0])} values", f"{len(numbers[1])}")])
    frequency, values = numbers
    if not np.isfinite(frequency).all() or frequency[0] < 0 or not (np.diff(frequency) > 0).all():
        raise InputError(str(path), [Problem(f"line {number}", "frequencies (Hz) that ascend from 0", f"{frequency[:3]} ...")])
    return number, frequency, np.where(values == MISSING, np.nan, values), time


def _not_one(path: Path, times: list[datetime], count: int, time: datetime | None) -> InputError:
    """Error for a file that has not one spectrum, or not one of a time."""
    form = "%Y-%m-%dT%H:%M"
    found = f"{len(times)}" if time is None else f"{count} of {len(times)}"
    if times:
        found += f", from {min(times).strftime(form)} to {max(times).strftime(form)}"
    if times and time is not None:
        asked = time
        found += f"; the nearest is {min(times, key=lambda stamp: abs(stamp - asked)).strftime(form)}"
    wanted = "one spectrum" if time is None else f"one spectrum of {time.strftime(form)}"
    return InputError(str(path), [Problem("time", wanted, found, "--sea-time says which (UTC).")])


def _time(path: Path, number: int, words: list[str], minutes: bool) -> datetime:
    """Time of a row (UTC); years of two digits are of the last century."""
    try:
        year, month, day, hour, minute = (int(word) for word in (*words[: 4 + minutes], *([] if minutes else ["0"])))
        return datetime(year + (1900 if year < 100 else 0), month, day, hour, minute)
    except ValueError:
        expected = f"year, month, day, hour{', minute' if minutes else ''}"
        raise InputError(str(path), [Problem(f"line {number}", expected, shown(" ".join(words[:5])))]) from None


def _numbers(path: Path, number: int, words: list[str]) -> Float[np.ndarray, " n"]:
    """Numbers of words; MM is NaN."""
    try:
        return np.array([np.nan if word == "MM" else float(word) for word in words])
    except ValueError as error:
        raise InputError(str(path), [Problem(f"line {number}", "numbers", str(error).rpartition(": ")[2])]) from None
