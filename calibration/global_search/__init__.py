"""Global searches for a starting point: interchangeable methods, run by `run_search`."""

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
