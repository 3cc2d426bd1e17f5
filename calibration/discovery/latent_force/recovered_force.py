"""The latent force that was recovered from one motion of a test."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from jaxhydro.waves.sea import AbstractSea

MIN_PEAK_OVER_NOISE = 20.0  # times the noise, in power, that the highest peak of a force has: without it there is none


class ResampledTest(NamedTuple):
    """A test on an even clock (s): motions (m, rad) measured and simulated, noise, the sea that it was in, and its wave (m)."""

    id: str
    use: str
    kind: str
    time: np.ndarray
    measured: Mapping[str, np.ndarray]
    simulated: Mapping[str, np.ndarray]
    noise: Mapping[str, float]
    sea: AbstractSea
    wave: np.ndarray | None = None

    @property
    def step(self) -> float:
        """s"""
        return float(self.time[1] - self.time[0])


class RecoveredForce(NamedTuple):
    """The latent force (N, N m) of one motion of a test; motion (m, rad; /s; /s2) and force all along its clock, and the
    `simulated` motion and its rate without it. Of these `inside` is to be believed. `gain` by Fourier line and `taper` in time
    are what the force was seen through, `noise` (N, N m) what the sensor's noise leaves in it, `peak` by how much its spectrum
    is above that at most, in power."""

    test: ResampledTest
    motion: str
    force: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    simulated: tuple[np.ndarray, np.ndarray]
    gain: np.ndarray
    taper: np.ndarray
    inside: slice
    noise: float
    peak: float

    def through_filter(self, values: np.ndarray) -> np.ndarray:
        """What the reconstruction would have left of a force."""
        return filtered(values * self.taper, self.gain)

    @property
    def root_mean_square(self) -> float:
        """N, N m"""
        return float(np.sqrt(np.mean(self.force[self.inside] ** 2)))

    @property
    def visible(self) -> bool:
        """Whether it is more than noise."""
        return self.peak > MIN_PEAK_OVER_NOISE and self.root_mean_square > 0


def filtered(values: np.ndarray, gain: np.ndarray) -> np.ndarray:
    """A series (n,) with its Fourier lines times a gain."""
    return np.fft.irfft(gain * np.fft.rfft(values), len(values))
