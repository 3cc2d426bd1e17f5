"""Drag with speed-dependent coefficients and another coefficient for slow motion."""

from collections.abc import Mapping
from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.drag import (
    POWER_LABEL,
    SLOW_DRAG_LABEL,
    SLOW_DRAG_PARAMETERS,
    about,
    about_exponent,
    end_area,
    exponents,
    groups_of,
    of_ends,
    of_strips,
    power,
    quadratic,
    strip_area,
)
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import Parameter


class ChangingDrag(AbstractLoad):
    """Drag that combines `SlowDrag` and `PowerDrag`.

    `SlowDrag` times the factor of `PowerDrag`: where a model may need either, or both. At both nulls plain drag.

    Sources are those of the two: OpenFAST HydroDyn, Morison.f90; Keulegan and Carpenter 1958; Graham 1980.
    """

    values: dict[str, Float[Array, ""]]
    coupled: bool = eqx.field(static=True, default=True)
    source: ClassVar[str] = "OpenFAST HydroDyn, Morison.f90; Keulegan and Carpenter 1958; Graham 1980"

    @classmethod
    def of(cls, values: Mapping[str, Float[Array, ""]], coupled: bool = True) -> "ChangingDrag":
        """Load on the lines whose drag coefficients are in `values`; missing parameters are neutral."""
        own = {label: jnp.asarray(about.null) for label, about in SLOW_DRAG_PARAMETERS.items()}
        own |= {f"{POWER_LABEL}.{group}.exponent": jnp.zeros(()) for group in groups_of(values)}
        return cls(own | dict(values), coupled)

    @classmethod
    def null(cls, values: Mapping[str, Float[Array, ""]], coupled: bool = True) -> "ChangingDrag":
        """Load at its neutral value: plain drag with the coefficients in `values`."""
        return cls.of({label: value for label, value in values.items() if ".Cd_" in label}, coupled)

    def rest(self) -> Float[Array, "6"]:
        return jnp.zeros(6)

    def about(self, label: str) -> Parameter:
        if label.startswith(f"{POWER_LABEL}."):
            return about_exponent(label)
        return SLOW_DRAG_PARAMETERS[label] if label in SLOW_DRAG_PARAMETERS else about(label, {})

    def act(self, now: Instant, memory: Float[Array, "6"]) -> Action:
        values, hull, density = self.values, now.hull, now.environment.density
        share = values[f"{SLOW_DRAG_LABEL}.low_share"]
        still, turning = (memory @ hull.motion).reshape(2, -1)
        slow_strip, slow_end = hull.split(still + turning * now.lines.away)
        own = exponents(values)

        def force(area: Array, relative: Array, slow: Array, coupled: bool, exponent: Array) -> Array:
            found = []
            for u in (relative, relative + slow):
                square = (u**2).sum(axis=0) if coupled else u**2
                found.append(quadratic(density, area, u, coupled) * power(square, exponent))
            return share * found[0] + (1 - share) * found[1]

        strips, ends = of_strips(now, own, "exponent", 0.0), of_ends(now, own, "exponent", 0.0)
        return Action(
            strip_force=force(strip_area(now, values), now.strip_flow.relative, slow_strip, self.coupled, strips),
            end_force=force(end_area(now, values), now.end_flow.relative, slow_end, False, ends),
            memory_rate=2 * jnp.pi * values[f"{SLOW_DRAG_LABEL}.cutoff"] * (now.velocity - memory),
        )
