"""Local least squares within a global search, with counted simulations."""

import contextlib
from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np

from calibration.campaign.records import Record
from calibration.fitting.decay_fit import FIRST_WINDOW_CYCLES, DecayFit, record_weights, run_fit
from calibration.global_search.task import FAILED_OBJECTIVE, BudgetSpent, Task
from calibration.residuals.decays import DecayProblem, Unknowns, first_guess


class WindowedFit(DecayFit):
    """A fit that knows which part of the records' time its present stage simulates."""

    part = 1.0

    def minimise(self, stage: str, weight, until, *rest, **named) -> bool:
        begin = np.asarray(self.problem.data.time[:, 0])
        self.part = float(np.sum(np.asarray(until) - begin) / np.sum(np.asarray(self.ends) - begin))
        return super().minimise(stage, weight, until, *rest, **named)

    @property
    def simulations_per_iteration(self) -> int:
        """Simulations that a whole iteration counts as: of every record one, and one for each of its unknowns, as finite
        differences would take; forward mode takes less time than that."""
        unknowns = self.unknowns
        return len(self.records) * (1 + unknowns.shared.shape[0] + unknowns.own.shape[1])


def fit_from(problem: DecayProblem, records: Sequence[Record], x: np.ndarray, report) -> WindowedFit:
    """A fit that begins, and has its vague priors, at coordinates x."""
    fit = WindowedFit(problem, records, Unknowns(jnp.asarray(x), first_guess(records, problem.data)), report)
    mean, precision = fit.prior
    declared = jnp.array([np.isfinite(p.prior_deviation) for p in problem.space.free], dtype=bool)
    fit.prior = (jnp.where(declared, mean, jnp.asarray(x)), precision)
    return fit


def short_fit(fit: DecayFit, until: np.ndarray) -> None:
    """Least squares up to `until`, coefficients and releases free. Next to no prior: it would be the releases' error."""
    weight = record_weights(fit.records, fit.problem.data, fit.scored, fit.spread, np.ones(len(fit.records)), until)
    fit.minimise("first cycles", weight, until, 1e-4, (0.0, 0.0), samples=1e12)


def rank_points(task: Task, x: np.ndarray) -> np.ndarray:
    """The points (n, p), the best first by J over the first window from a first guess of the releases."""
    guess = fit_from(task.problem, task.records, x[0], lambda *_: None)
    return x[np.argsort(task.simulate(x, guess.unknowns.own, guess.window(FIRST_WINDOW_CYCLES)), kind="stable")]


def compile_fit(task: Task) -> None:
    """One iteration over next to nothing, so that what follows needs no compilation."""

    def stop(*_) -> None:
        raise BudgetSpent

    with task.untimed():
        fit = fit_from(task.problem, task.records, np.asarray(task.problem.space.start), stop)
        with contextlib.suppress(BudgetSpent):
            short_fit(fit, task.begins + 1e-3 * (fit.window(FIRST_WINDOW_CYCLES) - task.begins))


class _Diverged(Exception):
    """A descent is where simulations give no number."""


def descend(task: Task, x: np.ndarray, name: str) -> None:
    """A whole calibration from coordinates x, given up where it is lost; J over whole records is noted at every iteration."""

    def report(stage: str, *_) -> None:
        task.stage = f"{name}: {stage}"
        task.simulations += fit.simulations_per_iteration * fit.part
        if task.simulate(np.asarray(fit.unknowns.shared)[None], fit.unknowns.own)[0] >= FAILED_OBJECTIVE:
            raise _Diverged

    fit = fit_from(task.problem, task.records, x, report)
    with contextlib.suppress(_Diverged):
        run_fit(fit)
