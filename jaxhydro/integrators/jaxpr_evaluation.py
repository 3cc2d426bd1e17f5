"""Evaluation of a traced function (jaxpr), operation by operation, with calls inlined."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from jax.extend import core

CALLS = {"jit", "pjit", "closed_call", "core_call", "custom_jvp_call", "custom_vjp_call", "remat", "checkpoint"}
Bind = Callable[[core.JaxprEqn, list[Any]], list[Any]]


def type_of(atom: Any) -> Any:
    """Shape and type of an operand or a result."""
    return atom.aval


def walk(jaxpr: core.Jaxpr, consts: Sequence[Any], arguments: Sequence[Any], bind: Bind) -> list[Any]:
    """Results of a traced function, operation by operation.

    Args:
        jaxpr: The traced function.
        consts: Values of its constants.
        arguments: Values of its arguments, of whatever kind `bind` knows.
        bind: Applies one operation to values. Operations that only call a function are opened, and so are never passed.

    Returns:
        Values of the results.
    """
    environment: dict[core.Var, Any] = dict(zip((*jaxpr.constvars, *jaxpr.invars), (*consts, *arguments), strict=True))

    def value(atom: Any) -> Any:
        return np.asarray(atom.val, type_of(atom).dtype) if isinstance(atom, core.Literal) else environment[atom]

    for equation in jaxpr.eqns:
        values = [value(atom) for atom in equation.invars]
        if equation.primitive.name in CALLS:
            inner: Any = equation.params.get("call_jaxpr", equation.params.get("jaxpr"))
            body, inner_consts = (inner.jaxpr, inner.consts) if isinstance(inner, core.ClosedJaxpr) else (inner, ())
            results = walk(body, inner_consts, values, bind)
        else:
            results = bind(equation, values)
        environment.update(zip(equation.outvars, results, strict=True))
    return [value(atom) for atom in jaxpr.outvars]


def apply(equation: core.JaxprEqn, values: Sequence[Any]) -> list[Any]:
    """One operation applied to arrays, traced or not."""
    parameters = equation.primitive.get_bind_params(equation.params)
    results = equation.primitive.bind(*values, **parameters)
    return list(results) if equation.primitive.multiple_results else [results]
