"""Constant force and moment."""

from collections.abc import Sequence
from typing import Any, ClassVar, Self

from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.per_dof import about, all_dofs, both_units, entries, nulls
from jaxhydro.parameters import Parameter

PARAMETERS = {"force": both_units("N", "N m", "constant load on the reference point in {dof}, earth axes")}


class StaticForce(AbstractLoad):
    """Constant force and moment at the reference point.

    F_i = f_i, constant along earth axes, at the reference point.

    A mean that nobody declared: a cable's pull, a rotor's thrust, wrong ballast or trim, a pretension, a steady wind. Where
    the stiffness is constant it is the same as a zero of the instrument that is off (f/C): only a period that changes with
    the offset tells the two apart.

    Faltinsen 1990, Sea Loads on Ships and Offshore Structures, chapter 6, Current and wind loads. Labels are
    `static_offset.surge.force` and so on (N; N m for rotations).
    """

    values: dict[str, Float[Array, ""]]
    source: ClassVar[str] = "Faltinsen 1990, chapter 6, Current and wind loads"

    @classmethod
    def null(cls, dofs: Sequence[str]) -> Self:
        """Load at its neutral value, in some degrees of freedom."""
        return cls(nulls("static_offset", dofs, PARAMETERS))

    def about(self, label: str) -> Parameter:
        return about(label, PARAMETERS)

    def act(self, now: Instant, memory: Any) -> Action:
        return Action(force=all_dofs(entries(self.values, "force"), self.values))
