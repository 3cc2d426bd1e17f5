"""What is kept of every run: statistics, spectra, energy in bands, damage-equivalent ranges. Pure functions of records."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import rainflow
from jaxtyping import Float

from jaxhydro.analysis.sea_statistics import bands_of, still
from jaxhydro.analysis.spectral import Statistics, band_integral, power_spectrum, statistics
from jaxhydro.environment import DOFS
from jaxhydro.units import unit_of

STATISTICS = Statistics._fields
BANDS = ("low_frequency", "wave_frequency")
HIGHEST = 0.5  # Hz, that spectra are kept to


class Kept(NamedTuple):
    """Of one run, by channel (m, deg, N): `STATISTICS`, density at `frequencies` (unit^2/Hz), integral over `BANDS` (unit^2;
    NaN: there is no such band), damage-equivalent ranges by exponent (unit), and the whole record or None."""

    statistics: Float[np.ndarray, "c s"]
    density: Float[np.ndarray, "c f"]
    bands: Float[np.ndarray, "c b"]
    ranges: Float[np.ndarray, "c m"]
    series: Float[np.ndarray, "c t"] | None


def unit(channel: str) -> str:
    """Of a channel: m, deg for rotations, N for mooring lines."""
    return "N" if channel.startswith("line") else unit_of(channel)


def frequencies(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, " f"]:
    """Hz, up to `HIGHEST`: those of `power_spectrum` for records at these times (s)."""
    found = power_spectrum(time, np.zeros(len(time))).frequency
    return found[found <= HIGHEST * (1 + 1e-9)]


def bands_in(channel: str, peak_period: float) -> dict[str, tuple[float, float]]:
    """Bands (Hz) of a channel in a sea of this peak period (s): those of `jaxhydro simulate`, none of mooring lines."""
    return bands_of(channel, peak_period) if channel in ("wave", *DOFS) else {}


def kept_of(
    time: Float[np.ndarray, " t"],
    start: float,
    channels: dict[str, Float[np.ndarray, " t"]],
    peak_period: float,
    exponents: Sequence[float],
    equivalent_frequency: float,
) -> Kept:
    """Of records (m, deg, N) at even times (s) from `start` (s) on. Raises ValueError for records with gaps."""
    inside = time >= start
    when = time[inside]
    size, found = len(frequencies(when)), []
    for name, values in channels.items():
        values = still(values[inside])
        spectrum = power_spectrum(when, values)
        limits = bands_in(name, peak_period)
        integrals = [band_integral(spectrum, *limits[band]) if band in limits else math.nan for band in BANDS]
        damage = equivalent_ranges(values, exponents, equivalent_frequency * (when[-1] - when[0]))
        found.append((np.array(statistics(when, values)), spectrum.density[:size], np.array(integrals), damage))
    of_statistics, density, areas, ranges = (np.stack(column) for column in zip(*found))
    return Kept(of_statistics, density, areas, ranges, np.stack(list(channels.values())))


def equivalent_ranges(values: Float[np.ndarray, " t"], exponents: Sequence[float], cycles: float) -> Float[np.ndarray, " m"]:
    """(sum n r^m / N)^(1/m): the range (unit of the record) of N even `cycles` that do the damage of the record's own n of
    range r.

    Miner's (1945) sum with an S-N curve of slope m, its cycles by rainflow (ASTM E1049-85, 5.4.4), halves counted as halves.
    """
    pairs = np.array([(cycle[0], cycle[2]) for cycle in rainflow.extract_cycles(values.tolist())]).reshape(-1, 2)
    largest = pairs[:, 0].max(initial=0.0)
    if not largest > 0:
        return np.zeros(len(exponents))
    share, count = pairs[:, 0] / largest, pairs[:, 1]  # r^m of forces would overflow
    return np.array([largest * (np.sum(count * share**m) / cycles) ** (1 / m) for m in exponents])
