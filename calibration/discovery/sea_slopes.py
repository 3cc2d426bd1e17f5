"""Residuals of a run in waves, and their slopes along many directions, on all cores.

XLA runs a loop on one core. The motion is simulated first. Then the right-hand side is linearised at the states that the scheme
evaluated, which takes most of the time: in segments, side by side. The scheme itself is applied to the slopes in order.

Candidates at other values of their shapes move nothing while they are neutral. The acceleration's slopes by the state are then
those of before. What is left to linearise are the candidates' own loads.
"""

from collections import deque
from collections.abc import Iterator
from concurrent.futures import Executor, Future
from operator import itemgetter
from typing import Any, NamedTuple, TypeAlias

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax.flatten_util import ravel_pytree
from jaxtyping import Array, Float, Int

from calibration.discovery.residual_slopes import Frame, SeaRecord
from calibration.fitting.cores import cores
from jaxhydro.dynamics.integrate import EXTRA_STEPS, MOTION_SIZE, grid_of, rate_of
from jaxhydro.dynamics.model import Model
from jaxhydro.integrators.adams_bashforth import Tangent, evaluations, first_evaluations, march, times_of
from jaxhydro.integrators.linearised_rate import linearised_rate
from jaxhydro.quick_jit import jit_once, quick_jit

LINEARISED_AT_ONCE = 16  # evaluations at a time within a segment: their flow fills the cache
SEGMENT = 32 * LINEARISED_AT_ONCE  # evaluations that are linearised by one core
SEGMENTS_AHEAD = 2  # of every core: linearisations take memory until the scheme has used them
COMPARED_AT_ONCE = 16  # directions along which slopes become those of the residual together
ACCELERATIONS = slice(MOTION_SIZE // 2, MOTION_SIZE)  # of a right-hand side

Accelerations: TypeAlias = list[Array]  # by segment: slopes of the acceleration by the state at the evaluations (e, 6, s)


class _Begin(NamedTuple):
    """What a simulation begins with, and how it moves along the directions.

    Attributes:
        model: The model.
        state: Its first state (s,).
        d_model: Slopes of the model, (q, ...) each; None of what does not move.
        d_state: Slopes of the first state (q, s).
    """

    model: Model
    state: Float[Array, " s"]
    d_model: Any
    d_state: Float[Array, "q s"]


def sea_slopes(
    record: SeaRecord,
    frame: Frame,
    count: int,
    directions: int,
    pool: Executor,
    keep: Accelerations | None = None,
    by_state: Accelerations | None = None,
) -> tuple[Float[np.ndarray, "w c n"], Float[np.ndarray, "w c n q"]]:
    """Residuals of a run over some steps, and their slopes along the first directions.

    Slopes along directions that are not asked for are zero.

    Args:
        record: The run.
        frame: Where, and the directions (q).
        count: Number of steps.
        directions: How many of the directions, from the first on.
        pool: Threads for the segments.
        keep: Receives the slopes of the acceleration by the state.
        by_state: These slopes, from a point where the motion and they are the same; None: they are computed. At most
            `COMPARED_AT_ONCE` directions are then asked for, and the others say what else may move.

    Returns:
        Residuals (w, c, n) and slopes (w, c, n, q).
    """
    steps, width = jnp.asarray(count), frame.basis.shape[1]
    begin = _begin(record, frame)
    if by_state is not None:
        begin = _few(begin, COMPARED_AT_ONCE)
    # the linearisation is compiled while the simulation is compiled and runs
    at_rest = jnp.broadcast_to(begin.state, (_whole_segments(evaluations(record.steps + EXTRA_STEPS + 1)), len(begin.state)))
    pool.submit(_linearised.prepare, record, begin, at_rest, jnp.asarray(0), None if by_state is None else by_state[0])
    path, states = _simulated(record, begin.model, begin.state, steps)
    needed = _whole_segments(int(evaluations(count + EXTRA_STEPS + 1))) // SEGMENT
    tangent, parts = jax.vmap(Tangent.begin)(begin.d_state), []
    for i, (slope, push) in enumerate(_segments(record, begin, states, needed, pool, by_state)):
        tangent, d_motion = _followed(tangent, jnp.asarray(i * SEGMENT), slope, push, record.step)
        parts.append(np.asarray(d_motion))
        if keep is not None:
            keep.append(slope[:, ACCELERATIONS])
    rows = first_evaluations(needed * SEGMENT - evaluations(0))[: len(path)]
    residual: Any = None
    slopes = np.zeros((*record.measured.shape, width))
    for first in range(0, max(directions, 1), COMPARED_AT_ONCE):
        mine = np.arange(first, first + COMPARED_AT_ONCE) % len(begin.d_state)  # always as many: one program
        along = np.zeros((COMPARED_AT_ONCE, *path.shape))
        along[:, : len(rows)] = np.moveaxis(np.concatenate([part[:, mine] for part in parts])[rows], 0, 1)
        few = begin._replace(d_model=jax.tree.map(itemgetter(mine), begin.d_model), d_state=begin.d_state[mine])
        residual, columns = _compared(record, few, path, jnp.asarray(along), steps)
        slopes[..., mine] = np.asarray(columns)
    return np.asarray(residual), slopes


def _few(begin: _Begin, count: int) -> _Begin:
    """The first directions only; a value that no direction at all moves has None as its slopes."""

    def first(slope: Array | None) -> Array | None:
        return slope[:count] if slope is not None and np.asarray(slope).any() else None

    d_model = jax.tree.map(first, begin.d_model, is_leaf=lambda leaf: leaf is None)
    return begin._replace(d_model=d_model, d_state=begin.d_state[:count])


def _segments(
    record: SeaRecord,
    begin: _Begin,
    states: Float[Array, "e s"],
    count: int,
    pool: Executor,
    by_state: Accelerations | None,
) -> Iterator[tuple[Array, Array]]:
    """Linearisations of the first segments in order, some of them computed ahead."""
    ahead: deque[Future[tuple[Array, Array]]] = deque()
    for i in range(count):
        segment_by_state = None if by_state is None else by_state[i]
        ahead.append(pool.submit(_linearised, record, begin, states, jnp.asarray(i * SEGMENT), segment_by_state))
        if len(ahead) > SEGMENTS_AHEAD * cores():
            yield ahead.popleft().result()
    while ahead:
        yield ahead.popleft().result()


@quick_jit
def _begin(record: SeaRecord, frame: Frame) -> _Begin:
    """Model and first state, and their slopes along the directions."""

    def begun(z: Float[Array, " q"]) -> tuple[Any, Array]:
        model, state = record.begin(frame.origin + frame.basis @ z)
        moves = jax.tree.map(lambda new, old: eqx.is_array(new) and new is not old, model, record.model)
        return eqx.filter(model, moves), ravel_pytree(state)[0]

    model, state = record.begin(frame.origin)
    slopes = jax.jacfwd(begun)(jnp.zeros(frame.basis.shape[1]))
    return _Begin(model, ravel_pytree(state)[0], *jax.tree.map(lambda x: jnp.moveaxis(x, -1, 0), slopes))


@jit_once
def _simulated(
    record: SeaRecord, model: Model, state: Float[Array, " s"], count: Int[Array, ""]
) -> tuple[Float[Array, "n m"], Float[Array, "e s"]]:
    """Motion at the ends of the steps, and states at the evaluations of the right-hand side.

    The evaluations are those of whole segments.
    """
    _, unravel = ravel_pytree(model.rest())
    clock = (record.times[0], record.step, count + EXTRA_STEPS)
    capacity = record.steps + EXTRA_STEPS
    path, states = march((model, record.sea), state, *clock, rate_of(unravel), capacity, keep=True, shown=MOTION_SIZE)
    return path, jnp.pad(states, ((0, _whole_segments(len(states)) - len(states)), (0, 0)), mode="edge")


def _whole_segments(count: int) -> int:
    """A number of evaluations, rounded up to whole segments."""
    return -(-count // SEGMENT) * SEGMENT


@jit_once
def _linearised(
    record: SeaRecord,
    begin: _Begin,
    states: Float[Array, "e s"],
    first: Int[Array, ""],
    by_state: Float[Array, "e 6 s"] | None,
) -> tuple[Float[Array, "e s s"], Float[Array, "e q s"]]:
    """Slopes of the right-hand side in a segment, by the state and along the directions.

    They are those at the evaluations of the segment.
    """
    _, unravel = ravel_pytree(begin.model.rest())
    still = jax.tree.map(lambda _: None, record.sea)

    def linearised(now: tuple[Array, Array, Array | None]) -> tuple[Array, Array]:
        time, state, acceleration_slopes = now

        def along(d_model: Any) -> tuple[Array, Array]:
            driver, d_driver = (begin.model, record.sea), (d_model, still)
            return linearised_rate(rate_of(unravel), driver, d_driver, acceleration_slopes)(time, state)

        return jax.vmap(along, out_axes=(None, 0))(begin.d_model)

    times = times_of(first + jnp.arange(SEGMENT), record.times[0], record.step)
    mine = jax.lax.dynamic_slice_in_dim(states, first, SEGMENT)
    return jax.lax.map(linearised, (times, mine, by_state), batch_size=LINEARISED_AT_ONCE)


@jit_once
def _followed(
    tangent: Tangent,
    first: Int[Array, ""],
    slope: Float[Array, "e s s"],
    push: Float[Array, "e q s"],
    step: Float[Array, ""],
) -> tuple[Tangent, Float[Array, "e q m"]]:
    """Slopes of a simulation after some evaluations, and those of its motion before each."""

    def after(tangent: Tangent, now: tuple[Array, Array, Array]) -> tuple[Tangent, Array]:
        index, slope, push = now
        return jax.vmap(lambda along, push: along.after(index, slope, push, step))(tangent, push), tangent.y[:, :MOTION_SIZE]

    return jax.lax.scan(after, tangent, (first + jnp.arange(len(slope)), slope, push))


@jit_once
def _compared(
    record: SeaRecord, begin: _Begin, path: Float[Array, "n m"], along: Float[Array, "q n m"], count: Int[Array, ""]
) -> tuple[Float[Array, "w c n"], Float[Array, "w c n q"]]:
    """Residuals over `count` steps, and their slopes from those of the motion."""
    moves = jax.tree.map(lambda slope: slope is not None, begin.d_model, is_leaf=lambda leaf: leaf is None)
    moved, still = eqx.partition(begin.model, moves)

    def residual(moved: Any, rest: Float[Array, "6"], path: Float[Array, "n m"]) -> Float[Array, "w c n"]:
        model = eqx.combine(moved, still)
        grid = grid_of(model, path[:, :6], path[:, 6:], record.times[0], record.step, count)
        return record.compared(model, rest, grid, count)

    value, slope = jax.linearize(residual, moved, begin.state[:6], path)
    return value, jax.vmap(slope, out_axes=-1)(begin.d_model, begin.d_state[:, :6], along)
