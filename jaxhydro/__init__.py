"""Floating-wind platforms in waves, by differentiable strip theory. Switch JAX's float64 on before building a model."""

from jaxhydro.convergence import Convergence, convergence
from jaxhydro.environment import DOFS, Environment
from jaxhydro.loads import LOADS, AbstractLoad, Action, Instant, Parameter
from jaxhydro.model import Model, RigidBody, State
from jaxhydro.platform import build, load_model
from jaxhydro.platform_schema import Platform, builtin_platforms, load_platform
from jaxhydro.problems import InputError
from jaxhydro.response import Response
from jaxhydro.simulate import free_decay, simulate
from jaxhydro.statics import EquilibriumError, equilibrium, natural_modes
from jaxhydro.waves import (
    AbstractSea,
    Components,
    IrregularSea,
    StillWater,
    WaveSea,
    jonswap,
    record_components,
    regular_wave,
    spectrum_components,
)

__version__ = "0.1.0"

__all__ = [
    "DOFS",
    "LOADS",
    "AbstractLoad",
    "AbstractSea",
    "Action",
    "Components",
    "Convergence",
    "Environment",
    "EquilibriumError",
    "InputError",
    "Instant",
    "IrregularSea",
    "Model",
    "Parameter",
    "Platform",
    "Response",
    "RigidBody",
    "State",
    "StillWater",
    "WaveSea",
    "build",
    "builtin_platforms",
    "convergence",
    "equilibrium",
    "free_decay",
    "jonswap",
    "load_model",
    "load_platform",
    "natural_modes",
    "record_components",
    "regular_wave",
    "simulate",
    "spectrum_components",
]
