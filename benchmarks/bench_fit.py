"""One calibration of the built-in campaign: this package's least squares against population searches on its simulator.

Differential evolution (scipy) and a genetic algorithm (pymoo) get the same jitted simulation at the same time step, the
same bounds of the same coefficients on the same logarithmic scale, and two advantages: the records' releases and sensor
offsets, which the least squares has to find too, are given to them as it found them, and their populations are
simulated in batches.
"""

import contextlib
import itertools
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float
from scipy.optimize import differential_evolution

from benchmarks.bench_timing import Row, contest, times
from calibration.campaign import load_campaign
from calibration.fit import Fit, pose, run, scored
from calibration.parameters import default_free, parameter_space
from calibration.residuals import Problem, Unknowns, first_guess
from jaxhydro import Model
from jaxhydro.platform import build

CAMPAIGN = Path(__file__).resolve().parents[1] / "jaxhydro" / "campaigns" / "volturnus-s-decays"
FACTOR = 10.0  # every coefficient is searched from a tenth to ten times of what the platform declares
CLOSE = 1.01  # "the same objective"
BATCH = 33  # simulated together: five batches are scipy's population, three pymoo's
SEED = 1


class Search(NamedTuple):
    """What a population search took: evaluations of J (all records), CPU seconds, the least J, whether it is close."""

    evaluations: int
    seconds: float
    best: float
    reached: bool


class Stop(Exception):
    """The objective is reached, or the budget spent."""


@eqx.filter_jit
def objective(problem: Problem, own, weight, x: Float[Array, " p"]) -> Float[Array, ""]:
    """J = sum of RMSE / standard deviation over the scored series, releases and offsets given."""

    def of_record(inputs):
        own, record, weight = inputs
        residual = (problem.motion(x, own, record) - record.measured) * record.present
        return weight @ jnp.sqrt((residual**2).sum(axis=-1) / jnp.maximum(record.present.sum(axis=-1), 1.0))

    return jax.lax.map(of_record, (own, problem.data, weight)).sum()


@eqx.filter_jit
def objectives(problem: Problem, own, weight, x: Float[Array, "n p"]) -> Float[Array, " n"]:
    """The same of many at once."""
    return jax.vmap(lambda x: objective(problem, own, weight, x))(x)


class Population:
    """J of points in the unit cube (share of each coefficient's logarithmic range), counted, until target or budget."""

    def __init__(self, function: Callable[[np.ndarray], np.ndarray], spans: np.ndarray, target: float, budget: float):
        self.function, self.spans, self.target, self.budget = function, spans, target, budget
        self.evaluations, self.best, self.begun = 0, np.inf, time.process_time()

    def __call__(self, shares: np.ndarray) -> np.ndarray:
        found = []
        for at in range(0, len(shares), BATCH):
            part = shares[at : at + BATCH]
            inside = np.clip(np.resize(part, (BATCH, shares.shape[1])), 1e-6, 1 - 1e-6)
            values = self.function(0.25 * self.spans * np.log(inside / (1 - inside)))[: len(part)]
            found.append(np.where(np.isfinite(values), values, 1e3))
            self.evaluations += len(part)
            self.best = min(self.best, float(found[-1].min()))
            if self.best <= self.target or time.process_time() - self.begun > self.budget:
                raise Stop
        return np.concatenate(found)

    def result(self) -> Search:
        return Search(self.evaluations, time.process_time() - self.begun, self.best, self.best <= self.target)


def evolve(population: Population, size: int) -> None:
    """scipy's differential evolution at its defaults, generation by generation, without an end of its own."""
    differential_evolution(
        lambda shares: population(shares.T),
        [(0.0, 1.0)] * size,
        vectorized=True,
        updating="deferred",
        polish=False,
        tol=0.0,
        maxiter=10**6,
        rng=np.random.default_rng(SEED),
    )


def breed(population: Population, size: int) -> None:
    """pymoo's genetic algorithm at its defaults, but for three batches instead of 100 individuals."""
    from pymoo.algorithms.soo.nonconvex.ga import GA
    from pymoo.core.problem import Problem as Task
    from pymoo.optimize import minimize

    class Cube(Task):
        def __init__(self) -> None:
            super().__init__(n_var=size, n_obj=1, xl=0.0, xu=1.0)

        def _evaluate(self, x, out, *args: Any, **kwargs: Any) -> None:
            out["F"] = population(x)[:, None]

    minimize(Cube(), GA(pop_size=3 * BATCH), ("n_gen", 10**6), seed=SEED)


class Windowed(Fit):
    """A fit that knows which part of the records' time its present stage simulates."""

    part = 1.0

    def minimise(self, stage: str, weight, until, *rest, **named) -> bool:
        begin = np.asarray(self.problem.data.time[:, 0])
        self.part = float(np.sum(np.asarray(until) - begin) / np.sum(np.asarray(self.ends) - begin))
        return super().minimise(stage, weight, until, *rest, **named)


class Descent(NamedTuple):
    """A calibration by least squares: the fit, its CPU seconds, those of its iterations on whole records, and how many whole
    records' iterations it simulated. `near` is its first iteration whose J over whole records is within a hundredth of the
    last, and the CPU seconds and the whole iterations up to there."""

    fit: Fit
    seconds: float
    whole: tuple[float, ...]
    simulated: float
    near: tuple[int, float, float]


def descend(problem: Problem, records) -> Descent:
    """All stages of jaxhydro's calibration of these records."""
    marks: list[tuple[str, float, float, float]] = []

    def mark(stage: str, iteration: int, objective: float, *rest) -> None:
        marks.append((stage, time.process_time(), objective, fit.part))

    fit = Windowed(problem, records, Unknowns(problem.space.start, first_guess(records, problem.data)), mark)
    begun = time.process_time()
    run(fit)
    seconds = time.process_time() - begun
    stages, ends, objectives, parts = zip(*marks, strict=True)
    late = [not stage.startswith("first") for stage in stages]
    pairs = itertools.pairwise(range(len(marks)))
    whole = tuple(ends[b] - ends[a] for a, b in pairs if stages[a] == stages[b] and late[b])
    near = next(i for i, j in enumerate(objectives) if late[i] and j <= CLOSE * objectives[-1])
    return Descent(fit, seconds, whole, sum(parts), (near + 1, ends[near] - begun, sum(parts[: near + 1])))


def bounds(model: Model, labels: Sequence[str]) -> dict[str, tuple[float, float]]:
    """A range about each declared value, within what is physical."""
    found = {}
    for label in labels:
        value, about = float(model.values[label]), model.about(label)
        found[label] = (max(value / FACTOR, about.lower), min(value * FACTOR, about.upper))
    return found


def measure(budget: float, quick: bool) -> Iterator[tuple[list[Row], list[str]]]:
    """Least squares, then each population search until within a hundredth of its J, or `budget` seconds of CPU."""
    campaign = load_campaign(CAMPAIGN)
    records = [record for record in campaign.used("fit") if record.kind == "decay"]
    model = build(campaign.platform)
    labels = default_free(model, {str(record.degree_of_freedom) for record in records})
    space = parameter_space(model, labels, bounds(model, labels))
    records = [record for record in records if record.id == "heave-1"] if quick else records
    problem = pose(model, campaign, records, space)

    first = descend(problem, records)
    again = first if quick else descend(problem, records)
    fit, x = again.fit, np.asarray(again.fit.unknowns.shared)
    counts, spread = scored(records, problem.data)
    given = (problem, fit.unknowns.own, jnp.asarray(np.where(counts, 1 / spread, 0.0)))
    target = float(objective(*given, x))

    def many(x: np.ndarray) -> np.ndarray:
        return np.asarray(objectives(*given, x))

    def apart(x: np.ndarray) -> np.ndarray:
        return np.array([float(objective(*given, row)) for row in x])

    together = np.tile(x, (BATCH, 1))
    contestants = {"one": lambda: apart(together[:1]), "batch": lambda: (apart if quick else many)(together)}
    turns = contest(contestants, 2 if quick else 5)
    batched = 1.0 if quick else turns["batch"].over(turns["one"]) / BATCH
    function = many if batched < 1 else apart
    spans = np.array([parameter.transform.span for parameter in space.free])

    def search(method: Callable[[Population, int], None]) -> Search:
        population = Population(function, spans, CLOSE * target, budget)
        with contextlib.suppress(Stop):
            method(population, len(labels))
        return population.result()

    yield report(first, again, target, turns["one"].median, batched, {"DE": search(evolve), "GA": search(breed)})


def report(
    first: Descent, again: Descent, target: float, one: float, batched: float, searches: dict[str, Search]
) -> tuple[list[Row], list[str]]:
    """The rows and what they mean."""
    records, unknowns = len(again.fit.records), again.fit.unknowns
    tangents = unknowns.shared.shape[0] + unknowns.own.shape[1]
    every, each = records * (1 + tangents), 1 + tangents
    iterations, seconds, simulated = again.near
    whole = float(np.median(again.whole)) if again.whole else again.seconds / again.fit.iterations
    rows = [
        Row(
            "Calibration by least squares",
            f"J {target:.4f}, {again.fit.iterations} iterations, {again.simulated * every:.0f} simulations "
            f"({again.fit.iterations * every} begun), {again.seconds:.3g} s CPU",
            "",
            "125 simulations, 4 s (three decays)",
        ),
        Row(
            "... until within 1 % of its J",
            f"{iterations} iterations, {simulated * every:.0f} simulations ({iterations * every} begun), {seconds:.3g} s CPU",
        ),
        Row("... its compilation", f"{max(0.0, first.seconds - again.seconds):.2g} s CPU"),
        Row(f"... an iteration ({tangents} tangents)", f"{whole / one:.3g} simulations of all records, by CPU", "6"),
    ]
    full = {"DE": "Differential evolution", "GA": "Genetic algorithm"}
    measured = ("9064 simulations, 195 s (three decays)", "73 times", "49 times")
    prototype = {"DE": [("", text) for text in measured], "GA": [()] * 3}
    for name, found in searches.items():
        least = "" if found.reached else "at least "
        said = "" if found.reached else f", J {found.best:.4f} where the budget ended"
        took = f"{found.evaluations * records} simulations, {found.seconds:.3g} s CPU{said}"
        before = prototype[name]
        rows += [
            Row(full[name], took, *before[0]),
            Row(f"{name} over least squares, simulations", least + times(found.evaluations / (simulated * each)), *before[1]),
            Row(f"{name} over least squares, simulations begun", least + times(found.evaluations / (iterations * each))),
            Row(f"{name} over least squares, CPU", least + times(found.seconds / seconds), *before[2]),
        ]
    how = "one by one, which is faster than in batches"
    if batched < 1:
        how = f"in batches of {BATCH} by vmap, each simulation at {batched:.2g} of the CPU time of one alone"
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
        f"Their populations are simulated {how}.",
    ]
    return rows, notes
