"""Statistics and energy in bands of a motion in an irregular sea, as JSON and as tables."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from jaxhydro.analysis.spectral import band_integral, bands, power_spectrum, statistics
from jaxhydro.environment import DOFS
from jaxhydro.units import unit_of

STILL = 1e-9  # m, deg: what moves less does not move
SHOWN = ("mean", "standard_deviation", "minimum", "maximum", "significant_double_amplitude", "zero_crossing_period")
HEADS = ("Mean", "Standard deviation", "Least", "Largest", "Significant double amplitude", "Zero-crossing period (s)")


def bands_of(channel: str, peak_period: float | None) -> dict[str, tuple[float, float]]:
    """Bands (Hz) of a channel, of the wave only `wave_frequency`, none of yaw. peak_period None, as of white noise: those of a
    moderate sea."""
    if channel == "yaw":
        return {}
    found = bands("surge" if channel == "wave" else channel, peak_period or 1.0)
    return {"wave_frequency": found["wave_frequency"]} if channel == "wave" else found


def summary(time: np.ndarray, channels: Mapping[str, np.ndarray], peak_period: float | None) -> dict[str, Any]:
    """`window` (s), `statistics` and `bands` of every channel (m, deg), wave among them. What is not known is None."""
    return {
        "window": [float(time[0]), float(time[-1])],
        "statistics": {name: _statistics(time, name, values) for name, values in channels.items()},
        "bands": {name: _bands(time, name, values, peak_period) for name, values in channels.items() if name != "yaw"},
    }


def still(values: np.ndarray) -> np.ndarray:
    """Values, or their mean where they do not move."""
    return np.full_like(values, np.round(values.mean(), 9) + 0.0) if np.ptp(values) < STILL else values


def _statistics(time: np.ndarray, channel: str, values: np.ndarray) -> dict[str, Any]:
    found = statistics(time, still(values))._asdict()
    return {"unit": unit_of(channel), **{key: value if math.isfinite(value) else None for key, value in found.items()}}


def _bands(time: np.ndarray, channel: str, values: np.ndarray, peak_period: float | None) -> dict[str, Any]:
    spectrum, found = power_spectrum(time, still(values)), {}
    for name, (low, high) in bands_of(channel, peak_period).items():
        area = band_integral(spectrum, low, high)
        found[name] = {"band": [low, high], "integral": area, "standard_deviation": math.sqrt(area)}
    return found


def tables(document: Mapping[str, Any]) -> tuple[tuple[tuple[str, ...], list[tuple[str, ...]]], ...]:
    """Heads and rows of the two tables that are printed: statistics, and bands, of all that moves."""
    rows, energy = [], []
    for channel, found in document["statistics"].items():
        rows.append((f"{channel} ({found['unit']})", *(_number(found[name]) for name in SHOWN)))
        deviation = found["standard_deviation"]
        if not deviation or channel not in document["bands"]:
            continue
        cells = []
        for name in ("low_frequency", "wave_frequency"):
            one = document["bands"][channel].get(name)
            share = one and one["integral"] / deviation**2
            cells += [_band(one["band"]), _number(one["integral"]), f"{share:.0%}"] if one else ["-", "-", "-"]
        energy.append((f"{channel} ({found['unit']}²)", *cells))
    of_bands = ("Low frequency (Hz)", "Integral", "of all", "Wave frequency (Hz)", "Integral", "of all")
    return (("Channel", *HEADS), rows), (("Channel", *of_bands), energy)


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}" if abs(value) > STILL else "0"


def _band(band: list[float]) -> str:
    return f"{band[0]:g}-{band[1]:g}"


def in_order(motion: np.ndarray, wave: np.ndarray) -> dict[str, np.ndarray]:
    """Channels by name from motions (sample, dof) and the wave, which comes first."""
    return {"wave": wave, **dict(zip(DOFS, motion.T, strict=True))}
