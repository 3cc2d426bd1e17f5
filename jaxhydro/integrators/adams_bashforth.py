"""Four-step Adams-Bashforth scheme at fixed steps, one evaluation per step.

It is differentiable forward and in reverse. The cost of a sea is its kinematics, which are known at even times. The scheme
needs half the evaluations of any Runge-Kutta scheme of that order.

References: Hairer, Norsett and Wanner (1993), Solving Ordinary Differential Equations I, section III.1, eq. (1.5).
"""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from jaxhydro.integrators.adams_bashforth_coefficients import (
    EVALUATIONS,
    START_STEPS,
    STORED_SLOPES,
    coefficients_of,
    row_of,
)
from jaxhydro.integrators.linearised_rate import Rate, linearised_rate

CHECKPOINT_STEPS = 64  # steps per checkpointed block of a reverse gradient
BATCH = 4  # evaluations linearised together: their flow fills the cache


def evaluations(steps: int | Int[Array, ""]) -> Any:
    """Number of evaluations in `steps` steps."""
    return steps + 3 * START_STEPS


def evaluation(
    driver: Any,
    index: Int[Array, ""],
    y: Float[Array, " s"],
    slopes: Float[Array, "m s"],
    start: Float[Array, ""],
    step: Float[Array, ""],
    rate: Rate,
) -> tuple[Array, Array, Array, Array]:
    """One evaluation of the right-hand side.

    Args:
        driver: First argument of `rate`.
        index: Number of the evaluation.
        y: State at the start of its step.
        slopes: Remembered slopes, newest first.
        start: First time (s).
        step: Time step (s).
        rate: Right-hand side.

    Returns:
        The state and the remembered slopes after it, the number of its step, and the state at which it was made.
    """
    point, add, time, number = coefficients_of(index)
    state = y + step * (point @ slopes)
    slope = jnp.concatenate(rate(driver, start + step * time, state))
    slopes = jnp.concatenate([slope[None], slopes[:-1]])
    return y + step * (add @ slopes), slopes, number, state


def march(
    driver: Any,
    y: Array,
    start: Array,
    step: Array,
    count: Array,
    rate: Rate,
    capacity: int,
    keep: bool,
    shown: int | None = None,
) -> tuple[Array, Any]:
    """States after 0, 1 ... `count` steps, as `forward`, and on request those of all evaluations.

    Args:
        driver: First argument of `rate`.
        y: First state (s,).
        start: First time (s).
        step: Time step (s).
        count: Number of steps that are taken.
        rate: Right-hand side.
        capacity: Number of steps that there is room for.
        keep: Whether the states of all evaluations are returned, too.
        shown: How many entries of the states after the steps are returned; None: all.
    """

    def body(index, carry):
        y, slopes, path, taken = carry
        after, newer, number, state = evaluation(driver, index, y, slopes, start, step, rate)
        path = jax.lax.dynamic_update_index_in_dim(path, y[:shown], number, 0)
        taken = jax.lax.dynamic_update_index_in_dim(taken, state, index, 0) if keep else None
        return after, newer, path, taken

    size = y.shape[0]
    taken = jnp.zeros((evaluations(capacity + 1), size)) if keep else None
    carry = (y, jnp.zeros((STORED_SLOPES, size)), jnp.zeros((capacity + 1, y[:shown].shape[0])), taken)
    _, _, path, taken = jax.lax.fori_loop(0, evaluations(count + 1), body, carry)
    return path, taken


class Tangent(NamedTuple):
    """Slope of a simulation along one direction, between two evaluations.

    Attributes:
        y: Of the state (s,).
        slopes: Of the remembered slopes (m, s), each at its evaluation's number modulo m.
    """

    y: Float[Array, " s"]
    slopes: Float[Array, "m s"]

    @classmethod
    def begin(cls, y: Float[Array, " s"]) -> "Tangent":
        """Before the first evaluation, from the slope of the first state."""
        return cls(y, jnp.zeros((STORED_SLOPES, *y.shape)))

    def after(
        self, index: Int[Array, ""], slope: Float[Array, "s s"], push: Float[Array, " s"], step: Float[Array, ""]
    ) -> "Tangent":
        """After an evaluation.

        Args:
            index: Number of the evaluation.
            slope: Slopes of the right-hand side by the state there.
            push: Its slope along the direction of the driver.
            step: Time step (s).
        """
        row = row_of(index)

        def back(slopes: Array, ago: Array) -> Array:
            return jax.lax.dynamic_index_in_dim(slopes, (index - ago) % STORED_SLOPES, 0, keepdims=False)

        (last,), (weight,) = jnp.array(EVALUATIONS.point_back)[row], jnp.array(EVALUATIONS.point_weight)[row]
        new = slope @ (self.y + step * weight * back(self.slopes, last)) + push
        slopes = jax.lax.dynamic_update_index_in_dim(self.slopes, new, index % STORED_SLOPES, 0)
        lags, weights = jnp.array(EVALUATIONS.add_back)[row], jnp.array(EVALUATIONS.add_weight)[row]
        return Tangent(self.y + step * sum(weights[k] * back(slopes, lags[k]) for k in range(len(lags))), slopes)


@eqx.filter_custom_jvp
def forward(
    driver: Any,
    y: Float[Array, " s"],
    start: Float[Array, ""],
    step: Float[Array, ""],
    count: Int[Array, ""],
    *,
    rate: Rate,
    capacity: int,
    shown: int,
) -> Float[Array, "n m"]:
    """States after 0, 1 ... `count` steps, as `runge_kutta.forward`."""
    return march(driver, y, start, step, count, rate, capacity, False, shown)[0]


def times_of(index: Int[Array, " m"], start: Float[Array, ""], step: Float[Array, ""]) -> Float[Array, " m"]:
    """Times (s) of evaluations."""
    return start + step * jax.vmap(coefficients_of)(index)[2]


@forward.def_jvp
def _forward_jvp(primals, tangents, *, rate: Rate, capacity: int, shown: int):
    """Tangents by linearisation at all evaluations, several at once, and the scheme applied to them."""
    driver, y, start, step, count = primals
    d_driver, d_y, *_ = tangents
    path, taken = march(driver, y, start, step, count, rate, capacity, True, shown)
    linearised = linearised_rate(rate, driver, d_driver)
    batches = -(-evaluations(capacity + 1) // BATCH)
    taken = jnp.pad(taken, ((0, batches * BATCH - taken.shape[0]), (0, 0)))

    def advance(carry, now):
        tangent, d_path = carry
        d_path = jax.lax.dynamic_update_index_in_dim(d_path, tangent.y[:shown], coefficients_of(now[0])[3], 0)
        return (tangent.after(*now, step), d_path), None

    def batch(block, carry):
        index = block * BATCH + jnp.arange(BATCH)
        states = jax.lax.dynamic_slice_in_dim(taken, block * BATCH, BATCH)
        return jax.lax.scan(advance, carry, (index, *jax.vmap(linearised)(times_of(index, start, step), states)))[0]

    carry = Tangent.begin(jnp.zeros_like(y) if d_y is None else d_y), jnp.zeros((capacity + 1 + BATCH, shown))
    _, d_path = jax.lax.fori_loop(0, (evaluations(count + 1) + BATCH - 1) // BATCH, batch, carry)
    return path, d_path[: capacity + 1]


def first_evaluations(steps: int) -> np.ndarray:
    """Numbers of the evaluations at the beginnings of steps (n,)."""
    return np.concatenate([4 * np.arange(START_STEPS), np.arange(4 * START_STEPS, evaluations(steps))])[:steps]


def backward(driver, y, start, step, count, *, rate: Rate, capacity: int) -> Float[Array, "n s"]:
    """The same path for a reverse gradient: states at block starts are stored, the others recomputed."""

    def advance(carry, index):
        y, slopes = carry
        return evaluation(driver, index, y, slopes, start, step, rate)[:2], y

    total = evaluations(capacity + 1)
    blocks = -(-total // CHECKPOINT_STEPS)
    index = jnp.arange(blocks * CHECKPOINT_STEPS).reshape(blocks, CHECKPOINT_STEPS)
    carry = (y, jnp.zeros((STORED_SLOPES, y.shape[0])))
    _, saved = jax.lax.scan(jax.checkpoint(lambda c, i: jax.lax.scan(advance, c, i)), carry, index)
    return saved.reshape(-1, y.shape[0])[first_evaluations(capacity + 1)]
