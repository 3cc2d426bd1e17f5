"""Genetic algorithm, by pymoo."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from calibration.global_search.base import AbstractSearch, Task, even_batch


@dataclass(frozen=True)
class Genetic(AbstractSearch):
    """pymoo's real-coded genetic algorithm at its default settings: tournament selection, simulated binary crossover and
    polynomial mutation (Deb and Agrawal 1995, Complex Systems 9, 115-148), the best of parents and children kept. Without an
    end of its own. The population is pymoo's 100 less one: three full batches."""

    population: int = 99
    name: ClassVar[str] = "ga"
    needs: ClassVar[str | None] = "pymoo"

    def batch_size(self, size: int) -> int:
        return even_batch(self.population)

    def run(self, task: Task, random: np.random.Generator) -> None:
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
