"""Compiled residuals of one decay or run in waves, with their slopes along a few directions.

Directions are data, so that one compiled program scores every candidate effect and refits any few of them.
"""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from calibration.parameters.space import ParameterSpace
from calibration.residuals.decays import DecayData, DecayProblem
from jaxhydro.dynamics.integrate import Grid, integrate
from jaxhydro.dynamics.model import Model, State
from jaxhydro.dynamics.observe import observe
from jaxhydro.dynamics.statics import equilibrium
from jaxhydro.quick_jit import jit_once
from jaxhydro.waves.support_sea import SupportSea

STEP_ROUNDING = 1e-6  # fraction of a time step


class Frame(NamedTuple):
    """Coordinates x = origin + basis z of all parameters.

    Attributes:
        origin: Coordinates at z = 0 (p,).
        basis: The directions that are differentiated along (p, q).
    """

    origin: Float[Array, " p"]
    basis: Float[Array, "p q"]


@jit_once
def decay_residual(
    problem: DecayProblem, x: Float[Array, " p"], own_unknowns: Float[Array, " o"], record: DecayData
) -> Float[Array, "c t"]:
    """Simulated minus measured motions of a decay, zero where there is no sample (c, t)."""
    return problem.residual(x, own_unknowns, record)


@jit_once
def decay_slopes(
    problem: DecayProblem, frame: Frame, own_unknowns: Float[Array, " o"], record: DecayData
) -> tuple[Float[Array, "c t"], Float[Array, "c t k"]]:
    """Residual of a decay (c, t), and slopes along directions and own unknowns (c, t, k)."""
    return problem.slopes(frame.origin, own_unknowns, record, frame.basis)


class SeaRecord(eqx.Module):
    """One run in waves with the tests in it.

    Attributes:
        model: The model.
        sea: The sea.
        times: Times of the run (s).
        step: Time step (s).
        measured: Measured motions by test (w, c, n).
        space: All parameters.
        from_rest: Whether motions count from the static equilibrium.
        steps: Number of steps.
        fitted: Number of steps after which all fitted tests have ended.
        begins: First sample of every test.
        dofs: Numbers of the measured motions.
        tests: Names of the tests.
        slow: Frequency (Hz) below which the sea has no first-order waves.
    """

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

    @property
    def duration(self) -> float:
        """Duration of a test (s)."""
        return self.measured.shape[-1] * float(self.times[1] - self.times[0])

    def begin(self, x: Float[Array, " p"]) -> tuple[Model, State]:
        """The model with these parameters, and its state at rest."""
        model = self.space.model(self.model, x)
        return model, State(equilibrium(model), jnp.zeros(6), model.rest().memory)

    def simulated(self, x: Float[Array, " p"], count: Int[Array, ""] | None = None) -> tuple[Model, Float[Array, "6"], Grid]:
        """The model with these parameters, its equilibrium, and its motion over `count` steps or all."""
        model, start = self.begin(x)
        grid = integrate(model, self.sea, start, self.times[0], self.step, self.steps, "ab4", count=count)
        return model, start.position, grid

    def compared(self, model: Model, rest: Float[Array, "6"], grid: Grid, count: Int[Array, ""]) -> Float[Array, "w c n"]:
        """Simulated minus measured motions by test; zeros of tests that have not ended after `count` steps."""
        motion = observe(model, grid, self.times, rest if self.from_rest else None, in_waves=True)
        n = self.measured.shape[-1]
        residual = jnp.stack([motion[begin : begin + n, list(self.dofs)].T for begin in self.begins]) - self.measured
        ended = self.times[np.array(self.begins) + n - 1] <= self.times[0] + (count + STEP_ROUNDING) * self.step
        return jnp.where(ended[:, None, None], residual, 0.0)


@jit_once
def sea_residuals(record: SeaRecord, x: Float[Array, " p"], count: Int[Array, ""]) -> Float[Array, "w c n"]:
    """Simulated minus measured motions by test, over `count` steps (w, c, n)."""
    return record.compared(*record.simulated(x, count), count)
