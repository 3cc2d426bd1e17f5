"""Figures of the study: elevation, motions' spectra, band integrals."""

from pathlib import Path
from typing import Any

import numpy as np

Found = dict[str, list[dict[str, Any]]]
COLOURS = {"1": "#8fb4d9", "2": "#2f7f86", "3": "#d1495b", "4": "#30343b"}
NAMES = {"1": "1 first order", "2": "2 second order", "3": "3 and stretching, MacCamy-Fuchs", "4": "4 and pontoon elements"}
UNIT = {"surge": "m", "heave": "m", "pitch": "deg"}


def label_of(height: float, period: float) -> str:
    return f"Hs {height:g} m, Tp {period:g} s"


def mean_of(results: list[dict[str, Any]], key: str) -> np.ndarray:
    """Mean over the seeds."""
    return np.mean([result[key] for result in results], axis=0)


def elevation(results_by_sea: Found, seas: dict[str, tuple[float, float]], cutoff: float, path: Path) -> Path:
    """Spectra of the elevation at the origin, of first order and with second, mean over the seeds."""
    from matplotlib.figure import Figure

    from jaxhydro.plots.style import BEFORE, GREY, MEASURED, WIDTH, header, save, style

    with style():
        figure = Figure(figsize=(2 * WIDTH, 2.6), layout="constrained")
        lines = {}
        for ax, (sea, results) in zip(figure.subplots(1, 2), results_by_sea.items(), strict=True):
            frequency = np.array(results[0]["elevation frequency"])
            for case, words, colour, width in (("2", "second order", MEASURED, 1.0), ("1", "first order", BEFORE, 1.6)):
                mean = mean_of(results, f"elevation {case}")
                lines[words] = ax.semilogy(frequency[2:], mean[2:], color=colour, lw=width)[0]
            ax.axvline(cutoff, color=GREY, lw=0.6, ls="--")
            ax.text(cutoff + 0.006, 0.97, "cut-off", color=GREY, va="top", transform=ax.get_xaxis_transform())
            peak = float(mean_of(results, "elevation 2").max())
            ax.set(xlim=(0, 0.6), ylim=(1e-7 * peak, 3 * peak), xlabel="Frequency (Hz)", title=label_of(*seas[sea]))
        figure.axes[0].set_ylabel("Elevation (m²/Hz)")
        header(figure, f"Elevation, mean of {len(results)} seeds", lines)
        save(figure, path)
    return path


def densities(results_by_sea: Found, seas: dict[str, tuple[float, float]], path: Path) -> Path:
    """Spectra of the motions by case, mean over the seeds, the bands shaded."""
    from matplotlib.figure import Figure

    from jaxhydro.analysis.motion_bands import bands
    from jaxhydro.plots.style import WIDTH, header, save, style

    with style():
        figure = Figure(figsize=(2 * WIDTH, 5.6), layout="constrained")
        axes, lines = figure.subplots(3, 2, sharex=True), {}
        for column, (sea, results) in enumerate(results_by_sea.items()):
            frequency = np.array(results[0]["frequency"])
            shown = (frequency > 0.002) & (frequency < 0.2)
            for ax, dof in zip(axes[:, column], UNIT, strict=True):
                for band in bands(dof, seas[sea][1]).values():
                    ax.axvspan(*band, color="#eef0f3", lw=0, zorder=0)
                highest, lowest = 0.0, np.inf
                for case, name in NAMES.items():
                    mean = np.mean([result["spectra"][f"{dof} {case}"] for result in results], axis=0)[shown]
                    highest, lowest = max(highest, mean.max()), min(lowest, mean[frequency[shown] < 0.15].min())
                    style_of = {"lw": 1.0 if case != "4" else 0.8, "ls": "-" if case != "4" else "--"}
                    lines[name] = ax.semilogy(frequency[shown], mean, color=COLOURS[case], **style_of)[0]
                ax.set_ylim(max(0.5 * lowest, 1e-5 * highest), 2 * highest)
                ax.set_xlim(0, 0.2)
                ax.set_xticks([0, 0.05, 0.1, 0.15, 0.2])
                if column == 0:
                    ax.set_ylabel(f"{dof.capitalize()} ({UNIT[dof]}²/Hz)")
            axes[0, column].set_title(label_of(*seas[sea]))
            axes[-1, column].set_xlabel("Frequency (Hz)")
        header(figure, f"Motions, mean of {len(results)} seeds; bands shaded", lines, 2)
        save(figure, path)
    return path


def bars(results_by_sea: Found, seas: dict[str, tuple[float, float]], path: Path) -> Path:
    """Band integrals by case: mean over the seeds, their range as a line."""
    from matplotlib.figure import Figure

    from jaxhydro.plots.style import MEASURED, WIDTH, header, save, style

    columns = [(dof, band) for dof in UNIT for band in ("low", "wave")]
    with style():
        figure = Figure(figsize=(2 * WIDTH, 3.9), layout="constrained")
        axes, artists = figure.subplots(2, 6), {}
        for row, (sea, results) in enumerate(results_by_sea.items()):
            for i, (dof, band) in enumerate(columns):
                ax = axes[row, i]
                for position, (case, name) in enumerate(NAMES.items()):
                    values = np.array([result["integrals"][case][i] for result in results])
                    artists[name] = ax.bar(position, values.mean(), color=COLOURS[case], width=0.75)
                    ax.plot([position, position], [values.min(), values.max()], color="#f0b429", lw=1.4, zorder=3)
                ax.set_xticks(range(4), list(NAMES))
                ax.grid(visible=False, axis="x")
                ax.tick_params(axis="y", labelsize=7)
                ax.ticklabel_format(axis="y", style="sci", scilimits=(-2, 3))
                ax.yaxis.get_offset_text().set_fontsize(7)
                unit = f"{UNIT[dof]}²"
                if row == 0:
                    ax.text(0, 1.16, f"{dof}, {band}\n({unit})", transform=ax.transAxes, color=MEASURED, fontsize=7.5)
            axes[row, 0].set_ylabel(label_of(*seas[sea]))
        header(figure, f"Integrals over the low- and wave-frequency bands; yellow: range of {len(results)} seeds", artists, 4)
        save(figure, path)
    return path
