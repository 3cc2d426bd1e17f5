"""Drag with another coefficient for the platform's slow motion (six states)."""

import math
from typing import ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.coefficients import PerGroup
from jaxhydro.loads.drag import cutoff, drag_coefficients, end_area, low_share, quadratic, strip_area
from jaxhydro.loads.instant import Instant


class SlowDrag(AbstractLoad):
    """Drag with one coefficient for the platform's low-passed motion and another for the rest.

    f = 1/2 rho A Cd ((1 - r) |u'| u' + r |u| u), on strips and on ends; u' = u + w, w that of the low-passed motion.

    u is the water's relative velocity, w a strip's own velocity by the platform's low-passed one: dm/dt = 2 pi fc (v - m), m
    and v of six components in body axes. So u' is u without the platform's slow motion, and that motion feels r Cd where
    fast motion and waves feel Cd. r = 1 is plain drag exactly, whatever fc; r above 1 gives slow motion more drag than fast.
    In place of `StripDrag` and `EndDrag`, whose coefficients it has.

    The idea is that of OpenFAST HydroDyn's filtered drag (AxVnCOff and AxFDLoFSc, Morison.f90), which is `HighPassDrag`. The
    difference: there the relative velocity of every line is filtered, water included, so that a current and slow
    second-order flow have the small coefficient, too; here only the platform's own motion is, one r and one fc serve all,
    and the state has six entries instead of one per line, which keeps derivatives cheap. Low-passing along body axes takes
    the slow turning of these for none. Not passive at every instant: with r above 1, or where slow and fast motion mix, it
    can, for a while, give energy back.
    """

    Cd: PerGroup = drag_coefficients()
    low_share: Float[Array, ""] = low_share()
    cutoff: Float[Array, ""] = cutoff()
    coupled: bool = eqx.field(static=True, default=True)
    source: ClassVar[str] = "OpenFAST HydroDyn, Morison.f90 (AxVnCOff, AxFDLoFSc); filtering the platform's motion is ours"

    def rest(self) -> Float[Array, "6"]:
        return jnp.zeros(6)

    def act(self, now: Instant, memory: Float[Array, "6"]) -> Action:
        hull, density = now.hull, now.environment.density
        share = self.low_share
        still, turning = (memory @ hull.motion).reshape(2, -1)
        slow_strip, slow_end = hull.split(still + turning * now.lines.away)

        def force(area: Array, relative: Array, slow: Array, coupled: bool) -> Array:
            whole, fast = (quadratic(density, area, u, coupled) for u in (relative, relative + slow))
            return share * whole + (1 - share) * fast

        return Action(
            strip_force=force(strip_area(now, self.Cd), now.strip_flow.relative, slow_strip, self.coupled),
            end_force=force(end_area(now, self.Cd), now.end_flow.relative, slow_end, False),
            memory_rate=2 * math.pi * self.cutoff * (now.velocity - memory),
        )
