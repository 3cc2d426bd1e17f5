"""Global search over the coefficients that a campaign's decays determine."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import jax.numpy as jnp
import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.records import Record
from calibration.fitting.decay_fit import prepare_fit
from calibration.fitting.progress import Progress
from calibration.global_search.multistart import MultiStart
from calibration.global_search.objective import ranges
from calibration.global_search.task import Budget, BudgetSpent, History, SearchMethod, Task
from calibration.parameters.space import parameter_space
from calibration.residuals.decays import DecayProblem
from jaxhydro.interrupts import stopping

DEFAULT_FACTOR = 10.0  # a coefficient without bounds is searched from a tenth to ten times of what the platform declares


@dataclass(frozen=True, eq=False)
class Found:
    """Result of a global search.

    Attributes:
        method: Name of the method.
        seed: Seed of the random numbers.
        values: Coefficients of the lowest J by label; continue with `calibrate(campaign, start=found.values)`.
        objective: Their J over whole records, with the releases that the search used.
        simulations: Number of simulations of a record; a part of one counts as that part.
        seconds: CPU time (s), compilation apart.
        history: Lowest J against simulations and time.
        ended: "settled" by itself, "reached" the objective asked for, "budget" or "interrupted".
    """

    method: str
    seed: int
    values: dict[str, float]
    objective: float
    simulations: float
    seconds: float
    history: History
    ended: Literal["settled", "reached", "budget", "interrupted"]


class SearchInterrupted(KeyboardInterrupt):
    """Interruption of a search by the user (Ctrl-C).

    Attributes:
        partial: Result that was reached; None if there is none.
    """

    def __init__(self, partial: Found | None) -> None:
        super().__init__("search interrupted")
        self.partial = partial


def search(
    campaign: Campaign,
    *,
    starts: int = MultiStart.starts,
    finalists: int = MultiStart.finalists,
    seed: int = 0,
    budget: Budget = Budget(),
    free: Sequence[str] | None = None,
    factor: float = DEFAULT_FACTOR,
    progress: Callable[[Progress], None] | None = None,
) -> Found:
    """Search globally for the coefficients of lowest J for the decay records marked `fit`.

    J is the sum of RMSE / standard deviation over the records' released degrees of freedom. The search covers the
    manifest's bounds. Where it has none, it covers 1/`factor` to `factor` times the platform's value. Positive coefficients
    are on a logarithmic scale. Priors are not used. Releases and offsets are fitted with the coefficients.

    Args:
        campaign: The campaign.
        starts: Number of starting points that are ranked by their first cycles.
        finalists: Number of the best starting points that least squares are begun from.
        seed: Seed of the random numbers. The same seed gives the same search, unless seconds end it.
        budget: When the search ends.
        free: Labels or patterns of the free parameters; None for those of the manifest.
        factor: Factor of the range of coefficients without bounds.
        progress: Function that is called with the progress.

    Returns:
        The coefficients of lowest J, and the history of the search.

    Raises:
        ValueError: If an option is invalid.
        InputError: If there is nothing to search, or bounds are missing.
        SearchInterrupted: If the user stops the search (a KeyboardInterrupt); it holds what was reached.
    """
    if not (isinstance(seed, int) and not isinstance(seed, bool) and seed >= 0):
        raise ValueError(f"seed: expected a whole number from 0, found {seed!r}")
    if not factor > 1:
        raise ValueError(f"factor: expected a number above 1, found {factor!r}")
    if not (budget.seconds > 0 and budget.simulations > 0):
        raise ValueError(f"budget: expected seconds and simulations above 0, found {budget.seconds!r}, {budget.simulations!r}")
    method = MultiStart(starts, finalists)
    problem, records = set_up_search(campaign, free, factor)
    task = Task(problem, records, None, budget, progress or (lambda _: None))
    return run(task, method, seed)


def run(task: Task, method: SearchMethod, seed: int) -> Found:
    """Run a search on a task, beginning now.

    Raises ValueError where the budget is too small for anything, SearchInterrupted with what was reached.
    """
    ended: Literal["settled", "reached", "budget", "interrupted"] = "settled"
    task.batch = method.batch_size(task.size)
    try:
        task.begin()
        method.run(task, np.random.default_rng(seed))
    except BudgetSpent:
        ended = "reached" if task.best <= task.budget.objective else "budget"
    except KeyboardInterrupt:
        stopping()
        ended = "interrupted"
    history, space = task.history(), task.problem.space
    result = None
    if math.isfinite(task.best):
        values = {label: float(value) for label, value in space.values(jnp.asarray(task.x)).items()}
        spent = (float(history.simulations[-1]), float(history.seconds[-1]))
        result = Found(method.name, seed, values, task.best, *spent, history, ended)
    if ended == "interrupted":
        raise SearchInterrupted(result)
    if result is None:
        raise ValueError(f"budget: expected enough for one simulation of every record, found {task.budget}")
    return result


def set_up_search(
    campaign: Campaign, free: Sequence[str] | None = None, factor: float = DEFAULT_FACTOR
) -> tuple[DecayProblem, tuple[Record, ...]]:
    """Set up the problem of a search, and its records.

    Raises:
        InputError: There is nothing to search, or bounds are missing.
    """
    decays = prepare_fit(campaign, free=free).decays
    model, labels, source = decays.problem.model, decays.problem.space.labels, str(campaign.folder / "campaign.yaml")
    bounds = ranges(model, labels, dict(campaign.manifest.calibrate.bounds), factor, source)
    space = parameter_space(model, labels, bounds, None, source)
    return replace(decays.problem, space=space), decays.records
