"""Section: diagnoses of OpenFAST's potential-flow runs, taken as measurements of a strip model."""

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence import common
from benchmarks.evidence import numerical_tank_runs as runs
from benchmarks.evidence import numerical_tank_truth as truth
from benchmarks.evidence.common import Section, cached, fingerprint, parallel, require, say, within
from benchmarks.evidence.numerical_tank_text import shortcomings, words

TITLE = "A numerical wave tank taken as measurements"
SLOW = 0.025  # Hz: the upper end of surge's low-frequency band


def one(part: str) -> dict[str, Any]:
    """One of the calculations of `runs`."""
    return {"declared": runs.declared, "calibrated": runs.calibrated}.get(part, partial(runs.diagnosed, part))()


def key() -> str:
    """Key of the section's results."""
    files = (*sorted(runs.CAMPAIGN.glob("*.csv")), *sorted(runs.CAMPAIGN.glob("*.yaml")))
    return fingerprint(Path(runs.__file__), *files)


def truth_key(law: dict[str, dict[str, float]]) -> str:
    """Key of what is known of the tank; `law`, of wave drift, as it was found."""
    return fingerprint(key(), Path(truth.__file__), repr(law))


def run(figures: Path, processes: int) -> Section:
    """The baseline, calibrated; diagnoses of decays and sea, of the decays alone, with tables among candidates."""
    for path in (runs.FOLDER, runs.HYDRO):
        require(path, "OpenFAST's runs and WAMIT's files (../shared/reference) are not on this machine")
    if not common.text_only:
        runs.written()
        runs.written_with_tables()
    sources = key()
    results: dict[str, Any] = {}
    for name, result in parallel(runs.NAME, sources, ("declared", "calibrated", "all", "decays", "tables"), one, processes):
        results[name] = result
        if "verdict" in result:
            named = [" ".join(filter(None, (x["effect"], x["motion"]))) for x in result["effects"]]
            say(f"  {name}: {', '.join(named) or result['verdict']}, {result['seconds']:.0f} s")
    law: dict[str, dict[str, float]] = {}
    for x in results["all"]["effects"]:
        if x["effect"] == "wave_drift":
            law[x["motion"]] = {label.split(".")[-1]: value for label, (value, _, _) in x["parameters"].items()}
    tank = cached(runs.NAME, truth_key(law), "truth", partial(known_of, law))
    setup = cached(runs.NAME, sources, "setup", runs.setup)
    path = figures / "numerical-tank-surge.png"
    draw(results["all"], path)
    return Section(TITLE, words(results, tank, setup), (path,), shortcomings(results))


def known_of(law: dict[str, dict[str, float]]) -> dict[str, Any]:
    """What is known of the tank; `law`, of wave drift, as it was found."""
    return {
        "mooring": truth.mooring(),
        "radiation": truth.radiation(),
        "drift": truth.drift(law),
        "quadratic": truth.quadratic(),
        "excitation": truth.excitation(),
    }


def draw(diagnosis: dict[str, Any], path: Path) -> None:
    """Surge of the sea that was held out: measured, of the fitted baseline and with what was found; its slow part."""
    from jaxhydro.plots.style import BEFORE, MEASURED, SIMULATED, header, save, stack, style

    motions = diagnosis["motions"][runs.HELD]
    time = np.array(motions["time"])
    series = dict(zip(("measured", "declared, fitted", "with what was found"), np.array(motions["surge"])))
    looks = ((MEASURED, 1.5), (BEFORE, 1.0), (SIMULATED, 0.8))
    with style():
        figure, axes = stack([1.2, 1.2])
        artists = {}
        for (name, x), (colour, width) in zip(series.items(), looks):
            artists[name] = axes[0].plot(time, x, color=colour, lw=width)[0]
            axes[1].plot(time, within(x, 0.0, SLOW, float(time[1] - time[0])), color=colour, lw=width)
        axes[0].set_ylabel("Surge (m)")
        axes[1].set_ylabel(f"slower than\n{SLOW:g} Hz (m)")
        axes[1].set_xlabel("Time (s)")
        axes[1].set_xlim(runs.HALF, runs.HALF + 1200)
        header(figure, "Surge, held-out half of the sea", artists, columns=2)
        save(figure, path)
