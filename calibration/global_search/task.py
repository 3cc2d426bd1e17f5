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
        there = np.flatnonzero(self.objective <= objective)
        return (float(self.simulations[there[0]]), float(self.seconds[there[0]])) if len(there) else None


class BudgetSpent(Exception):
    """End of a search: the budget is spent, or the objective reached. Methods must not catch it."""


class Task:
    """J over points of the unit cube, until the budget is spent; the best point and the history on the way to it.

    `own` are the records' releases that points are judged with, see `objectives`; None for a search that fits them.
    """

    def __init__(
        self,
        problem: DecayProblem,
        records: Sequence[Record],
        own,
        budget: Budget,
        report: Callable[[Progress], None] = lambda _: None,
    ) -> None:
        self.problem, self.records, self.own, self.budget, self.report = problem, records, own, budget, report
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
        """Its time counts from now."""
        self._begun = clock.process_time()

    @property
    def seconds(self) -> float:
        """CPU time (s) since it began, less what was spent `untimed`."""
        return clock.process_time() - self._begun

    @contextmanager
    def untimed(self) -> Iterator[None]:
        """What is done within does not count as time."""
        before = clock.process_time()
        try:
            yield
        finally:
            self._begun += clock.process_time() - before

    def part(self, until: np.ndarray) -> float:
        """The share of the records' time that lies before `until` (s, by record)."""
        return float(np.sum(np.asarray(until) - self.begins) / np.sum(self.ends - self.begins))

    def simulate(self, x: np.ndarray, own=None, until: np.ndarray | None = None) -> np.ndarray:
        """Return J (n,) at coordinates (n, p); FAILED_OBJECTIVE where it is no number. The simulations are counted.

        Batches have one size, which is compiled once.
        """
        own, until = self.own if own is None else own, self.ends if until is None else until
        batch = self.batch if len(x) > 1 else 1

        def run(points: np.ndarray) -> np.ndarray:
            full = jnp.asarray(np.resize(points, (batch, self.size)))
            return np.asarray(objectives(self.problem, own, self.weight, jnp.asarray(until), full))[: len(points)]

        if batch not in self._compiled:
            with self.untimed():
                run(x[:1])
            self._compiled.add(batch)
        found = np.full(len(x), FAILED_OBJECTIVE)
        for at in range(0, len(x), batch):
            stop_if_asked()
            points = x[at : at + batch]
            values = run(points)
            found[at : at + batch] = np.where(
                np.isfinite(values), np.minimum(np.nan_to_num(values), FAILED_OBJECTIVE), FAILED_OBJECTIVE
            )
            self.simulations += len(points) * len(self.records) * self.part(until)
            if until is self.ends:
                least = int(np.argmin(found[at : at + batch]))
                self.note(points[least], float(found[at + least]))
            else:
                self.check()
        return found

    def __call__(self, shares: np.ndarray) -> np.ndarray:
        """J (n,) of points (n, p) of the unit cube."""
        return self.simulate(coordinates(self.problem.space, np.asarray(shares, float)))

    def note(self, x: np.ndarray, objective: float) -> None:
        """A point's J over whole records, the best so far or not; then `check`."""
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
    """A way to look for the least J over the unit cube."""

    name: ClassVar[str]

    def batch_size(self, size: int) -> int:
        """Number of points that it asks for at once, of `size` coefficients."""

    def run(self, task: Task, random: np.random.Generator) -> None:
        """Search until done, or until the task raises BudgetSpent. All chance comes from `random`."""


def even_batch(count: int) -> int:
    """The size of a batch that divides `count` points evenly into as few as may be."""
    return -(-count // -(-count // MAX_BATCH))
