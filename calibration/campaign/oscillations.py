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
    high, low = (prominent_peaks(sign * part, prominence) for sign in (1, -1))
    both = sorted([*((k, 1) for k in high), *((k, -1) for k in low)])
    turns: list[tuple[int, int]] = []
    for index, sign in both:
        if turns and turns[-1][1] == sign:
            if sign * part[index] > sign * part[turns[-1][0]]:
                turns[-1] = (index, sign)
        else:
            turns.append((index, sign))
    return np.array([index + begin for index, _ in turns], int)


def prominent_peaks(x: np.ndarray, prominence: float) -> np.ndarray:
    """Samples of the peaks of a record, of flat ones the middle: `scipy.signal.find_peaks`, whose import takes a second.

    The prominence of a peak is its height above the higher of the lowest values that separate it, on either side, from a
    higher value or from the end of the record.

    Args:
        x: (n,) the record.
        prominence: Least prominence (unit of `x`).
    """
    if len(x) < 3:
        return np.zeros(0, int)
    first = np.flatnonzero(np.diff(x, prepend=np.nan))  # of each stretch of equal values
    rising = np.diff(x[first]) > 0
    turns = np.concatenate([[0], 1 + np.flatnonzero(rising[1:] != rising[:-1]), [len(first) - 1]])
    height = x[first[turns]]
    after = np.append(first, len(x))[turns + 1]
    middle = (first[turns] + after - 1) // 2
    base = np.maximum(_lowest_since_higher(height), _lowest_since_higher(height[::-1])[::-1])
    inner = np.arange(len(turns))[1:-1]
    peaks = inner[(height[inner] > height[inner - 1]) & (height[inner] - base[inner] >= prominence)]
    return middle[peaks]


def _lowest_since_higher(x: np.ndarray) -> np.ndarray:
    """Lowest value from behind the last higher value up to each value, (n,)."""
    lowest = []
    higher: list[tuple[float, float]] = []  # values that no later one reaches, and the lowest value since the one before
    for value in x.tolist():
        low = value
        while higher and higher[-1][0] <= value:
            low = min(low, higher.pop()[1])
        higher.append((value, low))
        lowest.append(low)
    return np.array(lowest)


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
