"""Figures of tests in waves: spectra with bands, motion per metre of wave, excerpt of the record."""

from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure

from calibration.campaign.signals import wave_height
from calibration.formatting import number
from calibration.plots.calibration_figures import write_band_error
from calibration.residuals.measured_seas import SeaTest
from calibration.residuals.sea_errors import channels, density, in_bands, moving
from jaxhydro.analysis.sea_statistics import bands_of
from jaxhydro.analysis.transfer_functions import transfer_function
from jaxhydro.files import safe_name
from jaxhydro.plots.seas import about_highest_crest
from jaxhydro.plots.spectrum_axes import Density, draw_densities, shade_bands
from jaxhydro.plots.style import MEASURED, SIMULATED, header, stack
from jaxhydro.units import unit_of

MAX_FREQUENCY = 0.2  # Hz, that spectra are drawn to; of waves shorter than 10 s 2.5 times their peak
MIN_WAVE_DENSITY = 0.02  # of the waves' largest density, where motions per metre of wave are drawn
EXCERPT_LENGTH = 400.0  # s about the highest crest


def figures(tests: Sequence[SeaTest]) -> Iterator[tuple[str, str, Figure]]:
    """File name, caption and figure, one after the other. Call within `plots.style.style()`."""
    for test in tests:
        name = safe_name(test.fit.id)
        caption = f"Test {test.fit.id}: spectra, measured and simulated; bands shaded, with the error of the energy in each."
        yield f"spectra-{name}.png", caption, spectra_figure(test)
        if (figure := response_figure(test)) is not None:
            caption = (
                f"Test {test.fit.id}: motion per metre of wave (RAO), and the share of the motion that is linear in the waves "
                "(coherence)."
            )
            yield f"rao-{name}.png", caption, figure
        caption = f"Test {test.fit.id}: {EXCERPT_LENGTH:g} s about the highest crest, measured and simulated."
        yield f"excerpt-{name}.png", caption, excerpt_figure(test)


def _title(test: SeaTest) -> str:
    if test.fit.kind == "regular":
        return f"{test.fit.id}: regular, {number(test.peak_period, 3)} s"
    height = f"Hs {number(wave_height(test.wave, irregular=True), 2)} m"
    return f"{test.fit.id}: {height}, Tp {number(test.peak_period, 3)} s"


def spectra_figure(test: SeaTest, names: Sequence[str] | None = None, title: str | None = None) -> Figure:
    """Spectral densities of the wave and of the moving channels."""
    both, highest = channels(test), max(MAX_FREQUENCY, 2.5 / test.peak_period)
    shown = ["wave", *moving(test)] if names is None else list(names)
    figure, axes = stack([0.95] * len(shown))
    artists: dict[str, Artist] = {}
    errors = in_bands(test) if test.fit.kind == "irregular" else {}
    for ax, name in zip(axes, shown):
        bands = bands_of(name, test.peak_period) if test.fit.kind == "irregular" else {}
        artists |= shade_bands(ax, bands)
        for band, limits in bands.items():
            write_band_error(ax, *limits, errors[name][band].error)
        measured, simulated = (density(test, x) for x in both[name])
        densities = [
            Density("measured", measured.frequency, measured.density, MEASURED, 1.4),
            Density("simulated", simulated.frequency, simulated.density, SIMULATED, 0.8),
        ]
        artists |= draw_densities(ax, name, densities, highest)
    axes[-1].set_xlabel("Frequency (Hz)")
    order = ["measured", "simulated", "low frequency", "wave frequency"]
    header(figure, title or _title(test), {label: artists[label] for label in order if label in artists}, 2)
    return figure


def response_figure(test: SeaTest) -> Figure | None:
    """Response amplitude operators of the moving channels, and coherence, where the waves have energy.

    None for regular waves and for a record that is too short.
    """
    both, shown = channels(test), moving(test)
    if test.fit.kind != "irregular" or not shown:
        return None
    try:
        transfers = {
            name: [transfer_function(test.fit.time, wave, x) for wave, x in zip(both["wave"], both[name])] for name in shown
        }
    except ValueError:  # fewer than two segments
        return None
    energy = np.interp(transfers[shown[0]][0].frequency, *density(test, test.wave)[:2])
    gap = np.where(energy > MIN_WAVE_DENSITY * energy.max(), 0.0, np.nan)
    figure, axes = stack([0.8, 0.4] * len(shown))
    artists: dict[str, Artist] = {}
    for i, name in enumerate(shown):
        for label, transfer, colour, width in zip(
            ("measured", "simulated"), transfers[name], (MEASURED, SIMULATED), (1.4, 0.8)
        ):
            artists[label] = axes[2 * i].plot(transfer.frequency, transfer.amplitude + gap, color=colour, lw=width)[0]
            axes[2 * i + 1].plot(transfer.frequency, transfer.coherence + gap, color=colour, lw=width)
        axes[2 * i].set_ylim(bottom=0)
        axes[2 * i].set_ylabel(f"{name.capitalize()}\n({unit_of(name)}/m)")
        axes[2 * i + 1].set_ylim(0, 1.05)
        axes[2 * i + 1].set_ylabel("Coh. (-)")
    axes[-1].set_xlabel("Frequency (Hz)")
    header(figure, _title(test), artists)
    return figure


def excerpt_figure(test: SeaTest) -> Figure:
    """Part of the record, about the wave's highest crest."""
    both, time = channels(test), test.fit.time
    excerpt = about_highest_crest(time, test.wave, EXCERPT_LENGTH, float(time[0]))
    shown = ["wave", *moving(test)]
    figure, axes = stack([0.8] * len(shown))
    artists: dict[str, Artist] = {}
    for ax, name in zip(axes, shown):
        for label, x, colour, line in zip(("measured", "simulated"), both[name], (MEASURED, SIMULATED), (1.4, 0.8)):
            artists[label] = ax.plot(time[excerpt], x[excerpt], color=colour, lw=line)[0]
        ax.set_ylabel(f"{name.capitalize()} ({unit_of(name)})")
    axes[-1].set_xlabel("Time (s)")
    header(figure, _title(test), artists)
    return figure
