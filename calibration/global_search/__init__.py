"""Global searches: one file each, interchangeable. `calibration.global_search.run_search` is how they are used."""

from calibration.global_search.base import AbstractSearch, Budget, BudgetSpent, History, Task
from calibration.global_search.cma_es import CMAES
from calibration.global_search.differential_evolution import DifferentialEvolution
from calibration.global_search.genetic import Genetic
from calibration.global_search.multistart import MultiStart

METHODS: dict[str, type[AbstractSearch]] = {
    search.name: search for search in (MultiStart, CMAES, Genetic, DifferentialEvolution)
}

__all__ = [
    "CMAES",
    "METHODS",
    "AbstractSearch",
    "Budget",
    "BudgetSpent",
    "DifferentialEvolution",
    "Genetic",
    "History",
    "MultiStart",
    "Task",
]
