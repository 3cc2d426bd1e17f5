"""Checks of a channel: frozen, clipped, spiked or drifting values."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from calibration.campaign.checked_series import MAX_SHOWN, MIN_SAMPLES, CheckedSeries
from calibration.campaign.digits import local_resolution, straight_piece
from calibration.campaign.finding import Finding
from calibration.campaign.manifest_sections import WAVE
from calibration.campaign.series import frozen_channels
from calibration.campaign.signals import constant_stretches, flank_heights, resolution, spikes, straight_line


def signal_findings(checked: CheckedSeries, channel: str) -> Iterator[Finding]:
    """Frozen, clipped, spiked, drifting?"""
    values, time = checked.values[channel], checked.time
    grain = resolution(values)
    if grain == 0:
        message = f"one value throughout, {values[0]:.6g}"
        if channel == checked.driven:
            yield checked.finding("error", channel, None, message, "a signal that moves")
        else:
            left_out = ": left out" if channel in frozen_channels(checked.series) else ""
            yield checked.finding("warning", channel, None, f"{message}{left_out}")
        return
    step = local_resolution(values)
    starts, lengths = constant_stretches(values, grain)
    long = max(MIN_SAMPLES, int((checked.period or 0) / 3 / checked.step))
    for i, n in list(zip(starts[lengths > long], lengths[lengths > long]))[:MAX_SHOWN]:
        beside = (values[max(0, i - long) : i + 1], values[i + n - 1 : i + n + long])
        still = _still_until(checked) > time[i + n - 1] or _in_zero(checked, time[i], time[i + n - 1])
        if max(map(np.ptp, beside)) > 6 * step[i] and not still:  # else it has come to rest
            yield checked.finding(
                "warning",
                channel,
                float(time[i]),
                f"frozen from {checked.at(time[i])} to {checked.at(time[i + n - 1])}, {n} samples at {values[i]:.5g}",
            )
    piece = straight_piece(values, step)
    for name, extreme in (("highest", values.max()), ("lowest", values.min())):
        flat = (np.abs(values[starts] - extreme) < grain / 2) & (lengths >= 3 * piece) & (starts > 0)
        flat &= flank_heights(values, starts, lengths) > 16 * step[starts]
        if (count := int(lengths[flat].sum())) >= 6:
            yield checked.finding(
                "warning",
                channel,
                float(time[starts[flat][0]]),
                f"clipped: {count} samples at its {name} value, {extreme:.5g}, up to {lengths[flat].max()} in a row",
            )
    off = spikes(values, step)
    if len(off := off[time[off + 2] - time[off - 2] < 4.5 * checked.step]):  # none beside a gap
        i, more = int(off[0]), f", and {len(off) - 1} more" if len(off) > 1 else ""
        height = abs(values[i] - 0.5 * (values[i - 1] + values[i + 1]))
        digits = max(5, 2 + math.ceil(math.log10(np.abs(values[i - 1 : i + 2]).max() / height)))
        it, before, after = (f"{value:.{digits}g}" for value in values[[i, i - 1, i + 1]])
        yield checked.finding(
            "warning",
            channel,
            float(time[i]),
            f"a spike at {checked.at(time[i])}, {it} between {before} and {after}{more}",
        )
    yield from _drift(checked, channel, values, grain)


def _still_until(checked: CheckedSeries) -> float:
    """When the waves arrive, where the record begins before; until then nothing has to move."""
    if checked.driven != WAVE or WAVE not in checked.values:
        return -np.inf
    wave = np.abs(checked.values[WAVE] - np.median(checked.values[WAVE]))
    return float(checked.time[np.argmax(wave > 0.5 * wave.max())])


def _in_zero(checked: CheckedSeries, first: float, last: float) -> bool:
    """Whether a stretch of time is in still water by the manifest.

    With a zero window, the stretch begins after the window's begin, and ends less than a period after its end. With a zero
    test, every time of that test counts.

    Args:
        first: Begin of the stretch, in the file's unit.
        last: End of the stretch, in the file's unit.
    """
    zero = checked.manifest.zero
    if zero is None or zero.window is None:
        return zero is not None and zero.test == checked.test.id
    return bool(first >= zero.window[0] and last < zero.window[1] + (checked.period or 0.0))


def _drift(checked: CheckedSeries, channel: str, values: np.ndarray, grain: float) -> Iterator[Finding]:
    """Warn of a mean that drifts.

    In a decay, means over one cycle in the first and the last third of the record are compared. In other tests, the rise of
    a straight line through the values is compared with their deviation from it.

    Args:
        channel: Name of the channel.
        values: (n,) its values, in its own unit.
        grain: Its resolution, in its own unit.
    """
    if checked.test.kind == "decay":
        n = round(checked.period / checked.step) if checked.period is not None and channel == checked.driven else 0
        if n < 2 or len(values) < 3 * n:
            return
        means = np.convolve(values, np.full(n, 1 / n), "valid")
        third = len(means) // 3
        drift, limit = means[-third:].mean() - means[:third].mean(), 0.1 * np.abs(values - means[-1]).max()
    else:
        values = values[checked.compared]
        mean = straight_line(checked.time[checked.compared], values)
        drift, limit = mean[-1] - mean[0], 2 * float(np.std(values - mean))
    if abs(drift) > limit + 2 * grain:
        unit = checked.series.channels[channel].unit
        yield checked.finding("warning", channel, None, f"its mean drifts by {drift:.3g} {unit}")
