"""Linear damping matrix."""

from typing import Any, ClassVar

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.matrix import Entries, assemble, by_entry


class LinearDamping(AbstractLoad):
    """Linear damping matrix along body axes.

    F = -B v, v the velocity of the reference point and the angular velocity, along body axes as in OpenFAST.

    Labels are `linear_damping.B11` and so on. Faltinsen 1990, Sea Loads on Ships and Offshore Structures, chapter 3.
    """

    entries: Entries = by_entry("B", "linear damping", "velocity")
    source: ClassVar[str] = "Faltinsen 1990, chapter 3"

    def act(self, now: Instant, memory: Any) -> Action:
        return Action(body_force=-assemble(self.entries) @ now.velocity)
