"""Linear damping between two degrees of freedom."""

from collections.abc import Sequence
from typing import Any, ClassVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.environment import DOFS
from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.matrix import assemble, place, unit
from jaxhydro.parameters import Parameter


class CoupledDamping(AbstractLoad):
    """Symmetric linear damping between pairs of degrees of freedom.

    F_i = -B_ij v_j, F_j = -B_ij v_i along body axes: what velocity in one motion takes from another, the same both ways.

    Symmetry is that of potential damping (Faltinsen 1990, Sea Loads on Ships and Offshore Structures, chapter 3), and of a
    damper at a height z: B15 = z B11. Beyond sqrt(B_ii B_jj) of all damping it gives energy. Labels are
    `coupled_damping.B15` and so on.
    """

    values: dict[str, Float[Array, ""]]
    source: ClassVar[str] = "Faltinsen 1990, chapter 3"

    @classmethod
    def null(cls, labels: Sequence[str] = ("B15",)) -> "CoupledDamping":
        """Load at its neutral value, for some pairs of degrees of freedom."""
        return cls({f"coupled_damping.{label}": jnp.zeros(()) for label in labels})

    def about(self, label: str) -> Parameter:
        i, j = place(label)
        return Parameter(unit("B", label), f"linear damping that couples {DOFS[i]} and {DOFS[j]}")

    def act(self, now: Instant, memory: Any) -> Action:
        matrix = assemble(self.values)
        return Action(body_force=-(matrix + matrix.T) @ now.velocity)
