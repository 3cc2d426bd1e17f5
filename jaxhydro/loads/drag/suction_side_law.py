"""Drag on column ends where the flow leaves them."""

from typing import Any, ClassVar

from jaxtyping import Array, Float

from jaxhydro.loads.coefficients import PerGroup
from jaxhydro.loads.drag.abstract_law import AbstractDragLaw, drag_parameters
from jaxhydro.loads.drag.drag_flow import DragFlow

MEANING = "share of the drag of the ends of {group} that moves to where the flow leaves them"


class SuctionSideLaw(AbstractDragLaw):
    """Drag on member ends that moves to the side where the flow leaves.

    |w| w + s n w^2 on an end, w the water's velocity relative to it and n its outward side, on the axis; |u| u on strips.

    s = 0 is `ConstantLaw`; s = 1 is nothing where the flow meets the end and twice that drag where it leaves it, where flow
    separates: OpenFAST HydroDyn's AxFDMod = 1 (Morison.f90, subroutine Morison_CalcOutput, external hydrodynamic joint
    loads; user documentation, HydroDyn input files, axial coefficients; its AxCd is twice this Cd). The half-way house is
    ours: it makes the choice a parameter. The force has a mean in a motion that has none, outward, and takes energy out at
    any s.

    Members have the same law in HydroDyn (FDMod = 2, OpenFAST pull request 2895), with the flow at the middle of their four
    faces. With that of the axis, which strips have here, one of two opposite faces always carries the whole drag: that is
    `ConstantLaw` with `coupled=False`, so strips are left as they are.
    """

    suction: PerGroup = drag_parameters("-", MEANING, 0.0, 1.0)
    source: ClassVar[str] = "OpenFAST HydroDyn, Morison.f90, Morison_CalcOutput, AxFDMod; pull request 2895"

    def signed_square(self, flow: DragFlow, velocity: Float[Array, "..."], memory: Any) -> Float[Array, "..."]:
        square = flow.signed_square(velocity)
        if not flow.ends:
            return square
        return square + flow.spread(self.suction, 0.0) * flow.now.hull.ends.outward * velocity**2
