"""Right-hand sides in float32 inside a time integration in float64."""

from typing import Any, Literal

import jax
import jax.numpy as jnp
from jax.extend import core

from jaxhydro.integrators.jaxpr_evaluation import apply, type_of, walk
from jaxhydro.integrators.linearised_rate import Rate

Precision = Literal["double", "mixed"]
APART = frozenset({"optimization_barrier"})  # operations whose operands have nothing to do with each other
# operations that hold functions traced in float64
WHOLE = {"scatter", "scatter-add", "scatter_add", "scatter_mul", "while", "scan", "cond", "reduce", "custom_linear_solve"}


def in_float32(rate: Rate) -> Rate:
    """Right-hand side whose operations on the state are in float32.

    What depends on time and model only, such as a sea's series and their clock, stays in float64, and so do its slopes' sums
    in the time integration. Operations that hold a function, such as loops, stay in float64, too.

    Args:
        rate: Right-hand side in float64.

    Returns:
        The same with arguments and results in float64.
    """

    def mixed(driver: Any, time: Any, y: Any) -> tuple[Any, ...]:
        closed = jax.make_jaxpr(lambda time, y: rate(driver, time, y))(time, y)
        results = walk(closed.jaxpr, closed.consts, [time, y.astype(jnp.float32)], _bind)
        return tuple(jnp.asarray(x).astype(y.dtype) for x in results)

    return mixed


def _bind(equation: core.JaxprEqn, values: list[Any]) -> list[Any]:
    """One operation: in float32 where any operand is."""
    name = equation.primitive.name
    if name in APART or not any(_dtype(x) == jnp.float32 for x in values):
        return apply(equation, values)
    if name in WHOLE:
        results = apply(equation, [_to(x, jnp.float32, type_of(atom).dtype) for x, atom in zip(values, equation.invars)])
        return [_to(x, jnp.float64, jnp.float32) for x in results]
    changed = {
        key: jnp.dtype(jnp.float32)
        for key, value in equation.params.items()
        if key in ("new_dtype", "preferred_element_type", "dtype") and value == jnp.float64
    }
    equation = equation.replace(params=equation.params | changed)
    return apply(equation, [_to(x, jnp.float64, jnp.float32) for x in values])


def _dtype(x: Any) -> Any:
    return jnp.result_type(x)


def _to(x: Any, old: Any, new: Any) -> Any:
    return jnp.asarray(x).astype(new) if _dtype(x) == old else x
