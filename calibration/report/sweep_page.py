"""HTML page of a sweep: extremes, statistics over the life, failed runs."""

from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import NamedTuple

from calibration.formatting import counted, number, percent
from calibration.formatting import listed as joined
from calibration.report.web_page import embedded, figures, framed, listed, result_box, table, warning_box
from jaxhydro.environment import DOFS
from jaxhydro.sweep.cases import runs_in_words
from jaxhydro.sweep.sweep_results import SweepResults

FIGURES = {
    "scatter.png": (
        "Standard deviation by sea state, over seeds and headings; areas are shares of the life. A ring: no run of it is done."
    ),
    "exceedance.png": (
        "Probability that a run goes beyond: below a minimum, to the left, and above a maximum, to the right; each "
        "seed's, and of all seeds together."
    ),
}
_LIFE = """<p>Over the life every run counts by the probability of its sea state and heading. Spreads are standard deviations
from seed to seed; the maximum of a seed is the largest of its runs, averaged over seeds, the maximum of all that of all runs.
Equivalent ranges do the same damage as all cycles{frequency}, for S-N curves of the exponent m.</p>"""


class SweepSummary(NamedTuple):
    """What the sentence on a sweep says: runs in all and done, and the extremes of every motion with its unit."""

    total: int
    done: int
    extremes: dict[str, tuple[float, float, str]]


def summary_of(saved: SweepResults) -> SweepSummary:
    """The summary of a sweep.json."""
    extremes = {
        channel: (one.minimum, one.maximum, one.unit)
        for channel, one in saved.lifetime.items()
        if channel in DOFS and one.minimum is not None and one.maximum is not None
    }
    return SweepSummary(saved.runs.total, saved.runs.done, extremes)


def sweep_sentence(summary: SweepSummary) -> str:
    """A sweep in one sentence.

    "All 48 runs done; extremes over the life: surge -2.1 to 12.3 m and pitch -1.0 to 4.2 deg."
    """
    done, total = summary.done, summary.total
    runs = f"{'All ' * (total > 1)}{counted(total, 'run')} done" if done == total else f"{done} of {total} runs done"
    said = [f"{name} {number(low, 3)} to {number(high, 3)} {unit}" for name, (low, high, unit) in summary.extremes.items()]
    return f"{runs}; extremes over the life: {joined(said)}." if said and done else f"{runs}."


def page(saved: SweepResults, folder: Path) -> str:
    """The page's text. Whatever comes from files is escaped; images are part of the page."""
    version = saved.source.removeprefix("jaxhydro ")
    return framed(f"{saved.platform}: {saved.sweep}", f"Sweep by jaxhydro {version}", _parts(saved, folder), version)


def _parts(saved: SweepResults, folder: Path) -> Iterator[str]:
    runs = saved.runs
    if runs.failed:
        share = percent(saved.probability_without_runs)
        lost = f"{share} of the life is without a run, and what follows is of the rest"
        yield warning_box(f"{runs.failed} of {runs.total} runs failed; {lost}.")
    yield result_box(sweep_sentence(summary_of(saved)))
    if runs.done:
        yield f"<h2>Over the life</h2>{_LIFE.format(frequency=f' at {number(saved.options.equivalent_frequency, 3)} Hz')}"
        yield from _lifetimes(saved)
    yield "<h2>What was run</h2>"
    yield table(["Property", "Value"], list(_run(saved)), 2)
    if saved.calibration is not None:
        values = ", ".join(f"{label} = {number(value)}" for label, value in saved.calibration.values.items())
        counted = ""
        if (reference := saved.calibration.sea_state_reference) is not None:
            hs, tp = number(reference.significant_height, 3), number(reference.peak_period, 3)
            counted = f"; exponents count from Hs {hs} m, Tp {tp} s"
        yield f"<p>With the values of {escape(saved.calibration.file)}: {escape(values)}{counted}.</p>"
    if saved.notes:
        yield f"<h2>Notes</h2>{listed(saved.notes)}"
    if saved.failures:
        yield "<h2>Failed</h2>"
        yield listed(
            f"{runs_in_words((one.hs, one.tp, one.gamma), one.headings, one.seeds)}: {one.reason}" for one in saved.failures
        )
    drawn = figures(embedded(folder / name, caption) for name, caption in FIGURES.items() if (folder / name).is_file())
    yield f"<h2>Figures</h2>{drawn}" if drawn else ""


def _run(saved: SweepResults) -> Iterator[tuple[str, str]]:
    how, seeds = saved.options, len(saved.seeds)
    headings = ", ".join(f"{one.heading:g} deg ({percent(one.probability)})" for one in saved.headings)
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


def _lifetimes(saved: SweepResults) -> Iterator[str]:
    """Statistics of every channel, then its equivalent ranges: as two tables, since one would be wider than a page."""
    heads = [
        "Channel",
        "Mean",
        "Standard deviation",
        "Spread of it",
        "Maximum of a seed",
        "Spread of that",
        "Minimum of a seed",
        "Maximum of all",
        "Minimum of all",
    ]
    rows = []
    for channel, one in saved.lifetime.items():
        values = [one.mean, one.standard_deviation, one.standard_deviation_spread, one.maximum_of_seed, one.maximum_spread]
        values += [one.minimum_of_seed, one.maximum, one.minimum]
        rows.append([f"{channel} ({one.unit})", *map(number, values)])
    yield table(heads, rows)
    exponents = list(dict.fromkeys(m for one in saved.lifetime.values() for m in one.damage_equivalent_range))
    if exponents:
        heads = ["Channel", *(f"Equivalent range, m = {m}" for m in exponents)]
        ranges = {f"{channel} ({one.unit})": one.damage_equivalent_range for channel, one in saved.lifetime.items()}
        yield table(heads, [[channel, *(number(by.get(m)) for m in exponents)] for channel, by in ranges.items()])
