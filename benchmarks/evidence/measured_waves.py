"""Section: measured waves, FOCAL campaign 2 under its own wave record before anything is fitted to it."""

from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.evidence import focal_potential_flow
from benchmarks.evidence import measured_waves_runs as runs
from benchmarks.evidence.common import Section, cached, fingerprint, parallel, require, say
from benchmarks.evidence.focal_potential_flow import FOLDER
from benchmarks.evidence.measured_waves_text import SETS, off, shortcomings, words

TITLE = "Measured waves: the model as it is, before the loop is closed"


def key() -> str:
    """Key of the section's results."""
    modules = (Path(runs.__file__), Path(focal_potential_flow.__file__))
    return fingerprint(FOLDER / "focal-c2", FOLDER / "focal-c4", *modules)


def run(figures: Path, processes: int = 2) -> Section:
    """All cases, and a figure of spectra."""
    require(FOLDER / "focal-c2", "the measured records (../shared/measured) are not on this machine")
    sources = key()
    coefficients = cached(runs.NAME, sources, "coefficients", runs.fitted)
    results: dict[str, dict[str, Any]] = {}
    for name, result in parallel(runs.NAME, sources, list(runs.CASES), partial(runs.case, sources), processes):
        results[name] = result
        say(
            f"  {name}: low-frequency surge "
            + ", ".join(f"{off(sea, 'surge', 'low_frequency'):+.0f} %" for sea in result["seas"].values())
        )
    drawn = figures / "measured-waves.png"
    draw(results, drawn)
    flow = cached(runs.NAME, sources, "potential", runs.potential)
    return Section(TITLE, words(results, coefficients["vague"], flow), (drawn,), shortcomings(results["tuned"]))


def draw(results: dict[str, dict[str, Any]], path: Path) -> None:
    """Spectra of all three seas: measured, and simulated with both sets of coefficients."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from jaxhydro.analysis.sea_statistics import bands_of
    from jaxhydro.plots.spectrum_axes import BAND_COLOURS
    from jaxhydro.plots.style import BEFORE, MEASURED, SIMULATED, header, save, style

    with style():
        figure = Figure(figsize=(6.9, 5.6), layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.subplots(len(runs.UNITS), 3, sharex=True, sharey="row")
        artists: dict[str, Any] = {}
        for column, (name, sea) in enumerate(results["tuned"]["seas"].items()):
            fitted = results["fitted"]["seas"][name]
            for ax, (channel, unit) in zip(axes[:, column], runs.UNITS.items(), strict=True):
                for band, (low, high) in bands_of(channel, sea["tp"]).items():
                    ax.axvspan(low, high, color=BAND_COLOURS[band], lw=0, zorder=0.5)
                f, (measured, simulated) = sea["frequency"], sea["density"][channel]
                artists["measured"] = ax.plot(f, measured, color=MEASURED, lw=1.3)[0]
                artists[f"simulated, {SETS[runs.FITTED]}"] = ax.plot(f, fitted["density"][channel][1], color=BEFORE, lw=0.8)[0]
                artists[f"simulated, {SETS[runs.TUNED]}"] = ax.plot(f, simulated, color=SIMULATED, lw=0.8)[0]
                ax.set_yscale("log")
                largest = max(max(s["density"][channel][0]) for s in results["tuned"]["seas"].values())
                ax.set_ylim(largest * 3e-6, largest * 3)
                ax.minorticks_off()
                ax.set_xlim(0, runs.HIGHEST)
                if column == 0:
                    ax.set_ylabel(f"{channel.capitalize()}\n({unit}²/Hz)")
            axes[0, column].set_title(f"{name}: Hs {4 * sea['deviation']['wave'][0]:.1f} m, Tp {sea['tp']:g} s")
            axes[-1, column].set_xlabel("Frequency (Hz)")
        header(figure, "FOCAL campaign 2, second order, MacCamy-Fuchs; bands shaded", artists)
        save(figure, path)
