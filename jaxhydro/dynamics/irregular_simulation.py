"""Simulation in an irregular sea, which is prepared for the hull."""

import math
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.dynamics.integrate import Adjoint, Grid, Method, clock, integrate
from jaxhydro.dynamics.model import Model, State
from jaxhydro.dynamics.response import Response
from jaxhydro.dynamics.table_ranges import heading_fault
from jaxhydro.dynamics.time_steps import steps_in
from jaxhydro.exported_programs import exported_jit
from jaxhydro.integrators.adams_bashforth_coefficients import START_STEPS
from jaxhydro.integrators.mixed_precision import Precision
from jaxhydro.quick_jit import on_device
from jaxhydro.rotations import rotation
from jaxhydro.waves.irregular_sea import EXCURSION, IrregularSea
from jaxhydro.waves.sea import AbstractSea
from jaxhydro.waves.support_sea import SupportSea
from jaxhydro.waves.wave_sea import WaveSea

MAX_PAIRS = 10_000  # pairs of components of which the second order of a sea of several headings is summed directly


class CarriedAwayError(ValueError):
    """The platform drifts along the waves without end."""


def excursion_of(model: Model) -> float:
    """Drift (m) along the waves beyond which a sea is prepared anew: 20 m at the size of VolturnUS-S."""
    return EXCURSION * float(model.size)


@exported_jit
def simulate_steps(
    model: Model,
    sea: AbstractSea,
    start: State,
    times: Float[Array, " t"],
    step: Float[Array, ""],
    steps: int,
    method: Method,
    adjoint: Adjoint,
    precision: Precision = "double",
) -> tuple[Response, Grid]:
    """Simulate a number of equal steps from a state.

    Args:
        model: The platform, with its coefficients in this sea.
        sea: The sea.
        start: Initial state.
        times: Output times (s), (t,).
        step: Time step (s).
        steps: Number of steps.
        method: Integration scheme.
        adjoint: As in `simulate`.
        precision: As in `simulate`.

    Returns:
        Motion at the output times, and motion at the ends of all steps.
    """
    grid = integrate(model, sea, start, times[0], step, steps, method, adjoint, precision=precision)
    return Response(times, *grid.at(times)), grid


def summed_directly(model: Model, sea: IrregularSea) -> WaveSea:
    """A sea of several headings by direct summation, for the tables of a model.

    Raises:
        ValueError: A table of the model has not all of its headings, or its second order has too many pairs.
    """
    if (fault := heading_fault(model, np.asarray(sea.components.heading))) is not None:
        raise ValueError(f"expected {fault[0]}, found {fault[1]}")
    count = sea.components.omega.size
    if sea.order == 2 and count**2 > MAX_PAIRS:
        raise ValueError(too_many_pairs(count))
    return sea.direct()


def too_many_pairs(count: int) -> str:
    """Why a sea of several headings and so many components is not simulated at second order."""
    most = math.isqrt(MAX_PAIRS)
    return (
        f"at second order a sea of several headings is the sum over all pairs of its components: {most} components at most, "
        f"found {count}. Take order 1, one heading, or a shorter duration"
    )


class IrregularSimulation(NamedTuple):
    """Simulation in an irregular sea.

    Attributes:
        response: Motion at the times asked for.
        grid: Motion at the ends of all steps.
        sea: The sea as it was prepared; one of several headings by direct summation.
        step: Time step (s).
        steps: Number of steps.
    """

    response: Response
    grid: Grid
    sea: SupportSea | WaveSea
    step: float
    steps: int


def simulate_irregular(
    model: Model,
    sea: IrregularSea,
    start: State,
    times: Float[Array, " t"],
    limit: float,
    method: Method = "ab4",
    adjoint: Adjoint = "forward",
    margin: float = 0.0,
    precision: Precision = "double",
) -> IrregularSimulation:
    """Simulate in an irregular sea, prepared anew for a larger box where the platform leaves the first.

    A sea of several headings is summed directly.

    Args:
        model: The platform, with its coefficients in this sea.
        sea: The sea.
        start: Initial state.
        times: Output times (s), (t,).
        limit: Largest time step (s); the step taken divides the sea's period.
        method: Integration scheme.
        adjoint: As in `simulate`.
        margin: Distance (m) that the last box has to spare.
        precision: As in `simulate`.

    Returns:
        The motion, and the sea and steps that were used.

    Raises:
        CarriedAwayError: The platform drifts without end.
    """
    begin = float(times[0])
    if not sea.long_crested:
        duration = float(times[-1] - times[0])
        steps = max(START_STEPS, math.ceil(duration / limit - 1e-9))
        met = summed_directly(model, sea)
        response, grid = simulate_steps(
            model, met, start, times, jnp.asarray(duration / steps), steps, method, adjoint, precision
        )
        return IrregularSimulation(response, grid, met, duration / steps, steps)
    step, steps = steps_in(sea, float(times[-1] - times[0]), limit)
    points, first_excursion = model.hull.extremities(), excursion_of(model)
    excursion = first_excursion
    computed: Any = {"transfer": model.transfer, "exciting": model.excitation}
    while True:
        prepared = sea.prepared(points, model.cylinders, clock(method, begin, step, steps), excursion, **computed)
        response, grid = simulate_steps(model, prepared, start, times, jnp.asarray(step), steps, method, adjoint, precision)
        box: Any = model.through(prepared)  # with the box moved where the sea is
        reached = float(_farthest(response.position, on_device(points), box))
        if not reached + margin > prepared.half:
            return IrregularSimulation(response, grid, prepared, step, steps)
        if reached > prepared.half + 10 * first_excursion:
            raise CarriedAwayError(f"the platform is carried {reached:.3g} m along the waves: check mooring, step and sea")
        excursion += reached + margin - prepared.half + 0.5 * first_excursion


def farthest(position: Float[Array, "t 6"], points: Float[Array, "3 p"], sea: SupportSea) -> Float[Array, ""]:
    """Largest distance (m) of the hull from the middle of the sea's box, along the waves.

    Args:
        position: Positions (m, rad) over time, (t, 6).
        points: Extremities of the hull (m), (3, p).
        sea: The prepared sea.
    """
    along = jax.vmap(lambda q: sea.along @ (q[:2, None] + rotation(q[3:])[:2] @ points) - sea.middle)(position)
    return jnp.abs(along).max()


_farthest = exported_jit(farthest)
