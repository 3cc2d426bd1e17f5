"""Covariance matrix adaptation (CMA-ES), by the package `cma`."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from calibration.global_search.base import AbstractSearch, Task, even_batch


@dataclass(frozen=True)
class CMAES(AbstractSearch):
    """Covariance matrix adaptation (Hansen 2016, arXiv:1604.00772) at its default settings, from a random point of the cube
    with a step of `step` of its sides; started anew with twice the population where it has converged (IPOP: Auger and Hansen
    2005, IEEE CEC, 1769-1776). Without an end of its own.
    """

    step: float = 0.25
    name: ClassVar[str] = "cma-es"
    needs: ClassVar[str | None] = "cma"

    def _population(self, size: int) -> int:
        return 4 + int(3 * np.log(size))  # arXiv:1604.00772, eq. 48

    def batch_size(self, size: int) -> int:
        if size == 1:
            raise ValueError("cma-es: expected two coefficients or more, found 1")
        return even_batch(self._population(size))

    def run(self, task: Task, random: np.random.Generator) -> None:
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
