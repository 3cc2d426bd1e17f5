"""Lumped added mass."""

from typing import Any, ClassVar

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.matrix import Entries, assemble, by_entry


class AddedMass(AbstractLoad):
    """Lumped added mass that members do not give.

    F = -A a, a the acceleration of the reference point in body axes: added mass that members do not give. With `directions`
    "earth" of the model's conventions both are along earth axes, as in OpenFAST.

    Labels are `added_mass.A44` and so on. Newman 1977, Marine Hydrodynamics, chapter 4, its quadratic terms left out.
    """

    entries: Entries = by_entry("A", "added mass", "acceleration")
    source: ClassVar[str] = "Newman 1977, chapter 4"

    def act(self, now: Instant, memory: Any) -> Action:
        return Action(added_mass=now.body_added_mass(assemble(self.entries)))
