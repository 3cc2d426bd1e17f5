"""Residuals of tests in waves by multiple shooting: blocks with own initial states.

Over an hour a slightly wrong natural period puts slow motions out of phase. The sum of squares of the whole motion then has
many minima, and is about phase alone. In a block of a few periods the phase cannot wander.

Unknowns beside the parameters:

- Position and rate of the fitted motions at every block's start, with a vague prior about the values of the record there.
- A constant for every motion of a test, since only the motion about its mean is fitted.

Motions that are not fitted, and memories of loads, start from the continuous run. That run is made with the model that a round
of the fit begins with. Blocks need not join. The jumps between them say what the model lacks.

References:
    Bock 1983, Recent advances in parameter identification techniques for O.D.E. Bock and Plitt 1984, A multiple shooting
    algorithm for direct solution of optimal control problems, IFAC Proceedings 17(2), 1603-1608.
"""

import math
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from calibration.parameters.space import ParameterSpace
from calibration.residuals.abstract_residual import AbstractResidual, Unknowns
from calibration.residuals.blocks import Blocks, RunInBlocks
from calibration.residuals.seas import SeaProblem, SeaRun
from jaxhydro.dynamics.integrate import EXTRA_STEPS, Grid, integrate, states
from jaxhydro.dynamics.irregular_simulation import farthest
from jaxhydro.dynamics.model import Model, State
from jaxhydro.dynamics.observe import clock_lag, motion_behind, observe, reading_at
from jaxhydro.dynamics.statics import equilibrium, natural_modes
from jaxhydro.environment import DOFS
from jaxhydro.exported_programs import exported_jit


class BlockResiduals(NamedTuple):
    """Residuals and ends of the blocks of a run.

    Attributes:
        residual: Residuals by block, channel and time.
        first: Motions at the start of each block (m, rad).
        last: Motions when the next block begins (m, rad).
        beyond: Distance that the hull goes beyond the sea's box (m).
    """

    residual: Float[Array, "b c t"]
    first: Float[Array, "b c"]
    last: Float[Array, "b c"]
    beyond: Float[Array, " b"]


class BlockProblem(AbstractResidual):
    """Residuals of tests in waves, by blocks.

    Its `Unknowns` are the parameters' coordinates and every motion's constant (`shared`), and position and rate of every
    block (`own`). The record of a motion is its position from `rest`, or from the reference position, plus its constant.
    """

    model: Model
    space: ParameterSpace = eqx.field(static=True)
    sea: SeaProblem
    blocks: tuple[Blocks, ...]  # of every run
    constant: Float[Array, " m"]  # m, rad: the difference of the means at first
    wide: Float[Array, " m"]  # what a coordinate of 1 adds
    dofs: tuple[int, ...] = eqx.field(static=True)

    @property
    def observations(self) -> int:
        """Number of observations: one for every motion of a test."""
        return self.constant.shape[0]

    @property
    def piece(self) -> Int[Array, "b c"]:
        """`Blocks.piece` of all blocks."""
        return jnp.concatenate([blocks.piece for blocks in self.blocks])

    def begin(self) -> Unknowns:
        """First unknowns: starting values of the parameters, and states from the records."""
        shared = jnp.concatenate([self.space.start, jnp.zeros(self.observations)])
        return Unknowns(shared, jnp.zeros((len(self.piece), 2 * len(self.dofs))))

    def continued(self, x: Float[Array, " p"]) -> "BlockProblem":
        """The problem with blocks that start from the continuous runs at other coordinates."""
        model = self.space.model(self.model, x)
        paths = [_continuous(model, run) for run in self.sea.runs]
        states = [jax.tree.map(lambda leaf, b=b: leaf[b.begin], path) for path, b in zip(paths, self.blocks, strict=True)]
        return eqx.tree_at(lambda problem: [blocks.state for blocks in problem.blocks], self, states)

    def simulated(
        self, x: Float[Array, " p"], constants: Float[Array, " m"], own: Float[Array, " o"], block: Blocks, run: SeaRun
    ) -> tuple[Float[Array, "c t"], Grid, Float[Array, " c"]]:
        """Simulated readings of one block (m, rad), its motion, and the constants of its channels."""
        model, dofs = self.space.model(self.model, x), jnp.array(self.dofs)
        run_model = model if run.state is None else model.in_sea(run.state)
        base = jnp.zeros(6)
        if self.sea.from_rest:
            base = equilibrium(model) if self.sea.rest is None else self.sea.rest
        constant = jnp.append(self.constant + self.wide * constants, 0.0)[block.piece]
        position, rate = block.smooth + block.loose * own.reshape(2, -1)
        fitted, continuous = block.loose[0] > 0, block.state
        rates = model.position_rate(continuous.position, continuous.velocity)
        reading, reading_rate = jax.jvp(lambda q: reading_at(model, q), (continuous.position,), (rates,))
        origin = reading_at(model, base)[dofs]
        reading = reading.at[dofs].set(jnp.where(fitted, origin + position - constant, reading[dofs]))
        reading_rate = reading_rate.at[dofs].set(jnp.where(fitted, rate, reading_rate[dofs]))
        q, rates = motion_behind(model, reading, reading_rate)
        sea = run.sea.from_step(block.begin, block.steps + EXTRA_STEPS)
        state = State(q, model.body_velocity(q, rates), continuous.memory)
        grid = integrate(run_model, sea, state, sea.start, run.step, block.steps, "ab4")
        readings = observe(model, grid, block.times, base, in_waves=True)[:, dofs]
        return (readings + constant).T, grid, constant

    def block_residuals(self, unknowns: Unknowns) -> BlockResiduals:
        """Residuals and ends of all blocks."""
        x, constants = jnp.split(unknowns.shared, [len(self.space.free)])

        def residuals_of(own: Array, block: Blocks, run: SeaRun) -> BlockResiduals:
            readings, grid, _ = self.simulated(x, constants, own, block, run)
            ends = grid.position[:, jnp.array(self.dofs)]  # of the platform itself: what is to join
            beyond = farthest(grid.position, self.sea.points, run.sea) - run.sea.half
            return BlockResiduals((readings - block.measured) * block.factor, ends[0], ends[block.span], beyond)

        shots = self._by_run(unknowns.own, residuals_of)
        longest = max(shot.residual.shape[2] for shot in shots)
        shots = [s._replace(residual=jnp.pad(s.residual, ((0, 0), (0, 0), (0, longest - s.residual.shape[2])))) for s in shots]
        return jax.tree.map(lambda *parts: jnp.concatenate(parts), *shots)

    def products(self, unknowns: Unknowns) -> Float[Array, "b c+1 k k"]:
        """Products [J r]^T [J r] by block and channel.

        The last channel is the prior of the block's own unknowns.
        """
        p = len(self.space.free)
        x, constants = jnp.split(unknowns.shared, [p])
        m, o = len(constants), unknowns.own.shape[1]
        widths = jnp.append(self.wide, 0.0)

        def products_of(own: Array, block: Blocks, run: SeaRun) -> Array:
            def residual(z):
                r = (self.simulated(z[:p], constants, z[p:], block, run)[0] - block.measured) * block.factor
                return r, r

            slope, r = jax.jacfwd(residual, has_aux=True)(jnp.concatenate([x, own]))
            # a constant moves what is read, and, against it, the position that the block begins at
            safe = jnp.where(block.loose[0] > 0, block.loose[0], jnp.inf)
            at_start = slope[..., p : p + o // 2] / safe
            each = (jnp.eye(o // 2)[:, None] * block.factor[..., None] - at_start) * widths[block.piece]
            by_constant = each @ jax.nn.one_hot(block.piece, m)
            full = jnp.concatenate([slope[..., :p], by_constant, slope[..., p:], r[..., None]], axis=-1)
            prior = jnp.concatenate([jnp.zeros((o, p + m)), jnp.eye(o), own[:, None]], axis=1)
            return jnp.concatenate([jnp.einsum("ctk,ctl->ckl", full, full), (prior.T @ prior)[None]])

        return jnp.concatenate(self._by_run(unknowns.own, products_of))

    def _by_run(self, own: Array, function: Callable[[Array, Blocks, SeaRun], Any]) -> list[Any]:
        """Values of function(own unknowns, block, run) for every block; one entry for each run."""
        results, done = [], 0
        for run, blocks in zip(self.sea.runs, self.blocks, strict=True):
            count = blocks.begin.shape[0]
            results.append(jax.lax.map(partial(_of_pair, function, run), (own[done : done + count], blocks)))
            done += count
        return results


def _of_pair(function: Callable[[Array, Blocks, SeaRun], Any], run: SeaRun, pair: tuple[Array, Blocks]) -> Any:
    return function(*pair, run)


@exported_jit
def simulate_blocks(problem: BlockProblem, unknowns: Unknowns) -> BlockResiduals:
    """`BlockProblem.block_residuals`, compiled."""
    return problem.block_residuals(unknowns)


def set_up_blocks(sea: SeaProblem, period: float) -> BlockProblem:
    """Cut the tests of a problem in waves into blocks of `PERIODS_PER_BLOCK` times a period (s)."""
    dofs = _fitted(sea)
    total = sum(len(run.pieces) for run in sea.runs)
    origin = reading_at(sea.model, equilibrium(sea.model) if sea.from_rest else jnp.zeros(6))
    late = clock_lag(sea.model)
    lag = 0.0 if late is None else float(late)
    blocks: list[Blocks] = []
    constant: list[float] = []
    wide: list[float] = []
    for run in sea.runs:
        path = _continuous(sea.model, run)
        readings = np.asarray(reading_at(sea.model, path.position) - origin)
        made = RunInBlocks(run, path, dofs, [], lag)
        for test in dict.fromkeys(piece.test for piece in run.pieces):
            pieces = [piece for piece in run.pieces if piece.test == test]
            made.cut(pieces, range(len(constant), len(constant) + len(pieces)), period, total)
            for piece in pieces:
                x = np.asarray(piece.measured)
                steps = made.step_of(np.arange(piece.begin, piece.begin + len(x)))
                constant.append(float(x.mean() - readings[steps, piece.dof].mean()))
                wide.append(float(x.std()))
        blocks.append(made.stacked())
    return BlockProblem(sea.model, sea.space, sea, tuple(blocks), jnp.asarray(constant), jnp.asarray(wide), dofs)


def slowest(sea: SeaProblem) -> float:
    """The longest natural period (s) of the motions that are fitted; inf where none has one."""
    modes = natural_modes(sea.model)
    periods = [modes.of(DOFS[dof]) for dof in _fitted(sea)]
    return max((period for period in periods if math.isfinite(period)), default=math.inf)


def _fitted(sea: SeaProblem) -> tuple[int, ...]:
    return tuple(sorted({piece.dof for run in sea.runs for piece in run.pieces}))


def _continuous(model: Model, run: SeaRun) -> State:
    """State after every step of a run that is simulated as a whole."""
    run_model = model if run.state is None else model.in_sea(run.state)
    start = State(equilibrium(model), jnp.zeros(6), model.rest().memory) if run.start is None else run.start
    return states(run_model, run.sea, start, run.times[0], run.step, run.steps)
