"""Fewer and quicker compilations, and arrays without a compiled program.

The jit functions are for programs that run a few times, or in threads.
"""

import threading
from collections.abc import Callable, Hashable
from functools import wraps
from typing import ParamSpec, TypeVar

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from numpy.typing import ArrayLike

UNOPTIMISED = {"xla_backend_optimization_level": 0, "xla_llvm_disable_expensive_passes": True}
P = ParamSpec("P")
R = TypeVar("R")


def quick_jit(fun: Callable[P, R]) -> Callable[P, R]:
    """`equinox.filter_jit` that compiles without optimisation, which takes half the time.

    For statics and set-up, whose compilation takes a thousand times as long as their run. Within another program that is
    traced, the function is part of that program, and is optimised with it.

    Args:
        fun: The function.
    """
    alone: Callable[P, R] = eqx.filter_jit(fun, compiler_options=UNOPTIMISED)  # type: ignore[call-overload]
    within = eqx.filter_jit(fun)  # JAX takes compiler options at the top level only

    @wraps(fun)
    def compiled(*args: P.args, **kwargs: P.kwargs) -> R:
        fresh = jnp.zeros(())  # a tracer where a program is traced
        traced = any(isinstance(leaf, jax.core.Tracer) for leaf in jax.tree.leaves((fresh, args, kwargs)))
        result: R = (within if traced else alone)(*args, **kwargs)
        return result

    return compiled


def jit_once(fun: Callable[P, R]) -> Callable[P, R]:
    """`equinox.filter_jit` that compiles once when several threads ask for the same program.

    JAX compiles it in every thread that calls before the first compilation has ended.

    Args:
        fun: The function.
    """
    jitted: Callable[P, R] = eqx.filter_jit(fun)
    lock, compiled = threading.Lock(), set[Hashable]()

    @wraps(fun)
    def alone_at_first(*args: P.args, **kwargs: P.kwargs) -> R:
        leaves, structure = jax.tree.flatten((args, kwargs))
        kinds = ((leaf.shape, leaf.dtype) if eqx.is_array(leaf) else leaf for leaf in leaves)
        key = (structure, *kinds)
        if key in compiled:
            return jitted(*args, **kwargs)
        with lock:
            result = jitted(*args, **kwargs)
            compiled.add(key)
        return result

    return alone_at_first


def on_device(values: ArrayLike) -> jax.Array:
    """JAX array of a NumPy array or number, made without a program.

    `jnp.asarray` compiles one for every shape (JAX 0.10).

    Args:
        values: The numbers; they are copied.
    """
    return jax.device_put(np.array(values))
