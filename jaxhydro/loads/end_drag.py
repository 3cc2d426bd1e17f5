"""Quadratic drag on the ends of columns."""

from typing import Any, ClassVar

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.coefficients import PerGroup, by_group
from jaxhydro.loads.drag import end_area, quadratic
from jaxhydro.loads.instant import Instant


class EndDrag(AbstractLoad):
    """Quadratic drag on member ends along the axis.

    f = 1/2 rho Cd A |w| w, w the water's velocity relative to the end along the member, A the end's area, or that of a ring
    where the section changes (`EndShape`).

    Robertson et al. 2014 (NREL/TP-5000-60601, the OC4 semisubmersible); OpenFAST's own input is twice this Cd, since it
    halves again. Ends whose coefficient is not in `Cd` have another law.
    """

    Cd: PerGroup = by_group("-", "axial drag coefficient of the ends of {group}, on the end's area", 0.0, 30.0)
    source: ClassVar[str] = "Robertson et al. 2014, NREL/TP-5000-60601"

    def act(self, now: Instant, memory: Any) -> Action:
        return Action(end_force=quadratic(now.environment.density, end_area(now, self.Cd), now.end_flow.relative))
