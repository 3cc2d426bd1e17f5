"""Population searches over a campaign's decays, the baselines of multi-start least squares.

They see the same simulator, bounds and coordinates as `calibration.global_search`. They know nothing of releases: those are
fitted first, and offsets are eliminated in J. None of them ends of its own.
"""

import abc
from dataclasses import dataclass
from typing import Any, ClassVar

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from calibration.fitting.decay_fit import FIRST_WINDOW_CYCLES, WINDOW_GROWTH
from calibration.global_search.descents import compile_fit, fit_from, rank_points, short_fit, simulations_per_iteration
from calibration.global_search.objective import coordinates
from calibration.global_search.task import Task, even_batch

FIRST_POINTS_POWER = 5  # 2^5 points to begin with


def fit_releases(task: Task) -> Float[Array, "r 3*c"]:
    """The records' releases by least squares over their first cycles (1.25, then 3.1 of them), whose coefficients, free too,
    are thrown away. Begun from the best of a few points, none of them by chance; first guesses where that gives no number.
    Counted."""
    from scipy.stats.qmc import Sobol

    task.stage = "releases"
    x = coordinates(
        task.problem.space, Sobol(task.size, scramble=False).random_base2(FIRST_POINTS_POWER) + 0.5**FIRST_POINTS_POWER / 2
    )
    x = rank_points(task, np.concatenate([np.asarray(task.problem.space.start)[None], x]))
    compile_fit(task)

    def report(*_) -> None:
        task.simulations += simulations_per_iteration(fit)
        task.check()

    fit = fit_from(task.problem, task.records, x[0], report)
    guess = fit.unknowns.own
    for cycles in (FIRST_WINDOW_CYCLES, WINDOW_GROWTH * FIRST_WINDOW_CYCLES):
        short_fit(fit, fit.decays.window(cycles))
    return fit.unknowns.own if bool(jnp.isfinite(fit.unknowns.own).all()) else guess


@dataclass(frozen=True)
class PopulationSearch(abc.ABC):
    """A search by a population. Its fields are its options."""

    name: ClassVar[str]

    @abc.abstractmethod
    def batch_size(self, size: int) -> int:
        """Number of points that it asks for at once, of `size` coefficients."""

    @abc.abstractmethod
    def evolve(self, task: Task, random: np.random.Generator) -> None:
        """Search until the task raises BudgetSpent."""

    def run(self, task: Task, random: np.random.Generator) -> None:
        """Search, the releases fitted first where the task has none."""
        if task.releases is None:
            task.releases = fit_releases(task)
        self.evolve(task, random)


@dataclass(frozen=True)
class CMAES(PopulationSearch):
    """Covariance matrix adaptation at the default settings of the package `cma`, from a random point of the unit cube.

    `step` is the first step, of the cube's sides. Converged, it starts anew with twice the population (IPOP).

    References:
        Hansen (2016), arXiv:1604.00772; Auger and Hansen (2005), IEEE CEC, 1769-1776.
    """

    step: float = 0.25
    name: ClassVar[str] = "cma-es"

    def _population(self, size: int) -> int:
        return 4 + int(3 * np.log(size))  # arXiv:1604.00772, eq. 48

    def batch_size(self, size: int) -> int:
        """See `PopulationSearch`. Raises ValueError for one coefficient."""
        if size == 1:
            raise ValueError("cma-es: expected two coefficients or more, found 1")
        return even_batch(self._population(size))

    def evolve(self, task: Task, random: np.random.Generator) -> None:
        """See `PopulationSearch`."""
        import cma

        population = self._population(task.size)
        while True:
            task.stage = f"cma-es, population {population}"
            # its own generator: cma's default is numpy's global one; "seed" nan leaves that alone
            draw = {"seed": np.nan, "randn": lambda *shape: random.standard_normal(shape)}
            options = {"bounds": [0, 1], "popsize": population, "verbose": -10, **draw}
            strategy = cma.CMAEvolutionStrategy(random.uniform(size=task.size), self.step, options)
            while not strategy.stop():
                points = strategy.ask()
                strategy.tell(points, task(np.array(points)).tolist())
            population *= 2


@dataclass(frozen=True)
class Genetic(PopulationSearch):
    """Real-coded genetic algorithm of pymoo at its default settings; its population of 100 less one, three full batches.

    References:
        Deb and Agrawal (1995), Complex Systems 9, 115-148.
    """

    population: int = 99
    name: ClassVar[str] = "ga"

    def batch_size(self, size: int) -> int:
        """See `PopulationSearch`."""
        return even_batch(self.population)

    def evolve(self, task: Task, random: np.random.Generator) -> None:
        """See `PopulationSearch`."""
        from pymoo.algorithms.soo.nonconvex.ga import GA
        from pymoo.core.problem import Problem
        from pymoo.optimize import minimize

        class Cube(Problem):
            def __init__(self) -> None:
                super().__init__(n_var=task.size, n_obj=1, xl=0.0, xu=1.0)

            def _evaluate(self, x, out, *args: Any, **kwargs: Any) -> None:
                out["F"] = task(x)[:, None]

        task.stage = f"genetic algorithm, population {self.population}"
        minimize(Cube(), GA(pop_size=self.population), ("n_gen", 10**6), seed=int(random.integers(2**31)))


@dataclass(frozen=True)
class DifferentialEvolution(PopulationSearch):
    """Differential evolution of scipy at its default settings, best1bin, generation by generation, without a polish.

    `population` is over the number of coefficients.

    References:
        Storn and Price (1997), Journal of Global Optimization 11, 341-359.
    """

    population: int = 15
    name: ClassVar[str] = "de"

    def batch_size(self, size: int) -> int:
        """See `PopulationSearch`."""
        return even_batch(max(5, self.population * size))

    def evolve(self, task: Task, random: np.random.Generator) -> None:
        """See `PopulationSearch`."""
        from scipy.optimize import differential_evolution

        task.stage = f"differential evolution, population {max(5, self.population * task.size)}"
        differential_evolution(
            lambda shares: task(shares.T),
            [(0.0, 1.0)] * task.size,
            popsize=self.population,
            vectorized=True,
            updating="deferred",
            polish=False,
            tol=0.0,
            maxiter=10**6,
            rng=random,
        )


POPULATIONS: dict[str, type[PopulationSearch]] = {method.name: method for method in (CMAES, DifferentialEvolution, Genetic)}
