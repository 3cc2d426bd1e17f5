"""Drag with separate coefficients for slow and fast flow, by a high-pass filter."""

import math
from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.hull.hull import Hull
from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.coefficients import PerGroup
from jaxhydro.loads.drag import (
    SUCTION,
    drag_coefficients,
    end_area,
    law_parameters,
    lines_of,
    of_ends,
    of_strips,
    on_all,
    one_sided,
    quadratic,
    strip_area,
)
from jaxhydro.loads.instant import Instant

# A first-order filter faster than this is no filter in waves, and at 0.25 s leaves what Adams-Bashforth can follow (0.19 Hz).
MAX_CUTOFF = 0.15  # Hz
MAX_SLOW_SHARE = 10.0  # of slow motion; HydroDyn takes 0 to 1
CUTOFF = "frequency above which {group} has its whole {way} drag coefficient"
LOW_SHARE = "share of the {way} drag coefficient of {group} that slow motion feels"


class HighPassDrag(AbstractLoad):
    """Drag with one coefficient for high-passed flow and another for the rest.

    f = 1/2 rho A Cd ((1 - r) |u'| u' + r |u| u), on strips and on ends; u' = u - m, dm/dt = 2 pi fc u'.

    u is the water's relative velocity, u' the same high-passed at the cut-off fc: gain 1/(1 + (fc/f)^2)^0.5, ahead by
    atan(fc/f). Fast motion has the coefficient Cd, slow motion r Cd. r = 1 is plain Morison drag whatever fc, and so is
    fc = 0 whatever r. The memory m is the low-passed velocity of every strip's direction and end that has this law.

    OpenFAST HydroDyn's velocity filter: AxVnCOff and AxFDLoFSc on ends (Morison.f90, subroutine Morison_CalcOutput),
    VnCOffA, VnCOffB, FDLoFScA, FDLoFScB on the faces of rectangular members (subroutine GetDistDrag_Rec, pull request 2895).
    There it goes step by step, u'_k = exp(-2 pi fc dt) (u'_{k-1} + u_k - u_{k-1}) (subroutine Morison_UpdateDiscState): this
    is the limit dt -> 0. HydroDyn's members take |.| of the component (`coupled=False`); of the filtered vector, and so for
    circles, it is ours. So is `drag_suction` being a number: 0 and 1 are AxFDMod (see `SuctionSideDrag`; it goes with u' and
    u alike).

    In a harmonic motion of gain G it takes r + (1 - r) G^3 of the energy that plain drag takes. Where slow and fast motion
    mix it can, for a while, give energy back.
    """

    lines: tuple[int, ...] = eqx.field(static=True)
    Cd: PerGroup = drag_coefficients()
    drag_cutoff: PerGroup = law_parameters("Hz", CUTOFF, 0.0, MAX_CUTOFF)
    drag_low_share: PerGroup = law_parameters("-", LOW_SHARE, 0.0, MAX_SLOW_SHARE, 1.0)
    drag_suction: PerGroup = law_parameters("-", SUCTION, 0.0, 1.0)
    coupled: bool = eqx.field(static=True, default=True)
    source: ClassVar[str] = "OpenFAST HydroDyn, Morison.f90, Morison_UpdateDiscState and GetDistDrag_Rec, pull request 2895"

    @classmethod
    def of(cls, hull: Hull, coefficients: PerGroup, *, coupled: bool = True, **law: PerGroup) -> "HighPassDrag":
        """Load on the lines of a hull that have these drag coefficients.

        Args:
            hull: The hull.
            coefficients: Drag coefficients.
            coupled: Whether |u| is that of the vector across a strip.
            law: `drag_cutoff`, `drag_low_share` and `drag_suction`.
        """
        return cls(lines_of(hull, coefficients), coefficients, coupled=coupled, **law)

    def rest(self) -> Float[Array, " k"]:
        return jnp.zeros(len(self.lines))

    def act(self, now: Instant, memory: Any) -> Action:
        hull, density = now.hull, now.environment.density
        relative = hull.join(now.strip_flow.relative, now.end_flow.relative)
        fast = relative - on_all(memory, self.lines, relative.shape[0])
        of_strip, of_end = (find(now, self.drag_cutoff, 0.0) for find in (of_strips, of_ends))
        own = jnp.array(self.lines, dtype=int)
        rate = 2 * math.pi * (hull.join(of_strip, of_end) * fast)[own]
        fast_strip, fast_end = hull.split(fast)

        area, share = strip_area(now, self.Cd), of_strips(now, self.drag_low_share, 1.0)
        slow = quadratic(density, area, now.strip_flow.relative, self.coupled)
        strip_force = share * slow + (1 - share) * quadratic(density, area, fast_strip, self.coupled)

        area, share = end_area(now, self.Cd), of_ends(now, self.drag_low_share, 1.0)
        side = (hull.ends.outward, of_ends(now, self.drag_suction, 0.0))
        slow = one_sided(density, area, now.end_flow.relative, *side)
        end_force = share * slow + (1 - share) * one_sided(density, area, fast_end, *side)
        return Action(strip_force=strip_force, end_force=end_force, memory_rate=rate)
