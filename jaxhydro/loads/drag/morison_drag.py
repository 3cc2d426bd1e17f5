"""Morison drag, rho Cd A |u| u / 2, on strips and ends, with a law for its coefficients."""

from typing import Any, ClassVar

import equinox as eqx
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.coefficients import PerGroup
from jaxhydro.loads.drag.abstract_law import AbstractDragLaw, drag_parameters
from jaxhydro.loads.drag.constant_law import ConstantLaw
from jaxhydro.loads.drag.drag_flow import DragFlow
from jaxhydro.loads.instant import Instant

MEANING = "{way} drag coefficient of {group}, on {area} area"


class MorisonDrag(AbstractLoad):
    """Drag across members, on their wetted strips, and along them, on their ends.

    f = 1/2 rho Cd A |u| u, u the water's velocity relative to the strip or end. A `law` may replace |u| u.

    The drag term of the relative Morison equation (Morison et al. 1950; Chakrabarti 1987, Hydrodynamics of Offshore
    Structures, chapter 6). A is the area that faces the direction: diameter or side height times length for t, plan width
    times length for z. |u| is the length of the transverse vector, which couples the two directions (OpenFAST's law, the
    default). With `coupled=False` it is that of the direction's own component, which only makes sense for rectangular
    sections. On ends u is along the member and A the end's area, or that of a ring where the section changes (`EndShape`;
    Robertson et al. 2014, NREL/TP-5000-60601). OpenFAST's own input for ends is twice this Cd, since it halves again.

    Strips and ends whose coefficient is not in `Cd` have no drag of this load: another one may have it, by another law.
    """

    Cd: PerGroup = drag_parameters("-", MEANING, 0.0, 30.0, label="{key[0]}.{name}_{key[1]}")
    law: AbstractDragLaw = ConstantLaw()
    coupled: bool = eqx.field(static=True, default=True)
    source: ClassVar[str] = "Morison et al. 1950, Petroleum Transactions 189; Chakrabarti 1987, chapter 6"

    def rest(self) -> Any:
        return self.law.rest()

    def act(self, now: Instant, memory: Any) -> Action:
        forces: list[Float[Array, ...] | None] = [None, None]
        for flow in (DragFlow(now, False, self.coupled), DragFlow(now, True, self.coupled)):
            if not self.Cd.keys().isdisjoint(flow.coefficients):
                area = flow.spread(self.Cd, 0.0) * flow.area
                square = self.law.signed_square(flow, flow.velocity, memory)
                forces[flow.ends] = 0.5 * now.environment.density * area * square
        return Action(strip_force=forces[0], end_force=forces[1], memory_rate=self.law.memory_rate(now, memory))
