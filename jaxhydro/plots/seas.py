"""Figures of a motion in an irregular sea: record, window and spectra."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from jaxhydro.analysis.sea_statistics import bands_of
from jaxhydro.analysis.spectral import SEGMENT, power_spectrum
from jaxhydro.plots.spectrum_axes import Density, draw_densities, shade_bands
from jaxhydro.plots.style import GREY, MEASURED, SIMULATED, WAVE, header, stack
from jaxhydro.units import unit_of

WINDOW = 200.0  # s, of which the waves can be told apart at half a page
MIN_SEGMENT = 400.0  # s, of the segments of a spectrum
PANEL_HEIGHT = 1.01  # inches of a panel
Figure = Any


def moving(channels: Mapping[str, np.ndarray]) -> list[str]:
    """Names of channels that are not next to still; the first one at least."""
    size = {name: float(np.ptp(values)) for name, values in channels.items()}
    largest = {unit: max((size[n] for n in size if unit_of(n) == unit), default=0.0) for unit in ("m", "deg")}
    return [name for name in channels if size[name] > max(1e-6, 1e-3 * largest[unit_of(name)])] or list(channels)[:1]


def about_highest_crest(time: np.ndarray, wave: np.ndarray, length: float, start: float) -> np.ndarray:
    """Samples of the window about the highest crest of a wave.

    Args:
        time: Sample times (s), (t,).
        wave: Elevation (m), (t,).
        length: Length of the window (s), at most that of the record.
        start: Time from which on the window lies (s).

    Returns:
        Whether each sample is in the window, (t,).
    """
    later = time >= start
    crest = float(time[later][np.argmax(wave[later])])
    width = min(length, time[-1] - start)
    begin = min(max(crest - 0.5 * width, start), time[-1] - width)
    return (time >= begin) & (time <= begin + width)


def record_figure(
    time: np.ndarray, channels: Mapping[str, np.ndarray], start: float, title: str, colour: str = SIMULATED
) -> Figure:
    """All of the record, motions in a colour; the part before `start` (s), without statistics, is grey."""
    names = moving(channels)
    figure, axes = stack([PANEL_HEIGHT] * len(names))
    artists = {}
    for ax, name in zip(axes, names, strict=True):
        ax.plot(time, channels[name], color=WAVE if name == "wave" else colour, lw=0.35)
        ax.set_ylabel(f"{name.capitalize()} ({unit_of(name)})")
        if start > time[0]:
            artists["left out of statistics"] = ax.axvspan(time[0], start, color="#dfe2e7", lw=0, zorder=0.5)
    axes[-1].set_xlabel("Time (s)")
    header(figure, title, artists)
    return figure


def window_figure(
    time: np.ndarray, channels: Mapping[str, np.ndarray], first_order: np.ndarray | None, start: float, title: str
) -> Figure:
    """Figure of `WINDOW` (s) about the highest crest after `start` (s), with second-order waves."""
    names = moving(channels)
    window = about_highest_crest(time, channels["wave"], WINDOW, start)
    figure, axes = stack([PANEL_HEIGHT] * len(names))
    artists = {}
    for ax, name in zip(axes, names, strict=True):
        (line,) = ax.plot(time[window], channels[name][window], color=_colour(name), lw=0.9)
        ax.set_ylabel(f"{name.capitalize()} ({unit_of(name)})")
        if name == "wave" and first_order is not None:
            (second,) = ax.plot(time[window], (channels[name] - first_order)[window], color=MEASURED, lw=0.8)
            artists = {"wave": line, "its second order": second}
    axes[-1].set_xlabel("Time (s)")
    header(figure, f"{title}, about the highest crest", artists)
    return figure


def spectra_figure(
    time: np.ndarray,
    channels: Mapping[str, np.ndarray],
    peak_period: float | None,
    highest: float,
    target: Callable[[np.ndarray], np.ndarray] | None,
    title: str,
) -> Figure:
    """Figure of spectra up to `highest` (Hz), bands shaded; `target` (Hz to m²/Hz) as asked for."""
    names = moving(channels)
    figure, axes = stack([0.95] * len(names))
    artists: dict[str, Any] = {}
    for ax, name in zip(axes, names, strict=True):
        spectrum = power_spectrum(time, channels[name], min(SEGMENT, max(0.5 * (time[-1] - time[0]), MIN_SEGMENT)))
        artists |= shade_bands(ax, bands_of(name, peak_period))
        if name == "wave" and target is not None:
            f = spectrum.frequency[(spectrum.frequency > 0) & (spectrum.frequency <= highest)]
            (artists["spectrum asked for"],) = ax.plot(f, np.maximum(target(f), 1e-300), color=GREY, lw=0.9, ls=(0, (3, 1.2)))
        draw_densities(ax, name, [Density(name, spectrum.frequency, spectrum.density, _colour(name), 0.7)], highest)
    axes[-1].set_xlabel("Frequency (Hz)")
    order = ("low frequency", "wave frequency", "spectrum asked for")
    header(figure, title, {name: artists[name] for name in order if name in artists}, columns=2)
    return figure


def _colour(name: str) -> str:
    return WAVE if name == "wave" else SIMULATED
