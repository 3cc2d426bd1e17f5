"""Differential evolution, by scipy."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from calibration.global_search.base import AbstractSearch, Task, even_batch


@dataclass(frozen=True)
class DifferentialEvolution(AbstractSearch):
    """scipy's differential evolution at its default settings, best1bin (Storn and Price 1997, Journal of Global Optimization
    11, 341-359), generation by generation; `population` times as many points as there are coefficients. Without an end of its
    own, and without a polish at it."""

    population: int = 15
    name: ClassVar[str] = "de"

    def batch_size(self, size: int) -> int:
        return even_batch(max(5, self.population * size))

    def run(self, task: Task, random: np.random.Generator) -> None:
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
