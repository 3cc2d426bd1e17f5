"""Data-quality checks: clocks, gaps, frozen and clipped channels, spikes, drift, windows.

An error is what no fit should be built on, a warning what its reader should know. Rows that lack a value or repeat a time are
dropped with a warning, while they are less than 2 % of the window. Nothing else is changed. Times in the messages are the
file's own, in its own unit.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from calibration.campaign.digits import local_resolution, straight_piece
from calibration.campaign.extent_checks import extent_warnings
from calibration.campaign.manifest import Manifest
from calibration.campaign.manifest_sections import DOFS, IN_WAVES, WAVE
from calibration.campaign.records import Series, frozen_channels, read_series, unit_factors, valid_values
from calibration.campaign.signals import (
    constant_stretches,
    dominant_period,
    flank_heights,
    missing_code,
    resolution,
    spikes,
    straight_line,
    wave_height,
)
from jaxhydro.errors import Problem

MAX_DROPPED_SHARE = 0.02  # of a window's rows
MIN_SAMPLES = 20  # in a window
GAP_STEPS = 3.5  # median steps
FEW_SAMPLES_PER_CYCLE, MIN_SAMPLES_PER_CYCLE = 15, 8  # samples per cycle
MIN_SAMPLES_PER_WAVE = 4  # these only drive: what is slower is worth having still
MIN_WAVES = 20  # after the transient
MAX_SHOWN = 5  # of one kind in one channel

Severity = Literal["warning", "error"]


@dataclass(frozen=True)
class Finding:
    """Observation on the quality of a record.

    Attributes:
        severity: Warning or error.
        file: Name of the data file.
        test: Name of the test.
        channel: Channel, or "".
        time: Time on the file's axis, or None.
        message: The observation in words.
        expected: What an error should have been instead.
    """

    severity: Severity
    file: str
    test: str
    channel: str
    time: float | None
    message: str
    expected: str = ""

    @property
    def place(self) -> str:
        return f"{self.file}, test {self.test}{', channel ' + self.channel if self.channel else ''}"

    def __str__(self) -> str:
        return f"{self.place}: {self.message}"

    @property
    def problem(self) -> Problem:
        """The finding as a line of an InputError."""
        return Problem(self.place, self.expected or "a sound record", self.message)


def check_records(manifest: Manifest, folder: Path, series: tuple[Series, ...] | None = None) -> tuple[Finding, ...]:
    """Check the quality of the data of every test.

    Args:
        manifest: The manifest of the campaign.
        folder: Folder of the data files.
        series: The tests as read from their files; None: they are read here.

    Returns:
        Findings on every test.

    Raises:
        InputError: A file cannot be read.
    """
    series = read_series(manifest, folder) if series is None else series
    return tuple(finding for test_series in series for finding in _Check(manifest, test_series, series).all())


class _Check:
    """Checks of one series.

    Checks after `missing` use only rows without faults, and need increasing times.
    """

    def __init__(self, manifest: Manifest, series: Series, others: tuple[Series, ...]) -> None:
        self.manifest, self.series, self.others, self.test = manifest, series, others, series.test
        self.unit = series.channels["time"].unit
        good = series.good
        self.time = series.time[good]
        self.values = {name: values[good] for name, values in series.values.items()}
        steps = np.diff(self.time)
        self.step = float(np.mean(steps[steps <= GAP_STEPS * np.median(steps)])) if np.any(steps > 0) else 0.0
        # the rows after the transient
        self.compared = self.time >= self.time[0] + self.test.transient if len(self.time) else good[:0]
        self.driven = WAVE if self.test.kind in IN_WAVES else self.test.degree_of_freedom or ""
        self.period: float | None = None

    def all(self) -> list[Finding]:
        findings = [*self.window(), *self.zero()]
        findings += self.units()
        if not any(finding.severity == "error" for finding in findings):
            findings += [*self.clock(), *self.missing()]
        if any(finding.severity == "error" for finding in findings):
            return findings
        if self.driven in self.values:
            self.period = dominant_period(self.time, self.values[self.driven])
        signals = (f for name in self.values for f in self.signal(name))
        told = extent_warnings(self.series, self.time, self.values, self.compared, self.period)
        extent = [self.finding("warning", *warning) for warning in told]
        return [*findings, *extent, *self.held_out(), *self.oscillation(), *self.sea(), *signals]

    def finding(self, severity: Severity, channel: str, time: float | None, message: str, expected: str = "") -> Finding:
        return Finding(severity, self.test.file, self.test.id, channel, time, message, expected)

    def at(self, time: float) -> str:
        return f"{time:.6g} {self.unit}"

    def held_out(self) -> Iterator[Finding]:
        """Is it really held out?"""
        for other in self.others if self.test.use == "holdout" else ():
            alike = other.test.use == "fit" and other.test.file == self.test.file and len(other.time) > 0
            if alike and min(self.time[-1], other.time[-1]) > max(self.time[0], other.time[0]):
                yield self.finding("warning", "", None, f"held out, and the fitted test {other.test.id} has samples of it")

    def window(self) -> Iterator[Finding]:
        """Is there enough of a record?"""
        (first, last), count, after = self.series.span, len(self.series.time), int(self.compared.sum())
        start, end = self.test.window or (first, last)
        beyond = 0.01 * (end - start) + 2 * self.step
        if not first <= last:
            yield self.finding("error", "time", None, "none", "times")
        elif start < first - beyond or end > last + beyond:
            yield self.finding(
                "error",
                "",
                None,
                f"a window from {self.at(start)} to {self.at(end)}",
                f"a window in the file's range, {self.at(first)} to {self.at(last)}",
            )
        elif count < MIN_SAMPLES:
            yield self.finding("error", "", None, f"{count} samples", f"{MIN_SAMPLES} samples or more in the window")
        elif self.test.transient > 0 and after < MIN_SAMPLES:
            message = f"{self.at(self.test.transient)} of a record of {self.at(end - start)}, which leaves {after}"
            if missing := int((~self.series.good).sum()):
                message = f"{message}, as {missing} of its {count} rows lack a value"
            yield self.finding("error", "", None, message, f"a transient that leaves {MIN_SAMPLES} samples or more")

    def units(self) -> Iterator[Finding]:
        """Does the file state the unit that the manifest does?"""
        for channel, unit in self.series.units.items():
            stated = self.series.channels[channel]
            if unit != stated.unit:
                yield self.finding(
                    "warning",
                    channel,
                    None,
                    f"the file states {unit} for column {stated.column!r}, and the manifest {stated.unit}",
                )

    def zero(self) -> Iterator[Finding]:
        """Is there still water to take off?"""
        zero = self.manifest.zero
        if zero is not None and zero.window is not None:
            fewest, (first, last) = min(map(len, self.series.still.values())), self.series.span
            if fewest < MIN_SAMPLES:
                yield self.finding(
                    "error",
                    "",
                    None,
                    f"{fewest} in {list(zero.window)}, of a file from {self.at(first)} to {self.at(last)}",
                    f"{MIN_SAMPLES} or more samples in zero.window",
                )
        elif zero is not None:
            rest = next(other for other in self.others if other.test.id == zero.test)
            for channel in sorted(set(self.values) & set(DOFS) - set(rest.values)):
                yield self.finding(
                    "error", channel, None, f"no such channel in test {zero.test}", "a channel that the zero test has too"
                )

    def clock(self) -> Iterator[Finding]:
        """Do times increase, and evenly?"""
        rows = np.flatnonzero(valid_values(self.series.time))
        time = self.series.time[rows]
        steps = np.diff(time)
        if np.any(steps < 0):
            i = int(np.argmax(steps < 0))
            yield self.finding(
                "error",
                "time",
                float(time[i]),
                f"a step back from {self.at(time[i])} to {self.at(time[i + 1])} in {self.series.row(rows[i + 1])} of the file",
                "times that increase",
            )
            return
        if same := int(np.sum(steps == 0)):
            i = int(np.argmax(steps == 0))
            first_repeat = f"the first {self.at(time[i])} in {self.series.row(rows[i + 1])}"
            yield self.dropped(same, "time", float(time[i]), f"{same} times that repeat, {first_repeat}")
        steps = np.diff(self.time)
        for i in np.flatnonzero(steps > GAP_STEPS * self.step)[:MAX_SHOWN]:
            yield self.finding(
                "warning",
                "time",
                float(self.time[i]),
                f"a gap of {self.at(steps[i])} after {self.at(self.time[i])}, where steps are {self.at(self.step)}",
            )
        usual = steps[steps < 1.5 * self.step]
        rounding = resolution(usual) if len(usual) else 0.0
        if rounding > 0.02 * self.step and np.ptp(usual) < 2.5 * rounding:
            yield self.finding(
                "warning", "time", None, f"times are written to {self.at(rounding)}, where steps are {self.at(self.step)}"
            )

    def missing(self) -> Iterator[Finding]:
        """Values that are not there."""
        for channel, values in {"time": self.series.time, **self.series.values}.items():
            bad = np.flatnonzero(~valid_values(values))
            if len(bad):
                before = self.series.time[: bad[0] + 1]
                before = before[valid_values(before)]
                when = float(before[-1]) if len(before) else None
                near = "at the start" if when is None else f"near {self.at(when)}"
                first_missing = f"the first {near}, {self.series.row(int(bad[0]))}"
                code = missing_code(values)
                fault = "missing or infinite" if code is None else f"missing, as {code:g} seems to say"
                yield self.dropped(len(bad), channel, when, f"{len(bad)} values {fault}, {first_missing}")

    def dropped(self, count: int, channel: str, time: float | None, message: str) -> Finding:
        if count < MAX_DROPPED_SHARE * len(self.series.time):
            return self.finding("warning", channel, time, f"{message}: these rows are dropped")
        return self.finding(
            "error",
            channel,
            time,
            message,
            f"fewer than {MAX_DROPPED_SHARE:.0%} of the {len(self.series.time)} rows to be dropped; "
            "a `window` beside the gap, or values interpolated in the file",
        )

    def oscillation(self) -> Iterator[Finding]:
        """Is what oscillates sampled often and long enough?"""
        if self.period is None:
            return
        samples, cycles = self.period / self.step, (self.time[-1] - self.time[0]) / self.period
        message = f"{samples:.1f} samples per cycle of {self.at(self.period)}"
        least = MIN_SAMPLES_PER_WAVE if self.driven == WAVE else MIN_SAMPLES_PER_CYCLE
        if samples < least:
            yield self.finding("error", self.driven, None, message, f"{least} samples per cycle or more")
        elif samples < FEW_SAMPLES_PER_CYCLE:
            yield self.finding("warning", self.driven, None, f"only {message}")
        if cycles < 1.5:
            yield self.finding("warning", self.driven, None, f"only {cycles:.1f} cycles of about {self.at(self.period)}")

    def sea(self) -> Iterator[Finding]:
        """Does the sea agree with the manifest, is the position of its gauge stated, and is it long enough?"""
        test, irregular = self.test, self.test.kind == "irregular"
        if self.driven != WAVE or WAVE not in self.values:
            return
        if self.manifest.wave_channel is not None and self.manifest.wave_channel.position is None:
            yield self.finding("warning", WAVE, None, "wave_channel has no position: taken as the origin")
        name = "significant_wave_height" if irregular else "wave_height"
        stated = test.significant_wave_height if irregular else test.wave_height
        metres = abs(unit_factors(self.manifest, self.series.channels)[WAVE]) / self.manifest.scale
        height = wave_height(self.values[WAVE][self.compared], irregular) * metres
        if stated is not None and not 0.7 < height / stated < 1.4:
            yield self.finding("warning", WAVE, None, f"{name} is stated as {stated:g} m, and recorded as {height:.3g} m")
        duration = float(self.time[-1] - self.time[0]) - test.transient
        if irregular and self.period is not None and duration < MIN_WAVES * self.period:
            yield self.finding(
                "warning",
                WAVE,
                None,
                f"only {self.at(duration)} after the transient, {duration / self.period:.1f} waves "
                f"of about {self.at(self.period)}: too few to tell a sea by",
            )

    def signal(self, channel: str) -> Iterator[Finding]:
        """Frozen, clipped, spiked, drifting?"""
        values, time = self.values[channel], self.time
        grain = resolution(values)
        if grain == 0:
            message = f"one value throughout, {values[0]:.6g}"
            if channel == self.driven:
                yield self.finding("error", channel, None, message, "a signal that moves")
            else:
                left_out = ": left out" if channel in frozen_channels(self.series) else ""
                yield self.finding("warning", channel, None, f"{message}{left_out}")
            return
        step = local_resolution(values)
        starts, lengths = constant_stretches(values, grain)
        long = max(MIN_SAMPLES, int((self.period or 0) / 3 / self.step))
        for i, n in list(zip(starts[lengths > long], lengths[lengths > long]))[:MAX_SHOWN]:
            beside = (values[max(0, i - long) : i + 1], values[i + n - 1 : i + n + long])
            still = self.still_until() > time[i + n - 1] or self.in_zero(time[i], time[i + n - 1])
            if max(map(np.ptp, beside)) > 6 * step[i] and not still:  # else it has come to rest
                yield self.finding(
                    "warning",
                    channel,
                    float(time[i]),
                    f"frozen from {self.at(time[i])} to {self.at(time[i + n - 1])}, {n} samples at {values[i]:.5g}",
                )
        piece = straight_piece(values, step)
        for name, extreme in (("highest", values.max()), ("lowest", values.min())):
            flat = (np.abs(values[starts] - extreme) < grain / 2) & (lengths >= 3 * piece) & (starts > 0)
            flat &= flank_heights(values, starts, lengths) > 16 * step[starts]
            if (count := int(lengths[flat].sum())) >= 6:
                yield self.finding(
                    "warning",
                    channel,
                    float(time[starts[flat][0]]),
                    f"clipped: {count} samples at its {name} value, {extreme:.5g}, up to {lengths[flat].max()} in a row",
                )
        off = spikes(values, step)
        if len(off := off[time[off + 2] - time[off - 2] < 4.5 * self.step]):  # none beside a gap
            i, more = int(off[0]), f", and {len(off) - 1} more" if len(off) > 1 else ""
            height = abs(values[i] - 0.5 * (values[i - 1] + values[i + 1]))
            digits = max(5, 2 + math.ceil(math.log10(np.abs(values[i - 1 : i + 2]).max() / height)))
            it, before, after = (f"{value:.{digits}g}" for value in values[[i, i - 1, i + 1]])
            yield self.finding(
                "warning",
                channel,
                float(time[i]),
                f"a spike at {self.at(time[i])}, {it} between {before} and {after}{more}",
            )
        yield from self.drift(channel, values, grain)

    def still_until(self) -> float:
        """When the waves arrive, where the record begins before; until then nothing has to move."""
        if self.driven != WAVE or WAVE not in self.values:
            return -np.inf
        wave = np.abs(self.values[WAVE] - np.median(self.values[WAVE]))
        return float(self.time[np.argmax(wave > 0.5 * wave.max())])

    def in_zero(self, first: float, last: float) -> bool:
        """Whether a stretch of time is in still water by the manifest.

        With a zero window, the stretch begins after the window's begin, and ends less than a period after its end. With a zero
        test, every time of that test counts.

        Args:
            first: Begin of the stretch, in the file's unit.
            last: End of the stretch, in the file's unit.
        """
        zero = self.manifest.zero
        if zero is None or zero.window is None:
            return zero is not None and zero.test == self.test.id
        return bool(first >= zero.window[0] and last < zero.window[1] + (self.period or 0.0))

    def drift(self, channel: str, values: np.ndarray, grain: float) -> Iterator[Finding]:
        """Warn of a mean that drifts.

        In a decay, means over one cycle in the first and the last third of the record are compared. In other tests, the rise of
        a straight line through the values is compared with their deviation from it.

        Args:
            channel: Name of the channel.
            values: (n,) its values, in its own unit.
            grain: Its resolution, in its own unit.
        """
        if self.test.kind == "decay":
            n = round(self.period / self.step) if self.period is not None and channel == self.driven else 0
            if n < 2 or len(values) < 3 * n:
                return
            means = np.convolve(values, np.full(n, 1 / n), "valid")
            third = len(means) // 3
            drift, limit = means[-third:].mean() - means[:third].mean(), 0.1 * np.abs(values - means[-1]).max()
        else:
            values = values[self.compared]
            mean = straight_line(self.time[self.compared], values)
            drift, limit = mean[-1] - mean[0], 2 * float(np.std(values - mean))
        if abs(drift) > limit + 2 * grain:
            unit = self.series.channels[channel].unit
            yield self.finding("warning", channel, None, f"its mean drifts by {drift:.3g} {unit}")
