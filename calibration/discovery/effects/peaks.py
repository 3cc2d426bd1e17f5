"""Values of a shape that are worth trying: peaks of the predicted gain in likelihood."""

import numpy as np
import scipy  # its parts are imported when they are used: that takes a second

MAX_PEAKS = 2  # number of values that are tried
MIN_PEAK_GAIN = 10.0  # decrease of -2 ln L; values that gain less are not tried


def highest_peaks(gain: np.ndarray) -> np.ndarray:
    """Positions of the highest peaks of a predicted decrease of -2 ln L, the highest first."""
    peaks = scipy.signal.find_peaks(gain, height=MIN_PEAK_GAIN)[0]
    return peaks[np.argsort(-gain[peaks])][:MAX_PEAKS]
