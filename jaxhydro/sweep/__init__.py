"""Sweeps: one platform in every sea state of a scatter table, with every heading, with every seed: `run_sweep`."""

from jaxhydro.sweep.load import load_sweep
from jaxhydro.sweep.run import Progress, run_sweep
from jaxhydro.sweep.schema import Sweep
from jaxhydro.sweep.sensitivity import Sensitivity, lifetime_sensitivity

__all__ = ["Progress", "Sensitivity", "Sweep", "lifetime_sensitivity", "load_sweep", "run_sweep"]
