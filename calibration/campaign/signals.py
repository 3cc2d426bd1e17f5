"""Analysis of one recorded channel: resolution, noise, period, spikes, constant stretches."""

from __future__ import annotations

import re

import numpy as np

SPIKE_DEVIATIONS = 8.0  # robust standard deviations
SPIKE_MARGIN = 2.0  # the same, or steps of the last digit: a spike is that far beyond both neighbours
MAX_SPIKE_SHARE = 0.02  # of the samples: what is more often is the sensor's grain
MISSING_CODE_RATIO = 10.0  # times all else: what is no measurement


def resolution(values: np.ndarray) -> float:
    """Step in which values were written: the least difference between two that differ.

    Returns:
        The step in the unit of `values`; 0 if all are the same.
    """
    steps = np.diff(np.unique(values))
    steps = steps[steps > 1e-9 * np.abs(values).max()] if len(steps) else steps
    return float(steps.min()) if len(steps) else 0.0


def noise_level(time: np.ndarray, values: np.ndarray) -> float:
    """One standard deviation of the white noise on a slow signal, in the unit of `values`.

    Third differences, and third differences of these, take the signal away. Divided by the norm of their weights, they have
    the noise's standard deviation. It is estimated as 1.4826 times their median size, which a few outliers do not change.

    Differences are taken over the recorded times, and as if these were even. Rounded times disturb the first, and real jitter
    the second. Each estimate is the noise plus a rest of the signal, so one that is clearly less is nearer. Where none is
    clearly less, the simplest is kept, since the least of several estimates is biased low. The result is no less than the
    rounding, resolution / 12^0.5.

    Assumes noise that is white at the sampling interval: of noise smoothed by a sensor's filter it sees only a part.
    The signal should have 15 samples or more per cycle.
    """
    floor = resolution(values) / 12**0.5
    if len(values) < 8:
        return floor
    even = np.arange(len(time), dtype=float)
    grids = (time, even) if np.all(np.diff(time) > 0) else (even,)
    sizes = [float(np.median(np.abs(_differences(grid, values, order)))) for order in (3, 6) for grid in grids]
    size = sizes[0]
    for candidate in sizes[1:]:
        size = candidate if candidate < 0.8 * size else size
    return max(1.4826 * size, floor)


def _differences(time: np.ndarray, values: np.ndarray, order: int) -> np.ndarray:
    """(n - order,) divided differences, their weights scaled to a norm of one."""
    times = np.lib.stride_tricks.sliding_window_view(time, order + 1)
    gaps = (times[:, :, None] - times[:, None, :]) / np.ptp(times, axis=1)[:, None, None]
    weights = 1 / np.prod(gaps + np.eye(order + 1), axis=2)
    weights /= np.linalg.norm(weights, axis=1, keepdims=True)
    return np.sum(weights * np.lib.stride_tricks.sliding_window_view(values, order + 1), axis=1)


def straight_line(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """(n,) the straight line of least squares through the values."""
    centred = time - time.mean()
    return values.mean() + centred * np.sum(centred * (values - values.mean())) / max(np.sum(centred**2), 1e-300)


def dominant_period(time: np.ndarray, values: np.ndarray) -> float | None:
    """Period of the highest peak of a record's spectrum.

    Args:
        time: (n,) increasing times.
        values: (n,) one channel.

    Returns:
        The period in the unit of `time`; None where no peak has 40 % of the power.
    """
    if len(values) < 8 or np.ptp(values) == 0 or np.any(np.diff(time) <= 0):
        return None
    even = np.linspace(time[0], time[-1], len(time))
    resampled = np.interp(even, time, values)
    power = np.abs(np.fft.rfft(resampled - straight_line(even, resampled), 4 * len(resampled))) ** 2
    peak = int(np.argmax(power))
    if peak == 0 or power[int(0.6 * peak) : int(1.6 * peak) + 5].sum() < 0.4 * power.sum():
        return None
    return float(4 * len(resampled) * (even[1] - even[0]) / peak)


def wave_height(elevation: np.ndarray, irregular: bool) -> float:
    """Significant height of an irregular sea, or the height of a regular wave.

    Args:
        elevation: (n,) surface elevation.
        irregular: Whether the sea is irregular.

    Returns:
        Four standard deviations of an irregular sea, 8^0.5 of them of a regular wave; in the unit of `elevation`.
    """
    return (4.0 if irregular else 8**0.5) * float(np.std(elevation))


def constant_stretches(values: np.ndarray, grain: float) -> tuple[np.ndarray, np.ndarray]:
    """Where stretches of one value start, and how many samples they have. `grain` is the resolution."""
    edges = np.flatnonzero(np.concatenate([[True], np.abs(np.diff(values)) > grain / 2, [True]]))
    return edges[:-1], np.diff(edges)


def flank_heights(values: np.ndarray, starts: np.ndarray, lengths: np.ndarray) -> np.ndarray:
    """Lesser height of a signal's flanks before and after each stretch of one value, (m,).

    Each flank is as long as the stretch. Round a rounded peak its height is at most 8 times the resolution. So a peak with much
    higher flanks is cut off.

    Args:
        values: (n,) one channel.
        starts: (m,) first index of each stretch.
        lengths: (m,) samples of each stretch.
    """
    before, after = np.maximum(starts - lengths, 0), np.minimum(starts + 2 * lengths - 1, len(values) - 1)
    return np.minimum(np.abs(values[before] - values[starts]), np.abs(values[after] - values[starts]))


def missing_code(values: np.ndarray) -> float | None:
    """Number of nines alone (-9999) that a logger has written for missing values.

    Returns:
        The number; None where there is no such number.
    """
    finite = values[np.isfinite(values)]
    extreme = float(finite[np.argmax(np.abs(finite))]) if len(finite) else 0.0
    rest = np.abs(finite[finite != extreme])
    nines = re.fullmatch(r"9{3,}|9+\.9+", f"{abs(extreme):.10g}")
    return extreme if nines and len(rest) and abs(extreme) > MISSING_CODE_RATIO * float(rest.max()) else None


def spikes(values: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Indices of single samples that stick out from both neighbours.

    They are above both or below both, by more than digits and noise explain. Such a sample is off the cubic through two
    neighbours on either side. It is also off the lines that continue either side, unlike a corner between straight pieces.

    Args:
        values: (n,) one channel.
        step: (n,) the step of its last digit at every value.
    """
    if len(values) < 12:
        return np.arange(0)
    import pandas as pd

    middle, step = values[2:-2], step[2:-2]
    before, after = values[1:-3], values[3:-1]
    off = middle - (4 * (before + after) - values[:-4] - values[4:]) / 6
    scatter = 1.4826 * pd.Series(np.abs(off)).rolling(101, center=True, min_periods=8).median().to_numpy()
    tolerance = np.maximum(scatter, step)
    alone = np.abs(off) > SPIKE_DEVIATIONS * tolerance
    for shift in (-1, 1):  # its neighbours are off by two thirds of it, the other way
        alone &= np.abs(np.roll(off, shift) + 2 / 3 * off) < 0.35 * np.abs(off)
    above = np.sign(off)
    outside = np.minimum(above * (middle - before), above * (middle - after))
    beyond = np.minimum(above * (middle - 2 * before + values[:-4]), above * (middle - 2 * after + values[4:]))
    indices = np.flatnonzero(alone & (outside > SPIKE_MARGIN * tolerance) & (beyond > 0.5 * np.abs(off)))
    if len(indices) > MAX_SPIKE_SHARE * len(values):  # the sensor's grain sticks out again and again, by the same
        height = np.abs(off[indices])
        indices = indices[height > SPIKE_DEVIATIONS * np.median(height)]
    return indices + 2
