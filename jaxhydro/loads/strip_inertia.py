"""Added mass and Froude-Krylov force of strips (Morison)."""

from typing import Any, ClassVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.coefficients import PerGroup, by_group, spread
from jaxhydro.loads.forces_at_rest import taken_off
from jaxhydro.loads.instant import Instant

MEANING = "{way} added-mass coefficient of {group}, on displaced volume"


class StripInertia(AbstractLoad):
    """Inertial load across members, on their wetted strips.

    f = rho V (1 + Ca) a_water - rho V Ca a_strip, across the member, on the wetted part of each strip.

    The transverse inertia term of the relative Morison equation: Morison et al. 1950 (Petroleum Transactions 189, 149-154)
    in the relative form of Chakrabarti 1987, Hydrodynamics of Offshore Structures, chapter 6. The 1 is the Froude-Krylov
    force. Ca refers to the displaced volume V of the strip, in a circular and in a rectangular section alike. The strip's
    acceleration includes the centripetal part. Directions turn with the body.

    On members that diffract the waves rho V times `Flow.diffracted` takes the place of rho V (1 + Ca) a_water: the
    coefficient of MacCamy and Fuchs for every component, bound ones by their own wavenumber (2 for long ones, whatever Ca,
    unless `Conventions.diffraction` is "ramp"). Members that lie at the surface have the pressure on their waterplane too:
    `waterplane`.
    """

    Ca: PerGroup = by_group("-", MEANING, 0.0, 10.0, t={"way": "transverse"}, z={"way": "vertical"}, symbol="Ca")
    source: ClassVar[str] = "Morison et al. 1950, Petroleum Transactions 189; Chakrabarti 1987, chapter 6"

    def act(self, now: Instant, memory: Any) -> Action:
        flow = now.strip_flow
        mass = now.environment.density * spread(now.hull.elements, self.Ca, "Ca")
        second, at_ends, on_body = self._second_order(now, mass)
        off = None if now.at_rest is None else taken_off(self.Ca, now.at_rest.strips)
        if flow.acceleration is None:
            return Action(strip_force=second, element_mass=mass, end_force=at_ends, body_force=on_body)
        density, volume = now.environment.density, now.strip_shape.volume
        lid, moment = (0.0, None) if now.hull.waterplane is None else now.hull.waterplane.act(now)
        if second is not None and on_body is not None:
            lid, moment = lid + second, on_body if moment is None else moment + on_body
        if flow.diffracted is None:
            force = now.over_strips(density + mass) * volume * flow.acceleration
            return Action(off, moment, strip_force=force + lid, element_mass=mass, end_force=at_ends)
        force = jnp.where(now.diffracting(), density * flow.diffracted, now.over_strips(density + mass) * flow.acceleration)
        if flow.tuned is not None:
            force = force + now.over_strips(mass - density) * flow.tuned
        return Action(off, moment, strip_force=force * volume + lid, element_mass=mass, end_force=at_ends)

    def _second_order(
        self, now: Instant, mass: Float[Array, "2 e"]
    ) -> tuple[Float[Array, "2 n"], Float[Array, " m"], Float[Array, "6"]] | tuple[None, None, None]:
        """Second-order forces on the added mass (`SlenderBodyForces`), or None.

        Returns:
            Force (N) on strips, (2, n), and on ends, (m,), and force and moment (N, N m) on the body, (6,).
        """
        if (slender := now.slender) is None:
            return None, None, None
        of_strips = now.over_strips(mass)
        on_strips, moment = slender.on_strips(now.hull, now.strip_shape, of_strips)
        on_ends, force = slender.on_ends(now.hull, now.end_shape, of_strips, now.end_flow.wet)
        return on_strips, on_ends, moment + force
