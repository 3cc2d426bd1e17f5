"""Recovered latent force of one motion of a test."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from jaxhydro.waves.sea import AbstractSea

MIN_PEAK_OVER_NOISE = 20.0  # in power, of the highest spectral peak: with less there is no force


class ResampledTest(NamedTuple):
    """A test on an even clock.

    Attributes:
        id: Its name.
        use: Its use (fit, holdout).
        kind: Its kind (decay, regular, irregular).
        time: Times (s; n,).
        measured: Measured motions (m, rad).
        simulated: Simulated motions (m, rad).
        noise: Sensor noise by motion (m, rad).
        sea: The sea.
        wave: Wave elevation (m; n,), or None.
    """

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
        """Time step (s)."""
        return float(self.time[1] - self.time[0])


class RecoveredForce(NamedTuple):
    """Latent force of one motion of a test.

    Attributes:
        test: The test.
        motion: The motion.
        force: The force (N, N m; n,).
        position: The motion (m, rad; n,).
        velocity: Its velocity (m/s, rad/s; n,).
        acceleration: Its acceleration (m/s², rad/s²; n,).
        simulated: Simulated motion without the force, and its velocity.
        gain: Gain of the filter by Fourier line.
        taper: Taper of the force (n,).
        inside: The part of the record that is reliable.
        noise: Noise that is left in the force (N, N m).
        peak: Highest peak of the spectrum over the noise, in power.
    """

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
        """A force as the recovery would show it."""
        return filtered(values * self.taper, self.gain)

    @property
    def root_mean_square(self) -> float:
        """Root mean square (N, N m)."""
        return float(np.sqrt(np.mean(self.force[self.inside] ** 2)))

    @property
    def visible(self) -> bool:
        """Whether the force is more than noise."""
        return self.peak > MIN_PEAK_OVER_NOISE and self.root_mean_square > 0


def filtered(values: np.ndarray, gain: np.ndarray) -> np.ndarray:
    """A series (n,) with its Fourier lines multiplied by a gain."""
    return np.fft.irfft(gain * np.fft.rfft(values), len(values))
