"""Residuals of static offsets and of natural periods."""

from collections.abc import Mapping, Sequence
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from calibration.campaign.manifest_sections import Period
from calibration.campaign.records import Record
from calibration.parameters.space import ParameterSpace
from calibration.residuals.abstract_residual import AbstractGroupedResidual
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.natural_modes import strain_energy
from jaxhydro.dynamics.observe import changes_readings, reading_at
from jaxhydro.dynamics.statics import characteristic_length, equilibrium, held_at, linearised
from jaxhydro.environment import DOFS

MODE_SHARE = 0.7  # of a mode's largest share of strain energy: surge and sway of one period may come mixed
EIGENVALUE_SHIFT = 1e-4  # of an eigenvalue, off which inverse iterations are shifted
NEWTON_STEPS = 3  # steps of Newton's method, where sensors track another point


class OffsetProblem(AbstractGroupedResidual):
    """Mean offsets of static tests in which an unknown force holds one motion.

    The held motion is where it was measured; the others follow from balance. A residual is a share of the held motion. An
    angle counts as the platform's characteristic length (m) times it.
    """

    model: Model
    space: ParameterSpace = eqx.field(static=True)
    tail: Float[Array, "1"] | None
    measured: Float[Array, "s 6"]  # m, rad; from the position measured as zero
    unit: Float[Array, "s 6"]  # m, rad: what counts as 1
    held: tuple[int, ...] = eqx.field(static=True)
    compared: tuple[tuple[int, int], ...] = eqx.field(static=True)  # test and motion
    from_rest: bool = eqx.field(static=True)

    def readings(self, x: Float[Array, " p"]) -> Float[Array, "s 6"]:
        """Simulated readings in every test (m, rad), from the position measured as zero."""
        model = self.space.model(self.model, x)
        base = equilibrium(model) if self.from_rest else jnp.zeros(6)

        def reading(dof: int, position: Float[Array, ""]) -> Float[Array, "6"]:
            return reading_at(model, held_at(model, dof, position)) - reading_at(model, base)

        def held(dof: int, measured: Float[Array, ""]) -> Float[Array, ""]:
            """Held motion of the platform with which the tracked point reads the measured value (Newton)."""

            def corrected(_: int, position: Float[Array, ""]) -> Float[Array, ""]:
                value, slope = jax.jvp(lambda position: reading(dof, position)[dof], (position,), (jnp.ones_like(position),))
                return position + (measured - value) / slope

            return jax.lax.fori_loop(0, NEWTON_STEPS if changes_readings(model) else 0, corrected, measured + base[dof])

        return jnp.stack([reading(dof, held(dof, q[dof])) for dof, q in zip(self.held, self.measured, strict=True)])

    def residuals(self, x: Float[Array, " p"]) -> tuple[Float[Array, " n"]]:
        off = (self.readings(x) - self.measured) / self.unit
        return (off[tuple(jnp.array(self.compared).T)],)


def set_up_offsets(model: Model, records: Sequence[Record], space: ParameterSpace, from_rest: bool) -> OffsetProblem:
    """Set up static tests with a `degree_of_freedom`, which is the motion that was held."""
    length = characteristic_length(model)
    lengths = np.array([1.0, 1.0, 1.0, length, length, length])
    shape = (len(records), 6)
    measured, unit = np.zeros(shape), np.ones(shape)
    held, compared = [], []
    for i, record in enumerate(records):
        dof = DOFS.index(str(record.degree_of_freedom))
        held.append(dof)
        for name, values in record.values.items():
            measured[i, DOFS.index(name)] = float(np.mean(values))
            compared += [(i, DOFS.index(name))] if DOFS.index(name) != dof else []
        unit[i] = max(abs(measured[i, dof]) * lengths[dof], 1e-3) / lengths
    arrays = (jnp.asarray(measured), jnp.asarray(unit))
    return OffsetProblem(model, space, None, *arrays, tuple(held), tuple(compared), from_rest)


class PeriodProblem(AbstractGroupedResidual):
    """Residuals of stated natural periods: ln(T / stated) over the relative standard deviation.

    T is the period of the undamped natural mode in which the motion has the largest strain energy (`natural_modes`).
    """

    model: Model
    space: ParameterSpace = eqx.field(static=True)
    tail: Float[Array, "1"] | None
    stated: Float[Array, " n"]  # s
    deviation: Float[Array, " n"]  # relative
    dofs: tuple[int, ...] = eqx.field(static=True)

    def periods(self, x: Float[Array, " p"]) -> Float[Array, " n"]:
        """Natural periods (s)."""
        model = self.space.model(self.model, x)
        return jnp.stack([natural_period(model, dof) for dof in self.dofs])

    def residuals(self, x: Float[Array, " p"]) -> tuple[Float[Array, " n"]]:
        return (jnp.log(self.periods(x) / self.stated) / self.deviation,)


def natural_period(model: Model, dof: int) -> Float[Array, ""]:
    """Natural period (s) of a motion as `natural_modes(model).of`, differentiable.

    T = 2 pi (l M r / l K r)^0.5, with l and r the left and right eigenvectors of M^-1 K. Their own change is of second order
    in T. They come from the symmetric part of K, and by two inverse iterations from K itself.

    Args:
        model: The platform.
        dof: Number of the motion.

    Returns:
        The period; NaN where nothing restores the motion.

    References:
        Fox and Kapoor 1968, AIAA Journal 6, 2426-2429.
    """
    mass, stiffness = linearised(model, equilibrium(model))
    m, k = jax.lax.stop_gradient((mass, stiffness))
    half = jnp.linalg.cholesky(m)

    def scaled(matrix: Float[Array, "6 6"]) -> Float[Array, "6 6"]:
        inner = jax.scipy.linalg.solve_triangular(half, matrix, lower=True)
        return jax.scipy.linalg.solve_triangular(half, inner.T, lower=True).T

    whole = scaled(k)
    square, vectors = jnp.linalg.eigh(0.5 * (whole + whole.T))
    share = strain_energy(k, jax.scipy.linalg.solve_triangular(half.T, vectors, lower=False))
    candidates = (share[dof] > MODE_SHARE * share.max(axis=0)) & (square > 1e-10 * jnp.abs(square).max())
    mode = jnp.argmin(jnp.where(candidates, square, jnp.inf))
    right = left = vectors[:, mode]
    near = whole - square[mode] * (1 + EIGENVALUE_SHIFT) * jnp.eye(6)
    for _ in range(2):
        right, left = (x / jnp.linalg.norm(x) for x in (jnp.linalg.solve(near, right), jnp.linalg.solve(near.T, left)))
    right, left = (jax.scipy.linalg.solve_triangular(half.T, x, lower=False) for x in (right, left))
    period = 2 * jnp.pi * jnp.sqrt((left @ mass @ right) / (left @ stiffness @ right))
    return jnp.where(candidates.any(), period, jnp.nan)


def set_up_periods(model: Model, stated: Mapping[Any, Period], space: ParameterSpace, scale: float) -> PeriodProblem:
    """Set up periods that are stated by motion, at the scale of the files."""
    values = jnp.array([period.value * scale**0.5 for period in stated.values()])
    deviations = jnp.array([period.standard_deviation / period.value for period in stated.values()])
    return PeriodProblem(model, space, None, values, deviations, tuple(DOFS.index(dof) for dof in stated))
