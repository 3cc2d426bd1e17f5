"""Directional spectra: seas of several wave systems. Those in tables are in `tabulated_sea`.

Each system has its heading and spreading. A directional spectrum is E(omega, heading) = S(omega) D(heading; omega). A sea is
drawn from it with one direction per frequency component. So its variance at every frequency is that of S, and it is the same
at every point.
"""

import abc
import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Array, Float

from jaxhydro.choices import check
from jaxhydro.environment import Environment
from jaxhydro.quick_jit import on_device
from jaxhydro.waves.components import Components
from jaxhydro.waves.irregular import spectrum_components
from jaxhydro.waves.spectra import SPECTRA
from jaxhydro.waves.spreading import equal_energy_shares, spread_angle

SHAPES = tuple(SPECTRA)  # names of spectra that a system may have


class AbstractDirectionalSpectrum(abc.ABC):
    """Base class of directional spectra."""

    @abc.abstractmethod
    def density(self, omega: Float[Array, " w"]) -> Float[Array, " w"]:
        """Spectral density S over all directions (m² s/rad) at frequencies (rad/s), (w,)."""

    @abc.abstractmethod
    def headings(self, omega: Float[np.ndarray, " w"], share: Float[np.ndarray, " w"]) -> Float[np.ndarray, " w"]:
        """Directions (rad) up to which a share of the energy of each frequency (rad/s) travels, (w,)."""

    @property
    @abc.abstractmethod
    def long_crested(self) -> bool:
        """Whether all waves travel one way."""


@dataclass(frozen=True)
class WaveSystem:
    """Wind sea or swell: a spectrum with a heading and a spreading.

    Attributes:
        hs: Significant wave height (m).
        tp: Peak period (s).
        gamma: Peak enhancement of JONSWAP (-); None: that of IEC 61400-3-1.
        heading: Mean direction that the waves travel to (deg).
        spreading: Exponent s of `spreading.spreading` (-); None: long-crested.
        spectrum: "jonswap" or "pierson-moskowitz".
    """

    hs: float
    tp: float
    gamma: float | None = None
    heading: float = 0.0
    spreading: float | None = None
    spectrum: str = "jonswap"

    def __post_init__(self) -> None:
        """Check the shape of the spectrum and the exponent of the spreading.

        Raises:
            UnknownName: Another spectrum.
            ValueError: The exponent of the spreading is negative.
        """
        check(spectrum=(self.spectrum, SHAPES))
        if self.spreading is not None and not (self.spreading >= 0 and math.isfinite(self.spreading)):
            raise ValueError(f"the exponent of a spreading is not negative, found {self.spreading}")

    @property
    def words(self) -> str:
        """The system in words."""
        shape = "" if self.gamma is None else f", gamma {self.gamma:g}"
        spread = "long-crested" if self.spreading is None else f"spreading {self.spreading:g}"
        return f"Hs {self.hs:g} m, Tp {self.tp:g} s{shape}, heading {self.heading:g} deg, {spread}"

    def density(self, omega: Float[Array, " w"]) -> Float[Array, " w"]:
        """Spectral density (m² s/rad) at frequencies (rad/s), (w,)."""
        return SPECTRA[self.spectrum](omega, self.hs, self.tp, self.gamma)


@dataclass(frozen=True)
class SystemsSpectrum(AbstractDirectionalSpectrum):
    """Sum of the spectra of several wave systems.

    Where two systems have energy at one frequency, its component belongs to one of them, by chance in proportion to their
    energies there. The variance at that frequency is the sum of both.

    Attributes:
        systems: The systems, one or more.
    """

    systems: tuple[WaveSystem, ...]

    def density(self, omega: Float[Array, " w"]) -> Float[Array, " w"]:
        total = self.systems[0].density(omega)
        for system in self.systems[1:]:
            total = total + system.density(omega)
        return total

    @property
    def long_crested(self) -> bool:
        return all(system.spreading is None and system.heading == self.systems[0].heading for system in self.systems)

    def headings(self, omega: Float[np.ndarray, " w"], share: Float[np.ndarray, " w"]) -> Float[np.ndarray, " w"]:
        density = np.stack([np.asarray(system.density(on_device(omega))) for system in self.systems])
        total = density.sum(axis=0)
        total = np.where(total > 0, total, 1.0)
        headings, below = np.full(np.shape(omega), math.radians(self.systems[0].heading)), np.zeros(np.shape(omega))
        for system, fraction in zip(self.systems, density / total):
            mine = (share >= below) & (fraction > 0)
            heading = np.full(np.shape(omega), math.radians(system.heading))
            if system.spreading is not None:
                inside = np.clip((share - below) / np.where(fraction > 0, fraction, 1.0), 0.0, 1.0)
                heading = heading + spread_angle(system.spreading, inside)
            headings, below = np.where(mine, heading, headings), below + fraction
        return headings


def systems_spectrum(systems: Sequence[WaveSystem]) -> SystemsSpectrum:
    """Directional spectrum of wave systems.

    Raises:
        ValueError: There are none.
    """
    if not systems:
        raise ValueError("one wave system or more expected, found none")
    return SystemsSpectrum(tuple(systems))


def directional_components(
    spectrum: AbstractDirectionalSpectrum,
    duration: float,
    environment: Environment,
    *,
    low: float,
    cutoff: float,
    seed: int,
    amplitudes: str = "deterministic",
) -> Components:
    """Draw a sea from a directional spectrum, with one direction per frequency component.

    Amplitudes and phases are those of `spectrum_components`, directions by `equal_energy_shares`. A spectrum of one direction
    gives the long-crested sea itself.

    Args:
        spectrum: The directional spectrum.
        duration: Time (s) within which the sea must not repeat.
        environment: Water depth and gravity.
        low: Lowest frequency (Hz).
        cutoff: Highest frequency (Hz).
        seed: Seed of the random numbers.
        amplitudes: "deterministic" or "rayleigh".

    Returns:
        The components.

    Raises:
        ValueError: As `spectrum_components`.
    """
    waves = spectrum_components(
        spectrum.density, duration, environment, low=low, cutoff=cutoff, seed=seed, amplitudes=amplitudes
    )
    first, last = waves.harmonics
    headings = spectrum.headings(np.asarray(waves.omega), equal_energy_shares(first, last, seed))
    return dataclasses.replace(waves, heading=on_device(headings))
