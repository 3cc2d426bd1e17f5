"""Figures of decays: decrement and period against amplitude."""

from typing import Any, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from calibration.decay_analysis.linear_quadratic import classical
from calibration.result import Series, TestFit
from jaxhydro.dynamics.response import Cycles, decay_cycles
from jaxhydro.plots.style import BEFORE, MEASURED, SIMULATED, header, stack
from jaxhydro.units import for_people, unit_of

CLEAR_AMPLITUDE = 25  # times the noise: an amplitude from which decrement and period are well measured


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
        """Half cycles of a test's main channel."""
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
        """Quantity of the cycles that are clear of the noise, or of the largest ones where none is."""
        values, size = getattr(cycles, quantity), cycles.amplitude
        return values[(size >= min(self.clear, 0.3 * size.max(initial=0.0))) & np.isfinite(values)]


def _fitted_line(time: np.ndarray, series: Series) -> np.ndarray | None:
    """Line of linear and quadratic damping: two amplitudes, and the decrements per cycle there, (2, 2).

    The decrement is T p / 2 + 8/3 q a. The amplitudes a are the smallest and the largest. None with too few cycles.
    """
    try:
        analysis = classical(time, series.measured, series.noise)
    except ValueError:  # too few cycles
        return None
    ends = analysis.half_cycles.amplitude[[-1, 0]]
    decrement = 0.5 * analysis.fit.period * analysis.fit.linear.value + 8 / 3 * analysis.fit.quadratic.value * ends
    return np.stack([for_people(series.channel, ends), decrement])


def decay_figure(dof: str, tests: list[TestFit]) -> Figure | None:
    """Decrement and period against amplitude of all decays of one motion.

    It is None where no decay has a whole cycle. Cycles of small amplitude scatter by the noise. The axes fit cycles of
    `CLEAR_AMPLITUDE` times the noise and more. Cycles beyond the axes are triangles at the edge.
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
    """Draw the measured cycles, and triangles at the edge for those beyond the limits."""
    low, high = limits
    x, y = decay.measured.amplitude, getattr(decay.measured, quantity)
    face = "white" if decay.held else MEASURED
    properties: dict[str, Any] = {"ms": 3, "mfc": face, "mec": MEASURED, "mew": 0.7, "ls": "", "zorder": 4, "clip_on": False}
    for rows, marker in (((y >= low) & (y <= high), "o"), (y > high, "^"), (y < low, "v")):
        if rows.any():
            line = ax.plot(x[rows], np.clip(y[rows], low, high), marker=marker, **properties)[0]
            line.set_in_layout(False)
            if marker == "o":
                artists["held out" if decay.held else "measured"] = line


def _limits(decays: list[DecayCycles], quantity: str) -> tuple[float, float]:
    """Limits of an axis that hold the clear cycles.

    They hold all calibrated cycles and nine tenths of the measured ones. They hold cycles before calibration that are not far
    off. The limits of a period are at least 2 % apart.
    """
    measured, simulated, before = (
        np.concatenate([decay.well_seen(getattr(decay, source), quantity) for decay in decays])
        for source in ("measured", "simulated", "before")
    )
    core = np.concatenate([np.quantile(measured, [0.05, 0.95]) if len(measured) else measured, simulated])
    low, high = (float(core.min()), float(core.max())) if len(core) else (0.0, 1.0)
    near = before[(before > 0.9 * low) & (before < 1.1 * high)]
    low, high = float(near.min(initial=low)), float(near.max(initial=high))
    if quantity == "decrement":
        return min(0.0, 1.1 * low), max(1.15 * high, 1e-3)
    room = max(0.2 * (high - low), 0.01 * (low + high) - 0.5 * (high - low))
    return low - room, high + room
