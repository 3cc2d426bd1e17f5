"""Section: measured decays, a semi-submersible's surge and a ship's roll."""

from pathlib import Path
from typing import Any

from benchmarks.evidence import common
from benchmarks.evidence import measured_runs as runs
from benchmarks.evidence.common import Absent, Section, cached, fingerprint, keep, require, say
from benchmarks.evidence.measured_text import shortcomings, words

NAME = "measured"
TITLE = "Measured decays"


def key(*names: str) -> str:
    """Key of the results of some campaigns, of all where none is named."""
    return fingerprint(*(runs.FOLDER / name for name in names or runs.CASES), Path(runs.__file__))


def run(figures: Path) -> Section:
    """Both campaigns, each with a figure of its record and one of its cycles."""
    require(runs.FOLDER, "the measured records (../shared/measured) are not on this machine")
    results, drawn = {}, []
    for name in runs.CASES:
        results[name], motions = results_of(name)
        say(f"  {name}: relative error {results[name]['relative']:.4f}, {results[name]['iterations']} iterations")
        paths = [figures / f"{name}-{kind}.png" for kind in ("record", "cycles")]
        if motions is not None:
            draw(motions, *paths)
        drawn += paths
    return Section(TITLE, words(results), tuple(drawn), shortcomings(results))


def results_of(name: str) -> tuple[dict[str, Any], dict[str, Any] | None]:
    """Numbers of a campaign, and the motions that its figures show.

    The motions are None where only a text is made and they are not kept: figures then stay as they are.
    """
    sources = key(name)
    numbers = cached(NAME, sources, name)
    try:
        motions = cached(NAME, sources, f"{name}-motions")
    except Absent:
        motions = None
    if not common.text_only and (numbers is None or motions is None):
        calibration, series = runs.calibrated(name)
        numbers, motions = keep(NAME, sources, name, calibration), keep(NAME, sources, f"{name}-motions", series)
    return numbers, motions


def draw(motions: dict[str, Any], record: Path, cycles: Path) -> None:
    """Motions of a decay, and its decrement and period against amplitude.

    Args:
        motions: The motions, as `measured_runs.motions_of` has them.
        record: File of the figure of the motions.
        cycles: File of the figure of the cycles, where there is a whole cycle.
    """
    from calibration.plots.calibration_figures import test_figure
    from calibration.plots.decay_figures import decay_figure
    from jaxhydro.plots.style import save, style

    test = runs.test_of(motions)
    with style():
        save(test_figure(test), record)
        figure = decay_figure(test.main.channel, [test])
        if figure is not None:
            save(figure, cycles)
