"""Period, turning points and ranges of a sampled oscillation."""

import numpy as np
import scipy  # its parts are imported when they are used: that takes a second

MIN_SAMPLES_PER_CYCLE = 8  # samples per cycle


def turning_points(y: np.ndarray, begin: int, end: int, prominence: float) -> np.ndarray:
    """Samples at which a motion turns, high and low in turn.

    Args:
        y: (n,) the motion.
        begin: First sample that is looked at.
        end: Sample after the last one.
        prominence: Least prominence of a turning point (unit of `y`).
    """
    part = y[begin:end]
    high, low = (scipy.signal.find_peaks(sign * part, prominence=prominence)[0] for sign in (1, -1))
    both = sorted([*((k, 1) for k in high), *((k, -1) for k in low)])
    turns: list[tuple[int, int]] = []
    for index, sign in both:
        if turns and turns[-1][1] == sign:
            if sign * part[index] > sign * part[turns[-1][0]]:
                turns[-1] = (index, sign)
        else:
            turns.append((index, sign))
    return np.array([index + begin for index, _ in turns], int)


def moving_range(y: np.ndarray, width: int) -> np.ndarray:
    """Largest less smallest value from each sample on.

    Args:
        y: (n,) the motion.
        width: Number of samples that are compared.

    Returns:
        (n,) the range, in the unit of `y`.
    """
    shift = -(width // 2)
    high = scipy.ndimage.maximum_filter1d(y, width, origin=shift, mode="nearest")
    return high - scipy.ndimage.minimum_filter1d(y, width, origin=shift, mode="nearest")  # type: ignore[no-any-return]


def true_stretches(flag: np.ndarray) -> list[tuple[int, int]]:
    """First and last index of every stretch that is true.

    Args:
        flag: (n,) a logical value for each sample.
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flag, [False]]).astype(int)))
    return [(int(first), int(last) - 1) for first, last in zip(edges[::2], edges[1::2])]


def spectral_peak_period(x: np.ndarray, step: float, noise: float) -> float:
    """Period of the highest peak in the spectrum of the speed.

    The power is averaged over a tenth of the frequency, and the expected power of the noise is subtracted.

    Args:
        x: (n,) the motion, evenly sampled.
        step: Time step, in any unit.
        noise: Standard deviation of the noise of `x`.

    Returns:
        The period in the unit of `step`; infinite where the record resolves no frequency.
    """
    speed = np.diff(x)
    frequency = np.fft.rfftfreq(4 * len(speed), step)
    power = np.abs(np.fft.rfft(speed, 4 * len(speed))) ** 2
    resolved = np.flatnonzero(frequency <= 1 / (MIN_SAMPLES_PER_CYCLE * step))[1:]
    if not len(resolved):
        return np.inf
    total = np.concatenate([[0.0], np.cumsum(power)])
    low, high = np.floor(resolved / 1.05).astype(int), np.minimum(np.ceil(resolved * 1.05).astype(int) + 1, len(power))
    mean = (total[high] - total[low]) / (high - low)
    mean -= 2 * len(speed) * (2 * noise * np.sin(np.pi * frequency[resolved] * step)) ** 2
    best = int(np.argmax(mean))
    return float(1 / frequency[low[best] + max(int(np.argmax(power[low[best] : high[best]])), low[best] == 0)])
