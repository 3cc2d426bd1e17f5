"""Section: free decays of the same strips in OpenFAST."""

from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence import openfast_runs as runs
from benchmarks.evidence.common import Section, cached, fingerprint, require, say
from benchmarks.evidence.openfast_text import compared, shortcomings, words

NAME = "openfast"
TITLE = "Decays against OpenFAST"


def key() -> str:
    """Key of the section's results."""
    return fingerprint(Path(runs.__file__), *(runs.FOLDER / f"decay_{dof}_strip" for dof in runs.DECAYS))


def run(figures: Path) -> Section:
    """Surge, heave and pitch released in OpenFAST and here."""
    require(runs.FOLDER, "OpenFAST's runs (../shared/reference/openfast) are not on this machine")
    sources = key()
    results = {dof: cached(NAME, sources, dof, lambda dof=dof: runs.decay(dof)) for dof in runs.DECAYS}
    for dof, motions in results.items():
        c = compared(motions)
        say(f"  {dof}: period {100 * (c['our_period'] / c['mean_period'] - 1):+.4f} %, largest {100 * c['largest']:.3f} %")
    path = figures / "openfast-pitch.png"
    draw(results["pitch"], path)
    return Section(TITLE, words(results), (path,), shortcomings(results))


def draw(motions: dict[str, Any], path: Path) -> None:
    """Pitch by both, and their difference."""
    from jaxhydro.plots.style import MEASURED, SIMULATED, header, save, stack, style

    time, reference, motion = (np.asarray(motions[k]) for k in ("time", "openfast", "jaxhydro"))
    shown = time <= 270
    with style():
        figure, axes = stack([1.4, 0.8])
        a = axes[0].plot(time[shown], reference[shown], color=MEASURED, lw=1.6)[0]
        b = axes[0].plot(time[shown], motion[shown], color=SIMULATED, lw=0.8)[0]
        axes[0].set_ylabel("Pitch (deg)")
        axes[1].plot(time[shown], (motion - reference)[shown], color=SIMULATED, lw=0.8)
        axes[1].set_ylabel("Difference\n(deg)")
        axes[1].set_xlabel("Time (s)")
        header(figure, "Pitch decay", {"OpenFAST": a, "jaxhydro": b})
        save(figure, path)
