"""Floating-wind platforms in waves, by differentiable strip theory.

The import sets JAX up for the whole process:

- float64 is switched on. `JAXHYDRO_X64=0` in the environment leaves JAX's precision alone.
- Compiled programs are kept on disk, in `~/.cache/jaxhydro/xla`, and reused by later processes. `XDG_CACHE_HOME` moves
  this folder. `JAXHYDRO_COMPILATION_CACHE=0` leaves JAX's compilation cache alone.
- XLA compiles quickly for CPUs: `XLA_FLAGS` gets `--xla_cpu_use_fusion_emitters=false`, unless it names that option. Child
  processes inherit it.

Your own JAX settings have precedence: `JAX_ENABLE_X64`, `JAX_COMPILATION_CACHE_DIR`, `JAX_ENABLE_COMPILATION_CACHE`, and a
cache folder that is set with `jax.config` before the import.
"""

from jaxhydro.jax_settings import start as _start

_start()  # before the imports below, which may compute

from jaxhydro.dynamics.conventions import Conventions
from jaxhydro.dynamics.model import Model, State
from jaxhydro.dynamics.response import Response
from jaxhydro.dynamics.rigid_body import RigidBody
from jaxhydro.dynamics.simulate import free_decay, simulate
from jaxhydro.dynamics.statics import EquilibriumError, equilibrium, natural_modes
from jaxhydro.environment import DOFS, Environment
from jaxhydro.errors import InputError
from jaxhydro.loads import LOADS, AbstractLoad, Action, Instant
from jaxhydro.parameters import Parameter
from jaxhydro.platform.build import build, load_model
from jaxhydro.platform.convergence import Convergence, convergence
from jaxhydro.platform.schema import Platform, builtin_platforms, load_platform
from jaxhydro.sensors import SENSOR_EFFECTS, AbstractSensorEffect
from jaxhydro.water import WATER_EFFECTS, AbstractWaterEffect
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

__version__ = "0.2.0"

__all__ = [
    "DOFS",
    "LOADS",
    "SENSOR_EFFECTS",
    "WATER_EFFECTS",
    "AbstractLoad",
    "AbstractSea",
    "AbstractSensorEffect",
    "AbstractWaterEffect",
    "Action",
    "Components",
    "Conventions",
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
