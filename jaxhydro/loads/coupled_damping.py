"""Linear damping between two degrees of freedom."""

from typing import Any, ClassVar

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.matrix import Entries, assemble_symmetric, by_pair


class CoupledDamping(AbstractLoad):
    """Symmetric linear damping between pairs of degrees of freedom.

    F_i = -B_ij v_j, F_j = -B_ij v_i along body axes: what velocity in one motion takes from another, the same both ways.

    Symmetry is that of potential damping, and of a damper at a height z: B15 = z B11. Beyond sqrt(B_ii B_jj) of all damping it
    gives energy. Labels are `coupled_damping.B15` and so on.

    References:
        Faltinsen 1990, Sea Loads on Ships and Offshore Structures, chapter 3.
    """

    entries: Entries = by_pair("B", "linear damping")
    source: ClassVar[str] = "Faltinsen 1990, chapter 3"

    def act(self, now: Instant, memory: Any) -> Action:
        return Action(body_force=-assemble_symmetric(self.entries) @ now.velocity)
