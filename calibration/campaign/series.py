"""Tests as they stand in their files: rows of the window, in the files' own units."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from calibration.campaign.manifest import Manifest
from calibration.campaign.manifest_sections import GAUGES, IN_WAVES, Channel, Test
from calibration.campaign.release import FreeMotion, free_motion
from calibration.campaign.signals import missing_code, resolution
from jaxhydro.errors import InputError, Problem, suggest

if TYPE_CHECKING:
    import pandas as pd

_LARGEST_VALUE = 1e15  # what is larger stands for a missing value


@dataclass(frozen=True, eq=False)
class Series:
    """Part of a data file that belongs to one test, in the file's own units; of a decay, the free motion.

    Nothing is converted or repaired. `values` has the elevation as `wave`, that of a second gauge as `second_wave`.
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


def valid_values(values: np.ndarray) -> np.ndarray:
    """Whether each value is a measurement, (n,) bool.

    False for a missing or infinite value, one so large that it stands for a missing one, and a logger's number for that.
    """
    good = np.abs(values) < _LARGEST_VALUE  # False for nan
    code = missing_code(values[good])
    return good if code is None else good & (values != code)


def read_series(manifest: Manifest, folder: Path) -> tuple[Series, ...]:
    """Every test as it stands in its file, each file read once. Raises InputError with all problems."""
    from jaxhydro.interop.data_files import read_table  # readers take a second to import

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
            if channel in GAUGES and test.kind not in IN_WAVES and channel not in test.channels:
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


def frozen_channels(series: Series) -> set[str]:
    """Motions of a test that have one value throughout, though others change.

    They were not measured; `checks` says so. Empty for tests that are neither decays nor in waves, and where no motion changes.
    """
    if series.test.kind != "decay" and series.test.kind not in IN_WAVES:
        return set()
    good, motions = series.good, set(series.values) - set(GAUGES)
    still = {name for name in motions if resolution(series.values[name][good]) == 0}
    return still if still < motions else set()
