"""Simulation of a platform in a sea, and free decays."""

import math
from collections.abc import Mapping
from typing import get_args

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.choices import check, unknown
from jaxhydro.dynamics.integrate import Adjoint, Method
from jaxhydro.dynamics.irregular_simulation import simulate_irregular, simulate_steps
from jaxhydro.dynamics.model import Model, State
from jaxhydro.dynamics.response import Response
from jaxhydro.dynamics.statics import equilibrium
from jaxhydro.dynamics.table_ranges import check_waves
from jaxhydro.dynamics.time_steps import default_step, memory_step, sea_step
from jaxhydro.environment import DOFS
from jaxhydro.integrators.mixed_precision import Precision
from jaxhydro.waves.irregular_sea import IrregularSea
from jaxhydro.waves.sea import AbstractSea, StillWater
from jaxhydro.waves.sea_state import state_of


def simulate(
    model: Model,
    times: Float[Array, " t"] | np.ndarray,
    sea: AbstractSea | None = None,
    *,
    position: Mapping[str, float] | Float[Array, "6"] | None = None,
    rate: Mapping[str, float] | Float[Array, "6"] | None = None,
    step: float | None = None,
    method: Method | None = None,
    adjoint: Adjoint = "forward",
    precision: Precision = "double",
) -> Response:
    """Simulate the motion of a platform in a sea.

    The simulation starts at `times[0]` from the static equilibrium. Positions are those of the reference point, equilibrium
    included. In an `IrregularSea` the sea is first prepared for the hull (see `supports`); one of several headings is summed
    directly, which takes longer. Coefficients that depend on the sea state are then those of that sea (`Model.in_sea`).

    Methods, all at fixed steps:

    - "ab4": four-step Adams-Bashforth. Default in an `IrregularSea`, at `sea_step`.
    - "tsit5": Tsitouras 5(4) in a loop of this package. Default elsewhere, at `default_step`.
    - "rk4": the classical Runge-Kutta scheme in the same loop.
    - "diffrax": Tsitouras 5(4) by diffrax's own solver. Only its reverse gradient is cheaper than that of the loop.

    Args:
        model: The platform.
        times: Output times (s), (t,), increasing, of any spacing.
        sea: The sea; None: still water.
        position: Initial position (m, rad). By name: displacement from equilibrium, reached slowly and held. An array:
            absolute.
        rate: Initial rates of surge ... yaw (m/s, rad/s).
        step: Largest time step (s); the step taken divides the duration. None: the default of the method.
        method: Integration scheme; None: by the sea.
        adjoint: "forward" for jvp, jacfwd and least squares; "reverse" for grad of a scalar (checkpointed).
        precision: "double", or "mixed" for loads in float32. Waves' phases, positions and their sums over time stay in
            float64. Not for method "diffrax".

    Returns:
        Motion at `times`.

    Raises:
        UnknownName: Another method, adjoint, precision or motion.
        ValueError: Times do not increase, or regular waves lie outside a table of the model.
        CarriedAwayError: The platform drifts along the waves without end.
        EquilibriumError: The platform has no static equilibrium.
    """
    check(adjoint=(adjoint, get_args(Adjoint)), method=(method, (*get_args(Method), None)))
    check(precision=(precision, get_args(Precision)))
    times = jnp.asarray(times, float)
    if times.ndim != 1 or times.shape[0] < 2 or not (np.diff(np.asarray(times)) > 0).all():
        raise ValueError("times must be at least two increasing numbers")
    sea = StillWater() if sea is None else sea
    irregular = isinstance(sea, IrregularSea)
    check_waves(model, sea)
    method = ("ab4" if irregular else "tsit5") if method is None else method
    if step is None:
        step = min(sea_step(model), memory_step(model, method)) if irregular else default_step(model, method)
    named = position is None or isinstance(position, Mapping)
    memory = model.settled(by_name(position)) if named else model.rest().memory
    rest = equilibrium(model) if named else jnp.zeros(6)
    q, velocity = _initial_state(rest, by_name(position), by_name(rate))
    start = State(q, velocity, memory)
    if isinstance(sea, IrregularSea):
        model_in_sea = model.in_sea(state_of(sea.components))
        return simulate_irregular(model_in_sea, sea, start, times, step, method, adjoint, precision=precision).response
    duration = float(times[-1] - times[0])
    steps = max(1, math.ceil(duration / step - 1e-9))
    return simulate_steps(model, sea, start, times, jnp.asarray(duration / steps), steps, method, adjoint, precision)[0]


@jax.jit
def _initial_state(rest: Float[Array, "6"], position: Float[Array, "6"], rate: Float[Array, "6"]) -> tuple[Array, Array]:
    """Initial position, and velocity in body axes."""
    return rest + position, Model.body_velocity(rest + position, rate)


def free_decay(
    model: Model,
    displacement: Mapping[str, float] | Float[Array, "6"],
    times: Float[Array, " t"] | np.ndarray,
    *,
    sea: AbstractSea | None = None,
    rate: Mapping[str, float] | Float[Array, "6"] | None = None,
    step: float | None = None,
    method: Method | None = None,
    adjoint: Adjoint = "forward",
) -> Response:
    """Simulate a free decay, in still water and released at rest unless a sea or a rate is given.

    Args:
        model: The platform.
        displacement: Displacement (m, rad) from the static equilibrium, by name or (6,).
        times: Output times (s), (t,).
        sea: The sea; None: still water.
        rate: Initial rates of surge ... yaw (m/s, rad/s); None: at rest.
        step: Largest time step (s), as in `simulate`.
        method: Integration scheme, as in `simulate`.
        adjoint: "forward" or "reverse", as in `simulate`.

    Returns:
        Motion at `times`.

    Raises:
        ValueError: An angle is above pi/2, and so probably in degrees.
    """
    released = by_name(displacement)
    if bool((jnp.abs(released[3:]) > math.pi / 2).any()):
        raise ValueError(f"angles are in rad, at most pi/2 here, found {float(jnp.abs(released[3:]).max()):g}")
    position = dict(zip(DOFS, released))
    return simulate(model, times, sea, position=position, rate=rate, step=step, method=method, adjoint=adjoint)


def by_name(values: Mapping[str, float] | Float[Array, "6"] | None) -> Float[Array, "6"]:
    """Six degrees of freedom from named ones (others zero), or an array as it is.

    Raises:
        UnknownName: A name is not a degree of freedom.
    """
    if values is None:
        return jnp.zeros(6)
    if not isinstance(values, Mapping):
        return jnp.asarray(values, float)
    for name in values:
        if name not in DOFS:
            raise unknown("degree of freedom", name, DOFS)
    return jnp.stack([jnp.asarray(values.get(dof, 0.0), float) for dof in DOFS])
