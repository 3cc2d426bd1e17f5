"""Highest peaks of a predicted gain."""

import numpy as np
from scipy.signal import find_peaks

MAX_PEAKS = 2  # values
MIN_PEAK_GAIN = 10.0  # of -2 ln L: a value that promises less is not tried


def highest_peaks(gain: np.ndarray) -> np.ndarray:
    """Positions of the highest peaks of a predicted decrease of -2 ln L, the highest first."""
    peaks = find_peaks(gain, height=MIN_PEAK_GAIN)[0]
    return peaks[np.argsort(-gain[peaks])][:MAX_PEAKS]
