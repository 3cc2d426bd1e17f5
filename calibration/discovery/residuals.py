"""Records against a model that may have more than was declared: residuals, and their slopes along any few directions.

Which directions is data, so that one compiled program scores every candidate effect and refits any few of them.
"""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from calibration.parameters.space import ParameterSpace
from calibration.residuals.decays import DecayData, DecayProblem
from jaxhydro.dynamics.integrate import Grid, integrate
from jaxhydro.dynamics.model import Model, State
from jaxhydro.dynamics.observe import observe
from jaxhydro.dynamics.statics import equilibrium
from jaxhydro.waves.support_sea import SupportSea

ROUNDING = 1e-6  # of a step


class Frame(NamedTuple):
    """Coordinates x = origin + basis z of all parameters, z the few along which one looks."""

    origin: Float[Array, " p"]
    basis: Float[Array, "p q"]


def _record_residual(
    problem: DecayProblem, x: Float[Array, " p"], own: Float[Array, " o"], record: DecayData
) -> Float[Array, "c t"]:
    return (problem.motion(x, own, record) - record.measured) * record.present


@eqx.filter_jit
def decay_residuals(problem: DecayProblem, x: Float[Array, " p"], own: Float[Array, "r o"]) -> Float[Array, "r c t"]:
    """Simulated less measured, zero where there is no sample."""
    return jax.lax.map(lambda one: _record_residual(problem, x, *one), (own, problem.data))


@eqx.filter_jit
def decay_slopes(
    problem: DecayProblem, frame: Frame, own: Float[Array, "r o"]
) -> tuple[Float[Array, "r c t"], Float[Array, "r c t k"]]:
    """Residuals, and their slopes along the directions and the records' own unknowns."""
    q = frame.basis.shape[1]

    def of_record(inputs):
        own, record = inputs

        def residual(both):
            r = _record_residual(problem, frame.origin + frame.basis @ both[:q], both[q:], record)
            return r, r

        slopes, r = jax.jacfwd(residual, has_aux=True)(jnp.concatenate([jnp.zeros(q), own]))
        return r, slopes

    return jax.lax.map(of_record, (own, problem.data))


class SeaRecord(eqx.Module):
    """One run in waves: its sea, and the tests in it, each from sample `begins` on for as many samples of the run's clock as
    are measured. After `fitted` of the `steps` all fitted tests have ended. Slower than `slow` (Hz) the sea has no first
    order."""

    model: Model
    sea: SupportSea
    times: Float[Array, " t"]
    step: Float[Array, ""]
    measured: Float[Array, "w c n"]
    space: ParameterSpace = eqx.field(static=True)
    from_rest: bool = eqx.field(static=True)
    steps: int = eqx.field(static=True)
    fitted: int = eqx.field(static=True)
    begins: tuple[int, ...] = eqx.field(static=True)
    dofs: tuple[int, ...] = eqx.field(static=True)
    tests: tuple[str, ...] = eqx.field(static=True)
    slow: float = eqx.field(static=True)

    def simulated(self, x: Float[Array, " p"], count: Int[Array, ""] | None = None) -> tuple[Model, Float[Array, "6"], Grid]:
        """The model with these parameters, where it rests, and its motion from there on, over `count` steps or all."""
        model = self.space.model(self.model, x)
        rest = equilibrium(model)
        start = State(rest, jnp.zeros(6), model.rest().memory)
        return model, rest, integrate(model, self.sea, start, self.times[0], self.step, self.steps, "ab4", count=count)

    def residual(self, x: Float[Array, " p"], count: Int[Array, ""]) -> Float[Array, "w c n"]:
        """Simulated over `count` steps less measured, test by test; zeros of tests that have not ended then."""
        model, rest, grid = self.simulated(x, count)
        motion = observe(model, grid, self.times, rest if self.from_rest else None, in_waves=True)
        n = self.measured.shape[-1]
        found = jnp.stack([motion[begin : begin + n, list(self.dofs)].T for begin in self.begins]) - self.measured
        ended = self.times[np.array(self.begins) + n - 1] <= self.times[0] + (count + ROUNDING) * self.step
        return jnp.where(ended[:, None, None], found, 0.0)


@eqx.filter_jit
def sea_residuals(record: SeaRecord, x: Float[Array, " p"], count: Int[Array, ""]) -> Float[Array, "w c n"]:
    """Simulated less measured, test by test, over `count` steps."""
    return record.residual(x, count)


@eqx.filter_jit
def sea_slopes(record: SeaRecord, frame: Frame, count: Int[Array, ""]) -> tuple[Float[Array, "w c n"], Any]:
    """Residuals over `count` steps, and their slopes along the directions."""

    def residual(z):
        r = record.residual(frame.origin + frame.basis @ z, count)
        return r, r

    slopes, r = jax.jacfwd(residual, has_aux=True)(jnp.zeros(frame.basis.shape[1]))
    return r, slopes
