"""Linearisation of a right-hand side: by the state, and along one direction of what drives it."""

from collections.abc import Callable
from typing import Any, TypeAlias

import equinox as eqx
import jax
import jax.numpy as jnp
from jax.flatten_util import ravel_pytree
from jaxtyping import Array, Float

Rate = Callable[[Any, Float[Array, ""], Float[Array, " s"]], tuple[Float[Array, " _"], ...]]  # part by part
Linearised: TypeAlias = Callable[
    [Float[Array, ""], Float[Array, " s"]], tuple[Float[Array, "s s"], Float[Array, " s"]]
]  # by time and state: slopes by the state, slope along the driver's direction
ACCELERATION = 1  # number of the part that costs most, of states that begin with position and velocity


def linearised_rate(rate: Rate, driver: Any, d_driver: Any, by_state: Float[Array, "a s"] | None = None) -> Linearised:
    """Slopes of a right-hand side by the state, and along a direction of its driver.

    The acceleration is differentiated in reverse, once for the state and for all that moves in the driver. With `jax.vmap` over
    directions, each then costs a matrix product. The other parts, the memories of loads, take little.

    Args:
        rate: Right-hand side.
        driver: Its first argument.
        d_driver: The direction; None where nothing moves.
        by_state: Slopes of the acceleration by the state, where they are known; None: they are computed.
    """
    moves = jax.tree.map(lambda _, d: d is not None, driver, d_driver, is_leaf=lambda leaf: leaf is None)
    moved, still = eqx.partition(driver, moves)
    along, _ = ravel_pytree(d_driver)
    d_moved = jax.tree.unflatten(jax.tree.structure(moved), jax.tree.leaves(d_driver))

    def part(i: int, time: Float[Array, ""], state: Float[Array, " s"], moved: Any) -> Float[Array, " _"]:
        return rate(eqx.combine(moved, still), time, state)[i]

    def heavy(i: int, time: Float[Array, ""], state: Float[Array, " s"]) -> tuple[Array, Array]:
        value, transpose = jax.vjp(lambda *point: part(i, time, *point), state, moved)
        slope, by_moved = jax.vmap(transpose)(jnp.eye(value.shape[0]))
        columns = [leaf.reshape(value.shape[0], -1) for leaf in jax.tree.leaves(by_moved)]
        return slope if by_state is None else by_state, jnp.concatenate(columns, axis=1) @ along

    def light(i: int, time: Float[Array, ""], state: Float[Array, " s"]) -> tuple[Array, Array]:
        slope = jax.jacrev(lambda y: part(i, time, y, moved))(state)
        if not along.size:
            return slope, jnp.zeros(slope.shape[0])
        return slope, jax.jvp(lambda moved: part(i, time, state, moved), (moved,), (d_moved,))[1]

    def linearised(time: Float[Array, ""], state: Float[Array, " s"]) -> tuple[Array, Array]:
        count = len(jax.eval_shape(rate, driver, time, state))
        parts = [heavy(i, time, state) if along.size and i == ACCELERATION else light(i, time, state) for i in range(count)]
        slope, push = zip(*parts, strict=True)
        return jnp.concatenate(slope), jnp.concatenate(push)

    return linearised
