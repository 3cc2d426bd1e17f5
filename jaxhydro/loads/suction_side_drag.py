"""Drag on column ends where the flow leaves them."""

from typing import Any, ClassVar

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.coefficients import PerGroup, by_group
from jaxhydro.loads.drag import SUCTION, drag_coefficients, end_area, of_ends, one_sided
from jaxhydro.loads.instant import Instant


class SuctionSideDrag(AbstractLoad):
    """Drag on member ends that moves to the side where the flow leaves.

    f = 1/2 rho Cd A (|w| w + s n w^2) on an end, w the water's velocity relative to it and n its outward side, on the axis.

    s = 0 is `EndDrag`; s = 1 is nothing where the flow meets the end and twice that drag where it leaves it, where flow
    separates: OpenFAST HydroDyn's AxFDMod = 1 (Morison.f90, subroutine Morison_CalcOutput, external hydrodynamic joint
    loads; user documentation, HydroDyn input files, axial coefficients; its AxCd is twice this Cd). The half-way house is
    ours: it makes the choice a parameter. The force has a mean in a motion that has none, outward, and takes energy out at
    any s.

    Members have the same law in HydroDyn (FDMod = 2, OpenFAST pull request 2895), with the flow at the middle of their four
    faces. With that of the axis, which strips have here, one of two opposite faces always carries the whole drag: that is
    `StripDrag` with `coupled=False`, so there is no such law for strips.
    """

    Cd: PerGroup = drag_coefficients()
    drag_suction: PerGroup = by_group("-", SUCTION, 0.0, 1.0)
    source: ClassVar[str] = "OpenFAST HydroDyn, Morison.f90, Morison_CalcOutput, AxFDMod; pull request 2895"

    def act(self, now: Instant, memory: Any) -> Action:
        suction = of_ends(now, self.drag_suction, 0.0)
        force = one_sided(
            now.environment.density, end_area(now, self.Cd), now.end_flow.relative, now.hull.ends.outward, suction
        )
        return Action(end_force=force)
