"""Drag that goes with another power of the speed than the second."""

from collections.abc import Mapping
from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action, Instant, Parameter
from jaxhydro.loads.drag import about, end_area, of_ends, of_strips, quadratic, strip_area

NAME = "amplitude_dependent_drag"
SPEED = 0.5  # m/s at which Cd is what it says
SLOW = 0.02  # m/s below which the coefficient no longer changes


class PowerDrag(AbstractLoad):
    """f = 1/2 rho A Cd ((u^2 + e^2)/(U0^2 + e^2))^(n/2) |u| u on strips and ends, u the water's relative velocity.

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

    values: dict[str, Float[Array, ""]]
    coupled: bool = eqx.field(static=True, default=True)
    speed: float = eqx.field(static=True, default=SPEED)
    source: ClassVar[str] = "Keulegan and Carpenter 1958; Graham 1980 (the power); that of the instant's speed is ours"

    @classmethod
    def of(cls, values: Mapping[str, Float[Array, ""]], coupled: bool = True, speed: float = SPEED) -> "PowerDrag":
        """The law on the lines whose drag coefficients are in `values`; exponents that are not there are 0."""
        groups = dict.fromkeys(label.rsplit(".", 1)[0] for label in values if ".Cd_" in label)
        return cls({f"{NAME}.{group}.exponent": jnp.zeros(()) for group in groups} | dict(values), coupled, speed)

    @classmethod
    def null(cls, values: Mapping[str, Float[Array, ""]], coupled: bool = True) -> "PowerDrag":
        """Plain drag with the coefficients in `values`."""
        return cls.of({label: value for label, value in values.items() if ".Cd_" in label}, coupled)

    def about(self, label: str) -> Parameter:
        if not label.startswith(f"{NAME}."):
            return about(label, {})
        group = label.removeprefix(f"{NAME}.").removesuffix(".exponent")
        return Parameter("-", f"exponent of the drag coefficients of {group} in the speed over {self.speed:g} m/s", -1.0, 1.0)

    def act(self, now: Instant, memory: Any) -> Action:
        values, density = self.values, now.environment.density
        exponents = {
            label.removeprefix(f"{NAME}.") + way: value
            for label, value in values.items()
            if label.startswith(f"{NAME}.")
            for way in ("_t", "_z")
        }
        square = now.strip_flow.relative**2
        square = square.sum(axis=0) if self.coupled else square
        factor = power(square, of_strips(now, exponents, "exponent", 0.0), self.speed)
        strip_force = quadratic(density, strip_area(now, values), now.strip_flow.relative, self.coupled) * factor
        factor = power(now.end_flow.relative**2, of_ends(now, exponents, "exponent", 0.0), self.speed)
        end_force = quadratic(density, end_area(now, values), now.end_flow.relative) * factor
        return Action(strip_force=strip_force, end_force=end_force)


def power(square: Float[Array, "..."], exponent: Float[Array, "..."], speed: float) -> Float[Array, "..."]:
    """((u^2 + e^2)/(U0^2 + e^2))^(n/2) of u^2 (m2/s2): exactly 1 for n = 0."""
    return jnp.exp(0.5 * exponent * jnp.log((square + SLOW**2) / (speed**2 + SLOW**2)))
