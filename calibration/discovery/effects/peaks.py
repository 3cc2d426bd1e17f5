"""Where along a shape's values an effect promises the most."""

import numpy as np
from scipy.signal import find_peaks

MAX_PEAKS = 2  # values
MIN_PEAK_GAIN = 10.0  # of -2 ln L: a value that promises less is not tried


def highest_peaks(gain: np.ndarray) -> np.ndarray:
    """Numbers of the highest peaks of what -2 ln L would gain, the highest first."""
    peaks = find_peaks(gain, height=MIN_PEAK_GAIN)[0]
    return peaks[np.argsort(-gain[peaks])][:MAX_PEAKS]
