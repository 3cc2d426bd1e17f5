"""Start and end of the waves in a record, and waves in a decay record."""

from __future__ import annotations

import numpy as np
import scipy  # its parts are imported when they are used: that takes a second

from calibration.campaign.signals import dominant_period, noise_level

AVERAGING_CYCLES = 10  # over which the height of waves is averaged
QUIET_SHARE = 0.35  # of the usual height: waves that have not begun, or have died down
FULL_HEIGHT_SHARE = 0.5  # of it in the first cycle: waves that had begun before
MIN_NOISE_RATIO = 5.0  # standard deviations
MIN_MOTION_SHARE = 0.03  # of the largest motion: less is not told
MAX_PERIOD_RATIO = 0.6  # of the natural period: what is slower may be another motion's
MIN_LASTING_SHARE = 0.7  # of the amplitude a sixth of the record before: less dies down with the motion


def wave_span(time: np.ndarray, wave: np.ndarray, period: float) -> tuple[float, float]:
    """Return the first and last time between which waves are as high as usual.

    Args:
        time: (n,) times.
        wave: (n,) surface elevation.
        period: Period of the waves, in the unit of `time`.

    Returns:
        Both times; those of the whole record where it is short.
    """
    step = float(np.median(np.diff(time)))
    width = round(AVERAGING_CYCLES * period / step)
    if len(wave) < 4 * width:
        return float(time[0]), float(time[-1])
    centred = wave - np.median(wave)
    power = scipy.ndimage.uniform_filter1d(centred**2, width, mode="reflect")
    usual = np.flatnonzero(power > QUIET_SHARE**2 * np.median(power))
    first, last = int(usual[0]), int(usual[-1])
    inside = round((0.5 - QUIET_SHARE**2) * width)  # a mean over `width` sees waves that far away
    return float(time[first + inside if first > 0 else 0]), float(time[last - inside if last < len(time) - 1 else -1])


def begun_before(time: np.ndarray, wave: np.ndarray, period: float) -> bool:
    """Whether the waves are at their full height in the first cycle of a record."""
    centred = wave - np.mean(wave)
    start = centred[time < time[0] + period]
    return bool(np.std(start) > FULL_HEIGHT_SHARE * np.std(centred))


def waves_left(time: np.ndarray, values: np.ndarray, natural: float) -> tuple[float, float] | None:
    """Return period and amplitude of a fast oscillation that goes on in the last third of a decay.

    Args:
        time: (n,) times.
        values: (n,) the released motion.
        natural: Natural period, in the unit of `time`.

    Returns:
        Period and amplitude, in the units of `time` and `values`; None without such an oscillation.
    """
    tail = len(values) * 2 // 3
    late_time, late = time[tail:], values[tail:]
    period = dominant_period(late_time, late)
    if period is None or not period < min(MAX_PERIOD_RATIO * natural, (late_time[-1] - late_time[0]) / 5):
        return None
    half = len(late) // 2
    size, before = float(np.std(late[half:])), float(np.std(late[:half]))
    limit = max(MIN_NOISE_RATIO * noise_level(late_time, late), MIN_MOTION_SHARE * float(np.abs(values - np.mean(late)).max()))
    return (period, 2**0.5 * size) if 2**0.5 * size > limit and size > MIN_LASTING_SHARE * before else None


def waves_of_others(time: np.ndarray, wave: np.ndarray, natural: float | None) -> tuple[float, float] | None:
    """Return period and amplitude of waves in a decay that the model itself does not radiate.

    Args:
        time: (n,) times.
        wave: (n,) surface elevation.
        natural: Natural period of the released motion, in the unit of `time`; None where it is not clear.

    Returns:
        Period and amplitude, in the units of `time` and `wave`; None without such waves.
    """
    period = dominant_period(time, wave)
    size = 2**0.5 * float(np.std(wave))
    if period is None or size < MIN_NOISE_RATIO * noise_level(time, wave):
        return None
    return None if natural is not None and 0.75 < period / natural < 1.33 else (period, size)
