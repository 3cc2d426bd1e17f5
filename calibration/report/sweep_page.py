"""HTML page of a sweep: extremes, statistics over the life, failed runs."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from calibration.formatting import counted, number, percent
from calibration.formatting import listed as joined
from calibration.report.web_page import embedded, inputs_table, render, written_on
from calibration.vocabulary import Rows
from jaxhydro.environment import DOFS
from jaxhydro.sweep.sea_states import State, runs_in_words
from jaxhydro.sweep.sweep_results import SweepResults

SWEEP_FILE = "sweep.json"
FIGURES = {
    "scatter.png": (
        "Standard deviation by sea state, over seeds and headings; areas are shares of the life. A ring: no run of it is done."
    ),
    "exceedance.png": (
        "Probability that a run goes beyond: below a minimum, to the left, and above a maximum, to the right. Of each "
        "seed, and of all seeds together."
    ),
}
STATISTICS = {
    "mean": "Mean",
    "standard_deviation": "Standard deviation",
    "standard_deviation_spread": "Its spread over seeds",
    "maximum_of_seed": "Maximum of a seed",
    "maximum_spread": "Its spread over seeds",
    "minimum_of_seed": "Minimum of a seed",
    "maximum": "Maximum of all",
    "minimum": "Minimum of all",
}


class SweepSummary(NamedTuple):
    """Facts for the sentence on a sweep.

    Attributes:
        total: Number of runs.
        done: Number of runs that are done.
        extremes: Minimum, maximum and unit of every motion.
    """

    total: int
    done: int
    extremes: dict[str, tuple[float, float, str]]


def summary_of(saved: SweepResults) -> SweepSummary:
    """The summary of a sweep.json."""
    extremes = {
        channel: (statistics.minimum, statistics.maximum, statistics.unit)
        for channel, statistics in saved.lifetime.items()
        if channel in DOFS and statistics.minimum is not None and statistics.maximum is not None
    }
    return SweepSummary(saved.runs.total, saved.runs.done, extremes)


def sweep_sentence(summary: SweepSummary) -> str:
    """A sweep in one sentence.

    "All 48 runs done. Extremes over the life: surge -2.1 to 12.3 m and pitch -1.0 to 4.2 deg."
    """
    done, total = summary.done, summary.total
    runs = f"{'All ' * (total > 1)}{counted(total, 'run')} done" if done == total else f"{done} of {total} runs done"
    extremes = [f"{name} {number(low, 3)} to {number(high, 3)} {unit}" for name, (low, high, unit) in summary.extremes.items()]
    return f"{runs}. Extremes over the life: {joined(extremes)}." if extremes and done else f"{runs}."


def page(saved: SweepResults, folder: Path) -> str:
    """Text of the page of a sweep, whose figures are in a folder."""
    lost = f"{percent(saved.probability_without_runs)} of the life is without a run, and what follows is of the rest"
    return render(
        "sweep",
        title=f"{saved.platform}: {saved.sweep}",
        by="Sweep",
        version=(version := saved.source.removeprefix("jaxhydro ")),
        date=written_on(folder / SWEEP_FILE),
        inputs=inputs_table(
            version,
            sweep=saved.sweep,
            platform=saved.platform,
            calibration=None if saved.calibration is None else saved.calibration.file,
        ),
        saved=saved,
        failed=f"{saved.runs.failed} of {saved.runs.total} runs failed; {lost}.",
        sentence=sweep_sentence(summary_of(saved)),
        statistics=_statistics(saved),
        ranges=_ranges(saved),
        properties=list(_run(saved)),
        failures=[
            f"{runs_in_words(State.of(failure), failure.headings, failure.seeds)}: {failure.reason}"
            for failure in saved.failures
        ],
        images=embedded({folder / name: caption for name, caption in FIGURES.items()}).values(),
    )


def _run(saved: SweepResults) -> Iterator[tuple[str, str]]:
    how, seeds = saved.options, len(saved.seeds)
    headings = ", ".join(f"{heading.heading:g} deg ({percent(heading.probability)})" for heading in saved.headings)
    yield "Runs", f"{saved.runs.done} of {saved.runs.total} done"
    yield "Sea states", f"{saved.sea_states}"
    yield "Headings, and shares of the life", headings
    yield "Cases, a sea state from a heading", f"{saved.cases}"
    yield "Seeds", f"{seeds}" if seeds > 8 else f"{seeds}: {', '.join(map(str, saved.seeds))}"
    yield "Duration", f"{how.duration:g} s, of which the first {how.start:g} s are left out"
    yield (
        "Waves",
        (f"{how.spectrum.replace('_', ' ')}, {how.amplitudes} amplitudes, {how.low:g} to {how.cutoff:g} Hz, order {how.order}"),
    )
    yield "Wave stretching, diffraction", f"{how.stretching}, {how.diffraction.replace('_', ' ')}"
    yield "Records every, steps of at most", f"{how.time_step:g} s, {number(how.step, 3)} s"


def _statistics(saved: SweepResults) -> Rows:
    """Statistics of every channel."""
    rows = [
        (f"{channel} ({statistics.unit})", *(number(getattr(statistics, name)) for name in STATISTICS))
        for channel, statistics in saved.lifetime.items()
    ]
    return ("Channel", *STATISTICS.values()), rows


def _ranges(saved: SweepResults) -> Rows:
    """Equivalent ranges of every channel: a table of its own, since one would be wider than a page."""
    exponents = list(dict.fromkeys(m for statistics in saved.lifetime.values() for m in statistics.damage_equivalent_range))
    rows = [
        (f"{channel} ({statistics.unit})", *(number(statistics.damage_equivalent_range.get(m)) for m in exponents))
        for channel, statistics in saved.lifetime.items()
    ]
    return ("Channel", *(f"Equivalent range, m = {m}" for m in exponents)), rows
