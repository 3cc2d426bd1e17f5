"""Drag whose coefficients go with the speed and differ between slow and fast motion: two laws in one."""

from collections.abc import Mapping
from typing import ClassVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import Action, Instant, Parameter
from jaxhydro.loads.drag import end_area, of_ends, of_strips, quadratic, strip_area
from jaxhydro.loads.power_drag import NAME as POWER
from jaxhydro.loads.power_drag import SPEED, PowerDrag, power
from jaxhydro.loads.slow_drag import NAME as SLOW
from jaxhydro.loads.slow_drag import SlowDrag


class ChangingDrag(SlowDrag):
    """`SlowDrag` times the factor of `PowerDrag`: where a model may need either, or both. At both nulls plain drag exactly."""

    source: ClassVar[str] = "as SlowDrag and PowerDrag"

    @classmethod
    def of(cls, values: Mapping[str, Float[Array, ""]], coupled: bool = True) -> "ChangingDrag":
        """The law on the lines whose drag coefficients are in `values`; its own parameters are null where they are not."""
        both = {**SlowDrag.of({}).values, **PowerDrag.of(values).values}
        return cls({**both, **dict(values)}, coupled)

    def about(self, label: str) -> Parameter:
        return PowerDrag(self.values).about(label) if label.startswith(f"{POWER}.") else super().about(label)

    def act(self, now: Instant, memory: Float[Array, "6"]) -> Action:
        values, hull, density = self.values, now.hull, now.environment.density
        share = values[f"{SLOW}.low_share"]
        still, turning = (memory @ hull.motion).reshape(2, -1)
        slow_strip, slow_end = hull.split(still + turning * now.lines.away)
        exponents = {
            label.removeprefix(f"{POWER}.") + way: value
            for label, value in values.items()
            if label.startswith(f"{POWER}.")
            for way in ("_t", "_z")
        }

        def force(area: Array, relative: Array, slow: Array, coupled: bool, exponent: Array) -> Array:
            found = []
            for u in (relative, relative + slow):
                square = (u**2).sum(axis=0) if coupled else u**2
                found.append(quadratic(density, area, u, coupled) * power(square, exponent, SPEED))
            return share * found[0] + (1 - share) * found[1]

        strips, ends = of_strips(now, exponents, "exponent", 0.0), of_ends(now, exponents, "exponent", 0.0)
        return Action(
            strip_force=force(strip_area(now, values), now.strip_flow.relative, slow_strip, self.coupled, strips),
            end_force=force(end_area(now, values), now.end_flow.relative, slow_end, False, ends),
            memory_rate=2 * jnp.pi * values[f"{SLOW}.cutoff"] * (now.velocity - memory),
        )
