"""Linear damping matrix."""

from typing import Any, ClassVar

from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.matrix import assemble, meaning, place, unit
from jaxhydro.parameters import Parameter


class LinearDamping(AbstractLoad):
    """Linear damping matrix along body axes.

    F = -B v, v the velocity of the reference point and the angular velocity, along body axes as in OpenFAST.

    Labels are `linear_damping.B11` and so on. Faltinsen 1990, Sea Loads on Ships and Offshore Structures, chapter 3.
    """

    values: dict[str, Float[Array, ""]]
    source: ClassVar[str] = "Faltinsen 1990, chapter 3"

    def about(self, label: str) -> Parameter:
        i, j = place(label)
        lower = 0.0 if i == j else float("-inf")
        return Parameter(unit("B", label), meaning("linear damping", "velocity", label), lower)

    def act(self, now: Instant, memory: Any) -> Action:
        return Action(body_force=-assemble(self.values) @ now.velocity)
