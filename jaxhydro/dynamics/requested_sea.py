"""An irregular sea that is asked for: a spectrum, systems of waves, or a record."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from jaxhydro.waves import wave_bands
from jaxhydro.waves.directional_spectrum import (
    AbstractDirectionalSpectrum,
    SystemsSpectrum,
    WaveSystem,
)
from jaxhydro.waves.tabulated_sea import TabulatedDirections, TabulatedFrequencies

MIN_SAMPLES = 100  # samples after the transient
TRANSIENT = 500.0  # s times its pace, at most TRANSIENT_SHARE of the duration
TRANSIENT_SHARE = 0.25


def usual_transient(duration: float, pace: float = 1.0) -> float:
    """Default time (s) that statistics leave out at the start."""
    return min(TRANSIENT * pace, TRANSIENT_SHARE * duration)


@dataclass(frozen=True)
class SecondGauge:
    """Elevation that a second gauge measured at the same times.

    Attributes:
        column: Column of the file.
        elevation: Elevation (m), (t,).
        position: Position of the gauge (m, earth axes).
    """

    column: str
    elevation: np.ndarray
    position: tuple[float, float]


@dataclass(frozen=True)
class Record:
    """Measured wave elevation.

    Attributes:
        source: File that it was read from.
        column: Column of the file.
        times: Times (s), (t,), even.
        elevation: Elevation (m), (t,).
        position: Position of the gauge (m, earth axes).
        second: A second gauge, by which reflected waves are told from incident ones, or None.
    """

    source: str
    column: str
    times: np.ndarray
    elevation: np.ndarray
    position: tuple[float, float]
    second: SecondGauge | None = None


@dataclass(frozen=True)
class MeasuredDirections:
    """Spectrum of a file.

    Attributes:
        source: The file.
        spectrum: The spectrum, with directions or without.
        x_bearing: Compass bearing of the platform's x axis (deg).
        time: Time of the spectrum (UTC) as it was asked for, or "".
    """

    source: str
    spectrum: TabulatedDirections | TabulatedFrequencies
    x_bearing: float
    time: str = ""

    def summary(self) -> tuple[float, float, float]:
        """Significant height (m), peak period (s) and mean heading (deg)."""
        spectrum = self.spectrum
        height = 4 * math.sqrt(float(np.trapezoid(spectrum.table, spectrum.omega)))
        peak = float(spectrum.omega[int(np.argmax(spectrum.table))])
        return height, 2 * math.pi / peak, math.degrees(spectrum.mean_heading)


@dataclass(frozen=True)
class RequestedSea:
    """Request for an irregular sea, from a spectrum or, where `hs` is None, from `record`.

    Attributes:
        hs: Significant wave height (m), or None.
        tp: Peak period (s), or None.
        gamma: Peak enhancement (-), or None.
        spectrum: Name of the spectrum.
        seed: Seed of the random numbers.
        amplitudes: As in `spectrum_components`.
        low: Lowest frequency (Hz); None: by `jaxhydro.waves.wave_bands`.
        cutoff: Highest frequency (Hz); None: by `jaxhydro.waves.wave_bands`.
        order: 1 or 2.
        stretching: As in `WaveSea`.
        heading: Direction that the waves travel to (deg).
        transient: Time (s) that statistics leave out, or None.
        record: Measured elevation, or None.
        systems: Wave systems, of which `hs`, `tp` and `heading` are a summary (`of_systems`); empty: one long-crested one.
        measured: Directional spectrum of a file, or None.
    """

    hs: float | None
    tp: float | None
    gamma: float | None
    spectrum: str
    seed: int
    amplitudes: str
    low: float | None
    cutoff: float | None
    order: int
    stretching: str
    heading: float
    transient: float | None
    record: Record | None = None
    systems: tuple[WaveSystem, ...] = ()
    measured: MeasuredDirections | None = None

    @classmethod
    def of_systems(cls, systems: tuple[WaveSystem, ...], **options: Any) -> "RequestedSea":
        """Request for a sea of wave systems.

        Hs is that of all systems together. Period and heading are those of the highest system.

        Args:
            systems: The wave systems.
            options: Other fields of the request.
        """
        highest = max(systems, key=lambda system: system.hs)
        hs = math.sqrt(sum(system.hs**2 for system in systems))
        shape = "systems" if len(systems) > 1 else highest.spectrum
        gamma = None if len(systems) > 1 else highest.gamma
        return cls(hs=hs, tp=highest.tp, gamma=gamma, spectrum=shape, heading=highest.heading, systems=systems, **options)

    @property
    def directional(self) -> AbstractDirectionalSpectrum | None:
        """Directional spectrum of the sea; None for a long-crested sea of one spectrum, or a record."""
        if self.measured is not None:
            return self.measured.spectrum
        return SystemsSpectrum(self.systems) if self.systems else None

    @property
    def long_crested(self) -> bool:
        """Whether all waves of the sea travel one way."""
        if self.record is not None and self.record.second is not None:
            return False
        return self.directional is None or self.directional.long_crested

    def band(self, pace: float) -> tuple[float, float]:
        """Lowest and highest frequency (Hz) for a platform of a `pace`; those not given by `wave_bands`."""
        if self.low is not None and self.cutoff is not None:
            return self.low, self.cutoff
        if self.record is not None:
            step = float(np.median(np.diff(self.record.times)))
            usual = wave_bands.of_records([(self.record.elevation, step)], pace)
        else:
            peaks = [system.tp for system in self.systems] or ([] if self.tp is None else [self.tp])
            weights = [system.hs**2 for system in self.systems] or None
            usual = wave_bands.of_spectra(peaks, pace, weights) if peaks else wave_bands.at_pace(pace)
        low, cutoff = (default if limit is None else limit for limit, default in zip((self.low, self.cutoff), usual))
        return low, cutoff
