"""Data classes of a GPU kernel's plan: values, instructions, and where in a workspace they are stored."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np


class Value:
    """Array by the addresses of its elements in the workspace of its type.

    Attributes:
        dtype: Type of the elements.
        address: Address of each element.
        traced: The same array outside the kernel, where it does not vary in it, or None.
        stream: Number of the array outside the workspace that the addresses refer to, or None.
    """

    def __init__(self, dtype: Any, address: np.ndarray, traced: Any = None, stream: int | None = None) -> None:
        self.dtype, self.address, self.traced, self.stream = np.dtype(dtype), address, traced, stream

    @property
    def pool(self) -> str:
        """Workspace that holds it: one per type."""
        return self.dtype.name


class Instruction:
    """Computation of one array, stored from `start` on where it is read other than element by element.

    Attributes:
        kind: Name of an elementwise operation, or "lookup", "contract", "index".
        operands: `Value`s and scalars.
        parameters: What else defines it.
        value: The result.
        stored: Whether it is written to the workspace.
    """

    def __init__(self, kind: str, operands: Sequence[Any], parameters: dict[str, Any], value: Value) -> None:
        self.kind, self.operands, self.parameters, self.value = kind, list(operands), parameters, value
        self.stored = False
        self.start = int(value.address.reshape(-1)[0])


class Plan:
    """Instructions of a kernel, and the first contents of its workspaces.

    Attributes:
        instructions: What is computed, in order.
        contents: By workspace, pairs of first address and what lies there.
        size: By workspace, its number of elements.
        streams: Arrays that are looked up outside the workspaces, flat.
    """

    def __init__(self) -> None:
        self.instructions: list[Instruction] = []
        self.contents: dict[str, list[tuple[int, Any]]] = {}
        self.size: dict[str, int] = {}
        self.streams: list[Any] = []
        self.widest = 1
        self._owners: dict[str, list[tuple[int, Instruction | None]]] = {}
        self._known: dict[Any, tuple[Any, Value]] = {}

    def room(self, shape: tuple[int, ...], dtype: Any) -> Value:
        """New place for an array; its owner has to be added."""
        pool, count = np.dtype(dtype).name, math.prod(shape)
        start, padded = self.size.get(pool, 0), 1 << max(count - 1, 0).bit_length()
        self.size[pool], self.widest = start + padded, max(self.widest, padded)
        self._owners.setdefault(pool, []).append((start, None))
        return Value(dtype, start + np.arange(count).reshape(shape))

    def add(self, kind: str, operands: Sequence[Any], parameters: dict[str, Any], shape: tuple[int, ...], dtype: Any) -> Value:
        """Result of a new instruction."""
        value = self.room(shape, dtype)
        instruction = Instruction(kind, operands, parameters, value)
        self.instructions.append(instruction)
        self._owners[value.pool][-1] = (instruction.start, instruction)
        return value

    def fixed(self, array: Any, like: Any = None) -> Value:
        """Place of an array that does not vary in the kernel."""
        key = ("constant", array.dtype.name, array.shape, array.tobytes()) if isinstance(array, np.ndarray) else id(array)
        if key not in self._known:
            value = self.room(array.shape, array.dtype)
            if array.size:
                self.contents.setdefault(value.pool, []).append((int(value.address.reshape(-1)[0]), array))
            value.traced = array
            self._known[key] = (array, value)  # the array is kept, so that its id stays its own
        return self._known[key][1]

    def stream(self, array: Any) -> Value:
        """An array that stays outside the workspaces."""
        key = ("stream", id(array))
        if key not in self._known:
            address = np.arange(array.size).reshape(array.shape)
            self.streams.append(array)
            self._known[key] = (array, Value(array.dtype, address, array, len(self.streams) - 1))
        return self._known[key][1]

    def owner_of(self, value: Value) -> list[Instruction]:
        """Instructions that compute elements of an array."""
        if value.stream is not None or not value.address.size:
            return []
        owners = self._owners[value.pool]
        numbers = np.unique(np.searchsorted([start for start, _ in owners], value.address.reshape(-1), side="right") - 1)
        return [owner for i in numbers if (owner := owners[i][1]) is not None]

    def in_register(self, value: Value) -> Instruction | None:
        """The instruction whose whole result this is, element by element or one for all, or None."""
        owners = self.owner_of(value)
        if len(owners) != 1:
            return None
        whole, flat = owners[0].value.address.reshape(-1), value.address.reshape(-1)
        return owners[0] if whole.size in (1, flat.size) and bool((whole == flat).all()) else None

    def finish(self, results: Sequence[Value]) -> None:
        """Drop what no result needs, and mark what has to be stored."""
        needed: set[int] = set()
        for value in results:
            for owner in self.owner_of(value):
                needed.add(id(owner))
                owner.stored = owner.stored or self.in_register(value) is None
        for reader in reversed(self.instructions):
            if id(reader) not in needed:
                continue
            for value in (operand for operand in reader.operands if isinstance(operand, Value)):
                held = None if reader.kind == "contract" else self.in_register(value)
                for owner in self.owner_of(value):
                    needed.add(id(owner))
                    owner.stored = owner.stored or held is None
        self.instructions = [instruction for instruction in self.instructions if id(instruction) in needed]
