"""Linear damping between two degrees of freedom."""

from typing import Any, ClassVar

from jaxhydro.environment import DOFS
from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.matrix import Entries, assemble, row_and_column, unit
from jaxhydro.parameters import Parameter, parameters


class CoupledDamping(AbstractLoad):
    """Symmetric linear damping between pairs of degrees of freedom.

    F_i = -B_ij v_j, F_j = -B_ij v_i along body axes: what velocity in one motion takes from another, the same both ways.

    Symmetry is that of potential damping (Faltinsen 1990, Sea Loads on Ships and Offshore Structures, chapter 3), and of a
    damper at a height z: B15 = z B11. Beyond sqrt(B_ii B_jj) of all damping it gives energy. Labels are
    `coupled_damping.B15` and so on.
    """

    entries: Entries = parameters(lambda load, key: _about(key), "{prefix}.{key}")
    source: ClassVar[str] = "Faltinsen 1990, chapter 3"

    def act(self, now: Instant, memory: Any) -> Action:
        matrix = assemble(self.entries)
        return Action(body_force=-(matrix + matrix.T) @ now.velocity)


def _about(key: str) -> Parameter:
    i, j = row_and_column(key)
    return Parameter(unit("B", key), f"linear damping that couples {DOFS[i]} and {DOFS[j]}")
