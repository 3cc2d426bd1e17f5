"""Local least squares within a global search, with counted simulations."""

import contextlib
from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np

from calibration.campaign.records import Record
from calibration.fitting.decay_fit import FIRST_WINDOW_CYCLES, fit_of_decays, minimise_window, run_fit
from calibration.fitting.fit import Fit, Report
from calibration.global_search.task import FAILED_OBJECTIVE, BudgetSpent, Task
from calibration.residuals.decays import DecayProblem


def simulations_per_iteration(fit: Fit) -> float:
    """Simulations that an iteration in the present window counts as.

    Each record counts once, and once more for each of its unknowns, as finite differences would take. Forward mode takes less
    time than that.
    """
    unknowns = fit.unknowns
    return len(fit.decays.records) * (1 + unknowns.shared.shape[0] + unknowns.own.shape[1]) * fit.decays.share


def fit_from(problem: DecayProblem, records: Sequence[Record], x: np.ndarray, report: Report = lambda *_: None) -> Fit:
    """Fit that begins at coordinates x, and has its vague priors about them."""
    fit = fit_of_decays(problem, records, jnp.asarray(x), report)
    has_prior = jnp.array([np.isfinite(p.prior_deviation) for p in problem.space.free], dtype=bool)
    fit.mean = jnp.where(has_prior, fit.mean, jnp.asarray(x))
    return fit


def short_fit(fit: Fit, until: np.ndarray) -> None:
    """Least squares up to `until`, with free coefficients and releases.

    The prior has next to no weight: it would become an error of the releases.

    Args:
        fit: A fit to decays.
        until: End of the window (r,) in s.
    """
    weight = fit.decays.record_weights(np.ones(len(fit.decays.records)), until)
    minimise_window(fit, "first cycles", weight, until, 1e-4, (0.0, 0.0), samples=1e12)


def rank_points(task: Task, x: np.ndarray) -> np.ndarray:
    """The points (n, p), the best first by J over the first window from a first guess of the releases."""
    guess = fit_from(task.problem, task.records, x[0])
    return x[np.argsort(task.simulate(x, guess.unknowns.own, guess.decays.window(FIRST_WINDOW_CYCLES)), kind="stable")]


def compile_fit(task: Task) -> None:
    """One iteration over next to nothing, so that what follows needs no compilation."""

    def stop(*_) -> None:
        raise BudgetSpent

    with task.untimed():
        fit = fit_from(task.problem, task.records, np.asarray(task.problem.space.start), stop)
        with contextlib.suppress(BudgetSpent):
            short_fit(fit, task.begins + 1e-3 * (fit.decays.window(FIRST_WINDOW_CYCLES) - task.begins))


class _Diverged(Exception):
    """Descent that is where simulations give no number."""


def descend(task: Task, x: np.ndarray, name: str) -> None:
    """Calibrate from coordinates x, and give up where simulations fail.

    J over whole records is noted at every iteration.
    """

    def report(stage: str, *_) -> None:
        task.stage = f"{name}: {stage}"
        task.simulations += simulations_per_iteration(fit)
        if task.simulate(np.asarray(fit.unknowns.shared)[None], fit.unknowns.own)[0] >= FAILED_OBJECTIVE:
            raise _Diverged

    fit = fit_from(task.problem, task.records, x, report)
    with contextlib.suppress(_Diverged):
        run_fit(fit)
