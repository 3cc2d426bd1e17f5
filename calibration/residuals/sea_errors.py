"""Errors in waves: spectra integrated over bands, and amplitudes in regular waves."""

import dataclasses
import math

import numpy as np

from calibration.residuals.measured_seas import SeaTest
from calibration.residuals.moving_channels import moving_channels
from jaxhydro.analysis.sea_statistics import bands_of
from jaxhydro.analysis.spectral import SEGMENT, PowerSpectrum, band_integral, power_spectrum
from jaxhydro.units import for_people

OVERLAP, WINDOW = 0.5, "hann"
WELCH = (
    f"Welch, {WINDOW} segments of {SEGMENT:g} s that overlap by {OVERLAP:.0%} or more; a shorter record is one, not windowed"
)


@dataclasses.dataclass(frozen=True)
class Band:
    """Integrals of the spectra (m2 or deg2) from `low` to `high` (Hz)."""

    low: float
    high: float
    measured: float
    simulated: float

    @property
    def error(self) -> float:
        """(simulated - measured) / measured; NaN where nothing was measured."""
        return self.simulated / self.measured - 1 if self.measured > 0 else math.nan


def channels(test: SeaTest) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Measured and simulated channels, the wave first, then motions, in m and deg."""
    motions = {s.channel: (for_people(s.channel, s.measured), for_people(s.channel, s.simulated)) for s in test.fit.series}
    return {"wave": (test.wave, test.simulated_wave), **motions}


def density(test: SeaTest, x: np.ndarray) -> PowerSpectrum:
    """Spectrum of a channel."""
    return power_spectrum(test.fit.time, x, SEGMENT, OVERLAP, WINDOW)


def in_bands(test: SeaTest) -> dict[str, dict[str, Band]]:
    """Integrals of the spectra, by channel and band (`low_frequency`, `wave_frequency`)."""
    bands: dict[str, dict[str, Band]] = {}
    for name, pair in channels(test).items():
        spectra = [density(test, x) for x in pair]
        limits = bands_of(name, test.peak_period)
        bands[name] = {k: Band(*band, *(band_integral(s, *band) for s in spectra)) for k, band in limits.items()}
    return bands


def moving(test: SeaTest) -> list[str]:
    """Motions whose measured records are large beside others of their unit."""
    return moving_channels({series.channel: series.measured for series in test.fit.series})


def amplitude(test: SeaTest, x: np.ndarray) -> float:
    """Amplitude at the period of regular waves, by least squares over whole periods."""
    time = test.fit.time
    whole = max(1.0, math.floor((time[-1] - time[0]) / test.peak_period)) * test.peak_period
    used = time >= time[-1] - whole
    phase = 2 * math.pi / test.peak_period * time[used]
    basis = np.stack([np.ones(used.sum()), np.cos(phase), np.sin(phase)], axis=1)
    return float(np.hypot(*np.linalg.lstsq(basis, x[used], rcond=None)[0][1:]))
