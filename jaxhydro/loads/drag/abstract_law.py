"""Contract of drag laws."""

import abc
from typing import Any

from jaxtyping import Array, Float

from jaxhydro.loads.coefficients import by_group
from jaxhydro.loads.drag.drag_flow import DragFlow
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import AbstractEffect

TRANSVERSE = {"way": "transverse", "area": "projected"}
VERTICAL_OR_AXIAL = {"way": "vertical or axial", "area": "plan or end"}
LAW_LABEL = "{key[0]}.drag_{name}_{key[1]}"  # of a law's parameters


class AbstractDragLaw(AbstractEffect):
    """Base class of drag laws: what takes the place of |u| u in Morison's 1/2 rho Cd A |u| u.

    Parameters are fields, as those of loads are. At its neutral value a law is `ConstantLaw`.
    """

    def rest(self) -> Any:
        """Memory before t = 0; None for a law without memory."""
        return None

    def memory_rate(self, now: Instant, memory: Any) -> Any:
        """Time derivative of the memory.

        Args:
            now: Motion, geometry and flow at the instant.
            memory: The law's memory, as from `rest`.
        """
        return None

    @abc.abstractmethod
    def signed_square(self, flow: DragFlow, velocity: Float[Array, "..."], memory: Any) -> Float[Array, "..."]:
        """Signed square of the velocity times the law's factor on the coefficient (m²/s²).

        Args:
            flow: Flow past strips, or past ends.
            velocity: Relative velocity of the water (m/s), shaped like `flow.velocity`; a filter may have changed it.
            memory: The law's memory.
        """


def drag_parameters(unit: str, meaning: str, lower: float, upper: float, neutral: float = 0.0, label: str = LAW_LABEL) -> Any:
    """Field with a parameter for each drag coefficient; labels are like column.drag_exponent_t.

    Args:
        unit: Unit.
        meaning: What the parameter is; {group}, {way} and {area} are filled in.
        lower: Lower bound.
        upper: Upper bound.
        neutral: Neutral value.
        label: Template of the labels; `key` is group and kind.
    """
    return by_group(unit, meaning, lower, upper, neutral, t=TRANSVERSE, z=VERTICAL_OR_AXIAL, label=label, symbol="Cd")
