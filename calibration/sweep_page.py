"""A sweep as one self-contained HTML page: what was run, statistics over the life, what failed."""

from collections.abc import Iterator
from html import escape
from pathlib import Path

from pydantic import Field

from calibration.formatting import number, percent
from calibration.report import cells, embedded, figures, framed, listed, table
from calibration.saved import Open
from jaxhydro.problems import Number

FIGURES = {
    "scatter.png": (
        "Standard deviation by sea state, over seeds and headings; areas are shares of the life. A ring: no run of it is done."
    ),
    "exceedance.png": "Maximum of a run, and the share of runs above it by probability: each seed's, and all seeds together.",
}
_LIFE = """<p>Over the life every run counts by the probability of its sea state and heading. <i>Over seeds</i> are standard
deviations from seed to seed; the maximum of a seed is the largest of its runs, averaged over seeds. Equivalent ranges do the
same damage as all cycles, at the sweep's equivalent frequency, for S-N curves of the exponent m.</p>"""


class Runs(Open):
    """How many there are, and what became of them."""

    total: int
    done: int
    failed: int


class Life(Open):
    """Lifetime statistics of a channel, in its unit."""

    unit: str
    mean: Number | None = None
    standard_deviation: Number | None = None
    standard_deviation_spread: Number | None = None
    maximum_of_seed: Number | None = None
    maximum_spread: Number | None = None
    minimum_of_seed: Number | None = None
    damage_equivalent_range: dict[str, Number | None] = Field(default_factory=dict)


class Failure(Open):
    """A run that failed, and why."""

    hs: Number
    tp: Number
    heading: Number
    seed: int
    reason: str


class Used(Open):
    """A calibration's file, and the values that were used of it, by label."""

    file: str
    values: dict[str, Number]


class SavedSweep(Open):
    """sweep.json."""

    sweep: str
    platform: str
    source: str
    runs: Runs
    cases: int
    seeds: list[int]
    probability_without_runs: Number = 0.0
    lifetime: dict[str, Life]
    failures: list[Failure] = Field(default_factory=list)
    notes: list[str] = Field(default_factory=list)
    calibration: Used | None = None


def page(saved: SavedSweep, folder: Path) -> str:
    """The page's text. Whatever comes from files is escaped; images are part of the page."""
    version = saved.source.removeprefix("jaxhydro ")
    return framed(f"{saved.platform}: {saved.sweep}", f"Sweep by jaxhydro {version}", _parts(saved, folder), version)


def _parts(saved: SavedSweep, folder: Path) -> Iterator[str]:
    runs = saved.runs
    if runs.failed:
        share = percent(saved.probability_without_runs)
        lost = f"{share} of the life is without a run, and what follows is of the rest"
        yield f'<p class="warning">{runs.failed} of {runs.total} runs failed; {lost}.</p>'
    seeds = f"{len(saved.seeds)} seed{'s' * (len(saved.seeds) != 1)}"
    yield f"<p>{saved.cases} sea states and headings, {seeds}: {runs.done} runs of {runs.total} done.</p>"
    if saved.calibration is not None:
        values = ", ".join(f"{label} = {number(value)}" for label, value in saved.calibration.values.items())
        yield f"<p>With the values of {escape(saved.calibration.file)}: {escape(values)}.</p>"
    if saved.notes:
        yield f"<h2>Notes</h2>{listed(saved.notes)}"
    yield "<h2>Over the life</h2>"
    yield _LIFE
    yield _lifetimes(saved)
    if saved.failures:
        yield "<h2>Failed</h2>"
        yield listed(
            f"Hs {number(one.hs, 3)} m, Tp {number(one.tp, 3)} s, {number(one.heading, 3)} deg, seed {one.seed}: {one.reason}"
            for one in saved.failures
        )
    drawn = figures(embedded(folder / name, caption) for name, caption in FIGURES.items() if (folder / name).is_file())
    yield f"<h2>Figures</h2>{drawn}" if drawn else ""


def _lifetimes(saved: SavedSweep) -> str:
    exponents = list(dict.fromkeys(m for one in saved.lifetime.values() for m in one.damage_equivalent_range))
    heads = ["Channel", "Mean", "Standard deviation", "over seeds", "Maximum of a seed", "over seeds", "Minimum of a seed"]
    heads += [f"Equivalent range, m = {escape(m)}" for m in exponents]
    rows = []
    for channel, one in saved.lifetime.items():
        values = [one.mean, one.standard_deviation, one.standard_deviation_spread, one.maximum_of_seed, one.maximum_spread]
        values += [one.minimum_of_seed, *(one.damage_equivalent_range.get(m) for m in exponents)]
        rows.append(f"<tr>{cells([f'{channel} ({one.unit})', *(number(value) for value in values)], 1)}</tr>")
    return table(heads, rows, 1)
