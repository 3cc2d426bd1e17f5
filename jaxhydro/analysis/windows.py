"""Windows of spectra, by name."""

import numpy as np
from jaxtyping import Float


def window_weights(name: str, count: int) -> Float[np.ndarray, " s"]:
    """Weights of a window: `scipy.signal.get_window`, whose import takes as long as a simulation.

    Args:
        name: Name of the window.
        count: Number of samples.
    """
    if name == "boxcar":
        return np.ones(count)
    if name == "hann":
        return 0.5 + 0.5 * np.cos(np.linspace(-np.pi, np.pi, count + 1)[:-1])
    from scipy.signal import get_window

    return np.asarray(get_window(name, count))
