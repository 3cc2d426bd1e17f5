"""Wave pressure on members with a coefficient of its own, apart from added mass."""

from typing import Any, ClassVar

import jax.numpy as jnp

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.coefficients import PerGroup, by_group, spread, spread_ends
from jaxhydro.loads.instant import Instant

MEANING = "coefficient of the waves' pressure {way} {group}"
LABEL = "{prefix}.{key[0]}.{name}_{key[1]}"


class WaveExcitation(AbstractLoad):
    """Wave pressure on members, with coefficients other than 1.

    f = (Cp - 1) rho V a_water on strips, across the member, and (Cp - 1) p A on the ends of columns, along it.

    Strips are excited by rho V (Ca + 1) a_water, where the 1 is the Froude-Krylov force. Cp takes its place where the waves'
    pressure is another: near columns and pontoons that shade each other, or in waves that are not long. Without it one Ca
    has to be right for the mass and for the excitation. OpenFAST HydroDyn has it by member (MemberCp, AxCp). Members that
    diffract the waves have (Cp - 1) / 2 of the force of MacCamy and Fuchs. Half of that force is pressure in long waves. The
    ends of pontoons are left as they are (`CoveredEnds`).

    Labels are `wave_excitation.GROUP.Cp_t` across the members of a group, `.Cp_z` upwards on pontoons and on columns' ends.
    """

    Cp: PerGroup = by_group(
        "-", MEANING, -1.0, 4.0, 1.0, t={"way": "across"}, z={"way": "upwards on"}, label=LABEL, symbol="Cp"
    )
    source: ClassVar[str] = "OpenFAST HydroDyn, Morison module, pressure coefficients Cp and AxCp of members and joints"

    def act(self, now: Instant, memory: Any) -> Action:
        flow, ends, density = now.strip_flow, now.hull.ends, now.environment.density
        if flow.acceleration is None or now.end_flow.pressure is None:
            return Action()
        beyond = {key: value - 1 for key, value in self.Cp.items()}
        water = flow.acceleration
        if flow.diffracted is not None:
            water = jnp.where(now.diffracting(), 0.5 * flow.diffracted, water)
        strips = now.over_strips(density * spread(now.hull.elements, beyond, "Cp", 0.0)) * now.strip_shape.volume * water
        area = jnp.where(ends.radius > 0, now.end_shape.area, 0.0)
        pressure = -density * now.end_flow.pressure * area * ends.outward * now.end_flow.wet
        return Action(strip_force=strips, end_force=spread_ends(ends, beyond, "Cp", 0.0) * pressure)
