"""Axes of spectra: densities on a logarithmic axis over frequency, with shaded bands."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes

from jaxhydro.units import unit_of

DECADES = 4.5  # of a spectrum that are shown, under its largest value
BAND_COLOURS = {"low_frequency": "#ece3cf", "wave_frequency": "#dbe9ee"}


class Density(NamedTuple):
    """Spectral density to draw.

    Attributes:
        label: Name in the legend.
        frequency: Frequencies (Hz), (f,).
        density: Spectral density (unit²/Hz), (f,).
        colour: Colour of the line.
        width: Width of the line (points).
    """

    label: str
    frequency: np.ndarray
    density: np.ndarray
    colour: str
    width: float


def shade_bands(ax: Axes, bands: Mapping[str, tuple[float, float]]) -> dict[str, Artist]:
    """Shade frequency bands.

    Args:
        ax: Axes over frequency (Hz).
        bands: Limits (Hz) of `low_frequency` and `wave_frequency`, or of one of them.

    Returns:
        The shades, by name of the band in a legend.
    """
    return {
        name.replace("_", " "): ax.axvspan(low, high, color=BAND_COLOURS[name], lw=0, zorder=0.5)
        for name, (low, high) in bands.items()
    }


def draw_densities(ax: Axes, channel: str, densities: Iterable[Density], highest: float) -> dict[str, Artist]:
    """Draw the spectral densities of a channel above 0 Hz, and set the axes up.

    Args:
        ax: Empty axes.
        channel: "wave" or a degree of freedom.
        densities: The densities, the lowest layer first.
        highest: Highest frequency that is shown (Hz).

    Returns:
        The lines by label.
    """
    artists: dict[str, Artist] = {}
    top = 0.0
    for curve in densities:
        shown = (curve.frequency > 0) & (curve.frequency <= highest)
        artists[curve.label] = ax.plot(curve.frequency[shown], curve.density[shown], color=curve.colour, lw=curve.width)[0]
        top = max(top, float(curve.density[shown].max()))
    if top > 0:
        least, most = top * 10**-DECADES, top * 2.5
        ax.set_yscale("log")
        ax.set_ylim(least, most)
        ax.set_yticks([10.0**n for n in range(-15, 12) if least <= 10.0**n <= most][::2])
        ax.minorticks_off()
    ax.set_xlim(0, highest)
    ax.set_ylabel(f"{channel.capitalize()}\n({unit_of(channel)}²/Hz)")
    return artists
