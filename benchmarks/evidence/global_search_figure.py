"""The figure of the global searches: J against simulations and against CPU time."""

from pathlib import Path
from typing import Any

import numpy as np

COLOURS = {"multistart": "#d1495b", "cma-es": "#2f7f86", "de": "#4f6db0", "ga": "#8a9099"}


def steps(runs: list[dict[str, Any]], column: int, at: np.ndarray) -> np.ndarray:
    """The least J so far (run, at); nan before a run's first."""
    least = np.full((len(runs), len(at)), np.nan)
    for row, search in zip(least, runs, strict=True):
        step = np.searchsorted(np.array(search["history"][column]), at, side="right") - 1
        row[step >= 0] = np.array(search["history"][2])[step[step >= 0]]
    return least


def draw(results: dict[str, list[dict[str, Any]]], names: dict[str, str], best: float, path: Path) -> Path:
    """Medians over the seeds, and their range, from where every seed has a J to where the last one ends."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    from jaxhydro.plots.style import MEASURED, WIDTH, header, save, style

    with style():
        figure, artists = Figure(figsize=(2 * WIDTH, 3.3), layout="constrained"), {}
        axes = figure.subplots(1, 2, sharey=True)
        for column, (ax, label) in enumerate(zip(axes, ("Simulations of a record", "CPU time (s)"), strict=True)):
            for method, runs in results.items():
                first = max(search["history"][column][0] for search in runs)
                last = max(search["history"][column][-1] for search in runs)
                at = np.geomspace(max(first, 1e-2), last, 400)
                j = steps(runs, column, at)
                shown = np.isfinite(j).all(axis=0)
                low, middle, high = (f(j[:, shown], axis=0) for f in (np.min, np.median, np.max))
                ax.fill_between(at[shown], low, high, color=COLOURS[method], alpha=0.16, lw=0)
                artists[names[method]] = ax.plot(at[shown], middle, color=COLOURS[method], lw=1.4)[0]
                ax.plot(at[shown][-1:], middle[-1:], "o", ms=3, color=COLOURS[method])
            ax.axhline(best, color=MEASURED, lw=0.7, ls=(0, (4, 3)), zorder=1)
            ax.set_xscale("log")
            ax.set_yscale("log")
            ax.set_xlabel(label)
            for axis, subs in ((ax.xaxis, (1.0,)), (ax.yaxis, (1.0, 2.0, 5.0))):
                axis.set_major_locator(LogLocator(subs=subs))
                axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
                axis.set_minor_formatter(NullFormatter())
            ax.set_ylim(0.75 * best, None)
        axes[0].set_ylabel("J, the least so far")
        axes[0].annotate(
            "least J of all",
            (0.01, best),
            (2, 2),
            xycoords=("axes fraction", "data"),
            textcoords="offset points",
            va="bottom",
            fontsize=7,
            color=MEASURED,
        )
        seeds = max(len(runs) for runs in results.values())
        header(figure, f"Three decays, eleven coefficients: medians and ranges of {seeds} seeds", artists, 5)
        save(figure, path)
    return path
