"""Quadratic drag on the ends of columns."""

from typing import Any, ClassVar

from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.drag import end_area, quadratic
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import Parameter


class EndDrag(AbstractLoad):
    """Quadratic drag on member ends along the axis.

    f = 1/2 rho Cd A |w| w, w the water's velocity relative to the end along the member, A the end's area, or that of a ring
    where the section changes (`EndShape`).

    Robertson et al. 2014 (NREL/TP-5000-60601, the OC4 semisubmersible); OpenFAST's own input is twice this Cd, since it
    halves again. Ends whose coefficient is not in `values` have another law.
    """

    values: dict[str, Float[Array, ""]]
    source: ClassVar[str] = "Robertson et al. 2014, NREL/TP-5000-60601"

    def about(self, label: str) -> Parameter:
        group = label.rsplit(".", 1)[0]
        return Parameter("-", f"axial drag coefficient of the ends of {group}, on the end's area", 0.0, 30.0)

    def act(self, now: Instant, memory: Any) -> Action:
        return Action(end_force=quadratic(now.environment.density, end_area(now, self.values), now.end_flow.relative))
