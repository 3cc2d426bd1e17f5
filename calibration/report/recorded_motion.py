"""Motions of a result folder, from simulated.nc, as the interactive part of a page shows them."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from calibration.results.result_folder import MOTION_FILE
from jaxhydro.environment import DOFS
from jaxhydro.units import unit_of

SOURCES = ("measured", "simulated", "before")
WAVES = {"wave": "simulated", "wave_measured": "measured", "wave_simulated": "simulated"}  # variables of the elevation
FRAMES_PER_PERIOD, PERIODS = 20, 10  # of the stretch that is animated
MIN_FRAMES = 60
STILL_SHARE = 1e-3  # of the largest motion of its unit: what moves less is not shown


class Stretch(NamedTuple):
    """Times (s) of the frames of an animation, and the motion (m, deg; frame, dof) there by source."""

    times: np.ndarray
    poses: dict[str, np.ndarray]


class RecordedTest(NamedTuple):
    """Series of one test.

    Attributes:
        name: Name of the test; empty where there is only one.
        time: Times (s), (t,), even.
        series: Values (m, deg) by channel, the wave first, and by source; NaN where there are none.
        released: Motion that was released, or None.
        transient: Length (s) of the start that statistics leave out.
    """

    name: str
    time: np.ndarray
    series: dict[str, dict[str, np.ndarray]]
    released: str | None
    transient: float = 0.0

    @property
    def shown(self) -> dict[str, dict[str, np.ndarray]]:
        """The channels that are not next to still."""
        size = {name: max(float(np.nanmax(x) - np.nanmin(x)) for x in rows.values()) for name, rows in self.series.items()}
        largest = {unit: max((size[name] for name in size if unit_of(name) == unit), default=0.0) for unit in ("m", "deg")}
        moving = {name: rows for name, rows in self.series.items() if size[name] > STILL_SHARE * largest[unit_of(name)]}
        return moving or dict(list(self.series.items())[:1])

    def stretch(self) -> Stretch:
        """Ten periods from the release, or of the waves about their highest crest."""
        main = self.released or ("wave" if "wave" in self.series else self._largest())
        rows = self.series[main]
        values = np.nan_to_num(rows.get("measured", rows["simulated"]))
        period, whole = _period(self.time, values), float(self.time[-1] - self.time[0])
        span = min(PERIODS * period, whole)
        middle = self.time[0] + 0.5 * span
        if main == "wave":
            later = self.time >= self.time[0] + self.transient
            middle = float(self.time[later][np.argmax(values[later])]) if later.any() else middle
        begin = min(max(middle - 0.5 * span, float(self.time[0])), float(self.time[-1]) - span)
        times = np.linspace(begin, begin + span, max(MIN_FRAMES, round(span / period * FRAMES_PER_PERIOD)) + 1)
        poses = {}
        for source in ("measured", "simulated"):
            columns = [self.series.get(dof, {}).get(source) for dof in DOFS]
            if any(column is not None for column in columns):
                still = np.zeros_like(self.time)
                rows6 = [np.nan_to_num(still if column is None else column) for column in columns]
                poses[source] = np.stack([np.interp(times, self.time, row) for row in rows6], axis=1)
        return Stretch(times, poses)

    def _largest(self) -> str:
        return max(self.series, key=lambda name: max(float(np.nanstd(x)) for x in self.series[name].values()))


class RecordedMotion(NamedTuple):
    """All series of a result folder.

    Attributes:
        tests: Series by test.
        hull: Outlines of the hull (element, end, point, axis; m), or None.
        offsets: Largest fitted sensor offset (m, deg) by channel, which is taken off the measured series.
    """

    tests: list[RecordedTest]
    hull: np.ndarray | None
    offsets: dict[str, float] = {}


def read_motion(folder: Path) -> RecordedMotion | None:
    """Series and hull of a result folder; None where it has no simulated.nc that can be read."""
    path = folder / MOTION_FILE
    if not path.is_file():
        return None
    try:
        with xr.open_dataset(path, engine="h5netcdf") as opened:
            data = opened.load()
        tests = [test for name in _names(data) if (test := _test(data, name)) is not None]
    except (OSError, ValueError, KeyError):
        return None
    hull = data["hull"].values if "hull" in data else None
    return RecordedMotion(tests, hull, _offsets(data)) if tests else None


def _offsets(data: xr.Dataset) -> dict[str, float]:
    """Largest sensor offset of each channel, without those that are zero."""
    if "sensor_offset" not in data:
        return {}
    largest = abs(data["sensor_offset"].fillna(0.0)).max("test")
    return {str(name): float(value) for name, value in zip(largest["channel"].values, largest.values) if value > 0}


def _names(data: xr.Dataset) -> list[str]:
    return [str(name) for name in data["test"].values] if "test" in data.dims else [""]


def _test(data: xr.Dataset, name: str) -> RecordedTest | None:
    """Series of a test up to its last sample; None where it has none."""
    test = data.sel(test=name) if name else data
    series: dict[str, dict[str, np.ndarray]] = {}
    for variable, source in WAVES.items():
        if variable in test:
            series.setdefault("wave", {})[source] = test[variable].values
    for channel in map(str, test["channel"].values):
        series[channel] = {source: test[source].sel(channel=channel).values for source in SOURCES if source in test}
    finite = {
        channel: {source: x for source, x in rows.items() if np.isfinite(x).any()}
        for channel, rows in series.items()
        if any(np.isfinite(x).any() for x in rows.values())
    }
    if not any(channel in DOFS for channel in finite):
        return None
    present = np.any([np.isfinite(x) for rows in finite.values() for x in rows.values()], axis=0)
    count = int(np.flatnonzero(present)[-1]) + 1
    trimmed = {channel: {source: x[:count] for source, x in rows.items()} for channel, rows in finite.items()}
    released = str(test["degree_of_freedom"].values) if "degree_of_freedom" in test else ""
    return RecordedTest(
        name,
        test["time"].values[:count],
        trimmed,
        released if released in trimmed else None,
        float(data.attrs.get("transient", 0.0)),
    )


def _period(time: np.ndarray, values: np.ndarray) -> float:
    """Period (s) of the highest peak of a record's spectrum; the whole record where it does not move."""
    whole = float(time[-1] - time[0]) or 1.0
    even = np.interp(np.linspace(time[0], time[-1], len(time)), time, values)
    lines = np.abs(np.fft.rfft(even - even.mean()))
    peak = int(np.argmax(lines))
    return whole / peak if peak else whole
