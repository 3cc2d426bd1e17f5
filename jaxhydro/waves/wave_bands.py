"""Frequency band of first-order waves where none is given.

One rule serves records, spectra and tables of sea states. The band is 0.03 to 0.3 Hz where the waves lie there. Otherwise it
is the same band at the hull's pace (`jaxhydro.scales`), where they lie in that. Otherwise it is the band that holds the
waves.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple, TypeAlias

import numpy as np
from jaxtyping import Float

LOW, CUTOFF = 0.03, 0.3  # Hz, for an ocean; over the pace of the platform for seas elsewhere
MAX_FREQUENCY = 0.55  # Hz, over the pace: the hull does not feel shorter waves, and no band derived from a sea has them
MIN_ENERGY_IN_BAND = 0.95  # least share of the waves' energy in a band that is to hold them
PEAK_WITHIN = 0.8  # of a band's cutoff: the peak of a spectrum that the band is to hold is not above
LOW_ENERGY_SHARE = 0.05  # of the waves' energy: their slowest part
CUTOFF_ENERGY_SHARE = 0.99  # of the waves' energy: below the cutoff
LOW_LIMIT_FACTOR = 0.5  # of the frequency of the slowest part: there the band begins
MIN_CUTOFF_FACTOR = (
    1.5  # of the frequency below which `MIN_ENERGY_IN_BAND` lies: the least cutoff, so that regular waves have a band
)
DRIFT_FREQUENCY_FACTOR = 0.2  # of the median frequency: what is slower is drift of a gauge or of the basin
MIN_CYCLES = 3  # cycles in a record; what is slower is drift
MIN_WAVE_SHARE = 0.5  # least share of a record's variance above its noise; with less there are no waves
NOISE_CELLS = 8  # of the frequencies, in the quietest of which noise is seen
NYQUIST_SHARE = 0.9  # of half the sampling frequency: the highest cutoff

Band: TypeAlias = tuple[float, float]  # Hz


class WaveEnergy(NamedTuple):
    """Share of a record's wave energy up to each frequency (Hz), and the highest that its sampling allows."""

    frequency: Float[np.ndarray, " f"]
    below: Float[np.ndarray, " f"]
    sampled: float

    def at(self, share: float) -> float:
        """The frequency (Hz) below which a share of the energy lies."""
        return float(self.frequency[np.argmax(self.below >= share)])

    def within(self, low: float, high: float) -> float:
        """Share of the energy between two frequencies (Hz)."""
        edges = np.searchsorted(self.frequency, (low, high * (1 + 1e-9)))
        under, up_to = (float(self.below[edge - 1]) if edge else 0.0 for edge in edges)
        return up_to - under

    @property
    def band(self) -> Band:
        """The band (Hz) that holds the waves."""
        cutoff = max(self.at(CUTOFF_ENERGY_SHARE), MIN_CUTOFF_FACTOR * self.at(MIN_ENERGY_IN_BAND))
        return LOW_LIMIT_FACTOR * self.at(LOW_ENERGY_SHARE), min(cutoff, self.sampled)


def wave_energy(elevation: Float[np.ndarray, " n"], step: float) -> WaveEnergy | None:
    """Distribution of a record's wave energy over frequency; None where it has no waves.

    Args:
        elevation: (n,) m, sampled every `step` (s).
        step: s.
    """
    count = len(elevation)
    clock = np.arange(count) - 0.5 * (count - 1)
    slope = float(clock @ elevation / max(clock @ clock, 1.0))
    moving = elevation - np.mean(elevation) - slope * clock
    if count < 8 * NOISE_CELLS or not np.ptp(moving) > 1e-9 * np.abs(elevation).max():
        return None
    power = np.abs(np.fft.rfft(moving)) ** 2
    power[:MIN_CYCLES] = 0.0
    frequency = np.fft.rfftfreq(count, step)
    # lines of white noise are exponentially distributed: their median is ln 2 of their mean
    noise = min(float(np.median(cell)) for cell in np.array_split(power[MIN_CYCLES:], NOISE_CELLS)) / math.log(2)
    above = np.cumsum(np.where(frequency > 0, power - noise, 0.0))
    if not above[-1] > MIN_WAVE_SHARE * power.sum():
        return None
    median = frequency[np.argmax(above >= 0.5 * above[-1])]
    above -= above[np.searchsorted(frequency, DRIFT_FREQUENCY_FACTOR * median) - 1]
    below = np.clip(np.where(frequency < DRIFT_FREQUENCY_FACTOR * median, 0.0, above) / above[-1], 0.0, 1.0)
    return WaveEnergy(frequency, below, NYQUIST_SHARE * 0.5 / step)


def of_records(records: Iterable[tuple[Float[np.ndarray, " n"], float]], pace: float) -> Band:
    """Return the band (Hz) of first-order waves of records, for a platform of a `pace`.

    Args:
        records: elevation (m) and sampling interval (s) of each. Every one has to lie in the band.
        pace: time over that of VolturnUS-S, by Froude.
    """
    waves = [energy for energy in (wave_energy(*record) for record in records) if energy is not None]
    return _chosen(
        lambda band: all(energy.within(*band) >= MIN_ENERGY_IN_BAND for energy in waves),
        [energy.band for energy in waves],
        pace,
    )


def of_spectra(peak_periods: Sequence[float], pace: float, weights: Sequence[float] | None = None) -> Band:
    """Return the band (Hz) of first-order waves of spectra, for a platform of a `pace`.

    A spectrum lies in a band where its peak does. A band derived from it holds Pierson and Moskowitz' spectrum, whose energy
    below f is exp(-5/4 (f_p/f)^4). Most of the energy of all of them has to lie in the band.

    Args:
        peak_periods: s, of each.
        pace: time over that of VolturnUS-S, by Froude.
        weights: energy of each, in any unit; None: all the same.
    """
    periods = np.asarray(peak_periods, dtype=float)
    energy = np.ones_like(periods) if weights is None else np.asarray(weights, dtype=float)

    def holds(band: Band) -> bool:
        inside = (1 / periods >= band[0]) & (1 / periods <= PEAK_WITHIN * band[1])
        return bool(energy[inside].sum() >= MIN_ENERGY_IN_BAND * energy.sum())

    under, below = ((1.25 / -math.log(share)) ** 0.25 for share in (LOW_ENERGY_SHARE, CUTOFF_ENERGY_SHARE))
    return _chosen(holds, [(LOW_LIMIT_FACTOR * under / period, below / period) for period in periods], pace)


def at_pace(pace: float) -> Band:
    """Return 0.03 to 0.3 Hz at the pace of a platform, to three digits."""
    return _rounded(LOW / pace), _rounded(CUTOFF / pace)


def _chosen(holds: Callable[[Band], bool], derived: Sequence[Band], pace: float) -> Band:
    """The first band that holds the waves; the hull's where it would feel none of them."""
    for band in ((LOW, CUTOFF), at_pace(pace)):
        if holds(band):
            return band
    low = _rounded(min(low for low, _ in derived))
    cutoff = _rounded(min(max(high for _, high in derived), MAX_FREQUENCY / pace))
    return (low, cutoff) if low < cutoff else at_pace(pace)


def _rounded(value: float) -> float:
    return float(f"{value:.3g}")
