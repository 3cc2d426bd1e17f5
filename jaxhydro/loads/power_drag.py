"""Drag with another power of the speed than the second."""

from collections.abc import Mapping
from typing import Any, ClassVar

import equinox as eqx
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.coefficients import PerGroup
from jaxhydro.loads.drag import (
    REFERENCE_SPEED,
    drag_coefficients,
    end_area,
    exponents_of_the_speed,
    groups_of,
    of_both_kinds,
    of_ends,
    of_strips,
    power,
    quadratic,
    strip_area,
)
from jaxhydro.loads.instant import Instant


class PowerDrag(AbstractLoad):
    """Drag with coefficients that are a power of the speed.

    f = 1/2 rho A Cd ((u^2 + e^2)/(U0^2 + e^2))^(n/2) |u| u on strips and ends, u the water's relative velocity.

    In place of `StripDrag` and `EndDrag`, whose coefficients it has; one exponent n for each group, n = 0 is plain drag
    exactly. Cd is that at the `speed` U0; e = 0.02 m/s keeps it bounded at rest. |u| is that of the vector, or with
    `coupled=False` of the component, in the power, too.

    A drag coefficient that goes as a power of the amplitude at a given period is one that goes as the same power of the
    Keulegan-Carpenter number (Keulegan and Carpenter 1958, J. Res. Nat. Bur. Standards 60, 423-440; n = -1/3 at a sharp
    edge, Graham 1980, J. Fluid Mech. 97, 331-346). This is the cheap form, ours, with the speed of the instant for that of
    the cycle: no memory, and in a harmonic motion the loss per cycle goes as amplitude^(3 + n), as there, but for a
    constant and for the form within a cycle. Where periods differ it goes with the speed, not with KC (see
    `KeuleganCarpenterDrag`). Passive for any n.
    """

    Cd: PerGroup = drag_coefficients()
    exponent: Mapping[str, Float[Array, ""] | float] = exponents_of_the_speed()
    coupled: bool = eqx.field(static=True, default=True)
    speed: float = eqx.field(static=True, default=REFERENCE_SPEED)
    source: ClassVar[str] = "Keulegan and Carpenter 1958; Graham 1980 (the power); that of the instant's speed is ours"

    @classmethod
    def neutral(cls, coefficients: PerGroup, coupled: bool = True, speed: float = REFERENCE_SPEED) -> "PowerDrag":
        """Load at its neutral value: plain drag with these coefficients."""
        return cls(coefficients, dict.fromkeys(groups_of(coefficients), 0.0), coupled, speed)

    def act(self, now: Instant, memory: Any) -> Action:
        density, own = now.environment.density, of_both_kinds(self.exponent)
        square = now.strip_flow.relative**2
        square = square.sum(axis=0) if self.coupled else square
        factor = power(square, of_strips(now, own, 0.0), self.speed)
        strip_force = quadratic(density, strip_area(now, self.Cd), now.strip_flow.relative, self.coupled) * factor
        factor = power(now.end_flow.relative**2, of_ends(now, own, 0.0), self.speed)
        end_force = quadratic(density, end_area(now, self.Cd), now.end_flow.relative) * factor
        return Action(strip_force=strip_force, end_force=end_force)
