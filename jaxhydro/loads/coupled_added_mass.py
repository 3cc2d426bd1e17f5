"""Added mass between two degrees of freedom."""

from typing import Any, ClassVar

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.matrix import Entries, assemble_symmetric, by_pair


class CoupledAddedMass(AbstractLoad):
    """Symmetric added mass between pairs of degrees of freedom.

    F_i = -A_ij a_j, F_j = -A_ij a_i along the axes of `AddedMass`: added mass whose centre is at another height than the strips
    give. Labels are `coupled_added_mass.A15` and so on.

    References:
        Newman 1977, Marine Hydrodynamics, chapter 4, its quadratic terms left out.
    """

    entries: Entries = by_pair("A", "added mass")
    source: ClassVar[str] = "Newman 1977, chapter 4"

    def act(self, now: Instant, memory: Any) -> Action:
        return Action(added_mass=now.body_added_mass(assemble_symmetric(self.entries)))
