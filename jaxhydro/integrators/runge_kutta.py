"""Explicit Runge-Kutta schemes at fixed steps, differentiable forward and in reverse.

diffrax has the same schemes. These loops are kept for what this package does most, many simulations of different lengths
with free initial states: one compilation, from the persistent cache too, and Jacobians in which initial states cost nothing.
"""

import functools
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from jaxhydro.integrators.linearised_rate import Rate, linearised_rate

CHECKPOINT_STEPS = 64  # steps per checkpointed block of a reverse gradient
BATCH = 4  # steps linearised together: their stages fill the vector units and stay in the cache


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
        state = y + step * (coefficients @ slopes)
        slope = jnp.concatenate(rate(driver, time + node * step, state))
        return jax.lax.dynamic_update_index_in_dim(slopes, slope, index, 0), state if keep else None

    rows = (jnp.arange(size), jnp.array(scheme.nodes), jnp.asarray(scheme.coefficients()))
    slopes, stages = jax.lax.scan(stage, jnp.zeros((size, y.shape[0])), rows)
    return y + step * (jnp.array(scheme.weights) @ slopes), stages


def _march(driver, y, start, step, count, rate: Rate, scheme: Scheme, capacity: int, keep: bool, shown: int | None = None):
    """States after 0, 1 ... `count` steps, and if kept the states at the stages of every step.

    The arrays have room for `capacity` steps. States after the steps are their first `shown` entries.
    """

    def advance(index, carry):
        y, path, stages = carry
        after, states = _step(driver, y, start + step * index, step, rate, scheme, keep)
        path = jax.lax.dynamic_update_index_in_dim(path, y[:shown], index, 0)
        return after, path, jax.lax.dynamic_update_index_in_dim(stages, states, index, 0) if keep else None

    stages = jnp.zeros((capacity + 1, len(scheme.nodes), y.shape[0])) if keep else None
    carry = (y, jnp.zeros((capacity + 1, y[:shown].shape[0])), stages)
    _, path, stages = jax.lax.fori_loop(0, count + 1, advance, carry)
    return path, stages


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
    shown: int,
) -> Float[Array, "n m"]:
    """States after 0, 1 ... `count` steps of dy/dt = rate(driver, t, y), in an array for `capacity` steps.

    Has forward derivatives with respect to `driver` and `y`, not to times.

    Args:
        driver: First argument of `rate`.
        y: Initial state.
        start: First time (s).
        step: Time step (s).
        count: Number of steps that are taken.
        rate: Right-hand side.
        scheme: Butcher tableau.
        capacity: Largest number of steps.
        shown: Number of entries of the state that are returned.
    """
    return _march(driver, y, start, step, count, rate, scheme, capacity, False, shown)[0]


@forward.def_jvp
def _forward_jvp(primals, tangents, *, rate: Rate, scheme: Scheme, capacity: int, shown: int):
    """Tangents of a whole simulation from linearisations at every stage, several steps at once.

    Once the path is known, its linearisations do not depend on each other. Only one product of a small matrix per step is left
    in sequence. The state's part is common to all parameters, so that initial states cost nothing more.
    """
    driver, y, start, step, count = primals
    d_driver, d_y, *_ = tangents
    path, stages = _march(driver, y, start, step, count, rate, scheme, capacity, True, shown)
    assert stages is not None
    nodes, size, states = jnp.array(scheme.nodes), len(scheme.nodes), y.shape[0]
    linearised = linearised_rate(rate, driver, d_driver)
    batches = -(-(capacity + 1) // BATCH)
    stages = jnp.pad(stages, ((0, batches * BATCH - capacity - 1), (0, 0), (0, 0)))
    # the scheme applied to the linearised equation: d_y after a step = transfer d_y + drive
    eye, table = jnp.eye(states), scheme.coefficients()

    def batch(index, carry):
        numbers = index * BATCH + jnp.arange(BATCH)
        times = start + step * (numbers[:, None] + nodes)
        points = jax.lax.dynamic_slice_in_dim(stages, index * BATCH, BATCH)
        slope, push = jax.vmap(linearised)(times.reshape(-1), points.reshape(-1, states))
        slope, push = (x.reshape(BATCH, size, *x.shape[1:]) for x in (slope, push))
        matrices: list[Array] = []
        vectors: list[Array] = []
        for i in range(size):
            matrix = eye + step * sum((table[i, j] * matrices[j] for j in range(i)), jnp.zeros_like(slope[:, 0]))
            vector = step * sum((table[i, j] * vectors[j] for j in range(i)), jnp.zeros_like(push[:, 0]))
            matrices.append(slope[:, i] @ matrix)
            vectors.append(push[:, i] + jnp.einsum("nij,nj->ni", slope[:, i], vector))
        transfer = eye + step * sum(b * m for b, m in zip(scheme.weights, matrices, strict=True))
        drive = step * sum(b * v for b, v in zip(scheme.weights, vectors, strict=True))
        d_y, d_path = carry
        d_y, taken = jax.lax.scan(lambda d, now: (now[0] @ d + now[1], d[:shown]), d_y, (transfer, drive))
        return d_y, jax.lax.dynamic_update_slice_in_dim(d_path, taken, index * BATCH, 0)

    d_y = jnp.zeros_like(y) if d_y is None else d_y
    d_path = jnp.zeros((batches * BATCH, shown))
    _, d_path = jax.lax.fori_loop(0, (count + BATCH) // BATCH, batch, (d_y, d_path))
    return path, d_path[: capacity + 1]


def backward(driver, y, start, step, count, *, rate: Rate, scheme: Scheme, capacity: int) -> Float[Array, "n s"]:
    """The same path for a reverse gradient: states at block starts are stored, the others recomputed."""

    def advance(y, index):
        return _step(driver, y, start + step * index, step, rate, scheme, False)[0], y

    blocks = -(-(capacity + 1) // CHECKPOINT_STEPS)
    index = jnp.arange(blocks * CHECKPOINT_STEPS, dtype=float).reshape(blocks, CHECKPOINT_STEPS)
    _, saved = jax.lax.scan(jax.checkpoint(lambda y, index: jax.lax.scan(advance, y, index)), y, index)
    return saved.reshape(-1, y.shape[0])[: capacity + 1]
