"""Exact derivatives of a lifetime statistic with respect to coefficients."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.choices import unknown
from jaxhydro.dynamics.integrate import integrate
from jaxhydro.dynamics.model import Model, State
from jaxhydro.dynamics.statics import equilibrium
from jaxhydro.environment import DOFS
from jaxhydro.sweep.batch import pace_of_platform, prepared_for, sea_of, setup_of
from jaxhydro.sweep.cases import plan_of
from jaxhydro.sweep.sweep_schema import Sweep
from jaxhydro.waves.sea_state import SeaState, state_of
from jaxhydro.waves.support_sea import SupportSea


class Sensitivity(NamedTuple):
    """Lifetime standard deviation of a motion and its derivatives.

    Attributes:
        value: Lifetime standard deviation (m or rad).
        gradient: Derivative with respect to each coefficient, by label, per the coefficient's unit.
        deviation: Standard deviation of each run (m or rad), (case, seed).
        gradients: Derivatives of `deviation` by label, (case, seed).
    """

    value: float
    gradient: dict[str, float]
    deviation: Float[np.ndarray, "case seed"]
    gradients: dict[str, Float[np.ndarray, "case seed"]]


def lifetime_sensitivity(sweep: Sweep, labels: Sequence[str], dof: str = "surge") -> Sensitivity:
    """Derivatives of the lifetime standard deviation sqrt(sum p s²) with respect to coefficients.

    s is the standard deviation of the motion about its mean in each run. Derivatives are by forward mode. The seas, their
    probabilities, steps and transient are those of the sweep. A coefficient with a sea-state law moves with its value at the
    reference sea state.

    The static equilibrium is held. That is right for drag, damping and added mass, not for stiffness. Runs are done one
    after the other in this process, so it is for some tens of them.

    Args:
        sweep: The sweep.
        labels: Labels of the coefficients.
        dof: Degree of freedom.

    Returns:
        Value and derivatives.

    Raises:
        UnknownName: An unknown label or degree of freedom (a KeyError).
        InputError: The sweep has mistakes, or a sea is impossible.
        EquilibriumError: The platform has no static equilibrium.
        ValueError: The platform leaves the box that its sea was prepared for.
    """
    plan, _ = plan_of(sweep, "sweep", pace_of_platform(sweep.platform))
    setup = setup_of(plan, sweep.platform, None if sweep.calibration is None else Path(sweep.calibration))
    for label in labels:
        setup.model.about(label)
    column = DOFS.index(dof) if dof in DOFS else _no_motion(dof)
    times, after_start = jnp.asarray(setup.times), jnp.asarray(setup.times >= plan.start)
    values = jnp.stack([jnp.asarray(setup.model.values[label], float) for label in labels])
    deviation = np.zeros((len(plan.cases), len(plan.seeds)))
    slopes = np.zeros((len(labels), *deviation.shape))
    for number in range(len(plan)):
        run = plan.run(number)
        sea = sea_of(setup, run)
        state = state_of(sea.components)
        model_in_sea = setup.model.in_sea(state)
        start = State(equilibrium(model_in_sea), jnp.zeros(6), model_in_sea.settled(jnp.zeros(6)))
        prepared, step, steps = prepared_for(model_in_sea, sea, setup.times, setup.limit)
        how = (
            setup.model,
            prepared,
            start,
            jax.tree.map(jnp.asarray, state),
            times,
            after_start,
            jnp.asarray(step),
            steps,
            tuple(labels),
            column,
        )
        run_deviation, slope, reached = _with_slope(values, *how)
        if not float(reached) <= prepared.half:
            far = f"moves {float(reached):.3g} m along the waves in run {number}"
            raise ValueError(f"the platform {far}: too far for a derivative")
        deviation[run.row, run.column], slopes[:, run.row, run.column] = float(run_deviation), np.asarray(slope)
    probability = np.array([case.probability for case in plan.cases])[:, None] / len(plan.seeds)
    value = math.sqrt(float(np.sum(probability * deviation**2)))
    total = (probability * deviation * slopes).sum(axis=(1, 2)) / value
    return Sensitivity(value, dict(zip(labels, total.tolist())), deviation, dict(zip(labels, slopes)))


@eqx.filter_jit
def _with_slope(
    values: Float[Array, " l"],
    model: Model,
    sea: SupportSea,
    start: State,
    state: SeaState,
    times: Float[Array, " t"],
    after_start: Float[Array, " t"],
    step: Float[Array, ""],
    steps: int,
    labels: tuple[str, ...],
    column: int,
) -> tuple[Float[Array, ""], Float[Array, " l"], Float[Array, ""]]:
    """Standard deviation of a motion, its derivatives, and the largest distance (m) from the box's middle."""

    def deviation(values: Float[Array, " l"]):
        model_in_sea = model.with_values(dict(zip(labels, values))).in_sea(state)
        position = integrate(model_in_sea, sea, start, times[0], step, steps, "ab4", "forward").at(times)[0]
        x, count = position[:, column], after_start.sum()
        mean = jnp.sum(x * after_start) / count
        value = jnp.sqrt(jnp.sum(after_start * (x - mean) ** 2) / count)
        return value, (value, jnp.abs(position[:, :2] @ sea.along - sea.middle).max())

    slope, (value, reached) = jax.jacfwd(deviation, has_aux=True)(values)
    return value, slope, reached


def _no_motion(dof: str) -> int:
    raise unknown("degree of freedom", dof, DOFS)
