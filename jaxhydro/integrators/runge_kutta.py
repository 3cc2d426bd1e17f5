"""Explicit Runge-Kutta schemes at fixed steps, differentiable forward and in reverse.

diffrax has the same schemes. These loops are kept for what this package does most, many simulations of different lengths
with free initial states: one compilation, from the persistent cache too, and Jacobians in which initial states cost nothing.
"""

import functools
from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

CHECKPOINT_STEPS = 64  # steps per checkpointed block of a reverse gradient
BATCH = 32  # stages linearised together: fills the vector units and stays in the cache

Rate = Callable[[Any, Float[Array, ""], Float[Array, " s"]], tuple[Float[Array, " _"], ...]]  # part by part


class Scheme(NamedTuple):
    """Butcher tableau: nodes, weights, and the strictly lower triangular coefficients row by row."""

    nodes: tuple[float, ...]
    weights: tuple[float, ...]
    rows: tuple[tuple[float, ...], ...]

    def coefficients(self) -> Float[np.ndarray, "k k"]:
        size = len(self.nodes)
        return np.array([np.pad(row, (0, size - len(row))) for row in self.rows])


RK4 = Scheme((0.0, 0.5, 0.5, 1.0), (1 / 6, 1 / 3, 1 / 3, 1 / 6), ((), (0.5,), (0.0, 0.5), (0.0, 0.0, 1.0)))


@functools.cache
def tsit5() -> Scheme:
    """Tsitouras 5(4) scheme with diffrax's tableau, without its last stage, which has weight 0.

    References:
        Tsitouras (2011), Computers and Mathematics with Applications 62, 770-775, table 1.
    """
    import diffrax  # takes a fifth of a second

    tableau = diffrax.Tsit5.tableau
    rows = ((), *(tuple(map(float, row)) for row in tableau.a_lower[:-1]))
    return Scheme((0.0, *map(float, tableau.c[:-1])), tuple(map(float, tableau.b_sol[:-1])), rows)


def _step(driver, y, time, step, rate: Rate, scheme: Scheme, keep: bool):
    """One step: the state after it, and the states at its stages if they are to be kept."""
    size = len(scheme.nodes)

    # one traced copy of the equation of motion for all stages: a fraction of the compilation
    def stage(slopes, row):
        index, node, coefficients = row
        at = y + step * (coefficients @ slopes)
        slope = jnp.concatenate(rate(driver, time + node * step, at))
        return jax.lax.dynamic_update_index_in_dim(slopes, slope, index, 0), at if keep else None

    rows = (jnp.arange(size), jnp.array(scheme.nodes), jnp.asarray(scheme.coefficients()))
    slopes, stages = jax.lax.scan(stage, jnp.zeros((size, y.shape[0])), rows)
    return y + step * (jnp.array(scheme.weights) @ slopes), stages


def _march(driver, y, start, step, count, rate: Rate, scheme: Scheme, capacity: int, keep: bool, shown: int | None = None):
    """States (their first `shown` entries) at the ends of `count` steps, and if kept at the stages of each, in arrays for
    `capacity` steps."""

    def advance(index, carry):
        y, path, stages = carry
        after, at = _step(driver, y, start + step * index, step, rate, scheme, keep)
        path = jax.lax.dynamic_update_index_in_dim(path, y[:shown], index, 0)
        return after, path, jax.lax.dynamic_update_index_in_dim(stages, at, index, 0) if keep else None

    stages = jnp.zeros((capacity + 1, len(scheme.nodes), y.shape[0])) if keep else None
    carry = (y, jnp.zeros((capacity + 1, y[:shown].shape[0])), stages)
    _, path, stages = jax.lax.fori_loop(0, count + 1, advance, carry)
    return path, stages


def direct(driver, y, start, step, count, *, rate: Rate, scheme: Scheme, capacity: int, shown: int) -> Float[Array, "n _"]:
    """The first `shown` entries of the path that `forward` gives; tangents run along with the simulation.

    For long states (loads with memory), whose linearisations, a matrix for every evaluation, would be too large."""
    return _march(driver, y, start, step, count, rate, scheme, capacity, False, shown)[0]


@eqx.filter_custom_jvp
def forward(
    driver: Any,
    y: Float[Array, " s"],
    start: Float[Array, ""],
    step: Float[Array, ""],
    count: Int[Array, ""],
    *,
    rate: Rate,
    scheme: Scheme,
    capacity: int,
) -> Float[Array, "n s"]:
    """States after 0, 1 ... `count` steps of dy/dt = rate(driver, t, y), in an array for `capacity` steps.

    Has forward derivatives with respect to `driver` and `y`, not to times.
    """
    return _march(driver, y, start, step, count, rate, scheme, capacity, False)[0]


@forward.def_jvp
def _forward_jvp(primals, tangents, *, rate: Rate, scheme: Scheme, capacity: int):
    """Tangents of a whole simulation from linearisations at every stage, many at once.

    Once the path is known its linearisations do not depend on each other; what is left in sequence is one product of a
    small matrix per step. The state's part is common to all parameters, so that initial states cost nothing more.
    """
    driver, y, start, step, count = primals
    d_driver, d_y, *_ = tangents
    path, stages = _march(driver, y, start, step, count, rate, scheme, capacity, True)
    assert stages is not None
    nodes, size = jnp.array(scheme.nodes), len(scheme.nodes)
    times = (start + step * (jnp.arange(capacity + 1.0)[:, None] + nodes)).reshape(-1)
    states = stages.reshape(times.shape[0], -1)
    slope, push = linearised(rate, driver, d_driver, times, states, size * (count + 1), BATCH)
    slope, push = (x.reshape(capacity + 1, size, *x.shape[1:]) for x in (slope, push))
    # the scheme applied to the linearised equation: d_y after a step = transfer d_y + drive
    eye, table = jnp.eye(y.shape[0]), scheme.coefficients()
    matrices: list[Array] = []
    vectors: list[Array] = []
    for i in range(size):
        matrix = eye + step * sum((table[i, j] * matrices[j] for j in range(i)), jnp.zeros_like(slope[:, 0]))
        vector = step * sum((table[i, j] * vectors[j] for j in range(i)), jnp.zeros_like(push[:, 0]))
        matrices.append(slope[:, i] @ matrix)
        vectors.append(push[:, i] + jnp.einsum("nij,nj->ni", slope[:, i], vector))
    transfer = eye + step * sum(b * m for b, m in zip(scheme.weights, matrices, strict=True))
    drive = step * sum(b * v for b, v in zip(scheme.weights, vectors, strict=True))
    d_y = jnp.zeros_like(y) if d_y is None else d_y
    _, d_path = jax.lax.scan(lambda d, now: (now[0] @ d + now[1], d), d_y, (transfer, drive))
    return path, d_path


def linearised(
    rate: Rate,
    driver: Any,
    d_driver: Any,
    times: Float[Array, " n"],
    states: Float[Array, "n s"],
    count: Int[Array, ""],
    batch: int,
) -> tuple[Float[Array, "n s s"], Float[Array, "n s"]]:
    """Derivatives of the rate by the state, and along `d_driver`, at the first `count` of some times and states (zero beyond,
    but for the last batch's rest)."""
    total, size = states.shape
    points = -(-total // batch) * batch
    parts = len(jax.eval_shape(rate, driver, times[0], states[0]))
    times, states = jnp.pad(times, (0, points - total)), jnp.pad(states, ((0, points - total), (0, 0)))
    moving = bool(jax.tree.leaves(d_driver))

    def at(time: Float[Array, ""], state: Float[Array, " s"]) -> tuple[Float[Array, "s s"], Float[Array, " s"]]:
        slope = jnp.concatenate([jax.jacrev(lambda y, i=i: rate(driver, time, y)[i])(state) for i in range(parts)])
        if not moving:
            return slope, jnp.zeros(size)
        return slope, eqx.filter_jvp(lambda d: jnp.concatenate(rate(d, time, state)), (driver,), (d_driver,))[1]

    def block(index, out):
        here = index * batch
        part = (jax.lax.dynamic_slice_in_dim(times, here, batch), jax.lax.dynamic_slice_in_dim(states, here, batch))
        found = jax.vmap(at)(*part)
        return tuple(jax.lax.dynamic_update_slice_in_dim(o, f, here, 0) for o, f in zip(out, found, strict=True))

    out = (jnp.zeros((points, size, size)), jnp.zeros((points, size)))
    slope, push = jax.lax.fori_loop(0, (count + batch - 1) // batch, block, out)
    return slope[:total], push[:total]


def backward(driver, y, start, step, count, *, rate: Rate, scheme: Scheme, capacity: int) -> Float[Array, "n s"]:
    """The same path for a reverse gradient: states at block starts are stored, the others recomputed."""

    def advance(y, index):
        return _step(driver, y, start + step * index, step, rate, scheme, False)[0], y

    blocks = -(-(capacity + 1) // CHECKPOINT_STEPS)
    index = jnp.arange(blocks * CHECKPOINT_STEPS, dtype=float).reshape(blocks, CHECKPOINT_STEPS)
    _, saved = jax.lax.scan(jax.checkpoint(lambda y, index: jax.lax.scan(advance, y, index)), y, index)
    return saved.reshape(-1, y.shape[0])[: capacity + 1]
