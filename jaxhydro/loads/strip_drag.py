"""Quadratic drag across strips."""

from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action, Instant, Parameter
from jaxhydro.loads.strip_inertia import spread

REST = 1e-12  # m2/s2 under the root: keeps the gradient of the speed finite at rest, and is lost in rounding elsewhere


class StripDrag(AbstractLoad):
    """f = 1/2 rho Cd A |u| u, u the water's velocity relative to the strip across the member, on its wetted part.

    The drag term of the relative Morison equation (Morison et al. 1950; Chakrabarti 1987, Hydrodynamics of Offshore
    Structures, chapter 6). A is the area that faces the direction: diameter or side height times length for t, plan width
    times length for z. |u| is the length of the transverse vector, which couples the two directions (OpenFAST's law, the
    default), or with `coupled=False` that of the direction's own component, which only makes sense for rectangular
    sections.
    """

    values: dict[str, Float[Array, ""]]
    coupled: bool = eqx.field(static=True, default=True)
    source: ClassVar[str] = "Morison et al. 1950, Petroleum Transactions 189; Chakrabarti 1987, chapter 6"

    def about(self, label: str) -> Parameter:
        group, symbol = label.rsplit(".", 1)
        way, area = ("transverse", "projected") if symbol == "Cd_t" else ("vertical", "plan")
        return Parameter("-", f"{way} drag coefficient of {group}, on {area} area", 0.0, 30.0)

    def act(self, now: Instant, memory: Any) -> Action:
        flow = now.strip_flow
        area = now.over_strips(spread(now.hull.elements, self.values, "Cd")) * now.strip_shape.facing
        square = flow.relative**2
        if self.coupled:
            square = square.sum(axis=0)
        force = 0.5 * now.environment.density * area * jnp.sqrt(square + REST) * flow.relative
        return Action(strip_force=force)
