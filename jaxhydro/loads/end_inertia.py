"""Inertia and dynamic pressure at member ends."""

from collections.abc import Mapping
from typing import Any, ClassVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.hull.ends import Ends
from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import Parameter


def spread_ends(
    ends: Ends, values: Mapping[str, Float[Array, ""]], symbol: str, missing: float | None = None
) -> Float[Array, " m"]:
    """Coefficients `group.symbol_z` by end; `missing` where absent.

    Raises:
        KeyError: A coefficient is absent and `missing` is None.
    """
    if not ends.labels:
        return jnp.zeros(len(ends.label))
    labels = ends.parameters(symbol)
    stacked = jnp.stack([jnp.asarray(values[x] if missing is None else values.get(x, missing)) for x in labels])
    return stacked[jnp.asarray(ends.label)]


class EndInertia(AbstractLoad):
    """Added mass and dynamic pressure on member ends along the axis.

    f = rho Ca V (a_water - a_end) + p A, along the member, V = 2/3 pi r^3 half a sphere on the end.

    Added mass of an end as in OpenFAST HydroDyn (Morison module, loads on member ends); p A is the dynamic pressure on the
    end's area, the axial Froude-Krylov force, which the ends of pontoons carry too. Only ends under water are loaded. The
    same holds where the section changes along the axis, with the V and A of the ring: see `EndShape`. Where still water
    cuts what leans, the waves' pressure on the waterplane is part of it: `waterplane.Leaning`.
    """

    values: dict[str, Float[Array, ""]]
    source: ClassVar[str] = "OpenFAST HydroDyn, Morison module, loads on member ends"

    def about(self, label: str) -> Parameter:
        group = label.rsplit(".", 1)[0]
        return Parameter("-", f"axial added-mass coefficient of the ends of {group}, on half a sphere", 0.0, 10.0)

    def act(self, now: Instant, memory: Any) -> Action:
        flow, ends, density = now.end_flow, now.hull.ends, now.environment.density
        mass = density * spread_ends(ends, self.values, "Ca") * now.end_shape.volume * flow.wet
        if flow.acceleration is None:
            return Action(end_mass=mass)
        assert flow.pressure is not None
        pressure = -density * flow.pressure * now.end_shape.area * ends.outward * flow.wet
        lid = None if now.hull.leaning is None else now.hull.leaning.act(now)
        return Action(end_force=mass * flow.acceleration + pressure, end_mass=mass, body_force=lid)
