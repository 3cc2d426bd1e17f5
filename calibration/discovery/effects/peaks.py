"""Highest peaks of a predicted gain."""

import numpy as np
from scipy.signal import find_peaks

MAX_PEAKS = 2  # number of values that are tried
MIN_PEAK_GAIN = 10.0  # decrease of -2 ln L; values that gain less are not tried


def highest_peaks(gain: np.ndarray) -> np.ndarray:
    """Positions of the highest peaks of a predicted decrease of -2 ln L, the highest first."""
    peaks = find_peaks(gain, height=MIN_PEAK_GAIN)[0]
    return peaks[np.argsort(-gain[peaks])][:MAX_PEAKS]
