"""Plan of a GPU kernel, made from a traced function.

A kernel by Triton knows no concatenation, no slices, no gathers and no sizes but powers of two. So arrays lie in a workspace.
What moves numbers (slices, concatenations, transposes, constant gathers) is done by their addresses when the plan is made, and
costs nothing in the kernel. What computes is an instruction on a flat tile. Operations that do not depend on what varies in
the kernel are left to XLA, before it.
"""

from collections.abc import Callable, Sequence
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax.extend import core

from jaxhydro.integrators.jaxpr_evaluation import apply, type_of, walk
from jaxhydro.integrators.kernel_moves import MOVES, moved, sources
from jaxhydro.integrators.kernel_plan import Plan, Value

ELEMENTWISE = {"abs", "neg", "ceil", "floor", "exp", "exp2", "expm1", "log", "log1p", "sqrt", "rsqrt", "square"}
ELEMENTWISE |= {"cbrt", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh"}
ELEMENTWISE |= {"acosh", "atanh", "add", "sub", "mul", "div", "rem", "max", "min", "pow", "integer_pow", "and", "or"}
ELEMENTWISE |= {"not", "xor", "eq", "ne", "lt", "le", "gt", "ge", "select_n", "clamp", "convert_element_type"}
ELEMENTWISE |= {"is_finite", "sign", "round", "copy"}
REDUCTIONS = {"reduce_sum": "add", "reduce_max": "max", "reduce_min": "min", "reduce_prod": "mul", "reduce_and": "and"}
REDUCTIONS |= {"reduce_or": "or"}
IDENTITIES = {"optimization_barrier", "stop_gradient", "copy_p", "reduce_precision"}
STREAMED = 1 << 15  # elements from which an array that is looked up in stays where it is


class KernelError(NotImplementedError):
    """An operation that the kernel cannot do."""


def plan(
    function: Callable[..., tuple[Any, ...]], varying: Sequence[jax.ShapeDtypeStruct]
) -> tuple[Plan, list[Value], list[Value]]:
    """Plan of a function whose arguments vary in the kernel.

    Args:
        function: The function; arrays that it closes over do not vary.
        varying: Shapes and types of its arguments. The first is a number that the kernel counts.

    Returns:
        The plan, and places of the arguments and of the results.

    Raises:
        KernelError: The function does what no kernel can do.
    """
    closed = jax.make_jaxpr(function)(*varying)
    made = Plan()
    index = made.add("index", (), {}, varying[0].shape, varying[0].dtype)
    arguments = [index, *(made.room(argument.shape, argument.dtype) for argument in varying[1:])]
    consts = [const if isinstance(const, jax.core.Tracer) else np.asarray(const) for const in closed.consts]
    outputs = walk(closed.jaxpr, consts, arguments, lambda equation, values: _bind(made, equation, values))
    results = [x if isinstance(x, Value) else made.fixed(_array(x)) for x in outputs]
    made.finish(results)
    return made, arguments, results


def _array(x: Any) -> Any:
    return x if isinstance(x, jax.core.Tracer) else np.asarray(x)


def _bind(made: Plan, equation: core.JaxprEqn, values: list[Any]) -> list[Any]:
    """One operation: at once where nothing varies, else planned."""
    results = [type_of(x) for x in equation.outvars]
    if all(x.size == 0 for x in results):  # no element that could vary
        return [np.empty(x.shape, x.dtype) for x in results]
    name, outside = equation.primitive.name, [x.traced if isinstance(x, Value) else _array(x) for x in values]
    if all(x is not None for x in outside):
        if not any(isinstance(x, jax.core.Tracer) for x in outside):
            with jax.ensure_compile_time_eval():
                return [np.asarray(x) for x in apply(equation, [jnp.asarray(x) for x in outside])]
        computed = apply(equation, outside)
        if name == "broadcast_in_dim" and computed[0].size > outside[0].size:  # read again and again, not copied
            source = values[0] if isinstance(values[0], Value) else made.fixed(outside[0])
            return [Value(source.dtype, moved(equation, [source.address])[0], computed[0])]
        return computed
    if name in IDENTITIES:
        return values
    if name in MOVES:
        moving = sources(equation)
        where = [x for i, x in enumerate(outside) if i not in moving]
        if all(isinstance(x, np.ndarray) for x in where):
            placed = [x if isinstance(x, Value) else made.fixed(_array(x)) for x in (values[i] for i in moving)]
            return [Value(placed[0].dtype, address) for address in moved(equation, [x.address for x in placed], where)]
    return [_instruction(made, equation, values)]


def _instruction(made: Plan, equation: core.JaxprEqn, values: list[Any]) -> Value:
    """Plan one computing operation."""
    name, out = equation.primitive.name, type_of(equation.outvars[0])

    def placed(x: Any) -> Any:
        if isinstance(x, Value):
            return x
        array = _array(x)
        return array.item() if isinstance(array, np.ndarray) and array.ndim == 0 else made.fixed(array)

    if name in ELEMENTWISE:
        operands = [placed(x) for x in values]
        operands = [_of_shape(x, out.shape) if isinstance(x, Value) else x for x in operands]
        types = [type_of(x).dtype for x in equation.invars]
        how = {"primitive": equation.primitive, "parameters": equation.params, "types": types}
        return made.add(name, operands, how, out.shape, out.dtype)
    if name in REDUCTIONS:
        axes = tuple(equation.params["axes"])
        (operand,) = (placed(x) for x in values)
        address = np.moveaxis(operand.address, axes, range(-len(axes), 0)).reshape(*out.shape, -1)
        return _contract(made, [Value(operand.dtype, address)], REDUCTIONS[name], out)
    if name == "dot_general":
        (over_a, over_b), (batch_a, batch_b) = equation.params["dimension_numbers"]
        a, b = (placed(x) for x in values)
        sides = []
        for x, over, batch in ((a, over_a, batch_a), (b, over_b, batch_b)):
            free = [d for d in range(x.address.ndim) if d not in over and d not in batch]
            size = [x.address.shape[d] for d in free]
            moved_ = np.transpose(x.address, (*batch, *free, *over))
            sides.append((moved_.reshape(*moved_.shape[: len(batch) + len(free)], -1), len(batch), len(size)))
        (lhs, count, lhs_free), (rhs, _, rhs_free) = sides
        lhs = lhs.reshape(*lhs.shape[: count + lhs_free], *[1] * rhs_free, lhs.shape[-1])
        rhs = rhs.reshape(*rhs.shape[:count], *[1] * lhs_free, *rhs.shape[count:])
        lhs, rhs = np.broadcast_arrays(lhs, rhs)
        return _contract(made, [Value(a.dtype, lhs), Value(b.dtype, rhs)], "add", out)
    if name in ("dynamic_slice", "gather"):
        return _lookup(made, equation, values, out)
    raise KernelError(f"the kernel cannot do {name} on {', '.join(str(x.aval) for x in equation.invars)}")


def _of_shape(x: Value, shape: tuple[int, ...]) -> Value:
    """An array repeated along axes of size 1."""
    return Value(x.dtype, np.broadcast_to(x.address, shape), None, x.stream)


def _contract(made: Plan, operands: list[Value], how: str, out: Any) -> Value:
    """Sum, or the like, of products over the last axis of the addresses."""
    return made.add("contract", operands, {"how": how}, out.shape, out.dtype)


def _lookup(made: Plan, equation: core.JaxprEqn, values: list[Any], out: Any) -> Value:
    """Elements of an array at indices that vary."""
    array, outside = values[0], values[0].traced if isinstance(values[0], Value) else _array(values[0])
    if outside is not None and isinstance(outside, jax.core.Tracer) and outside.size >= STREAMED:
        array = made.stream(outside)
    elif not isinstance(array, Value):
        array = made.fixed(outside)
    shape = array.address.shape
    corner = array.address.reshape(-1)[0] if array.address.size else 0
    strides = [int(np.take(array.address, 1, d).reshape(-1)[0] - corner) if n > 1 else 0 for d, n in enumerate(shape)]
    affine = corner + (np.indices(shape) * np.array(strides, int).reshape(-1, *[1] * len(shape))).sum(axis=0)
    if not (affine == array.address).all():
        raise KernelError("the kernel cannot look up in an array that is not in order")
    if equation.primitive.name == "dynamic_slice":
        sizes = equation.params["slice_sizes"]
        base = array.address[tuple(slice(0, n) for n in sizes)]
        places = [(d, x) for d, x in enumerate(values[1:]) if sizes[d] < shape[d]]
        steps = [(strides[d], shape[d] - sizes[d], x) for d, x in places]
    else:
        numbers, sizes, index = equation.params["dimension_numbers"], equation.params["slice_sizes"], values[1]
        if numbers.operand_batching_dims or str(equation.params["mode"]).endswith("FILL_OR_DROP"):
            raise KernelError("the kernel cannot gather with fill values")
        base = array.address[tuple(slice(0, n) for n in sizes)]
        base = base.squeeze(tuple(numbers.collapsed_slice_dims))
        batch = index.address.shape[:-1]
        dims = [d for d in range(len(out.shape)) if d not in numbers.offset_dims]
        base = np.broadcast_to(np.expand_dims(base, tuple(dims)), out.shape)
        steps = []
        for k, d in enumerate(numbers.start_index_map):
            spread = np.expand_dims(index.address[..., k].reshape(batch), tuple(numbers.offset_dims))
            steps.append((strides[d], shape[d] - sizes[d], Value(index.dtype, np.broadcast_to(spread, out.shape))))
    places_ = [x if isinstance(x, Value) else int(np.asarray(x)) for _, _, x in steps]
    how = {"base": base, "steps": [(s, most) for s, most, _ in steps], "source": array}
    if array.traced is None:  # computed in the kernel: it has to be stored
        places_.append(array)
    return made.add("lookup", places_, how, out.shape, out.dtype)
