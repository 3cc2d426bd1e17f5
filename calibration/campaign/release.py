"""Detection of the free motion in a decay record."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy  # its parts are imported when they are used: that takes a second

from calibration.campaign.oscillations import (
    MIN_SAMPLES_PER_CYCLE,
    moving_range,
    spectral_peak_period,
    true_stretches,
    turning_points,
)
from calibration.campaign.signals import noise_level

STILLNESS_DURATION = 0.2  # period, for which stillness is looked for; a free peak moves by 0.19 of its amplitude in it
STILLNESS_AMPLITUDE = 0.08  # of the amplitude of the motion that follows: less is stillness
CATCH_AMPLITUDE = 0.03  # of the amplitude before: less is more than damping does
MIN_CATCH_AMPLITUDE = 0.3  # of the first amplitude: friction alone may stop less
MIN_HOLD_DURATION = 0.35  # period: what lasts less between motions is no hold, but two motions that cancel
SMOOTHING_DURATION = 0.06  # period, over which noise is averaged
NOISE_MARGIN = 3.0  # deviations of the averaged noise, by which stillness may move
PEAK_PROMINENCE = 0.1  # of the largest amplitude: what counts as a turn
MIN_PEAKS = 3  # of a free motion
MIN_VISIBLE_HOLD = 0.05  # period: a hold that is shorter is not told from a release
SLOW_MOTION_SHARE = 0.3  # of the range: turns of a slow motion that is the main one
MAX_HOLD_MISFIT = 0.012  # of the amplitude, by which a short hold and its release may miss a level and a cosine
MIN_HOLD_OFFSET = 0.15  # of the amplitude: a hold closer to rest is none
CAUGHT_OFFSET, CAUGHT_SPEED = 0.3, 0.8  # of the amplitude: where a caught model stands, and its speed just before over omega
RELEASE_DELAY = 0.02  # period after the release, at which the test begins
PUSH_GROWTH, MIN_PUSH_SHARE = 1.25, 0.18  # by which a swing exceeds the two before it, and by how much of the whole range
HALF_PERIOD_TOLERANCE = 0.15  # period, by which half a period may differ: another motion is no second push


@dataclass(frozen=True)
class FreeMotion:
    """The rows of a decay that move freely, [first, last), and what comes before and after them.

    Attributes:
        first: Index of the first row that moves freely.
        last: Index after the last row that moves freely.
        start: Event that begins the free motion; the record: it is free from the first row.
        end: Event that ends the free motion; the record: it is free up to the last row.
        held_until: Time at which the release or push ended the stillness (the time's unit).
        level: Value at which the motion stood until then (the channel's unit).
        ended_at: Time at which the free motion was ended (the time's unit).
    """

    first: int
    last: int
    start: Literal["record", "release", "push"] = "record"
    end: Literal["record", "catch", "push"] = "record"
    held_until: float = np.nan
    level: float = np.nan
    ended_at: float = np.nan


def free_motion(time: np.ndarray, values: np.ndarray) -> FreeMotion:
    """Find the first free decay in a record: all rows where nothing else is found.

    Args:
        time: (n,) increasing times.
        values: (n,) the motion that was released.
    """
    whole = FreeMotion(0, len(time))
    if len(time) < 4 * MIN_SAMPLES_PER_CYCLE or np.ptp(values) == 0 or not (np.diff(time) > 0).all():
        return whole
    step = float(np.median(np.diff(time)))
    even = np.arange(time[0], time[-1] + 0.5 * step, step)
    x = np.interp(even, time, values)
    noise = noise_level(even, x)
    period = spectral_peak_period(x, step, noise)
    slow = scipy.ndimage.uniform_filter1d(x, min(max(round(period / step), 1), len(x))) if np.isfinite(period) else x
    apart = np.diff(turning_points(slow, 0, len(x), SLOW_MOTION_SHARE * float(np.ptp(x))))
    if len(apart) and float(np.median(apart)) < 4 * period / step:  # the fast motion is not what was released
        period = spectral_peak_period(slow, step, 0.0)
    gap = float(np.diff(time).max())
    if not MIN_SAMPLES_PER_CYCLE * step < period < 0.7 * (time[-1] - time[0]) or gap > max(
        STILLNESS_DURATION * period, 1.5 * step
    ):
        return whole
    y = scipy.ndimage.uniform_filter1d(x, max(int(SMOOTHING_DURATION * period / step), 1), mode="nearest")
    decay = _first_decay(x, y, period / step, noise)
    if decay is None:
        return whole
    first, last, start, end, held, level = decay
    times = even[0] + step * np.array([first, last, held])
    rows = np.searchsorted(time, times[:2] - 1e-9 * step)
    return FreeMotion(
        int(rows[0]) if start != "record" else 0,
        int(rows[1]) if end != "record" else len(time),
        start,
        end,
        float(times[2]),
        level,
        float(times[1]),
    )


def _first_decay(
    x: np.ndarray, y: np.ndarray, period: float, sigma: float
) -> tuple[float, float, Literal["record", "release", "push"], Literal["record", "catch", "push"], float, float] | None:
    """Find the bounds of the first decay in an evenly sampled record.

    Args:
        x: (n,) the motion.
        y: (n,) the motion, smoothed.
        period: Its period (samples).
        sigma: Standard deviation of the noise of `x`.

    Returns:
        First and last sample of the decay; the events that begin and end it; the end of the stillness before it (samples), and
        the level there (unit of `x`). None where there is no decay.
    """
    size, width, cycle = 0.5 * float(np.ptp(y)), round(STILLNESS_DURATION * period), round(period)
    noise = NOISE_MARGIN * sigma / max(SMOOTHING_DURATION * period, 1) ** 0.5
    spread = moving_range(y, width)
    after = 0.5 * np.roll(moving_range(y, cycle), -width)
    after[len(y) - width :] = 0.0
    moves = after > max(PEAK_PROMINENCE * size, 0.8 * noise / STILLNESS_AMPLITUDE)
    runs = [
        run
        for run in true_stretches((spread < STILLNESS_AMPLITUDE * after + noise) & moves)
        if run[1] - run[0] + width > MIN_HOLD_DURATION * period
    ]
    begins = [0, *(last + width for _, last in runs)]
    ends = [*(max(first, 1) for first, _ in runs), len(y)]
    lasts = [*(last + width for _, last in runs), len(y)]
    for i, (begin, end, still) in enumerate(zip(begins, ends, lasts)):
        turns = turning_points(y, begin, end, max(PEAK_PROMINENCE * size, 3 * noise))
        if len(turns) < MIN_PEAKS:
            continue
        peaks = y[turns[:7]]
        rest = float(np.median((peaks[:-2] + 2 * peaks[1:-1] + peaks[2:]) / 4))
        amplitude = float(np.abs(peaks - rest).max())
        cycle = round(2 * float(np.median(np.diff(turns[:7]))))
        first, start, held = float(begin), "record", 0.0
        since = runs[i - 1][0] if i else 0
        level = float(np.median(x[since:begin])) if i else float(x[: max(cycle // 30, 1)].mean())
        if i and abs(level - rest) < MIN_HOLD_OFFSET * amplitude:
            start, held = "push", float(begin)
            large = [turn for turn in turns if abs(y[turn] - rest) > 0.5 * amplitude]
            first = float(large[0] if large else turns[0])
        elif abs(level - rest) > 0.5 * amplitude:
            least, most = max(since, begin - cycle // 3), begin + cycle // (5 if i else 2)
            held, misfit = _find_release(x, least, most, level - rest, cycle)
            if i or (held - begin > MIN_VISIBLE_HOLD * cycle and misfit < MAX_HOLD_MISFIT * amplitude + 1.5 * sigma):
                start, first = "release", held + RELEASE_DELAY * cycle
        later = (
            np.diff(turning_points(y, still, min(still + 12 * cycle, len(y)), max(PEAK_PROMINENCE * size, 3 * noise))) / cycle
        )
        pushed = len(later) > 0 and abs(float(np.median(later)) - 0.5) < HALF_PERIOD_TOLERANCE
        stop, how = _find_end(y, turns, rest, cycle, noise, end, still if pushed else None)
        return first, stop, start, how, held, level  # type: ignore[return-value]
    return None


def _find_end(
    y: np.ndarray, turns: np.ndarray, rest: float, cycle: int, noise: float, end: int, pushed: int | None
) -> tuple[float, Literal["record", "catch", "push"]]:
    """Where a free motion ends (samples) and by what."""
    swings = np.abs(np.diff(y[turns]))
    apart, whole = np.diff(turns) / cycle, float(np.ptp(y))
    for k in range(2, len(swings) - 1):
        before = max(swings[k - 1], swings[k - 2])
        grown = swings[k : k + 3] > max(PUSH_GROWTH * before, before + MIN_PUSH_SHARE * whole)
        if grown[0] and (grown[1:] & (np.abs(apart[k + 1 : k + 3] - 0.5) < HALF_PERIOD_TOLERANCE)).any():
            while k > 2 and swings[k - 1] > PUSH_GROWTH * max(swings[k - 2], swings[k - 3]):
                k -= 1  # a pull before the release is part of it
            return float(turns[k]), "push"
    width = round(STILLNESS_DURATION * cycle)
    spread, before = moving_range(y, width), np.zeros(len(y))
    before[cycle:] = 0.5 * moving_range(y, cycle)[:-cycle]
    still = (
        (spread < CATCH_AMPLITUDE * before + noise)
        & (noise < STILLNESS_AMPLITUDE * before)
        & (before > MIN_CATCH_AMPLITUDE * 0.5 * swings.max())
    )
    still &= (np.arange(len(y)) > turns[0]) & (np.arange(len(y)) < len(y) - width)
    for first, last in true_stretches(still):
        if first >= end:
            break
        if last - first + width < MIN_HOLD_DURATION * cycle:
            continue
        speed = np.abs(np.diff(y[max(first - cycle // 8, 0) : first + 1])).max(initial=0.0) * cycle / (2 * np.pi)
        off = abs(float(np.median(y[first : first + width])) - rest)
        if max(off / CAUGHT_OFFSET, speed / CAUGHT_SPEED) > before[first]:
            return float(first - SMOOTHING_DURATION * cycle), "catch"
    return (float(pushed - RELEASE_DELAY * cycle), "push") if pushed is not None else (float(len(y)), "record")


def _find_release(x: np.ndarray, first: int, last: int, fall: float, cycle: int) -> tuple[float, float]:
    """Find when a held motion is let go, by least squares.

    The motion is level until then, and the begin of a cosine after it.

    Args:
        x: (n,) the motion.
        first: Earliest sample of the release.
        last: Latest sample of the release.
        fall: Level less the position of rest (unit of `x`).
        cycle: Period (samples).

    Returns:
        The release (samples), and the root mean square of the residual (unit of `x`).
    """
    best = (np.inf, float(first))
    for release in np.arange(first, last, 0.25):
        rows = np.arange(first, min(int(release) + cycle // 8 + 2, len(x)))
        residual = x[rows] + np.where(rows > release, fall * (1 - np.cos(2 * np.pi * (rows - release) / cycle)), 0.0)
        best = min(best, (float(np.mean((residual - residual.mean()) ** 2)), float(release)))
    return best[1], best[0] ** 0.5
