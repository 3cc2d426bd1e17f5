"""Quadratic drag across strips (Morison)."""

from typing import Any, ClassVar

import equinox as eqx

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.coefficients import PerGroup, by_group
from jaxhydro.loads.drag import MEANING, TRANSVERSE, quadratic, strip_area
from jaxhydro.loads.instant import Instant


class StripDrag(AbstractLoad):
    """Quadratic drag across members, on their wetted strips.

    f = 1/2 rho Cd A |u| u, u the water's velocity relative to the strip across the member, on its wetted part.

    The drag term of the relative Morison equation (Morison et al. 1950; Chakrabarti 1987, Hydrodynamics of Offshore
    Structures, chapter 6). A is the area that faces the direction: diameter or side height times length for t, plan width
    times length for z. |u| is the length of the transverse vector, which couples the two directions (OpenFAST's law, the
    default), or with `coupled=False` that of the direction's own component, which only makes sense for rectangular
    sections. Strips whose coefficient is not in `Cd` have another law.
    """

    Cd: PerGroup = by_group("-", MEANING, 0.0, 30.0, t=TRANSVERSE, z={"way": "vertical", "area": "plan"})
    coupled: bool = eqx.field(static=True, default=True)
    source: ClassVar[str] = "Morison et al. 1950, Petroleum Transactions 189; Chakrabarti 1987, chapter 6"

    def act(self, now: Instant, memory: Any) -> Action:
        area = strip_area(now, self.Cd)
        return Action(strip_force=quadratic(now.environment.density, area, now.strip_flow.relative, self.coupled))
