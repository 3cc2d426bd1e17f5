"""Schema of masses that follow the hull in some directions only, in SI."""

from collections.abc import Iterator, Sequence
from typing import Annotated, Any, Literal, Protocol

from pydantic import BeforeValidator, Field

from jaxhydro.errors import Problem, shown
from jaxhydro.input_schema import Consistent, Flag, Positive, Text, Vector


def _as_list(value: Any) -> Any:
    return [value] if isinstance(value, str) else value


class GuidedMass(Consistent):
    """A mass (kg) that follows a `point` of the hull in the directions that it `moves` in.

    The point is in m from the reference point. The directions are the earth's axes x, y, z. Guides or rails hold it in the
    others and carry its weight. With `weight: true` the platform carries that (`jaxhydro.loads.GuidedMasses`).
    """

    name: Text
    mass: Positive
    point: Vector
    moves: Annotated[tuple[Literal["x", "y", "z"], ...], Field(min_length=1), BeforeValidator(_as_list)]
    weight: Flag = False

    def _faults(self) -> Iterator[Problem]:
        if len(set(self.moves)) < len(self.moves):
            yield Problem("moves", "each direction once", shown(list(self.moves)))
        if self.weight and "z" not in self.moves:
            yield Problem("weight", "false for a mass that does not move along z", "true", "Its guides carry the weight.")

    def axes(self) -> tuple[int, ...]:
        """Numbers from 0 of the directions that it moves in."""
        return tuple("xyz".index(axis) for axis in self.moves)


class Named(Protocol):
    """Entry of the platform file that has a name."""

    @property
    def name(self) -> str:
        """The name."""


def twice_named(key: str, things: Sequence[Named]) -> Iterator[Problem]:
    """Entries of a list in the platform file, under `key`, of a name that one before them has."""
    names = [thing.name for thing in things]
    for i, name in enumerate(names):
        if name in names[:i]:
            yield Problem(f"{key}[{i}].name", "a name of its own", f"{shown(name)} again")
