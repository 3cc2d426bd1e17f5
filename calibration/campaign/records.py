"""Records of the tests: measured motions in SI at full scale, with their noise.

`Series` is a test as it stands in its file; `Record` is what calibration works on. Recorded times are kept, jitter and
all. Rows with a value missing and rows that repeat a time are dropped here; `checks` says so, or refuses.

Froude scaling by the length scale L: lengths times L, times times L^0.5, angles as they are. Forces are not recorded:
`density_ratio` stays in the manifest for what needs it.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pandas as pd

from calibration.campaign.manifest import Manifest
from calibration.campaign.manifest_sections import IN_WAVES, WAVE, Channel, Test, Use, quantity
from calibration.campaign.release import FreeMotion, free_motion
from calibration.campaign.signals import missing_code, noise_level, resolution
from calibration.campaign.tracked_point import move_to_reference, noise_moved_to_reference
from jaxhydro.errors import InputError, Problem, suggest
from jaxhydro.interop.data_files import read_table
from jaxhydro.units import SI

_MIN_NOISE = 1e-6  # m at the scale of the file, or rad: finer than any basin's sensor
_LARGEST_VALUE = 1e15  # what is larger stands for a missing value


@dataclass(frozen=True, eq=False)
class Series:
    """Part of a data file that belongs to one test, in the file's own units; of a decay, the free motion.

    Nothing is converted or repaired. `values` has the elevation as `wave`.
    """

    test: Test
    time: np.ndarray  # (n,) in the time channel's unit
    values: dict[str, np.ndarray]  # channel -> (n,) in the channel's unit
    channels: dict[str, Channel]
    span: tuple[float, float]  # first and last time of the whole file
    rows: np.ndarray  # (n,) index in the file, 0 for the first sample
    still: dict[str, np.ndarray] = field(default_factory=dict)  # in the manifest's zero window of this file
    units: dict[str, str] = field(default_factory=dict)  # channel -> the unit that the file states, if any
    free: FreeMotion | None = None  # of a decay: the free motion in its window; all else is cut off
    first_row: int | None = None  # number of the file's first row of numbers, as an editor counts

    def row(self, index: int) -> str:
        """Where a sample stands in the file, in words: its row as an editor counts, or its number."""
        number = int(self.rows[index])
        return f"sample {number + 1}" if self.first_row is None else f"row {self.first_row + number}"

    @property
    def good(self) -> np.ndarray:
        """(n,) bool: rows that are complete and whose time has not been seen just before."""
        good = valid_values(self.time)
        for values in self.values.values():
            good = good & valid_values(values)
        index = np.flatnonzero(good)
        good[index[1:][np.diff(self.time[index]) == 0]] = False
        return good


@dataclass(frozen=True, eq=False)
class Record:
    """Measured motion of one test, in SI at full scale, zero in still water, from its first sample."""

    id: str
    kind: str
    use: Use
    degree_of_freedom: str | None
    time: np.ndarray  # (n,) s, on the file's axis
    values: dict[str, np.ndarray]  # motion -> (n,) m, rad
    wave: np.ndarray | None  # (n,) m
    wave_position: tuple[float, float] | None  # m; None without a wave; the origin where none is stated
    noise: dict[str, float]  # one standard deviation, m or rad; also `wave`, where measured
    noise_declared: bool  # for every channel; False if any was estimated
    transient: float  # s from the start, not to be compared
    test: Test  # as declared: at the scale of the file
    file: str


def valid_values(values: np.ndarray) -> np.ndarray:
    """Whether each value is a measurement, (n,) bool.

    False for a missing or infinite value, one so large that it stands for a missing one, and a logger's number for that.
    """
    good = np.abs(values) < _LARGEST_VALUE  # False for nan
    code = missing_code(values[good])
    return good if code is None else good & (values != code)


def unit_factors(manifest: Manifest, channels: dict[str, Channel]) -> dict[str, float]:
    """Channel -> what its column is multiplied by to be SI at full scale, the sign included."""
    froude = {"time": manifest.scale**0.5, "length": manifest.scale, "angle": 1.0}
    kinds = {name: quantity(name) for name in channels}
    return {name: c.sign * SI[kinds[name]][c.unit] * froude[kinds[name]] for name, c in channels.items()}


def read_series(manifest: Manifest, folder: Path) -> tuple[Series, ...]:
    """Every test as it stands in its file, each file read once. Raises InputError with all problems."""
    tables: dict[str, pd.DataFrame] = {}
    problems: list[Problem] = []
    series: list[Series] = []
    for name in dict.fromkeys(test.file for test in manifest.tests):
        try:
            tables[name] = read_table(folder / name, keep_text=True)
        except InputError as error:
            problems += [Problem(f"{name}, {p.where}", p.expected, p.found, p.hint) for p in error.problems]
    for test in manifest.tests:
        if test.file in tables:
            try:
                series.append(_windowed(manifest, test, tables[test.file]))
            except InputError as error:
                problems += error.problems
    if problems:
        raise InputError(str(folder / "campaign.yaml"), dict.fromkeys(problems))
    return tuple(series)


def _windowed(manifest: Manifest, test: Test, table: pd.DataFrame) -> Series:
    channels = manifest.channels_of(test)
    problems: list[Problem] = []
    columns: dict[str, np.ndarray] = {}
    taken: dict[int, str] = {}
    units: dict[str, str] = {}
    names = [str(name) for name in table.columns]
    for channel, stated in list(channels.items()):
        column, where = stated.column, f"{test.file}, channel {channel} of test {test.id}"
        if isinstance(column, str) and names.count(column) > 1:
            problems.append(
                Problem(
                    where,
                    f"one column {column!r}",
                    f"{names.count(column)} of that name",
                    "A number, 0 for the first column, tells them apart.",
                )
            )
        elif column not in names if isinstance(column, str) else column >= len(names):
            if channel == WAVE and test.kind not in IN_WAVES and WAVE not in test.channels:
                del channels[channel]  # no waves, and none measured
                continue
            problems.append(Problem(where, f"a column {column!r}", ", ".join(names[:12]), suggest(column, names)))
        else:
            number = names.index(column) if isinstance(column, str) else column
            cells, owner = table.iloc[:, number], taken.setdefault(number, channel)
            if owner != channel:
                problems.append(Problem(where, "a column of its own", f"that of channel {owner}, {column!r}"))
            elif names[number] in table.attrs.get("times", ()) and (channel != "time" or stated.unit != "s"):
                expected = "unit: s, since such times are read as seconds" if channel == "time" else "numbers"
                problems.append(Problem(where, expected, f"times in column {column!r}, stated in {stated.unit}"))
            elif cells.dtype.kind == "f":
                columns[channel] = cells.to_numpy()
                if (unit := table.attrs.get("stated", {}).get(names[number])) is not None:
                    units[channel] = unit
            elif mistakes := table.attrs.get("not_numbers", {}).get(number):
                problems += [replace(mistake, where=f"{test.file}, {mistake.where}") for mistake in mistakes]
            else:
                row = f" in row {table.attrs['row']}" if "row" in table.attrs else ""
                problems.append(Problem(where, f"numbers in column {column!r}", f"text such as {cells.iloc[0]!r}{row}"))
    if problems:
        raise InputError(test.file, problems)
    time = columns.pop("time")
    valid = time[valid_values(time)]
    rows = _rows(time, test.window)
    zero = manifest.zero.window if manifest.zero is not None else None
    still = _rows(time, zero) if zero is not None else np.arange(0)
    series = Series(
        test,
        time[rows],
        {name: values[rows] for name, values in columns.items()},
        channels,
        (float(valid.min()), float(valid.max())) if len(valid) else (np.nan, np.nan),
        rows,
        {name: values[still][valid_values(values[still])] for name, values in columns.items()},
        units,
        first_row=table.attrs.get("row"),
    )
    return _free(series) if test.kind == "decay" else series


def _free(series: Series) -> Series:
    """Cut a decay to its free motion.

    It begins at the release. It ends at the next push or where the model is caught; with a stated `window`, at the window's
    end.
    """
    good = np.flatnonzero(series.good)
    free = free_motion(series.time[good], series.values[str(series.test.degree_of_freedom)][good])
    if free.start == free.end == "record":
        return series
    last = good[free.last - 1] if series.test.window is None else len(series.time) - 1  # what is stated is respected
    free_rows = slice(good[free.first], last + 1)
    values = {name: column[free_rows] for name, column in series.values.items()}
    return replace(series, time=series.time[free_rows], values=values, rows=series.rows[free_rows], free=free)


def _rows(time: np.ndarray, window: tuple[float, float] | None) -> np.ndarray:
    """Rows from the first to the last whose time is in a window, (n,) indices.

    Rows between them that have no time of their own are included. Without a window, all rows are.
    """
    if window is None:
        return np.arange(len(time))
    inside = np.flatnonzero((time >= window[0]) & (time <= window[1]))
    return np.arange(inside[0], inside[-1] + 1) if len(inside) else inside


def still_water(manifest: Manifest, series: tuple[Series, ...]) -> tuple[dict[str, float], ...]:
    """Readings of all channels in still water.

    Args:
        manifest: The manifest of the campaign.
        series: The tests as they are in their files.

    Returns:
        For each series, channel -> mean reading (m, rad at full scale); empty where the manifest states no zero.
    """
    zero = manifest.zero
    if zero is None:
        return tuple({} for _ in series)

    def means(test_series: Series, values: dict[str, np.ndarray]) -> dict[str, float]:
        scale = unit_factors(manifest, test_series.channels)
        return {name: float(np.mean(v)) * scale[name] for name, v in values.items() if len(v)}

    if zero.window is not None:
        return tuple(means(test_series, test_series.still) for test_series in series)
    rest = next(test_series for test_series in series if test_series.test.id == zero.test)
    return (means(rest, {name: values[rest.good] for name, values in rest.values.items()}),) * len(series)


def records_of(manifest: Manifest, series: tuple[Series, ...]) -> tuple[Record, ...]:
    """The records of series that `checks` let pass."""
    return tuple(_record(manifest, test_series, zeros) for test_series, zeros in zip(series, still_water(manifest, series)))


def load_records(manifest: Manifest, folder: Path) -> tuple[Record, ...]:
    """The records of all tests, those to be ignored among them. Raises InputError for what cannot be read."""
    return records_of(manifest, read_series(manifest, folder))


def whole_series(manifest: Manifest, folder: Path, test: Test) -> tuple[Series, dict[str, float]]:
    """Read all that a test's file has, without the test's window.

    Args:
        manifest: The manifest of the campaign.
        folder: Folder of the data files.
        test: The test.

    Returns:
        The series, and its readings in still water by channel (m, rad at full scale).

    Raises:
        InputError: The file cannot be read.
    """
    rest = [other for other in manifest.tests if manifest.zero is not None and other.id == manifest.zero.test]
    tests = (test.model_copy(update={"window": None}), *rest)
    series = read_series(manifest.model_copy(update={"tests": tests}), folder)
    return series[0], still_water(manifest, series[::-1])[-1]


def frozen_channels(series: Series) -> set[str]:
    """Motions of a test that have one value throughout, though others change.

    They were not measured; `checks` says so. Empty for tests that are neither decays nor in waves, and where no motion changes.
    """
    if series.test.kind != "decay" and series.test.kind not in IN_WAVES:
        return set()
    good, motions = series.good, set(series.values) - {WAVE}
    still = {name for name in motions if resolution(series.values[name][good]) == 0}
    return still if still < motions else set()


def _record(manifest: Manifest, series: Series, zeros: dict[str, float]) -> Record:
    test, scale, good = series.test, unit_factors(manifest, series.channels), series.good
    out = frozen_channels(series)
    time = series.time[good] * scale["time"]
    values = {
        name: column[good] * scale[name] - zeros.get(name, 0.0) for name, column in series.values.items() if name not in out
    }
    stated = unit_factors(manifest, manifest.all_channels)
    floor = {name: _MIN_NOISE * (1.0 if quantity(name) == "angle" else manifest.scale) for name in values}
    noise = {
        name: manifest.noise[name] * abs(stated[name])
        if name in manifest.noise
        else max(noise_level(time, column), floor[name])
        for name, column in values.items()
    }
    wave = values.pop(WAVE, None)
    if manifest.tracked_point is not None:
        x, y, z = manifest.tracked_point
        point = (manifest.scale * x, manifest.scale * y, manifest.scale * z)
        values, noise = move_to_reference(values, point), noise_moved_to_reference(noise, point)
    x, y = (manifest.wave_channel.position if manifest.wave_channel else None) or (0.0, 0.0)
    return Record(
        id=test.id,
        kind=test.kind,
        use=test.use,
        degree_of_freedom=test.degree_of_freedom,
        time=time,
        values=values,
        wave=wave,
        noise=noise,
        noise_declared=set(noise) <= set(manifest.noise),
        test=test,
        wave_position=None if wave is None else (x * manifest.scale, y * manifest.scale),
        transient=test.transient * abs(scale["time"]),
        file=test.file,
    )
