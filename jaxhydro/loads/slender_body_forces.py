"""Second-order forces on slender members."""

from typing import Any, ClassVar

from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import parameter


class SlenderBodyForces(AbstractLoad):
    """Second-order forces of potential flow on slender members.

    They are those beyond the forces of displaced strips and moving surfaces.

    Morison's inertia takes the water's acceleration at a point, du/dt. Strips that move with the platform, wet up to the
    surface, have some second-order forces by that. `share` times the others is added:

    - the convective acceleration (u . grad) u, with 1 + Ca across members and on the added mass of ends;
    - Bernoulli's pressure -rho u²/2 on ends and on waterplanes;
    - forces on the added mass of strips where the water stretches along the member, where the member turns, and of pontoons
      whose Ca differ (`SlenderFlow.on_strips`);
    - forces on ends, where the added mass of the strips beside them ends (`SlenderFlow.on_ends`).

    Strips and ends compute them, with their own Ca. In still water a moving platform has them too: with the added mass's own
    inertia they are Kirchhoff's forces (Lamb 1932, chapter 6), Munk's moment among them. Members that diffract have twice the
    convective acceleration, the coefficient of MacCamy and Fuchs in long waves. The velocity is that of the waves, without a
    current. Drag is not changed. Theory has a share of 1; a share of computed excitation takes as much of them away.

    References:
        Rainey (1989), Journal of Fluid Mechanics 204, 295-324; Rainey (1995), Proceedings of the Royal Society A 450, 391-416;
        Lighthill (1971), Proceedings of the Royal Society B 179, 125-138, of a turning body in still water; Carmo and Simos
        (2022), on difference-frequency forces on semi-submersibles from these expressions.
    """

    share: Float[Array, ""] = parameter("-", "share of the second-order forces on slender members", 0.0, 2.0)
    source: ClassVar[str] = "Rainey 1989, Journal of Fluid Mechanics 204, 295-324; Rainey 1995, Proc. R. Soc. A 450, 391-416"

    def second_order_share(self) -> Float[Array, ""]:
        return self.share

    def act(self, now: Instant, memory: Any) -> Action:
        return Action()
