"""Fewer and quicker compilations, and arrays without a compiled program.

The jit functions are for programs that run a few times, or in threads.
"""

import threading
from collections.abc import Callable, Hashable
from functools import update_wrapper
from typing import Any, Generic, ParamSpec, TypeVar

import equinox as eqx
import jax
import numpy as np
from numpy.typing import ArrayLike

from jaxhydro.exported_programs import exported_jit

UNOPTIMISED = {"xla_backend_optimization_level": 0, "xla_llvm_disable_expensive_passes": True}
P = ParamSpec("P")
R = TypeVar("R")


def quick_jit(fun: Callable[P, R]) -> Callable[P, R]:
    """`exported_jit` that compiles without optimisation, which takes half the time.

    For statics and set-up, whose compilation takes a thousand times as long as their run. Within another program that is
    traced, the function is part of that program, and is optimised with it.

    Args:
        fun: The function.
    """
    return exported_jit(fun, UNOPTIMISED)


class JitOnce(Generic[P, R]):
    """Function of `jit_once`."""

    def __init__(self, fun: Callable[P, R]) -> None:
        update_wrapper(self, fun)
        self._jitted: Callable[P, R] = exported_jit(fun)
        self._lock, self._compiled = threading.Lock(), set[Hashable]()

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        key = self._key(args, kwargs)
        if key in self._compiled:
            return self._jitted(*args, **kwargs)
        with self._lock:
            result = self._jitted(*args, **kwargs)
            self._compiled.add(key)
        return result

    def prepare(self, *args: P.args, **kwargs: P.kwargs) -> None:
        """Compile the program of some arguments, unless it is compiled: it runs once, and the result is dropped."""
        key = self._key(args, kwargs)
        with self._lock:
            if key not in self._compiled:
                self._jitted(*args, **kwargs)
                self._compiled.add(key)

    @staticmethod
    def _key(args: tuple[Any, ...], kwargs: dict[str, Any]) -> Hashable:
        """What programs differ by: structure, shapes and types of arrays, all other values."""
        leaves, structure = jax.tree.flatten((args, kwargs))
        return structure, *((leaf.shape, leaf.dtype) if eqx.is_array(leaf) else leaf for leaf in leaves)


def jit_once(fun: Callable[P, R]) -> JitOnce[P, R]:
    """`exported_jit` that compiles once when several threads ask for the same program.

    JAX compiles it in every thread that calls before the first compilation has ended.

    Args:
        fun: The function.
    """
    return JitOnce(fun)


def on_device(values: ArrayLike) -> jax.Array:
    """JAX array of a NumPy array or number, made without a program.

    `jnp.asarray` compiles one for every shape (JAX 0.10).

    Args:
        values: The numbers; they are copied.
    """
    return jax.device_put(np.array(values))


def as_data(values: ArrayLike) -> jax.Array:
    """Numbers as an argument of `quick_jit`, which makes a Python number part of the program; a JAX array is left as it is."""
    return values if isinstance(values, jax.Array) else on_device(np.asarray(values, float))
