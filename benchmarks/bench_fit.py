"""One calibration of the built-in campaign: this package's least squares against population searches on its simulator.

Differential evolution (scipy), a genetic algorithm (pymoo) and CMA-ES (cma), as `benchmarks.population_search` has them, get
the same simulation at the same time step, the same bounds of the same coefficients on the same logarithmic scale, and two
advantages: the records' releases and sensor offsets, which the least squares has to find too, are given to them as it found
them, and their populations are simulated in batches.
"""

import dataclasses
import itertools
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.bench_timing import Row, contest, times
from benchmarks.population_search import POPULATIONS
from calibration.campaign.load_campaign import load_campaign
from calibration.fitting.decay_fit import fit_of_decays, run_fit
from calibration.fitting.fit import Fit
from calibration.global_search.run_search import Found, set_up_search
from calibration.global_search.run_search import run as search
from calibration.global_search.task import Budget, Task
from calibration.residuals.decays import DecayProblem

CAMPAIGN = Path(__file__).resolve().parents[1] / "jaxhydro" / "campaigns" / "volturnus-s-decays"
FACTOR = 10.0  # every coefficient is searched from a tenth to ten times of what the platform declares
CLOSE = 1.01  # "the same objective"
BATCH = 33  # simulated together: five are scipy's population, three pymoo's
SEED = 1
SEARCHES = {"DE": "Differential evolution", "GA": "Genetic algorithm", "CMA-ES": "CMA-ES"}


class Descent(NamedTuple):
    """A calibration by least squares: the fit, its CPU seconds, those of its iterations on whole records, and how many whole
    records' iterations it simulated. `near` is its first iteration whose J over whole records is within a hundredth of the
    last, and the CPU seconds and the whole iterations up to there."""

    fit: Fit
    seconds: float
    whole: tuple[float, ...]
    simulated: float
    near: tuple[int, float, float]


def descend(problem: DecayProblem, records) -> Descent:
    """All stages of jaxhydro's calibration of these records."""
    marks: list[tuple[str, float, float, float]] = []

    def mark(stage: str, iteration: int, objective: float, *unused) -> None:
        marks.append((stage, time.process_time(), objective, fit.decays.share))

    fit = fit_of_decays(problem, records, problem.space.start, mark)
    begun = time.process_time()
    run_fit(fit)
    seconds = time.process_time() - begun
    stages, ends, objectives, parts = zip(*marks, strict=True)
    late = [not stage.startswith("first") for stage in stages]
    pairs = itertools.pairwise(range(len(marks)))
    whole = tuple(ends[b] - ends[a] for a, b in pairs if stages[a] == stages[b] and late[b])
    near = next(i for i, j in enumerate(objectives) if late[i] and j <= CLOSE * objectives[-1])
    return Descent(fit, seconds, whole, sum(parts), (near + 1, ends[near] - begun, sum(parts[: near + 1])))


def measure(budget: float, quick: bool, searches: Sequence[str] = tuple(SEARCHES)) -> Iterator[tuple[list[Row], list[str]]]:
    """Least squares, then each population search until within a hundredth of its J, or `budget` seconds of CPU."""
    campaign = load_campaign(CAMPAIGN)
    chosen = tuple(record for record in campaign.records if record.id == "heave-1" or not quick)
    problem, records = set_up_search(dataclasses.replace(campaign, records=chosen), factor=FACTOR)

    first = descend(problem, records)
    warm = first if quick else descend(problem, records)
    fit, x = warm.fit, np.asarray(warm.fit.unknowns.shared)[None]
    task = Task(problem, records, fit.unknowns.own, Budget(np.inf))
    task.batch, together = BATCH, np.tile(x, (BATCH, 1))
    target = float(task.simulate(x)[0])
    task.simulate(together)  # compiled
    contestants = {"one": lambda: task.simulate(x), "batch": lambda: task.simulate(together)}
    turns = contest(contestants, 2 if quick else 5)
    budgeted = Budget(budget, objective=CLOSE * target)
    results = {
        name: search(Task(problem, records, fit.unknowns.own, budgeted), POPULATIONS[name.lower()](), SEED) for name in searches
    }
    yield report(first, warm, target, turns["one"].median, turns["batch"].over(turns["one"]) / BATCH, results)


def report(
    first: Descent, warm: Descent, target: float, simulation: float, batched: float, searches: dict[str, Found]
) -> tuple[list[Row], list[str]]:
    """The rows and what they mean."""
    records, unknowns = len(warm.fit.decays.records), warm.fit.unknowns
    tangents = unknowns.shared.shape[0] + unknowns.own.shape[1]
    per_iteration = records * (1 + tangents)
    iterations, seconds, simulated = warm.near
    whole = float(np.median(warm.whole)) if warm.whole else warm.seconds / warm.fit.iterations
    rows = [
        Row(
            "Calibration by least squares",
            f"J {target:.4f}, {warm.fit.iterations} iterations, {warm.simulated * per_iteration:.0f} simulations "
            f"({warm.fit.iterations * per_iteration} begun), {warm.seconds:.3g} s CPU",
            "",
            "125 simulations, 4 s (three decays)",
        ),
        Row(
            "... until within 1 % of its J",
            f"{iterations} iterations, {simulated * per_iteration:.0f} simulations "
            f"({iterations * per_iteration} begun), {seconds:.3g} s CPU",
        ),
        Row("... its compilation", f"{max(0.0, first.seconds - warm.seconds):.2g} s CPU"),
        Row(f"... an iteration ({tangents} tangents)", f"{whole / simulation:.3g} simulations of all records, by CPU", "6"),
    ]
    measured = ("9064 simulations, 195 s (three decays)", "73 times", "49 times")
    prototype = {"DE": [("", text) for text in measured]}
    for name, result in searches.items():
        least = "" if result.ended == "reached" else "at least "
        shortfall = "" if result.ended == "reached" else f", J {result.objective:.4f} where the budget ended"
        took = f"{result.simulations:.0f} simulations, {result.seconds:.3g} s CPU{shortfall}"
        before = prototype.get(name, [()] * 3)
        rows += [
            Row(SEARCHES[name], took, *before[0]),
            Row(
                f"{name} over least squares, simulations",
                least + times(result.simulations / (simulated * per_iteration)),
                *before[1],
            ),
            Row(
                f"{name} over least squares, simulations begun",
                least + times(result.simulations / (iterations * per_iteration)),
            ),
            Row(f"{name} over least squares, CPU", least + times(result.seconds / seconds), *before[2]),
        ]
    notes = [
        f"The calibration is of {records} decay records of volturnus-s-decays, {unknowns.shared.shape[0]} coefficients "
        f"from 1/{FACTOR:g} to {FACTOR:g} times what is declared, and {unknowns.own.shape[1]} initial values and "
        f"offsets per record. An iteration is one Jacobian, refused steps included, counted as 1 + {tangents} "
        "simulations of every record (finite differences), though it costs less. Early ones go over a few cycles only: "
        "simulations are counted by simulated time, one for the length of a record, those begun each as one. It is run "
        "twice, and the second run is timed.",
        f"The searches minimise J itself, from seed {SEED}, over the same coefficients, bounds and logarithmic scale, "
        "with initial values and offsets given as fitted, which is an advantage, until they are within 1 % of the "
        "least squares' J (ratios are against what least squares took to that) or their budget of CPU time is spent. "
        f"Their populations are simulated in batches by vmap; in one of {BATCH} a simulation takes {batched:.2g} of the CPU "
        "time of one alone.",
    ]
    return rows, notes
