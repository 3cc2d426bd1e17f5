"""Drag with speed-dependent coefficients and another coefficient for slow motion."""

from collections.abc import Mapping
from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.coefficients import PerGroup
from jaxhydro.loads.drag import (
    cutoff,
    drag_coefficients,
    end_area,
    exponents_of_the_speed,
    groups_of,
    low_share,
    of_both_kinds,
    of_ends,
    of_strips,
    power,
    quadratic,
    strip_area,
)
from jaxhydro.loads.instant import Instant


class ChangingDrag(AbstractLoad):
    """Drag that combines `SlowDrag` and `PowerDrag`.

    `SlowDrag` times the factor of `PowerDrag`: where a model may need either, or both. At its neutral value it is plain drag.

    Sources are those of the two: OpenFAST HydroDyn, Morison.f90; Keulegan and Carpenter 1958; Graham 1980.
    """

    Cd: PerGroup = drag_coefficients()
    exponent: Mapping[str, Float[Array, ""] | float] = exponents_of_the_speed()
    low_share: Float[Array, ""] = low_share()
    cutoff: Float[Array, ""] = cutoff()
    coupled: bool = eqx.field(static=True, default=True)
    source: ClassVar[str] = "OpenFAST HydroDyn, Morison.f90; Keulegan and Carpenter 1958; Graham 1980"

    @classmethod
    def neutral(cls, coefficients: PerGroup, coupled: bool = True) -> "ChangingDrag":
        """Load at its neutral value: plain drag with these coefficients."""
        return cls(coefficients, dict.fromkeys(groups_of(coefficients), 0.0), coupled=coupled)

    def rest(self) -> Float[Array, "6"]:
        return jnp.zeros(6)

    def act(self, now: Instant, memory: Float[Array, "6"]) -> Action:
        hull, density = now.hull, now.environment.density
        share = self.low_share
        still, turning = (memory @ hull.motion).reshape(2, -1)
        slow_strip, slow_end = hull.split(still + turning * now.lines.away)
        own = of_both_kinds(self.exponent)

        def force(area: Array, relative: Array, slow: Array, coupled: bool, exponent: Array) -> Array:
            found = []
            for u in (relative, relative + slow):
                square = (u**2).sum(axis=0) if coupled else u**2
                found.append(quadratic(density, area, u, coupled) * power(square, exponent))
            return share * found[0] + (1 - share) * found[1]

        strips, ends = of_strips(now, own, 0.0), of_ends(now, own, 0.0)
        return Action(
            strip_force=force(strip_area(now, self.Cd), now.strip_flow.relative, slow_strip, self.coupled, strips),
            end_force=force(end_area(now, self.Cd), now.end_flow.relative, slow_end, False, ends),
            memory_rate=2 * jnp.pi * self.cutoff * (now.velocity - memory),
        )
