"""Section: loads and motions in waves against the same strips in OpenFAST."""

from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence import openfast_runs, openfast_sea
from benchmarks.evidence import openfast_waves_runs as runs
from benchmarks.evidence.common import Section, cached, fingerprint, require, say
from benchmarks.evidence.openfast_waves_text import percent, shortcomings, words

NAME = "openfast_waves"
TITLE = "Waves against OpenFAST"


def key() -> str:
    """Key of the section's results."""
    modules = (Path(runs.__file__), Path(openfast_sea.__file__), Path(openfast_runs.__file__))
    return fingerprint(*modules, *sorted(openfast_runs.FOLDER.glob("*_c[1-4]*")))


def run(figures: Path) -> Section:
    """Held and free platform, then other conventions."""
    require(openfast_runs.FOLDER, "OpenFAST's runs (../shared/reference/openfast) are not on this machine")
    sources = key()
    loads, motions, seas = {}, {}, {}
    for case in runs.HELD:
        loads[case] = cached(NAME, sources, f"held-{case}", lambda case=case: runs.held(case))
        say(f"  held, {case}")
    for name in runs.FREE:
        motions[name] = cached(NAME, sources, name, lambda name=name: runs.free(name))
        say(f"  {name}: {', '.join(percent(motions[name]['whole'][d]) for d in runs.DOFS)}")
    for sea in runs.SEAS:
        seas[sea] = cached(NAME, sources, f"conventions-{sea}", lambda sea=sea: runs.changed(sea))
        say(f"  conventions, {sea}")
    shares = cached(NAME, sources, "drift", runs.drift_shares)
    path = figures / "openfast-waves.png"
    draw(seas["ss1"], path)
    return Section(TITLE, words(loads, motions, seas, shares), (path,), shortcomings(loads, motions))


def draw(changes: dict[str, Any], path: Path) -> None:
    """Spectra of ss1_c3 by OpenFAST and here, in its conventions and the default ones."""
    from jaxhydro.plots.style import BEFORE, MEASURED, SIMULATED, header, save, stack, style
    from jaxhydro.units import unit_of

    looks = {"OpenFAST": (MEASURED, 2.0), "base": (BEFORE, 1.0), runs.DEFAULT: (SIMULATED, 1.0)}
    names = {"OpenFAST": "OpenFAST", "base": "the same here", runs.DEFAULT: "default here"}
    with style():
        figure, axes = stack([1.1] * 3)
        for ax, dof in zip(axes, runs.DOFS, strict=True):
            lines = {}
            for label, (colour, width) in looks.items():
                frequency, density = map(np.asarray, changes["psd"][label][dof])
                shown = (frequency > 0) & (frequency <= 0.2)
                lines[names[label]] = ax.semilogy(frequency[shown], density[shown], color=colour, lw=width)[0]
            top = max(max(changes["psd"][label][dof][1]) for label in looks)
            ax.set_ylim(2e-5 * top, 2 * top)
            ax.set_ylabel(f"{dof.capitalize()} ({unit_of(dof)}²/Hz)")
        axes[-1].set_xlabel("Frequency (Hz)")
        header(figure, "Spectra in case 3, Hs 3.1 m", lines)
        save(figure, path)
