"""Drag with constant coefficients."""

from typing import Any, ClassVar

from jaxtyping import Array, Float

from jaxhydro.loads.drag.abstract_law import AbstractDragLaw
from jaxhydro.loads.drag.drag_flow import DragFlow


class ConstantLaw(AbstractDragLaw):
    """Drag coefficients that are the same for all motion: |u| u, as Morison et al. (1950) have it."""

    source: ClassVar[str] = "Morison et al. 1950, Petroleum Transactions 189"

    def signed_square(self, flow: DragFlow, velocity: Float[Array, "..."], memory: Any) -> Float[Array, "..."]:
        return flow.signed_square(velocity)
