"""Records of the tests: measured motions in SI at full scale, with their noise.

A `Series` is a test as it stands in its file, a `Record` is what calibration works on. Recorded times are kept, jitter and
all. Rows with a value missing and rows that repeat a time are dropped here; `checks` says so, or refuses.

Froude scaling by the length scale L: lengths times L, times times L^0.5, angles as they are. Forces are not recorded:
`density_ratio` stays in the manifest for what needs it.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from calibration.campaign.manifest import Manifest
from calibration.campaign.manifest_sections import SECOND_WAVE, WAVE, Channel, Test, Use, quantity
from calibration.campaign.series import Series, frozen_channels, read_series
from calibration.campaign.signals import noise_level
from calibration.campaign.tracked_point import move_to_reference, noise_moved_to_reference
from jaxhydro.units import SI

_MIN_NOISE = 1e-6  # m at the scale of the file, or rad: finer than any basin's sensor


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


def unit_factors(manifest: Manifest, channels: dict[str, Channel]) -> dict[str, float]:
    """Channel -> what its column is multiplied by to be SI at full scale, the sign included."""
    froude = {"time": manifest.scale**0.5, "length": manifest.scale, "angle": 1.0}
    kinds = {name: quantity(name) for name in channels}
    return {name: c.sign * SI[kinds[name]][c.unit] * froude[kinds[name]] for name, c in channels.items()}


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


def _record(manifest: Manifest, series: Series, zeros: dict[str, float]) -> Record:
    test, scale, good = series.test, unit_factors(manifest, series.channels), series.good
    out = frozen_channels(series)
    time = series.time[good] * scale["time"]
    values = {
        name: column[good] * scale[name] - zeros.get(name, 0.0) for name, column in series.values.items() if name not in out
    }
    values.pop(SECOND_WAVE, None)  # of the runs alone
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
