"""Stiffness between two degrees of freedom."""

from typing import Any, ClassVar

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.matrix import Entries, assemble_symmetric, by_pair


class CoupledStiffness(AbstractLoad):
    """Symmetric stiffness between pairs of degrees of freedom.

    F_i = -C_ij q_j, F_j = -C_ij q_i, q the displacement of the reference point in earth axes and roll, pitch, yaw: fairleads at
    another height, or a hull that is not symmetric. Labels are `coupled_stiffness.C15` and so on.

    References:
        Jonkman 2007, NREL/TP-500-41958: the linearised mooring system.
    """

    entries: Entries = by_pair("C", "stiffness")
    source: ClassVar[str] = "Jonkman 2007, NREL/TP-500-41958"

    def act(self, now: Instant, memory: Any) -> Action:
        return Action(force=-assemble_symmetric(self.entries) @ now.position)
