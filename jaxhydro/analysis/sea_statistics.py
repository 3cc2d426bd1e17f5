"""Statistics and band energies of a motion in an irregular sea, as JSON and as tables."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from jaxhydro.analysis.motion_bands import bands
from jaxhydro.analysis.record_statistics import statistics
from jaxhydro.analysis.spectral import band_integral, power_spectrum
from jaxhydro.environment import DOFS
from jaxhydro.units import unit_of
from jaxhydro.waves.sea_state import peak_period

MIN_RANGE = 1e-9  # m, deg: what moves less does not move
MIN_PRINTED_SHARE = 1e-6  # of the largest value of the same unit: smaller motions are rounding, printed as 0
PRINTED_STATISTICS = (
    "mean",
    "standard_deviation",
    "minimum",
    "maximum",
    "significant_double_amplitude",
    "zero_crossing_period",
)
PRINTED_HEADINGS = (
    "Mean",
    "Standard deviation",
    "Minimum",
    "Maximum",
    "Significant double amplitude",
    "Zero-crossing period (s)",
)


def bands_of(channel: str, peak_period: float | None) -> dict[str, tuple[float, float]]:
    """Frequency bands (Hz) of a channel.

    Args:
        channel: "wave", which has only `wave_frequency`, or a degree of freedom; yaw and mooring lines have no bands.
        peak_period: Peak period (s). None (white noise): the bands of a moderate sea.
    """
    if channel not in ("wave", *DOFS) or channel == "yaw":
        return {}
    limits = bands("surge" if channel == "wave" else channel, peak_period or 1.0)
    return {"wave_frequency": limits["wave_frequency"]} if channel == "wave" else limits


def record_peak_period(elevation: np.ndarray, step: float, low: float = 0.0, cutoff: float = math.inf) -> float:
    """Peak period (s) of an elevation record, as `jaxhydro.waves.sea_state.peak_period` defines it.

    Args:
        elevation: Evenly sampled elevation (m), (t,).
        step: Sampling interval (s).
        low: Lowest frequency of the waves (Hz).
        cutoff: Highest frequency of the waves (Hz).

    Raises:
        ValueError: If there are no waves in the band.
    """
    spectrum = power_spectrum(step * np.arange(len(elevation)), elevation)
    inside = (spectrum.frequency > 0) & (spectrum.frequency >= low) & (spectrum.frequency <= cutoff)
    if not spectrum.density[inside].any():
        raise ValueError(f"expected waves from {low:g} to {cutoff:g} Hz, found none")
    return peak_period(spectrum.frequency[inside], spectrum.density[inside])


def summary(time: np.ndarray, channels: Mapping[str, np.ndarray], peak_period: float | None) -> dict[str, Any]:
    """Time window, statistics and band energies of every channel, as written to JSON.

    Args:
        time: Sample times (s), (t,).
        channels: Records (m, deg) by channel, the wave among them.
        peak_period: Peak period of the sea (s), or None.

    Returns:
        `window` (s), `statistics` and `bands`; undefined values are None.
    """
    return {
        "window": [float(time[0]), float(time[-1])],
        "statistics": {name: _statistics(time, name, values) for name, values in channels.items()},
        "bands": {name: _bands(time, name, values, peak_period) for name, values in channels.items() if name != "yaw"},
    }


def still(values: np.ndarray) -> np.ndarray:
    """The values; where they vary by less than `MIN_RANGE`, their rounded mean throughout."""
    return np.full_like(values, np.round(values.mean(), 9) + 0.0) if np.ptp(values) < MIN_RANGE else values


def _statistics(time: np.ndarray, channel: str, values: np.ndarray) -> dict[str, Any]:
    numbers = statistics(time, still(values))._asdict()
    return {"unit": unit_of(channel), **{key: value if math.isfinite(value) else None for key, value in numbers.items()}}


def _bands(time: np.ndarray, channel: str, values: np.ndarray, peak_period: float | None) -> dict[str, Any]:
    spectrum, energies = power_spectrum(time, still(values)), {}
    for name, (low, high) in bands_of(channel, peak_period).items():
        area = band_integral(spectrum, low, high)
        energies[name] = {"band": [low, high], "integral": area, "standard_deviation": math.sqrt(area)}
    return energies


def moves(document: Mapping[str, Any], channel: str) -> bool:
    """Whether a channel of `summary` moves by more than rounding."""

    def extent(numbers: Mapping[str, Any]) -> float:
        return max(abs(numbers["minimum"] or 0.0), abs(numbers["maximum"] or 0.0))

    mine = document["statistics"][channel]
    alike = [extent(numbers) for numbers in document["statistics"].values() if numbers["unit"] == mine["unit"]]
    return extent(mine) > max(MIN_RANGE, MIN_PRINTED_SHARE * max(alike))


def tables(document: Mapping[str, Any]) -> tuple[tuple[tuple[str, ...], list[tuple[str, ...]]], ...]:
    """Headings and rows of the two printed tables: statistics, and band energies of every moving channel."""
    rows, energy = [], []
    for channel, numbers in document["statistics"].items():
        moving = moves(document, channel)
        *of_motion, period = PRINTED_STATISTICS
        printed = [
            *(_number(numbers[name]) if moving else "0" for name in of_motion),
            _number(numbers[period] if moving else None),
        ]
        rows.append((f"{channel} ({numbers['unit']})", *printed))
        deviation = numbers["standard_deviation"]
        if not moving or not deviation or channel not in document["bands"]:
            continue
        cells = []
        for name in ("low_frequency", "wave_frequency"):
            band = document["bands"][channel].get(name)
            share = band and band["integral"] / deviation**2
            cells += [_band(band["band"]), _number(band["integral"]), f"{share:.0%}"] if band else ["-", "-", "-"]
        energy.append((f"{channel} ({numbers['unit']}²)", *cells))
    of_bands = ("Low frequency (Hz)", "Integral", "of all", "Wave frequency (Hz)", "Integral", "of all")
    return (("Channel", *PRINTED_HEADINGS), rows), (("Channel", *of_bands), energy)


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}" if abs(value) > MIN_RANGE else "0"


def _band(band: list[float]) -> str:
    return f"{band[0]:g}-{band[1]:g}"


def in_order(motion: np.ndarray, wave: np.ndarray) -> dict[str, np.ndarray]:
    """Records by channel name: the wave first, then motions (sample, dof)."""
    return {"wave": wave, **dict(zip(DOFS, motion.T, strict=True))}
