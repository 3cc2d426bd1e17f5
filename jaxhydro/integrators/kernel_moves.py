"""Operations that only move numbers, applied to addresses when a kernel is planned."""

from collections.abc import Sequence

import jax
import jax.numpy as jnp
import numpy as np
from jax.extend import core

from jaxhydro.integrators.jaxpr_evaluation import apply, type_of

MOVES = {"broadcast_in_dim", "reshape", "squeeze", "expand_dims", "concatenate", "slice", "transpose", "rev", "stack", "split"}
MOVES |= {"unstack", "gather", "dynamic_slice", "scatter", "pad", "tile"}


def sources(equation: core.JaxprEqn) -> tuple[int, ...]:
    """Numbers of an operation's operands that are moved; the others say where."""
    name = equation.primitive.name
    if name in ("concatenate", "stack", "pad"):
        return tuple(range(len(equation.invars)))
    return (0, 2) if name == "scatter" else (0,)


def moved(equation: core.JaxprEqn, addresses: Sequence[np.ndarray], others: Sequence[np.ndarray] = ()) -> list[np.ndarray]:
    """Places, in the workspace, of the numbers that each result has.

    Args:
        equation: The operation.
        addresses: Places, in the workspace, of the numbers that each operand has.
        others: Indices.
    """
    name, how, first = equation.primitive.name, equation.params, addresses[0]
    if name == "broadcast_in_dim":
        dimensions = how["broadcast_dimensions"]
        shape = [1] * len(how["shape"])
        for dimension, size in zip(dimensions, first.shape, strict=True):
            shape[dimension] = size
        return [np.broadcast_to(first.reshape(shape), how["shape"])]
    if name in ("reshape", "squeeze", "expand_dims"):
        return [first.reshape(type_of(equation.outvars[0]).shape)]
    if name == "concatenate":
        return [np.concatenate(addresses, axis=how["dimension"])]
    if name == "stack":
        return [np.stack(addresses, axis=how["axis"])]
    if name == "slice":
        strides = how["strides"] or (1,) * first.ndim
        return [first[tuple(slice(*bounds) for bounds in zip(how["start_indices"], how["limit_indices"], strides))]]
    if name == "transpose":
        return [first.transpose(how["permutation"])]
    if name == "rev":
        return [np.flip(first, how["dimensions"])]
    if name == "split":
        return np.split(first, np.cumsum(how["sizes"])[:-1], axis=how["axis"])
    with jax.ensure_compile_time_eval():
        if name == "scatter":  # its operation knows the type that it was traced for
            arrays = [jnp.asarray(address, float) for address in addresses]
            arrays.insert(1, jnp.asarray(others[0]))
        else:
            arrays = [jnp.asarray(array) for array in (*addresses, *others)]
        return [np.asarray(result).astype(int) for result in apply(equation, arrays)]
