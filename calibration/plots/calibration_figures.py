"""Figures of a calibration: tests, decay against amplitude, parameters."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatterSciNotation, MaxNLocator, NullFormatter

from calibration.formatting import number, readable_unit, signed_percent
from calibration.plots.decay_figures import decay_figure
from calibration.result import Calibration, Estimate, Series, TestFit
from jaxhydro.analysis.spectral import power_spectrum
from jaxhydro.environment import DOFS
from jaxhydro.files import safe_name
from jaxhydro.plots.spectrum_axes import Density, draw_densities, shade_bands
from jaxhydro.plots.style import BEFORE, GREY, MEASURED, SIMULATED, WIDTH, header, stack
from jaxhydro.units import for_people, unit_of

_USE = {"fit": "fitted", "holdout": "held out", "ignore": "ignored"}
MAX_FREQUENCY = 0.2  # Hz, that spectra are drawn to


def figures(calibration: Calibration) -> Iterator[tuple[str, str, Figure]]:
    """File name, caption and figure, one after the other. Call within `plots.style.style()`."""
    yield "parameters.png", _PARAMETERS, parameters_figure(list(calibration.parameters.values()))
    decays = [test for test in calibration.tests if test.kind == "decay"]
    for dof in DOFS:
        released = [test for test in decays if test.degree_of_freedom == dof]
        figure = decay_figure(dof, released) if released else None
        if figure is not None:
            yield f"decay-{dof}.png", _DECAY.format(dof=dof), figure
    for test in calibration.tests:
        if test.bands:
            yield f"spectra-{safe_name(test.id)}.png", _SPECTRA.format(id=test.id), spectra_figure(test)
            continue
        yield f"test-{safe_name(test.id)}.png", _TEST.format(id=test.id, channel=test.main.channel), test_figure(test)


_PARAMETERS = "Where every parameter started and where it ended, with two standard deviations."
_DECAY = (
    "Decays in {dof}: logarithmic decrement per cycle and period against amplitude; triangles lie beyond the edge. Dashed: "
    "linear and quadratic (P-Q) damping fitted to the record alone."
)
_TEST = (
    "Test {id}: measured and simulated {channel}; their difference over a grey band of two standard deviations of "
    "the noise; the other channels."
)


_SPECTRA = (
    "Test {id}: spectra of the motions, measured and simulated before and after calibration; bands shaded, with the error of "
    "the energy in each after calibration."
)


def spectra_figure(test: TestFit) -> Figure:
    """Densities of the motions that count in an irregular sea."""
    shown = [series for series in test.series if series.channel in test.bands]
    figure, axes = stack([1.15] * len(shown))
    artists: dict[str, Artist] = {}
    for ax, series in zip(axes, shown):
        channel, before = series.channel, test.start.get(series.channel)
        shade_bands(ax, {name: (band.low, band.high) for name, band in test.bands[channel].items()})
        for band in test.bands[channel].values():
            write_band_error(ax, band.low, band.high, band.after)
        densities = [
            motion_density("measured", test, channel, series.measured, MEASURED, 1.5),
            motion_density("calibrated", test, channel, series.simulated, SIMULATED, 0.9),
        ]
        if before is not None:
            densities.append(motion_density("before", test, channel, before, BEFORE, 0.9))
        artists |= draw_densities(ax, channel, densities, MAX_FREQUENCY)
    axes[-1].set_xlabel("Frequency (Hz)")
    header(figure, f"{test.id} ({_USE[test.use]})", artists)
    return figure


def motion_density(label: str, test: TestFit, channel: str, values: np.ndarray, colour: str, width: float) -> Density:
    """Spectral density of a motion of a test, to draw.

    Args:
        label: Name in the legend.
        test: The test.
        channel: The motion.
        values: Its record (m, rad), (t,).
        colour: Colour of the line.
        width: Width of the line (points).
    """
    spectrum = power_spectrum(test.time, for_people(channel, values))
    return Density(label, spectrum.frequency, spectrum.density, colour, width)


def write_band_error(ax: Axes, low: float, high: float, error: float) -> None:
    """Write the relative error of the energy in a band at the foot of the band."""
    if np.isfinite(error):
        where: dict[str, Any] = {"transform": ax.get_xaxis_transform(), "ha": "center", "va": "bottom", "fontsize": "small"}
        ax.text(0.5 * (low + high), 0.03, signed_percent(error), **where)


def test_figure(test: TestFit) -> Figure:
    """Main channel measured and simulated, its residual below, the other channels in small panels."""
    main = test.main
    others = [series for series in test.series if series is not main]
    figure, axes = stack([1.55, 0.7, *[0.68] * len(others)])
    time = test.time - test.time[0]
    artists = compare_motions(axes[0], time, main, test.start.get(main.channel))
    axes[0].set_ylabel(_axis(main.channel))
    for ax, series in zip(axes[2:], others):
        compare_motions(ax, time, series, test.start.get(series.channel), 0.5)
        ax.set_ylabel(_axis(series.channel, "\n"))
    residual = for_people(main.channel, main.measured - main.simulated)
    noise = 2 * float(for_people(main.channel, main.noise))
    axes[1].axhspan(-noise, noise, color="#d3d8df", lw=0, zorder=0.5)
    axes[1].plot(time, residual, color=SIMULATED, lw=0.6)
    axes[1].set_ylabel(f"Residual\n({unit_of(main.channel)})")
    axes[-1].set_xlabel("Time (s)")
    rmse = number(float(for_people(main.channel, main.rmse)), 2)
    header(figure, f"{test.id} ({_USE[test.use]}): RMSE {rmse} {unit_of(main.channel)}", artists)
    return figure


def _axis(channel: str, between: str = " ") -> str:
    return f"{channel.capitalize()}{between}({unit_of(channel)})"


def compare_motions(
    ax: Axes, time: np.ndarray, series: Series, before: np.ndarray | None, width: float = 1.0
) -> dict[str, Artist]:
    """Draw a motion (m, deg) over time (s): measured, calibrated and before calibration.

    Args:
        ax: Axes.
        time: Times (s), (t,).
        series: Measured and calibrated motion (m, rad).
        before: Motion before calibration (m, rad), (t,); None where there is none.
        width: Factor of the line widths.

    Returns:
        The lines by name.
    """
    name = series.channel
    rows = [("measured", series.measured, MEASURED, 1.5, 3.0), ("calibrated", series.simulated, SIMULATED, 0.8, 4.0)]
    if before is not None:
        rows.append(("before", before, BEFORE, 0.8, 2.0))
    return {
        label: ax.plot(time, for_people(name, values), color=colour, lw=width * size, zorder=order)[0]
        for label, values, colour, size, order in rows
    }


def parameters_figure(parameters: list[Estimate]) -> Figure:
    """Start and calibrated value of every parameter, one axis for each unit.

    Markers are hollow where the records do not determine the parameter.
    """
    groups = {unit: [p for p in parameters if p.unit == unit] for unit in dict.fromkeys(p.unit for p in parameters)}
    heights = [0.2 * len(group) + 0.12 for group in groups.values()]
    figure = Figure(figsize=(WIDTH, sum(heights) + 0.45 * len(groups) + 0.55), layout="constrained")
    axes = figure.subplots(max(1, len(groups)), 1, squeeze=False, gridspec_kw={"height_ratios": heights or [1]})[:, 0]
    artists: dict[str, Artist] = {}
    for ax, (unit, group) in zip(axes, groups.items()):
        power = _scale(ax, unit, group)
        for row, estimate in enumerate(group):
            artists |= _parameter(ax, row, estimate, power)
        ax.set_ylim(len(group) - 0.4, -0.6)
        ax.set_yticks(range(len(group)), [estimate.label for estimate in group])
        ax.tick_params(axis="y", length=0)
        ax.grid(visible=False, axis="y")
    header(figure, "Parameters", artists, 2)
    return figure


def _scale(ax: Axes, unit: str, group: list[Estimate]) -> float:
    """Choose a linear or a logarithmic axis, and return the divisor of the values."""
    shown = readable_unit(unit)
    sizes = np.array([v for estimate in group for v in (estimate.start, estimate.value)])
    largest = float(np.abs(sizes).max(initial=0.0))
    sure = all(estimate.value > 2 * (estimate.standard_deviation or 0.0) for estimate in group)
    if sure and (sizes > 0).all() and largest / sizes.min() > 60:
        ax.set_xscale("log")
        ax.xaxis.set_minor_formatter(NullFormatter())
        ax.xaxis.set_major_formatter(LogFormatterSciNotation())
        ax.set_xlabel(f"Value ({shown})" if shown else "Value")
        return 1.0
    exponent = int(np.floor(np.log10(largest) / 3) * 3) if largest > 0 else 0
    exponent = exponent if abs(exponent) >= 3 else 0
    ax.xaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 2.5, 5, 10]))
    size = " ".join(filter(None, (f"$10^{{{exponent}}}$" if exponent else "", shown)))
    ax.set_xlabel(f"Value ({size})" if size else "Value")
    return 10.0**exponent


def _parameter(ax: Axes, row: int, estimate: Estimate, power: float) -> dict[str, Artist]:
    start, value, sd = estimate.start / power, estimate.value / power, estimate.standard_deviation
    colour = SIMULATED if estimate.identifiable else GREY
    label = "at its bound" if estimate.at_bound else "calibrated, ± 2 sd" if estimate.identifiable else "not determined"
    ax.plot([start, value], [row, row], color=BEFORE, lw=1.0, zorder=2)
    bar = ax.plot(start, row, "|", ms=8, color=BEFORE, mew=1.4, zorder=3)[0]
    if estimate.identifiable and sd is not None and np.isfinite(sd):
        ax.errorbar(value, row, xerr=2 * sd / power, color=colour, elinewidth=1.0, capsize=2, zorder=3)
    face = colour if estimate.identifiable else "white"
    dot = ax.plot(value, row, "D" if estimate.at_bound else "o", ms=4, mfc=face, mec=colour, mew=0.8, ls="", zorder=4)[0]
    return {"start": bar, label: dot}
