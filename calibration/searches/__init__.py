"""Global searches: one file each, interchangeable. `calibration.search` is how they are used."""

from calibration.searches.base import AbstractSearch, Budget, History, Stop, Task
from calibration.searches.cma_es import CMAES
from calibration.searches.differential_evolution import DifferentialEvolution
from calibration.searches.genetic import Genetic
from calibration.searches.multistart import MultiStart

METHODS: dict[str, type[AbstractSearch]] = {
    search.name: search for search in (MultiStart, CMAES, Genetic, DifferentialEvolution)
}

__all__ = [
    "CMAES", "METHODS", "AbstractSearch", "Budget", "DifferentialEvolution", "Genetic", "History", "MultiStart", "Stop", "Task",
]  # fmt: skip
