"""Instructions of a `Plan` written as a Pallas kernel: flat tiles of a power of two of numbers."""

import math
from collections.abc import Sequence
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax.experimental import pallas as pl
from jax.experimental.pallas import triton

from jaxhydro.integrators.kernel_plan import Instruction, Plan, Value

UNROLLED = 8  # terms of a sum up to which each is written out
WIDE = 8192  # numbers of a tile with which a sum over many terms is one reduction
REDUCE: dict[str, Any] = {"add": jnp.sum, "max": jnp.max, "min": jnp.min}
COMBINE = {"add": jnp.add, "max": jnp.maximum, "min": jnp.minimum, "mul": jnp.multiply, "and": jnp.logical_and}
COMBINE |= {"or": jnp.logical_or}
NEUTRAL = {"add": 0.0, "max": -math.inf, "min": math.inf}


def padded(count: int) -> int:
    """The smallest power of two from `count` on."""
    return 1 << max(count - 1, 0).bit_length()


def ordered(address: np.ndarray) -> tuple[int, list[int]] | None:
    """First address and strides, or None where addresses are not linear in the coordinates."""
    first = int(address.reshape(-1)[0])
    strides = [int(np.take(address, 1, d).reshape(-1)[0]) - first if n > 1 else 0 for d, n in enumerate(address.shape)]
    linear = np.full(address.shape, first)
    for d, (stride, n) in enumerate(zip(strides, address.shape)):
        linear = linear + stride * np.arange(n).reshape([-1 if i == d else 1 for i in range(address.ndim)])
    return (first, strides) if (linear == address).all() else None


class Tables:
    """Addresses that follow no rule, in one array that all simulations share."""

    def __init__(self) -> None:
        self.parts: list[np.ndarray] = []
        self.size, self._known = 0, dict[bytes, int]()

    def at(self, addresses: np.ndarray) -> int:
        """Number of the first of these addresses in the array."""
        row = np.ascontiguousarray(addresses, np.int32)
        if (key := row.tobytes()) not in self._known:
            self._known[key] = self.size
            self.parts.append(row)
            self.size += row.size
        return self._known[key]

    def array(self) -> np.ndarray:
        """All addresses in one array."""
        return np.concatenate(self.parts) if self.parts else np.zeros(1, np.int32)


class Writer:
    """Writer of one evaluation of a plan into a kernel.

    A kernel is traced twice: first to learn the tables of addresses, which it takes as an argument.

    Args:
        made: The plan.
        tables: Tables of addresses, which grow.
        pools: Workspaces by type.
        streams: Arrays that are looked up outside the workspaces.
        table: `tables` in the kernel.
        wait: Whether threads have to wait for each other: not where the kernel is only interpreted.
    """

    def __init__(self, made: Plan, tables: Tables, pools: dict[str, Any], streams: Sequence[Any], table: Any, wait: bool):
        self.plan, self.tables, self.pools, self.streams, self.table, self.wait = made, tables, pools, streams, table, wait
        self.tiles: dict[int, Any] = {}
        self._unread: set[int] = set()  # instructions stored since all threads last waited for each other

    def barrier(self) -> None:
        """Let all threads wait for what the others have stored."""
        self._unread.clear()
        if self.wait:
            triton.debug_barrier()

    def _ready(self, value: Value) -> None:
        if any(id(owner) in self._unread for owner in self.plan.owner_of(value)):
            self.barrier()

    def _ref(self, value: Value) -> Any:
        return self.pools[value.pool] if value.stream is None else self.streams[value.stream]

    def _places(self, address: np.ndarray, size: int, shape: tuple[int, ...] | None = None) -> Any:
        """Addresses of a tile of `size` numbers; `shape`: sizes of the axes with padding."""
        shape = address.shape if shape is None else shape
        if (rule := ordered(address)) is None:
            full = np.pad(address, [(0, s - n) for s, n in zip(shape, address.shape)], mode="edge").reshape(-1)
            full = np.pad(full, (0, size - full.size), mode="edge")
            return self.table[pl.ds(self.tables.at(full), size)]
        first, strides = rule
        flat, inner = jnp.arange(size, dtype=jnp.int32), math.prod(shape)
        places = jnp.full((size,), first, jnp.int32)
        for n, whole, stride in zip(address.shape, shape, strides):
            inner //= whole
            if stride:
                along = flat // inner if inner > 1 else flat
                if inner * whole < size:
                    along = along % whole
                places = places + stride * jnp.minimum(along, n - 1)
        return places

    def read(self, value: Value, size: int) -> Any:
        """Tile of an array from memory."""
        self._ready(value)
        ref, flat = self._ref(value), value.address.reshape(-1)
        if (flat == flat[0]).all():
            tile = jnp.broadcast_to(ref[pl.ds(int(flat[0]), 1)], (size,))
        elif (np.diff(flat) == 1).all():
            tile = ref[pl.ds(int(flat[0]), size)]
        else:
            tile = ref[self._places(value.address, size)]
        return tile != 0 if value.dtype == bool else tile

    def tile(self, x: Any, size: int, dtype: Any) -> Any:
        """Tile of an operand, from registers if it is in them."""
        if not isinstance(x, Value):
            return jnp.full((size,), x, dtype)
        owner = self.plan.in_register(x)
        if owner is not None and id(owner) in self.tiles:
            tile = self.tiles[id(owner)]
            return tile if tile.shape[0] == size else jnp.broadcast_to(tile, (size,))
        return self.read(x, size)

    def write(self, instruction: Instruction, index: Any) -> None:
        """Write one instruction."""
        size = padded(instruction.value.address.size)
        if instruction.kind == "index":
            tile = jnp.full((1,), index, instruction.value.dtype)
        elif instruction.kind == "contract":
            tile = self._contract(instruction, size)
        elif instruction.kind == "lookup":
            tile = self._lookup(instruction, size)
        else:
            how = instruction.parameters
            tiles = [self.tile(x, size, dtype) for x, dtype in zip(instruction.operands, how["types"])]
            rounding = instruction.kind == "round"
            tile = _rounded(tiles[0], how) if rounding else how["primitive"].bind(*tiles, **how["parameters"])
        self.tiles[id(instruction)] = tile
        if instruction.stored:
            stored = tile.astype(jnp.int32) if instruction.value.dtype == bool else tile
            self.pools[instruction.value.pool][pl.ds(instruction.start, size)] = stored
            self._unread.add(id(instruction))

    def advance(self, index: Any, carried: Sequence[Value], results: Sequence[Value]) -> None:
        """Write all instructions, and the results in the places that the next evaluation reads."""
        for instruction in self.plan.instructions:
            self.write(instruction, index)
        tiles = [self.tile(x, padded(x.address.size), x.dtype) for x in results]
        self.barrier()
        for value, tile in zip(carried, tiles, strict=True):
            self.pools[value.pool][pl.ds(int(value.address.reshape(-1)[0]), tile.shape[0])] = tile
        self.barrier()

    def _contract(self, instruction: Instruction, size: int) -> Any:
        operands, how, dtype = instruction.operands, instruction.parameters["how"], instruction.value.dtype
        terms = operands[0].address.shape[-1]

        def product(parts: list[Any]) -> Any:
            return parts[0] if len(parts) == 1 else parts[0] * parts[1]

        if terms <= UNROLLED or how not in REDUCE:
            combined = None
            for k in range(terms):
                term = product([self.read(Value(x.dtype, x.address[..., k], None, x.stream), size) for x in operands])
                combined = term if combined is None else COMBINE[how](combined, term)
            return combined
        for x in operands:
            self._ready(x)
        if size * padded(terms) <= WIDE:
            shape = (size, padded(terms))
            parts = [self._ref(x)[self._places(x.address.reshape(-1, terms), math.prod(shape), shape)] for x in operands]
            inside = jnp.arange(math.prod(shape), dtype=jnp.int32) % shape[1] < terms
            whole = jnp.where(inside, product(parts), jnp.full(inside.shape, NEUTRAL[how], dtype))
            return REDUCE[how](whole.reshape(shape), axis=1)
        refs = [self._ref(x) for x in operands]
        firsts: list[Any] = []
        steps: list[int | None] = []
        for x in operands:
            away = x.address[..., 1] - x.address[..., 0]
            step = int(away.reshape(-1)[0])
            if not (x.address == x.address[..., :1] + step * np.arange(terms)).all():
                rows = [x.address[..., k].reshape(-1) for k in range(terms)]
                rows = [np.pad(row, (0, size - row.size), mode="edge") for row in rows]
                firsts.append(self.tables.at(np.concatenate(rows)))
                steps.append(None)
            else:
                firsts.append(self._places(x.address[..., 0], size))
                steps.append(step)

        def more(k: Any, total: Any) -> Any:
            parts = [
                ref[self.table[pl.ds(first + k * size, size)] if step is None else first + k * step]
                for ref, first, step in zip(refs, firsts, steps)
            ]
            return COMBINE[how](total, product(parts))

        return jax.lax.fori_loop(0, terms, more, jnp.full((size,), NEUTRAL[how], dtype))

    def _lookup(self, instruction: Instruction, size: int) -> Any:
        how = instruction.parameters
        source: Value = how["source"]
        self._ready(source)
        places = self._places(how["base"], size)
        for (stride, most), x in zip(how["steps"], instruction.operands):
            index = self.tile(x, size, jnp.int32).astype(jnp.int32)
            places = places + stride * jnp.minimum(jnp.maximum(index, 0), most)
        return self._ref(source)[places]


def _rounded(x: Any, how: dict[str, Any]) -> Any:
    """Nearest whole number: Triton knows `floor` only."""
    if how["parameters"]["rounding_method"] == jax.lax.RoundingMethod.AWAY_FROM_ZERO:
        return jnp.where(x < 0, -jnp.floor(0.5 - x), jnp.floor(x + 0.5))
    up = jnp.floor(x + 0.5)
    odd = up - 2 * jnp.floor(0.5 * up) > 0.5
    return jnp.where((up - x == 0.5) & odd, up - 1, up)
