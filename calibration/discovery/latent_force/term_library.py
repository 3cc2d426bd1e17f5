"""Library of terms that a latent force may follow: of the motion, its velocity, and the wave."""

from typing import NamedTuple

import numpy as np
import scipy  # its parts are imported when they are used: that takes a second

from calibration.discovery.latent_force.recovered_force import RecoveredForce
from jaxhydro.environment import DOFS

LAG_RATIOS = (0.3, 1.0, 3.0)  # time constants of lagged velocity, times the circular frequency of the motion


class LibraryTerm(NamedTuple):
    """A term of the library.

    Attributes:
        name: Its name.
        motion: Power of the motion (m, rad).
        time: Power of the time (s).
        wave: Power of the wave elevation (m).
    """

    name: str
    motion: int = 0
    time: int = 0
    wave: int = 0

    def unit(self, motion: str) -> str:
        """Unit of its coefficient (SI, rad)."""
        turning = DOFS.index(motion) > 2
        above = ["N", *(["m"] if turning else []), *_powers("s", -self.time)]
        below = [*_powers("rad" if turning else "m", self.motion), *_powers("m", self.wave)]
        return " ".join(above) + ("/" + " ".join(below) if below else "")


def _powers(unit: str, power: int) -> list[str]:
    return [] if power == 0 else [unit if power == 1 else f"{unit}{power}"]


STILL_WATER_TERMS = (  # the simplest first
    LibraryTerm("1"),
    LibraryTerm("x", 1),
    LibraryTerm("v", 1, -1),
    LibraryTerm("|v| v", 2, -2),
    LibraryTerm("x^3", 3),
    LibraryTerm("tanh(v/v0)"),
    LibraryTerm("x |x|", 2),
    LibraryTerm("x^2", 2),
    LibraryTerm("v^3", 3, -3),
    *(LibraryTerm(f"v lagged, {lag:g}/omega", 1, -1) for lag in LAG_RATIOS),
)
# two of them make anything out of next to nothing
LAGGED_TERMS = range(len(STILL_WATER_TERMS) - len(LAG_RATIOS), len(STILL_WATER_TERMS))
WAVE_TERMS = (
    LibraryTerm("eta^2 slow", wave=2),
    LibraryTerm("eta^2 slow, a quarter later", wave=2),
    LibraryTerm("eta", wave=1),
    LibraryTerm("eta, a quarter later", wave=1),
)


def squared_envelope(wave: np.ndarray, step: float) -> np.ndarray:
    """Squared envelope (m²) of a wave (m): twice the low-passed square."""
    lines, frequency = np.abs(np.fft.rfft(wave - wave.mean())), np.fft.rfftfreq(len(wave), step)
    square = np.fft.rfft(2 * (wave - wave.mean()) ** 2)
    fade = 0.5 + 0.5 * np.cos(np.pi * np.clip(2 * frequency / frequency[max(int(lines.argmax()), 1)] - 0.5, 0.0, 1.0))
    return np.fft.irfft(square * fade, len(wave))


def quarter_period_later(values: np.ndarray) -> np.ndarray:
    """A series with every frequency shifted by a quarter of its period (Hilbert transform)."""
    return np.imag(scipy.signal.hilbert(values - values.mean()))


def lagged(velocity: np.ndarray, step: float, constant: float) -> np.ndarray:
    """A velocity through a first-order filter: constant (s) du/dt = v - u."""
    omega = 2 * np.pi * np.fft.rfftfreq(len(velocity), step)
    return np.fft.irfft(np.fft.rfft(velocity) / (1 + 1j * omega * constant), len(velocity))


def columns_of(recovered: RecoveredForce, slow: float, pace: float, without: bool = False) -> np.ndarray:
    """Terms of the library in one test (n, k), through the force's filter.

    Terms of the wave are zero in still water.

    Args:
        recovered: The force of the test.
        slow: Velocity scale of friction (m/s, rad/s).
        pace: Circular frequency of the motion (rad/s).
        without: Whether terms follow the simulated motion (instruments) rather than the measured one.
    """
    (x, v), step = recovered.simulated if without else (recovered.position, recovered.velocity), recovered.test.step
    rows = [np.ones_like(x), x, v, np.abs(v) * v, x**3, np.tanh(v / slow), x * np.abs(x), x**2, v**3]
    rows += [lagged(v, step, lag / pace) for lag in LAG_RATIOS]
    if recovered.test.wave is None:
        rows += [np.zeros_like(x)] * len(WAVE_TERMS)
    else:
        eta, square = recovered.test.wave - recovered.test.wave.mean(), squared_envelope(recovered.test.wave, step)
        rows += [square, quarter_period_later(square), eta, quarter_period_later(eta)]
    return np.stack([recovered.through_filter(row)[recovered.inside] for row in rows], axis=1)
