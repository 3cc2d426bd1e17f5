"""Runs in waves: the whole record of each file, and the tests that are windows of it."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest import platform_source
from calibration.campaign.manifest_sections import GAUGES, IN_WAVES, SECOND_WAVE, WAVE
from calibration.campaign.records import Record, unit_factors, whole_series
from calibration.campaign.series import valid_values
from calibration.campaign.wave_directions import StatedDirections, stated_directions
from jaxhydro.errors import InputError, Problem

MIN_SAMPLES = 20  # samples
# of a step, by which a time may miss the even clock that fits all best: rounding in a file does half of it
MAX_CLOCK_ERROR = 0.2
LONGEST_GAP = 3  # samples of the wave that may be missing in a row, and are drawn straight


@dataclass(frozen=True, eq=False)
class SecondWave:
    """Elevation at a second gauge.

    Attributes:
        wave: (n,) surface elevation (m), zero in still water.
        position: Position of the gauge (m).
    """

    wave: np.ndarray
    position: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Run:
    """Record of one file in waves, with even time steps.

    Attributes:
        file: Path of the file.
        time: (n,) even times (s).
        wave: (n,) surface elevation (m), zero in still water.
        position: Position of the wave gauge (m).
        heading: Direction that the waves run to (rad); of several, that of the highest system.
        records: Tests that are windows of the file.
        notes: Remarks in words.
        directions: Stated directions of waves of several headings, or None.
        second: A second gauge, which tells incident from reflected waves, or None.
    """

    file: str
    time: np.ndarray
    wave: np.ndarray
    position: tuple[float, float]
    heading: float
    records: tuple[Record, ...]
    notes: tuple[str, ...]
    directions: StatedDirections | None = None
    second: SecondWave | None = None

    @property
    def several_headings(self) -> bool:
        """Whether its waves have several headings, so that it is compared and not fitted."""
        return self.directions is not None or self.second is not None

    @property
    def step(self) -> float:
        """s between samples."""
        return float(self.time[1] - self.time[0])

    def samples(self, record: Record) -> np.ndarray:
        """Index into `time` of every sample of a record.

        Times in a file are rounded, the clock behind them is not.
        """
        return np.clip(np.rint((record.time - self.time[0]) / self.step).astype(int), 0, len(self.time) - 1)


def runs(campaign: Campaign) -> tuple[Run, ...]:
    """The runs of all tests in waves that are not ignored.

    Raises:
        InputError: There is no such test, or a wave record has no even clock, has gaps or is empty.
    """
    source = str(campaign.folder / "campaign.yaml")
    groups: dict[tuple[str, str, str], list[Record]] = {}
    for record in campaign.records:
        if record.kind in IN_WAVES and record.use != "ignore":
            test = record.test
            key = (test.file, repr(test.sea), repr(campaign.manifest.channels_of(test)))
            groups.setdefault(key, []).append(record)
    if not groups:
        actual = ", ".join(sorted({f"{r.kind} marked {r.use}" for r in campaign.records})) or "no tests"
        expected = "at least one irregular or regular test that is not ignored"
        hint = f"A decay: jaxhydro simulate {platform_source(campaign.manifest, campaign.folder)} --release MOTION=VALUE."
        raise InputError(source, [Problem("tests", expected, actual, hint)])
    problems: list[Problem] = []
    found_runs = []
    for group in groups.values():
        try:
            found_runs.append(_run(campaign, group))
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(source, dict.fromkeys(problems))
    return tuple(found_runs)


def _run(campaign: Campaign, records: Sequence[Record]) -> Run:
    manifest, test = campaign.manifest, records[0].test
    series, still = whole_series(manifest, campaign.folder, test)
    where = f"{test.file}, channel {WAVE}"
    if WAVE not in series.values:
        raise InputError(where, [Problem(f"{where} of test {test.id}", "a wave channel, since waves drive it", "none")])
    scale = unit_factors(manifest, series.channels)
    gauges = [name for name in GAUGES if name in series.values]
    valid = valid_values(series.time) & np.all([valid_values(series.values[name]) for name in gauges], axis=0)
    time = series.time[valid]
    first = np.concatenate([[True], np.diff(time) != 0])
    unit, waves = series.channels["time"].unit, {}
    for name in gauges:
        even, wave, missing = on_even_clock(time[first], series.values[name][valid][first], where, unit)
        waves[name] = wave * scale[name] - still.get(name, 0.0)
    notes = [f"{where}: {missing} samples are missing, and drawn straight"] if missing else []
    second = None
    if manifest.second_wave_channel is not None and manifest.second_wave_channel.position and SECOND_WAVE in waves:
        x, y = manifest.second_wave_channel.position
        second = SecondWave(waves[SECOND_WAVE], (x * manifest.scale, y * manifest.scale))
    position = records[0].wave_position
    assert position is not None
    return Run(
        test.file,
        even * scale["time"],
        waves[WAVE],
        position,
        math.radians(test.sea.mean_heading),
        tuple(sorted(records, key=lambda r: r.time[0])),
        tuple(notes),
        stated_directions(test.sea, manifest.scale),
        second,
    )


def on_even_clock(time: np.ndarray, values: np.ndarray, where: str, unit: str) -> tuple[np.ndarray, np.ndarray, int]:
    """Fit an even clock to written times, and interpolate values onto it.

    Args:
        time: (n,) times as written.
        values: (n,) values.
        where: File and channel, for messages.
        unit: Unit of the times.

    Returns:
        Even times (m,), values at them (m,), and the number of samples that are interpolated.

    Raises:
        InputError: There are too few samples, times that do not increase, uneven steps, or a gap that is too long.
    """

    def wrong(expected: str, actual: str) -> InputError:
        return InputError(where, [Problem(where, expected, actual)])

    steps = np.diff(time)
    if len(time) < MIN_SAMPLES:
        raise wrong(f"{MIN_SAMPLES} samples or more", str(len(time)))
    if not (steps > 0).all():
        raise wrong("times that increase", f"a step back after {time[:-1][steps <= 0][0]:.6g} {unit}")
    index = np.concatenate([[0], np.cumsum(np.maximum(np.rint(steps / np.median(steps)), 1))]).astype(int)
    slope, start = np.polyfit(index, time, 1)
    off = np.abs(time - start - slope * index)
    worst = int(np.argmax(off))
    if off[worst] > MAX_CLOCK_ERROR * slope:
        raise wrong(
            "even sampling, since a sea is made of the whole record",
            f"{time[worst]:.6g} {unit}, which is {off[worst]:.3g} off an even step of {slope:.6g} {unit}",
        )
    gap = int(np.argmax(np.diff(index)))
    if index[gap + 1] - index[gap] - 1 > LONGEST_GAP:
        missed = f"{index[gap + 1] - index[gap] - 1} missing after {time[gap]:.6g} {unit}"
        raise wrong(f"a whole record, no more than {LONGEST_GAP} samples missing in a row", missed)
    whole = np.arange(index[-1] + 1)
    return start + slope * whole, np.interp(whole, index, values), len(whole) - len(index)
