"""Results of one run: statistics, spectra, band energies and damage-equivalent ranges."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import rainflow
from jaxtyping import Float

from jaxhydro.analysis.record_statistics import Statistics, statistics
from jaxhydro.analysis.sea_statistics import bands_of, still
from jaxhydro.analysis.spectral import band_integral, power_spectrum
from jaxhydro.units import unit_of

STATISTICS = Statistics._fields
BANDS = ("low_frequency", "wave_frequency")
MAX_FREQUENCY = 0.5  # Hz, that spectra are kept to


class RunResults(NamedTuple):
    """Results of one run by channel (m, deg, N).

    Attributes:
        statistics: `STATISTICS` of each channel, (c, s).
        density: Spectral density at `frequencies` (unit²/Hz), (c, f).
        bands: Integral of the density over `BANDS` (unit²), (c, b); NaN for a band that a channel does not have.
        ranges: Damage-equivalent ranges by exponent (unit), (c, m).
        series: The whole record (unit), (c, t), or None.
    """

    statistics: Float[np.ndarray, "c s"]
    density: Float[np.ndarray, "c f"]
    bands: Float[np.ndarray, "c b"]
    ranges: Float[np.ndarray, "c m"]
    series: Float[np.ndarray, "c t"] | None


def unit(channel: str) -> str:
    """Unit of a channel: m, deg for rotations, N for mooring lines."""
    return "N" if channel.startswith("line") else unit_of(channel)


def frequencies(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, " f"]:
    """Frequencies (Hz) of `power_spectrum` for records at these times (s), up to `MAX_FREQUENCY`."""
    lines = power_spectrum(time, np.zeros(len(time))).frequency
    return lines[lines <= MAX_FREQUENCY * (1 + 1e-9)]


def run_results(
    time: Float[np.ndarray, " t"],
    start: float,
    channels: dict[str, Float[np.ndarray, " t"]],
    peak_period: float,
    exponents: Sequence[float],
    equivalent_frequency: float,
) -> RunResults:
    """Results of a run from its records.

    Args:
        time: Sample times (s), (t,), even.
        start: Time (s) from which statistics are taken.
        channels: Records (m, deg, N) by channel, (t,).
        peak_period: Peak period of the sea (s).
        exponents: Slopes m of the S-N curves.
        equivalent_frequency: Frequency (Hz) of the damage-equivalent ranges.

    Raises:
        ValueError: A record has gaps.
    """
    inside = time >= start
    when = time[inside]
    size, numbers = len(frequencies(when)), []
    for name, values in channels.items():
        values = still(values[inside])
        spectrum = power_spectrum(when, values)
        limits = bands_of(name, peak_period)
        integrals = [band_integral(spectrum, *limits[band]) if band in limits else math.nan for band in BANDS]
        damage = equivalent_ranges(values, exponents, equivalent_frequency * (when[-1] - when[0]))
        numbers.append((np.array(statistics(when, values)), spectrum.density[:size], np.array(integrals), damage))
    of_statistics, density, areas, ranges = (np.stack(column) for column in zip(*numbers))
    return RunResults(of_statistics, density, areas, ranges, np.stack(list(channels.values())))


def equivalent_ranges(values: Float[np.ndarray, " t"], exponents: Sequence[float], cycles: float) -> Float[np.ndarray, " m"]:
    """Damage-equivalent ranges (sum n r^m / N)^(1/m) of a record (unit), (m,).

    They are the ranges of N even cycles that do the same damage as the record's own n cycles of range r.

    Args:
        values: Record (unit), (t,).
        exponents: Slopes m of the S-N curves.
        cycles: Number N of even cycles.

    References:
        Miner (1945), sum of damage; ASTM E1049-85, 5.4.4, rainflow counting, halves counted as halves.
    """
    pairs = np.array([(cycle[0], cycle[2]) for cycle in rainflow.extract_cycles(values.tolist())]).reshape(-1, 2)
    largest = pairs[:, 0].max(initial=0.0)
    if not largest > 0:
        return np.zeros(len(exponents))
    share, count = pairs[:, 0] / largest, pairs[:, 1]  # r^m of forces would overflow
    return np.array([largest * (np.sum(count * share**m) / cycles) ** (1 / m) for m in exponents])
