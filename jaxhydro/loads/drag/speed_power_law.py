"""Drag with another power of the speed than the second."""

from collections.abc import Iterable, Mapping
from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.drag.abstract_law import AbstractDragLaw
from jaxhydro.loads.drag.drag_flow import DragFlow
from jaxhydro.parameters import Parameter, parameters

REFERENCE_SPEED = 0.5  # m/s at which Cd is what it says
MIN_SPEED_RATIO = 0.04  # of that speed, below which the coefficient no longer changes


def _about(law: Any, group: str) -> Parameter:
    return Parameter("-", f"exponent of the drag coefficients of {group} in the speed over {law.speed:g} m/s", -1.0, 1.0)


class SpeedPowerLaw(AbstractDragLaw):
    """Drag coefficients that are a power of the speed.

    ((u^2 + e^2)/(U0^2 + e^2))^(n/2) |u| u on strips and ends, u the water's relative velocity.

    One exponent n for each group, n = 0 is `ConstantLaw` exactly. Cd is that at the `speed` U0; e = 0.04 U0 keeps it
    bounded at rest. |u| is that of the vector, or with `coupled=False` of the component, in the power, too.

    At a given period a power of the amplitude is the same power of the Keulegan-Carpenter number (Keulegan and Carpenter
    1958, J. Res. Nat. Bur. Standards 60, 423-440). At a sharp edge n = -1/3 (Graham 1980, J. Fluid Mech. 97, 331-346). This
    law is the package's own, cheap form: it takes the speed of the instant for that of the cycle, and has no memory. In a
    harmonic motion the loss per cycle goes as amplitude^(3 + n), as with that number, but for a constant. The form within a
    cycle differs. Where periods differ it goes with the speed, not with KC (see `KeuleganCarpenterLaw`). Passive for any n.
    """

    exponent: Mapping[str, Float[Array, ""] | float] = parameters(_about)
    speed: float = eqx.field(static=True, default=REFERENCE_SPEED)
    label_prefix: ClassVar[str] = "amplitude_dependent_drag"
    source: ClassVar[str] = "Keulegan and Carpenter 1958; Graham 1980 (the power); that of the instant's speed is ours"

    @classmethod
    def neutral(cls, coefficients: Iterable[tuple[str, str]], speed: float = REFERENCE_SPEED) -> "SpeedPowerLaw":
        """Law at its neutral value for the groups of some drag coefficients.

        Args:
            coefficients: Groups and kinds of the drag coefficients.
            speed: Speed (m/s) at which coefficients are as declared.
        """
        return cls({group: 0.0 for group, _ in coefficients}, speed)

    def signed_square(self, flow: DragFlow, velocity: Float[Array, "..."], memory: Any) -> Float[Array, "..."]:
        exponent = flow.spread({(group, kind): value for group, value in self.exponent.items() for kind in "tz"}, 0.0)
        slow = (MIN_SPEED_RATIO * self.speed) ** 2
        ratio = (flow.together(velocity**2) + slow) / (self.speed**2 + slow)
        return flow.signed_square(velocity) * jnp.exp(0.5 * exponent * jnp.log(ratio))
