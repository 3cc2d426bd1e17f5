"""Fixed-step time integration, and output at any times."""

from typing import Literal

import diffrax
import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.model import Model, State
from jaxhydro.waves.sea import AbstractSea

Method = Literal["rk4", "tsit5"]
Adjoint = Literal["forward", "reverse"]
BLOCK = 64  # steps per checkpointed block of a reverse gradient


class Grid(eqx.Module):
    """Motion at the ends of every step: dof positions, rates and accelerations."""

    start: Float[Array, ""]
    step: Float[Array, ""]
    position: Float[Array, "n 6"]
    rate: Float[Array, "n 6"]
    acceleration: Float[Array, "n 6"]

    def at(self, times: Float[Array, " t"]) -> tuple[Float[Array, "t 6"], Float[Array, "t 6"], Float[Array, "t 6"]]:
        """Position, rate and acceleration at `times` (s), by quintic Hermite interpolation.

        Its error is of sixth order in the step, beyond that of the integrator. Times outside the grid are clipped to it.
        """
        last = self.position.shape[0] - 2
        place = (times - self.start) / self.step
        index = jnp.clip(jnp.floor(place).astype(int), 0, last)
        s = jnp.clip(place - index, 0.0, 1.0)[:, None]
        h = self.step
        x0, x1 = self.position[index], self.position[index + 1]
        v0, v1 = h * self.rate[index], h * self.rate[index + 1]
        a0, a1 = 0.5 * h * h * self.acceleration[index], 0.5 * h * h * self.acceleration[index + 1]
        # x = x0 + v0 s + a0 s^2 + s^3 (c3 + c4 s + c5 s^2), fixed by the far end
        gap, slope, bend = x1 - x0 - v0 - a0, v1 - v0 - 2 * a0, 2 * (a1 - a0)
        c3 = 10 * gap - 4 * slope + 0.5 * bend
        c4 = -15 * gap + 7 * slope - bend
        c5 = 6 * gap - 3 * slope + 0.5 * bend
        x = x0 + s * (v0 + s * (a0 + s * (c3 + s * (c4 + s * c5))))
        v = (v0 + s * (2 * a0 + s * (3 * c3 + s * (4 * c4 + s * 5 * c5)))) / h
        a = (2 * a0 + s * (6 * c3 + s * (12 * c4 + s * 20 * c5))) / h**2
        return x, v, a


def _add(state: State, rate: State, factor: Float[Array, ""]) -> State:
    return jax.tree.map(lambda x, r: x + factor * r, state, rate)


def _rk4(model: Model, sea: AbstractSea, state: State, start: Float[Array, ""], step: Float[Array, ""], steps: int,
         adjoint: Adjoint) -> tuple[Float[Array, "n 6"], Float[Array, "n 6"], Float[Array, "n 6"]]:
    """Classical Runge-Kutta as a scan: positions, body velocities and their rates at the ends of the steps."""

    def advance(state: State, index: Float[Array, ""]):
        time = start + step * index
        first = model.rate(time, state, sea)

        def stage(carry, weights):
            rate, total = carry
            ahead, share = weights
            rate = model.rate(time + ahead * step, _add(state, rate, ahead * step), sea)
            return (rate, _add(total, rate, share)), None

        # one traced copy of the equation of motion for three stages: a third of the compilation
        total = jax.tree.map(lambda r: r / 6, first)
        weights = (jnp.array([0.5, 0.5, 1.0]), jnp.array([1 / 3, 1 / 3, 1 / 6]))
        (_, total), _ = jax.lax.scan(stage, (first, total), weights)
        return _add(state, total, step), (state.position, state.velocity, first.velocity)

    if adjoint == "forward":
        return jax.lax.scan(advance, state, jnp.arange(steps + 1.0))[1]
    blocks = -(-(steps + 1) // BLOCK)
    index = jnp.arange(blocks * BLOCK, dtype=float).reshape(blocks, BLOCK)
    block = jax.checkpoint(lambda state, index: jax.lax.scan(advance, state, index))
    _, saved = jax.lax.scan(block, state, index)
    position, velocity, rate = (x.reshape(-1, 6)[: steps + 1] for x in saved)
    return position, velocity, rate


def _tsit5(model: Model, sea: AbstractSea, state: State, start: Float[Array, ""], step: Float[Array, ""], steps: int,
           adjoint: Adjoint) -> tuple[Float[Array, "n 6"], Float[Array, "n 6"], Float[Array, "n 6"]]:
    """diffrax's Tsitouras 5(4) on the same grid.

    `StepTo`, not `ConstantStepSize`: the latter's reverse gradients are wrong with output on the step grid (diffrax 0.7.2).
    """
    grid = start + step * jnp.arange(steps + 1.0)
    solution = diffrax.diffeqsolve(
        diffrax.ODETerm(lambda t, y, args: args[0].rate(t, y, args[1])),
        diffrax.Tsit5(),
        t0=grid[0],
        t1=grid[-1],
        dt0=None,
        y0=state,
        args=(model, sea),
        stepsize_controller=diffrax.StepTo(ts=grid),
        saveat=diffrax.SaveAt(ts=grid),
        adjoint=diffrax.ForwardMode() if adjoint == "forward" else diffrax.RecursiveCheckpointAdjoint(),
        max_steps=steps + 1,
    )
    rate = jax.vmap(lambda t, y: model.rate(t, y, sea).velocity)(grid, solution.ys)
    return solution.ys.position, solution.ys.velocity, rate


def integrate(
    model: Model,
    sea: AbstractSea,
    state: State,
    start: Float[Array, ""],
    step: Float[Array, ""],
    steps: int,
    method: Method = "rk4",
    adjoint: Adjoint = "forward",
) -> Grid:
    """Motion over `steps` steps of `step` seconds from `start`."""
    run = {"rk4": _rk4, "tsit5": _tsit5}[method]
    position, velocity, velocity_rate = run(model, sea, state, start, step, steps, adjoint)

    def rates(position, velocity, velocity_rate):
        rate = model.position_rate(position, velocity)
        return jax.jvp(model.position_rate, (position, velocity), (rate, velocity_rate))

    rate, acceleration = jax.vmap(rates)(position, velocity, velocity_rate)
    return Grid(start, step, position, rate, acceleration)
