"""Constant force and moment."""

from typing import Any, ClassVar

from jaxhydro.loads.base import Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.per_dof import AbstractLoadPerDof, PerDof, by_dof


class StaticForce(AbstractLoadPerDof):
    """Constant force and moment at the reference point.

    F_i = f_i, constant along earth axes, at the reference point.

    A mean that the model lacks: a cable's pull, a rotor's thrust, wrong ballast or trim, a pretension, a steady wind. Where
    the stiffness is constant it is the same as a zero of the instrument that is off (f/C): only a period that changes with
    the offset tells the two apart.

    Faltinsen 1990, Sea Loads on Ships and Offshore Structures, chapter 6, Current and wind loads. Labels are
    `static_offset.surge.force` and so on (N; N m for rotations).
    """

    label_prefix: ClassVar[str] = "static_offset"
    force: PerDof = by_dof("N", "N m", "constant load on the reference point in {dof}, earth axes")
    source: ClassVar[str] = "Faltinsen 1990, chapter 6, Current and wind loads"

    def act(self, now: Instant, memory: Any) -> Action:
        return Action(force=self.all_dofs(self.entries(self.force)))
