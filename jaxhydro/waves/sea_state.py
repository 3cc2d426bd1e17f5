"""Significant wave height and peak period of a sea."""

from typing import NamedTuple

import numpy as np

from jaxhydro.waves.components import Components

SMOOTHING_HALF_WIDTH = 0.005  # Hz, half the width over which a spectrum is averaged


class SeaState(NamedTuple):
    """Sea state.

    Attributes:
        significant_height: Significant wave height Hs = 4 sqrt(m0) (m).
        peak_period: Peak period (s).
    """

    significant_height: float
    peak_period: float


def peak_period(frequency: np.ndarray, density: np.ndarray) -> float:
    """Peak period (s) of a spectrum, Tp = sum S⁴ / sum f S⁴.

    It is steadier than the highest line of an estimated spectrum. The density is first averaged over 0.01 Hz.

    Args:
        frequency: Even frequencies (Hz), (n,).
        density: Spectral density in any unit, (n,).

    References:
        Young (1995), Ocean Engineering 22, 669-686, equation (3).
    """
    edges = np.searchsorted(
        frequency, np.add.outer((-SMOOTHING_HALF_WIDTH, SMOOTHING_HALF_WIDTH), frequency) + np.array([[-1e-9], [1e-9]])
    )
    summed = np.concatenate([[0.0], np.cumsum(density)])
    mean = (summed[edges[1]] - summed[edges[0]]) / (edges[1] - edges[0])
    weight = (mean / mean.max()) ** 4
    return float(weight.sum() / (weight * frequency).sum())


def state_of(waves: Components) -> SeaState:
    """Sea state of components on even frequencies.

    Raises:
        ValueError: All amplitudes are 0.
    """
    power, frequency = 0.5 * np.asarray(waves.amplitude) ** 2, np.asarray(waves.omega) / (2 * np.pi)
    if not power.sum() > 0:
        raise ValueError("expected a sea with waves, found amplitudes of 0 only")
    return SeaState(4 * float(power.sum()) ** 0.5, peak_period(frequency, power))
