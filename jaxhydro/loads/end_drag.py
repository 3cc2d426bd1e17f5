"""Quadratic drag on the ends of columns."""

import math
from typing import Any, ClassVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action, Instant, Parameter
from jaxhydro.loads.end_inertia import spread_ends
from jaxhydro.loads.strip_drag import REST


class EndDrag(AbstractLoad):
    """f = 1/2 rho Cd A |w| w, w the water's velocity relative to the end along the member, A the end's area.

    Robertson et al. 2014 (NREL/TP-5000-60601, the OC4 semisubmersible); OpenFAST's own input is twice this Cd, since it
    halves again.
    """

    values: dict[str, Float[Array, ""]]
    source: ClassVar[str] = "Robertson et al. 2014, NREL/TP-5000-60601"

    def about(self, label: str) -> Parameter:
        group = label.rsplit(".", 1)[0]
        return Parameter("-", f"axial drag coefficient of the ends of {group}, on the end's area", 0.0, 30.0)

    def act(self, now: Instant, memory: Any) -> Action:
        flow, ends = now.end_flow, now.hull.ends
        area = spread_ends(ends, self.values, "Cd") * (math.pi * ends.radius**2) * flow.wet
        force = 0.5 * now.environment.density * area * jnp.sqrt(flow.relative**2 + REST) * flow.relative
        return Action(end_force=force)
