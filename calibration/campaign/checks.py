"""Data-quality checks: clocks, gaps, frozen and clipped channels, spikes, drift, windows.

An error is what no fit should be built on, a warning what its reader should know. Rows that lack a value or repeat a time are
dropped with a warning, while they are less than 2 % of the window. Nothing else is changed. Times in the messages are the
file's own, in its own unit.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from calibration.campaign.checked_series import GAP_STEPS, MAX_SHOWN, MIN_SAMPLES, CheckedSeries
from calibration.campaign.extent_checks import extent_warnings
from calibration.campaign.finding import Finding
from calibration.campaign.manifest import Manifest
from calibration.campaign.manifest_sections import DOFS, WAVE
from calibration.campaign.oscillations import MIN_SAMPLES_PER_CYCLE
from calibration.campaign.records import unit_factors
from calibration.campaign.series import Series, read_series, valid_values
from calibration.campaign.signal_checks import signal_findings
from calibration.campaign.signals import missing_code, resolution, wave_height

MAX_DROPPED_SHARE = 0.02  # of a window's rows
FEW_SAMPLES_PER_CYCLE = 15  # samples per cycle
MIN_SAMPLES_PER_WAVE = 4  # these only drive: what is slower is worth having still
MIN_WAVES = 20  # after the transient


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
    return tuple(finding for test_series in series for finding in _findings(CheckedSeries(manifest, test_series, series)))


def _findings(checked: CheckedSeries) -> list[Finding]:
    """Findings on one series.

    Checks after `_missing` use only rows without faults, and need increasing times.
    """
    findings = [*_window(checked), *_zero(checked)]
    findings += _units(checked)
    if not any(finding.severity == "error" for finding in findings):
        findings += [*_clock(checked), *_missing(checked)]
    if any(finding.severity == "error" for finding in findings):
        return findings
    signals = (f for name in checked.values for f in signal_findings(checked, name))
    told = extent_warnings(checked.series, checked.time, checked.values, checked.compared, checked.period)
    extent = [checked.finding("warning", *warning) for warning in told]
    return [*findings, *extent, *_held_out(checked), *_oscillation(checked), *_sea(checked), *signals]


def _held_out(checked: CheckedSeries) -> Iterator[Finding]:
    """Is it really held out?"""
    for other in checked.others if checked.test.use == "holdout" else ():
        alike = other.test.use == "fit" and other.test.file == checked.test.file and len(other.time) > 0
        if alike and min(checked.time[-1], other.time[-1]) > max(checked.time[0], other.time[0]):
            yield checked.finding("warning", "", None, f"held out, and the fitted test {other.test.id} has samples of it")


def _window(checked: CheckedSeries) -> Iterator[Finding]:
    """Is there enough of a record?"""
    (first, last), count, after = checked.series.span, len(checked.series.time), int(checked.compared.sum())
    start, end = checked.test.window or (first, last)
    beyond = 0.01 * (end - start) + 2 * checked.step
    if not first <= last:
        yield checked.finding("error", "time", None, "none", "times")
    elif start < first - beyond or end > last + beyond:
        yield checked.finding(
            "error",
            "",
            None,
            f"a window from {checked.at(start)} to {checked.at(end)}",
            f"a window in the file's range, {checked.at(first)} to {checked.at(last)}",
        )
    elif count < MIN_SAMPLES:
        yield checked.finding("error", "", None, f"{count} samples", f"{MIN_SAMPLES} samples or more in the window")
    elif checked.test.transient > 0 and after < MIN_SAMPLES:
        message = f"{checked.at(checked.test.transient)} of a record of {checked.at(end - start)}, which leaves {after}"
        if missing := int((~checked.series.good).sum()):
            message = f"{message}, as {missing} of its {count} rows lack a value"
        yield checked.finding("error", "", None, message, f"a transient that leaves {MIN_SAMPLES} samples or more")


def _units(checked: CheckedSeries) -> Iterator[Finding]:
    """Does the file state the unit that the manifest does?"""
    for channel, unit in checked.series.units.items():
        stated = checked.series.channels[channel]
        if unit != stated.unit:
            yield checked.finding(
                "warning",
                channel,
                None,
                f"the file states {unit} for column {stated.column!r}, and the manifest {stated.unit}",
            )


def _zero(checked: CheckedSeries) -> Iterator[Finding]:
    """Is there still water to take off?"""
    zero = checked.manifest.zero
    if zero is not None and zero.window is not None:
        fewest, (first, last) = min(map(len, checked.series.still.values())), checked.series.span
        if fewest < MIN_SAMPLES:
            yield checked.finding(
                "error",
                "",
                None,
                f"{fewest} in {list(zero.window)}, of a file from {checked.at(first)} to {checked.at(last)}",
                f"{MIN_SAMPLES} or more samples in zero.window",
            )
    elif zero is not None:
        rest = next(other for other in checked.others if other.test.id == zero.test)
        for channel in sorted(set(checked.values) & set(DOFS) - set(rest.values)):
            yield checked.finding(
                "error", channel, None, f"no such channel in test {zero.test}", "a channel that the zero test has too"
            )


def _clock(checked: CheckedSeries) -> Iterator[Finding]:
    """Do times increase, and evenly?"""
    rows = np.flatnonzero(valid_values(checked.series.time))
    time = checked.series.time[rows]
    steps = np.diff(time)
    if np.any(steps < 0):
        i = int(np.argmax(steps < 0))
        row = checked.series.row(rows[i + 1])
        yield checked.finding(
            "error",
            "time",
            float(time[i]),
            f"a step back from {checked.at(time[i])} to {checked.at(time[i + 1])} in {row} of the file",
            "times that increase",
        )
        return
    if same := int(np.sum(steps == 0)):
        i = int(np.argmax(steps == 0))
        first_repeat = f"the first {checked.at(time[i])} in {checked.series.row(rows[i + 1])}"
        yield _dropped(checked, same, "time", float(time[i]), f"{same} times that repeat, {first_repeat}")
    steps = np.diff(checked.time)
    for i in np.flatnonzero(steps > GAP_STEPS * checked.step)[:MAX_SHOWN]:
        yield checked.finding(
            "warning",
            "time",
            float(checked.time[i]),
            f"a gap of {checked.at(steps[i])} after {checked.at(checked.time[i])}, where steps are {checked.at(checked.step)}",
        )
    usual = steps[steps < 1.5 * checked.step]
    rounding = resolution(usual) if len(usual) else 0.0
    if rounding > 0.02 * checked.step and np.ptp(usual) < 2.5 * rounding:
        yield checked.finding(
            "warning", "time", None, f"times are written to {checked.at(rounding)}, where steps are {checked.at(checked.step)}"
        )


def _missing(checked: CheckedSeries) -> Iterator[Finding]:
    """Values that are not there."""
    for channel, values in {"time": checked.series.time, **checked.series.values}.items():
        bad = np.flatnonzero(~valid_values(values))
        if len(bad):
            before = checked.series.time[: bad[0] + 1]
            before = before[valid_values(before)]
            when = float(before[-1]) if len(before) else None
            near = "at the start" if when is None else f"near {checked.at(when)}"
            first_missing = f"the first {near}, {checked.series.row(int(bad[0]))}"
            code = missing_code(values)
            fault = "missing or infinite" if code is None else f"missing, as {code:g} seems to say"
            yield _dropped(checked, len(bad), channel, when, f"{len(bad)} values {fault}, {first_missing}")


def _dropped(checked: CheckedSeries, count: int, channel: str, time: float | None, message: str) -> Finding:
    if count < MAX_DROPPED_SHARE * len(checked.series.time):
        return checked.finding("warning", channel, time, f"{message}: these rows are dropped")
    return checked.finding(
        "error",
        channel,
        time,
        message,
        f"fewer than {MAX_DROPPED_SHARE:.0%} of the {len(checked.series.time)} rows to be dropped; "
        "a `window` beside the gap, or values interpolated in the file",
    )


def _oscillation(checked: CheckedSeries) -> Iterator[Finding]:
    """Is what oscillates sampled often and long enough?"""
    if checked.period is None:
        return
    samples, cycles = checked.period / checked.step, (checked.time[-1] - checked.time[0]) / checked.period
    message = f"{samples:.1f} samples per cycle of {checked.at(checked.period)}"
    least = MIN_SAMPLES_PER_WAVE if checked.driven == WAVE else MIN_SAMPLES_PER_CYCLE
    if samples < least:
        yield checked.finding("error", checked.driven, None, message, f"{least} samples per cycle or more")
    elif samples < FEW_SAMPLES_PER_CYCLE:
        yield checked.finding("warning", checked.driven, None, f"only {message}")
    if cycles < 1.5:
        yield checked.finding(
            "warning", checked.driven, None, f"only {cycles:.1f} cycles of about {checked.at(checked.period)}"
        )


def _sea(checked: CheckedSeries) -> Iterator[Finding]:
    """Does the sea agree with the manifest, is the position of its gauge stated, and is it long enough?"""
    test, irregular = checked.test, checked.test.kind == "irregular"
    if checked.driven != WAVE or WAVE not in checked.values:
        return
    if checked.manifest.wave_channel is not None and checked.manifest.wave_channel.position is None:
        yield checked.finding("warning", WAVE, None, "wave_channel has no position: taken as the origin")
    name = "significant_wave_height" if irregular else "wave_height"
    stated = test.significant_wave_height if irregular else test.wave_height
    metres = abs(unit_factors(checked.manifest, checked.series.channels)[WAVE]) / checked.manifest.scale
    height = wave_height(checked.values[WAVE][checked.compared], irregular) * metres
    if stated is not None and not 0.7 < height / stated < 1.4:
        yield checked.finding("warning", WAVE, None, f"{name} is stated as {stated:g} m, and recorded as {height:.3g} m")
    duration = float(checked.time[-1] - checked.time[0]) - test.transient
    if irregular and checked.period is not None and duration < MIN_WAVES * checked.period:
        yield checked.finding(
            "warning",
            WAVE,
            None,
            f"only {checked.at(duration)} after the transient, {duration / checked.period:.1f} waves "
            f"of about {checked.at(checked.period)}: too few to tell a sea by",
        )
