"""Figures of a calibration: tests, decay against amplitude, parameters."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatterSciNotation, MaxNLocator, NullFormatter

from calibration.decay_analysis.linear_quadratic import classical
from calibration.formatting import number, readable_unit, signed_percent
from calibration.result import Calibration, Estimate, Series, TestFit
from jaxhydro.analysis.spectral import power_spectrum
from jaxhydro.dynamics.response import Cycles, decay_cycles
from jaxhydro.environment import DOFS
from jaxhydro.files import safe_name
from jaxhydro.plots.spectrum_axes import Density, draw_densities, shade_bands
from jaxhydro.plots.style import BEFORE, GREY, MEASURED, SIMULATED, WIDTH, header, stack
from jaxhydro.units import for_people, unit_of

_USE = {"fit": "fitted", "holdout": "held out", "ignore": "ignored"}
MAX_FREQUENCY = 0.2  # Hz, that spectra are drawn to
CLEAR_AMPLITUDE = 25  # times the noise: an amplitude from which decrement and period are well measured


def figures(calibration: Calibration) -> Iterator[tuple[str, str, Figure]]:
    """File name, caption and figure, one after the other. Call within `plots.style.style()`."""
    yield "parameters.png", _PARAMETERS, parameters_figure(list(calibration.parameters.values()))
    decays = [test for test in calibration.tests if test.kind == "decay"]
    for dof in DOFS:
        mine = [test for test in decays if test.degree_of_freedom == dof]
        figure = decay_figure(dof, mine) if mine else None
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
    """Measured against simulated of the main channel, the residual below it, the other channels in small panels."""
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
    """Draw a motion (m, deg) over time (s): measured, calibrated and, if there is one, before; gives the lines by name."""
    name = series.channel
    rows = [("measured", series.measured, MEASURED, 1.5, 3.0), ("calibrated", series.simulated, SIMULATED, 0.8, 4.0)]
    if before is not None:
        rows.append(("before", before, BEFORE, 0.8, 2.0))
    return {
        label: ax.plot(time, for_people(name, values), color=colour, lw=width * size, zorder=order)[0]
        for label, values, colour, size, order in rows
    }


class DecayCycles(NamedTuple):
    """Half cycles of one test, amplitudes in m or deg.

    Attributes:
        measured, simulated, before: Half cycles of the record, of the calibrated model, of the model before.
        fit: (2, 2) amplitudes and decrements at the ends of the line of linear and quadratic (P-Q) damping; None without one.
        clear: Amplitude that is well above the noise.
        held: Whether the test is held out.
    """

    measured: Cycles
    simulated: Cycles
    before: Cycles
    fit: np.ndarray | None
    clear: float
    held: bool

    @classmethod
    def of(cls, test: TestFit) -> "DecayCycles":
        """From a test's main channel."""
        main = test.main

        def cycles(values: np.ndarray | None) -> Cycles:
            if values is None or not np.isfinite(values).all():
                return Cycles(*[np.zeros(0)] * 4)
            half_cycles = decay_cycles(test.time, values, main.noise)
            return half_cycles._replace(amplitude=for_people(main.channel, half_cycles.amplitude))

        return cls(
            cycles(main.measured),
            cycles(main.simulated),
            cycles(test.start.get(main.channel)),
            _fitted_line(test.time, main),
            CLEAR_AMPLITUDE * float(for_people(main.channel, main.noise)),
            test.use != "fit",
        )

    def well_seen(self, cycles: Cycles, quantity: str) -> np.ndarray:
        """A quantity of the cycles that are clear of the noise; of the largest ones where none is."""
        values, size = getattr(cycles, quantity), cycles.amplitude
        return values[(size >= min(self.clear, 0.3 * size.max(initial=0.0))) & np.isfinite(values)]


def _fitted_line(time: np.ndarray, series: Series) -> np.ndarray | None:
    """Decrement per cycle of linear and quadratic damping, T p / 2 + 8/3 q a, at the smallest and largest amplitude a."""
    try:
        analysis = classical(time, series.measured, series.noise)
    except ValueError:  # too few cycles
        return None
    ends = analysis.half_cycles.amplitude[[-1, 0]]
    decrement = 0.5 * analysis.fit.period * analysis.fit.linear.value + 8 / 3 * analysis.fit.quadratic.value * ends
    return np.stack([for_people(series.channel, ends), decrement])


def decay_figure(dof: str, tests: list[TestFit]) -> Figure | None:
    """Decrement and period against amplitude of all decays of one motion; None where none has a whole cycle.

    Cycles of small amplitude scatter by the noise. The axes are for those of `CLEAR_AMPLITUDE` times the noise and more.
    Cycles beyond the axes are triangles at the edge.
    """
    decays = [DecayCycles.of(test) for test in tests]
    amplitudes = np.concatenate([decay.measured.amplitude for decay in decays])
    if not len(amplitudes):
        return None
    figure, axes = stack([1.25, 1.25])
    artists: dict[str, Artist] = {}
    for ax, quantity in zip(axes, ("decrement", "period")):
        low, high = _limits(decays, quantity)
        for decay in decays:
            _dots(ax, artists, decay, quantity, (low, high))
            for cycles, colour, label in ((decay.simulated, SIMULATED, "calibrated"), (decay.before, BEFORE, "before")):
                order = np.argsort(cycles.amplitude)
                artists[label] = ax.plot(cycles.amplitude[order], getattr(cycles, quantity)[order], color=colour)[0]
            if quantity == "decrement" and decay.fit is not None:
                artists["P-Q fit"] = ax.plot(*decay.fit, color=MEASURED, lw=0.7, ls=(0, (5, 3)))[0]
        ax.set_ylim(low, high)
    if amplitudes.min() < 0.4 * amplitudes.max():
        axes[0].set_xlim(0.0, 1.08 * amplitudes.max())
    axes[0].set_ylabel("Decrement\nper cycle (-)")
    axes[1].set_ylabel("Period (s)")
    axes[1].set_xlabel(f"Amplitude of {dof} ({unit_of(dof)})")
    names = [name for name in ("measured", "held out", "P-Q fit", "calibrated", "before") if name in artists]
    header(figure, f"Decays in {dof}", {name: artists[name] for name in names})
    return figure


def _dots(ax: Axes, artists: dict[str, Artist], decay: DecayCycles, quantity: str, limits: tuple[float, float]) -> None:
    """Measured cycles; those beyond the limits as triangles at the edge."""
    low, high = limits
    x, y = decay.measured.amplitude, getattr(decay.measured, quantity)
    face = "white" if decay.held else MEASURED
    look: dict[str, Any] = {"ms": 3, "mfc": face, "mec": MEASURED, "mew": 0.7, "ls": "", "zorder": 4, "clip_on": False}
    for rows, marker in (((y >= low) & (y <= high), "o"), (y > high, "^"), (y < low, "v")):
        if rows.any():
            line = ax.plot(x[rows], np.clip(y[rows], low, high), marker=marker, **look)[0]
            line.set_in_layout(False)
            if marker == "o":
                artists["held out" if decay.held else "measured"] = line


def _limits(decays: list[DecayCycles], quantity: str) -> tuple[float, float]:
    """Limits that hold the clear cycles: all calibrated ones, nine tenths of the measured ones, those before
    calibration where they are not far off. Those of a period are at least 2 % apart."""
    measured, simulated, before = (
        np.concatenate([decay.well_seen(getattr(decay, which), quantity) for decay in decays])
        for which in ("measured", "simulated", "before")
    )
    core = np.concatenate([np.quantile(measured, [0.05, 0.95]) if len(measured) else measured, simulated])
    low, high = (float(core.min()), float(core.max())) if len(core) else (0.0, 1.0)
    near = before[(before > 0.9 * low) & (before < 1.1 * high)]
    low, high = float(near.min(initial=low)), float(near.max(initial=high))
    if quantity == "decrement":
        return min(0.0, 1.1 * low), max(1.15 * high, 1e-3)
    room = max(0.2 * (high - low), 0.01 * (low + high) - 0.5 * (high - low))
    return low - room, high + room


def parameters_figure(parameters: list[Estimate]) -> Figure:
    """Start and calibrated value of every parameter, one axis per unit; hollow where the records do not tell."""
    groups = {unit: [p for p in parameters if p.unit == unit] for unit in dict.fromkeys(p.unit for p in parameters)}
    heights = [0.2 * len(group) + 0.12 for group in groups.values()]
    figure = Figure(figsize=(WIDTH, sum(heights) + 0.45 * len(groups) + 0.55), layout="constrained")
    axes = figure.subplots(max(1, len(groups)), 1, squeeze=False, gridspec_kw={"height_ratios": heights or [1]})[:, 0]
    artists: dict[str, Artist] = {}
    for ax, (unit, group) in zip(axes, groups.items()):
        power = _scale(ax, unit, group)
        for row, one in enumerate(group):
            artists |= _parameter(ax, row, one, power)
        ax.set_ylim(len(group) - 0.4, -0.6)
        ax.set_yticks(range(len(group)), [one.label for one in group])
        ax.tick_params(axis="y", length=0)
        ax.grid(visible=False, axis="y")
    header(figure, "Parameters", artists, 2)
    return figure


def _scale(ax: Axes, unit: str, group: list[Estimate]) -> float:
    """Choose a linear or a logarithmic axis; gives what values are divided by."""
    shown = readable_unit(unit)
    sizes = np.array([v for one in group for v in (one.start, one.value)])
    largest = float(np.abs(sizes).max(initial=0.0))
    sure = all(one.value > 2 * (one.standard_deviation or 0.0) for one in group)
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


def _parameter(ax: Axes, row: int, one: Estimate, power: float) -> dict[str, Artist]:
    start, value, sd = one.start / power, one.value / power, one.standard_deviation
    colour = SIMULATED if one.identifiable else GREY
    label = "at its bound" if one.at_bound else "calibrated, ± 2 sd" if one.identifiable else "not determined"
    ax.plot([start, value], [row, row], color=BEFORE, lw=1.0, zorder=2)
    bar = ax.plot(start, row, "|", ms=8, color=BEFORE, mew=1.4, zorder=3)[0]
    if one.identifiable and sd is not None and np.isfinite(sd):
        ax.errorbar(value, row, xerr=2 * sd / power, color=colour, elinewidth=1.0, capsize=2, zorder=3)
    face = colour if one.identifiable else "white"
    dot = ax.plot(value, row, "D" if one.at_bound else "o", ms=4, mfc=face, mec=colour, mew=0.8, ls="", zorder=4)[0]
    return {"start": bar, label: dot}
