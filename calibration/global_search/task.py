"""Task of a global search: counted objective, budget, history."""

import time as clock
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import ClassVar, NamedTuple, Protocol

import jax.numpy as jnp
import numpy as np

from calibration.campaign.records import Record
from calibration.fitting.decay_part import scored_channels
from calibration.fitting.progress import Progress
from calibration.global_search.objective import coordinates, objectives
from calibration.residuals.decays import DecayProblem
from jaxhydro.interrupts import stop_if_asked

FAILED_OBJECTIVE = 1e6  # J of a simulation that is no number
MAX_BATCH = 36  # points simulated at once at most: beyond, a point costs no less, and the arrays leave the cache


class Budget(NamedTuple):
    """Budget of a search, which ends at the first of these limits.

    Attributes:
        seconds: CPU time of this process (s), compilation apart.
        simulations: Number of simulations of a record; a part of one counts as that part.
        objective: Objective J that is good enough.
    """

    seconds: float = 60.0
    simulations: float = np.inf
    objective: float = 0.0


class History(NamedTuple):
    """Lowest objective J during a search, one entry for every improvement; the last entry is the end.

    Attributes:
        simulations: Number of simulations so far.
        seconds: CPU time so far (s).
        objective: Lowest J so far.
    """

    simulations: np.ndarray
    seconds: np.ndarray
    objective: np.ndarray

    def until(self, objective: float) -> tuple[float, float] | None:
        """Simulations and CPU seconds when J came down to `objective`; None if it never did."""
        reached = np.flatnonzero(self.objective <= objective)
        return (float(self.simulations[reached[0]]), float(self.seconds[reached[0]])) if len(reached) else None


class BudgetSpent(Exception):
    """End of a search: the budget is spent, or the objective reached. Methods must not catch it."""


class Task:
    """Objective J over points of the unit cube, with a budget, the best point and the history.

    Attributes:
        problem: The decay records and the model.
        records: The records.
        releases: Own unknowns of the records with which points are simulated (see `objectives`); None: the search fits them.
        budget: The budget.
        report: Function that is called with the progress.
        weight: Weights of the channels (1/m, 1/rad), (r, c).
        begins: First times of the records (s), (r,).
        ends: Last times of the records (s), (r,).
        size: Number of parameters.
        batch: Number of points that are simulated at once.
        simulations: Number of simulations so far.
        best: Lowest J so far.
        x: Coordinates of the best point, (p,).
        stage: Name of the current stage.
        calls: Number of calls of `note` so far.
    """

    def __init__(
        self,
        problem: DecayProblem,
        records: Sequence[Record],
        releases,
        budget: Budget,
        report: Callable[[Progress], None] = lambda _: None,
    ) -> None:
        self.problem, self.records, self.releases, self.budget, self.report = problem, records, releases, budget, report
        counts, spread = scored_channels(records, problem.data)
        self.weight = jnp.asarray(np.where(counts, 1 / spread, 0.0))
        self.begins, self.ends = np.asarray(problem.data.time[:, 0]), np.array([record.time[-1] for record in records])
        self.size, self.batch = len(problem.space.free), 1
        self.simulations, self.best, self.x = 0.0, np.inf, np.full(self.size, np.nan)
        self.stage, self.calls = "", 0
        self._compiled: set[int] = set()
        self._marks: list[tuple[float, float, float]] = []
        self._begun = clock.process_time()

    def begin(self) -> None:
        """Start the time of the search."""
        self._begun = clock.process_time()

    @property
    def seconds(self) -> float:
        """CPU time (s) since `begin`, less time spent `untimed`."""
        return clock.process_time() - self._begun

    @contextmanager
    def untimed(self) -> Iterator[None]:
        """Context whose time does not count."""
        before = clock.process_time()
        try:
            yield
        finally:
            self._begun += clock.process_time() - before

    def part(self, until: np.ndarray) -> float:
        """Share of the records' time that lies before `until` (r,) in s."""
        return float(np.sum(np.asarray(until) - self.begins) / np.sum(self.ends - self.begins))

    def simulate(self, x: np.ndarray, releases=None, until: np.ndarray | None = None) -> np.ndarray:
        """Return J (n,) at coordinates (n, p), and count the simulations.

        J is FAILED_OBJECTIVE where it is no number. Batches have one size, which is compiled once.

        Args:
            x: Coordinates (n, p).
            releases: Own unknowns of the records; None: those of the task.
            until: End of the samples that count (s), (r,); None: whole records.
        """
        releases, until = self.releases if releases is None else releases, self.ends if until is None else until
        batch = self.batch if len(x) > 1 else 1

        def run(points: np.ndarray) -> np.ndarray:
            full = jnp.asarray(np.resize(points, (batch, self.size)))
            return np.asarray(objectives(self.problem, releases, self.weight, jnp.asarray(until), full))[: len(points)]

        if batch not in self._compiled:
            with self.untimed():
                run(x[:1])
            self._compiled.add(batch)
        costs = np.full(len(x), FAILED_OBJECTIVE)
        for begin in range(0, len(x), batch):
            stop_if_asked()
            points = x[begin : begin + batch]
            values = run(points)
            costs[begin : begin + batch] = np.where(
                np.isfinite(values), np.minimum(np.nan_to_num(values), FAILED_OBJECTIVE), FAILED_OBJECTIVE
            )
            self.simulations += len(points) * len(self.records) * self.part(until)
            if until is self.ends:
                least = int(np.argmin(costs[begin : begin + batch]))
                self.note(points[least], float(costs[begin + least]))
            else:
                self.check()
        return costs

    def __call__(self, shares: np.ndarray) -> np.ndarray:
        """J (n,) of points (n, p) of the unit cube."""
        return self.simulate(coordinates(self.problem.space, np.asarray(shares, float)))

    def note(self, x: np.ndarray, objective: float) -> None:
        """Note a point's J over whole records, then `check`."""
        self.calls += 1
        if objective < min(self.best, FAILED_OBJECTIVE):
            self.best, self.x = objective, np.array(x)
            self._marks.append((self.simulations, self.seconds, objective))
        self.check()

    def check(self) -> None:
        """Report. Raises BudgetSpent where the budget is spent or the objective reached."""
        spent = max(self.seconds / self.budget.seconds, self.simulations / self.budget.simulations)
        self.report(Progress(self.stage, self.calls, self.best, min(1.0, spent)))
        if spent >= 1 or self.best <= self.budget.objective:
            raise BudgetSpent

    def history(self) -> History:
        """The history so far, its last entry now."""
        marks = [*self._marks, (self.simulations, self.seconds, self.best)]
        return History(*(np.array(column) for column in zip(*marks)))


class SearchMethod(Protocol):
    """Method that searches the least J over the unit cube."""

    name: ClassVar[str]

    def batch_size(self, size: int) -> int:
        """Number of points that the method asks for at once, with `size` coefficients."""

    def run(self, task: Task, random: np.random.Generator) -> None:
        """Search until done, or until the task raises BudgetSpent. All chance comes from `random`."""


def even_batch(count: int) -> int:
    """Size of batches that divide `count` points evenly into as few batches as possible."""
    return -(-count // -(-count // MAX_BATCH))
