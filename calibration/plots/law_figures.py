"""Figures of coefficients against the sea state."""

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure

from calibration.fitting.law_choice import LawFit, SeaLaws
from calibration.formatting import readable_unit
from calibration.vocabulary import LAW_NAMES
from jaxhydro.plots.style import BEFORE, GREY, MEASURED, SIMULATED, WAVE, header, stack
from jaxhydro.waves.sea_state import SeaState

COLOURS = (BEFORE, SIMULATED, WAVE, GREY)


def coefficient_figure(sea_laws: SeaLaws, label: str) -> Figure:
    """A coefficient against significant height: of each sea alone, by the constants, by the chosen law.

    Bars and the band are one standard deviation. The period changes with the height as in the tests, by a line through the
    logarithms of both. Call within `plots.style.style()`.
    """
    figure, (ax,) = stack([1.9])
    seas = sorted(sea_laws.seas, key=lambda sea: sea.state.significant_height)
    heights = np.array([sea.state.significant_height for sea in seas])
    artists: dict[str, Artist] = {}
    for sea in seas:
        estimate = sea.calibration.parameters[label]
        relative = estimate.standard_deviation / estimate.value if estimate.standard_deviation is not None else np.nan
        bars = np.array([[estimate.value * (1 - np.exp(-relative))], [estimate.value * (np.exp(relative) - 1)]])
        name = "one sea alone" if sea.use == "fit" else "one sea alone, held out"
        face = MEASURED if sea.use == "fit" else "white"
        artists[name] = ax.errorbar(
            sea.state.significant_height,
            estimate.value,
            yerr=None if np.isnan(relative) else bars,
            fmt="o",
            color=MEASURED,
            mfc=face,
            ms=4,
            lw=0.9,
            capsize=2,
            zorder=4,
        )[0]
    grid = np.geomspace(0.85 * heights.min(), 1.15 * heights.max(), 60)
    shown = [sea_laws.laws[0]] + ([sea_laws.chosen] if sea_laws.chosen is not sea_laws.laws[0] else [])
    for law, colour in zip(shown, COLOURS):
        value, deviation = np.array([law.coefficient(label, state) for state in _states(sea_laws, grid)]).T
        ax.fill_between(grid, value * np.exp(-deviation), value * np.exp(deviation), color=colour, alpha=0.22, lw=0)
        artists[_name(law, sea_laws)] = ax.plot(grid, value, color=colour, lw=1.4)[0]
    ax.set_yscale("log")
    ax.set_xlabel("Significant height (m)")
    unit = readable_unit(seas[0].calibration.parameters[label].unit)
    ax.set_ylabel(f"{label} ({unit})" if unit else label)
    header(figure, f"{label} and the sea state", artists, 2)
    return figure


def _name(law: LawFit, sea_laws: SeaLaws) -> str:
    return f"{LAW_NAMES[law.name]}{', chosen' if law is sea_laws.chosen else ''}"


def _states(sea_laws: SeaLaws, heights: np.ndarray) -> list[SeaState]:
    height, period = np.log([sea.state for sea in sea_laws.seas]).T
    slope, intercept = np.polyfit(height, period, 1) if np.ptp(height) > 0 else (0.0, period.mean())
    return [SeaState(float(h), float(np.exp(intercept + slope * np.log(h)))) for h in heights]
