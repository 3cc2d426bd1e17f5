"""Inertia and dynamic pressure at member ends."""

from typing import Any, ClassVar

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.coefficients import PerGroup, by_group, spread_ends
from jaxhydro.loads.forces_at_rest import taken_off
from jaxhydro.loads.instant import Instant

MEANING = "axial added-mass coefficient of the ends of {group}, on half a sphere"


class EndInertia(AbstractLoad):
    """Added mass and dynamic pressure on member ends along the axis.

    f = rho Ca V (a_water - a_end) + p A, along the member, V = 2/3 pi r^3 half a sphere on the end.

    Added mass of an end as in OpenFAST HydroDyn (Morison module, loads on member ends); p A is the dynamic pressure on the
    end's area, the axial Froude-Krylov force, which the ends of pontoons carry too. Only ends under water are loaded. The
    same holds where the section changes along the axis, with the V and A of the ring: see `EndShape`. Where still water
    cuts what leans, the waves' pressure on the waterplane is part of it: `waterplane.Leaning`.
    """

    Ca: PerGroup = by_group("-", MEANING, 0.0, 10.0, symbol="Ca")
    source: ClassVar[str] = "OpenFAST HydroDyn, Morison module, loads on member ends"

    def act(self, now: Instant, memory: Any) -> Action:
        flow, ends, density = now.end_flow, now.hull.ends, now.environment.density
        mass = density * spread_ends(ends, self.Ca, "Ca") * now.end_shape.volume * flow.wet
        if flow.acceleration is None:
            return Action(end_mass=mass)
        assert flow.pressure is not None
        pressure = -density * flow.pressure * now.end_shape.area * ends.outward * flow.wet
        lid = None if now.hull.leaning is None else now.hull.leaning.act(now)
        off = None if now.at_rest is None else taken_off(self.Ca, now.at_rest.ends)
        return Action(off, end_force=mass * flow.acceleration + pressure, end_mass=mass, body_force=lid)
