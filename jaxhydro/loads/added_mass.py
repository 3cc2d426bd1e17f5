"""Lumped added mass."""

from typing import Any, ClassVar

from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.matrix import assemble, meaning, place, unit
from jaxhydro.parameters import Parameter


class AddedMass(AbstractLoad):
    """Lumped added mass that members do not give.

    F = -A a, a the acceleration of the reference point in body axes: added mass that members do not give.

    Labels are `added_mass.A44` and so on. Newman 1977, Marine Hydrodynamics, chapter 4, its quadratic terms left out.
    """

    values: dict[str, Float[Array, ""]]
    source: ClassVar[str] = "Newman 1977, chapter 4"

    def about(self, label: str) -> Parameter:
        i, j = place(label)
        lower = 0.0 if i == j else float("-inf")
        return Parameter(unit("A", label), meaning("added mass", "acceleration", label), lower)

    def act(self, now: Instant, memory: Any) -> Action:
        return Action(added_mass=assemble(self.values))
