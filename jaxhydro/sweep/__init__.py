"""Sweeps: one platform in every sea state of a scatter table, with every heading and every seed."""

from jaxhydro.sweep.execute import Progress, run_sweep
from jaxhydro.sweep.sensitivity import Sensitivity, lifetime_sensitivity
from jaxhydro.sweep.sweep_file import load_sweep
from jaxhydro.sweep.sweep_schema import Sweep

__all__ = ["Progress", "Sensitivity", "Sweep", "lifetime_sensitivity", "load_sweep", "run_sweep"]
