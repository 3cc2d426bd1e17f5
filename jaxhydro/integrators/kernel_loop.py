"""Time loop of four-step Adams-Bashforth inside one GPU kernel, one block of threads per simulation.

Under `jax.vmap` each simulation is a block. The equation of motion is the same as elsewhere: it is traced, and its operations
are written into the kernel (`kernel_trace`). There are no derivatives.
"""

from collections.abc import Iterable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax.experimental import pallas as pl
from jax.experimental.pallas import triton
from jaxtyping import Array, Float

from jaxhydro.integrators import adams_bashforth
from jaxhydro.integrators.adams_bashforth_coefficients import START_STEPS, STORED_SLOPES
from jaxhydro.integrators.kernel_plan import Plan, Value
from jaxhydro.integrators.kernel_tiles import Tables, Writer, padded
from jaxhydro.integrators.kernel_trace import plan
from jaxhydro.integrators.linearised_rate import Rate

MANY = 1 << 28  # numbers in tables, at most
WARPS = 4  # of 32 threads per simulation


def march(
    driver: Any,
    y: Float[Array, " s"],
    start: Float[Array, ""],
    step: Float[Array, ""],
    *,
    rate: Rate,
    capacity: int,
    shown: int,
    interpret: bool = False,
) -> Float[Array, "n _"]:
    """First `shown` entries of the states after 0, 1 ... `capacity` steps of dy/dt = rate(driver, t, y).

    Args:
        driver: First argument of `rate`.
        y: Initial state.
        start: First time (s).
        step: Time step (s).
        rate: Right-hand side.
        capacity: Number of steps.
        shown: Number of entries that are returned.
        interpret: Run the kernel's operations by XLA on any device, slowly, for tests.

    Raises:
        KernelError: The right-hand side does what a kernel cannot do.
    """
    total = adams_bashforth.evaluations(capacity + 1)
    slopes = jnp.zeros((STORED_SLOPES, y.shape[0]), y.dtype)

    def advanced(index, y, slopes):
        return adams_bashforth.evaluation(driver, index, y, slopes, start, step, rate)[:2]

    types = [jax.ShapeDtypeStruct((), jnp.int32), *(jax.ShapeDtypeStruct(x.shape, x.dtype) for x in (y, slopes))]
    made, (_, *carried), results = plan(advanced, types)
    tables = Tables()
    pools = _first_contents(made, zip(carried, (y, slopes), strict=True))
    streams = [x.reshape(-1) for x in made.streams]
    names, width = list(pools), padded(shown)

    def kernel(*refs):
        table, *rest = refs[len(names) : len(names) + 1 + len(streams)]
        *spaces, path = refs[len(names) + 1 + len(streams) :]

        def body(index, _):
            writer = Writer(made, tables, dict(zip(names, spaces, strict=True)), rest, table, not interpret)
            row = jnp.where(index < 4 * START_STEPS, index // 4, index - 3 * START_STEPS)
            path[pl.ds(row * shown, width)] = writer.read(Value(y.dtype, carried[0].address[:shown]), width)
            writer.advance(index, carried, results)
            return 0

        jax.lax.fori_loop(0, total, body, 0)

    def run(table):
        return pl.pallas_call(
            kernel,
            out_shape=(
                *(jax.ShapeDtypeStruct(x.shape, x.dtype) for x in pools.values()),
                jax.ShapeDtypeStruct((capacity * shown + width,), y.dtype),
            ),
            input_output_aliases={i: i for i in range(len(names))},
            compiler_params=None if interpret else triton.CompilerParams(num_warps=WARPS),
            interpret=interpret,
        )(*pools.values(), table, *streams)

    jax.eval_shape(run, jax.ShapeDtypeStruct((MANY,), jnp.int32))  # only to learn the tables
    return run(jnp.asarray(tables.array()))[-1][: (capacity + 1) * shown].reshape(-1, shown)


def _first_contents(made: Plan, carried: Iterable[tuple[Value, Array]]) -> dict[str, Array]:
    """Workspaces before the first step."""
    contents = {name: list(parts) for name, parts in made.contents.items()}
    for value, array in carried:
        contents.setdefault(value.pool, []).append((int(value.address.reshape(-1)[0]), array))
    workspaces = {}
    for name, size in sorted(made.size.items()):
        dtype = jnp.int32 if name == "bool" else np.dtype(name)
        parts, end = [], 0
        for start, array in sorted(contents.get(name, []), key=lambda part: part[0]):
            parts += [jnp.zeros(start - end, dtype), jnp.asarray(array).reshape(-1).astype(dtype)]
            end = start + array.size
        workspaces[name] = jnp.concatenate([*parts, jnp.zeros(size + made.widest - end, dtype)])
    return workspaces
