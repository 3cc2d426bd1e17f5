"""Drag laws with different coefficients for slow and fast motion, by a filter of the velocity."""

import math
from typing import Any, ClassVar, NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.hull.hull import Hull
from jaxhydro.loads.coefficients import PerGroup
from jaxhydro.loads.drag.abstract_law import AbstractDragLaw, drag_parameters
from jaxhydro.loads.drag.constant_law import ConstantLaw
from jaxhydro.loads.drag.drag_flow import DragFlow, lines_of, on_all_lines, relative_velocity
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import parameter

# A first-order filter faster than this is no filter in waves, and at 0.25 s leaves what Adams-Bashforth can follow (0.19 Hz).
MAX_CUTOFF = 0.15  # Hz
MAX_SLOW_SHARE = 10.0  # of slow motion; HydroDyn takes 0 to 1
CUTOFF = "frequency above which {group} has its whole {way} drag coefficient"
LOW_SHARE = "share of the {way} drag coefficient of {group} that slow motion feels"


class FilterMemory(NamedTuple):
    """Memory of a filtered law.

    Attributes:
        slow: Low-passed velocity (m/s, rad/s).
        law: Memory of the law of the filtered velocity.
    """

    slow: Float[Array, " k"]
    law: Any


class HighPassLaw(AbstractDragLaw):
    """Drag with one coefficient for high-passed flow and another for the rest.

    (1 - r) |u'| u' + r |u| u, on strips and on ends; u' = u - m, dm/dt = 2 pi fc u'.

    u is the water's relative velocity, u' the same high-passed at the cut-off fc: gain 1/(1 + (fc/f)^2)^0.5, ahead by
    atan(fc/f). Fast motion has the coefficient Cd, slow motion r Cd. r = 1 is plain Morison drag whatever fc, and so is
    fc = 0 whatever r. The memory m is the low-passed velocity of every strip's direction and end that has this law. Another
    `law` may take the place of |u| u.

    OpenFAST HydroDyn's velocity filter: AxVnCOff and AxFDLoFSc on ends (Morison.f90, subroutine Morison_CalcOutput),
    VnCOffA, VnCOffB, FDLoFScA, FDLoFScB on the faces of rectangular members (subroutine GetDistDrag_Rec, pull request 2895).
    There it goes step by step, u'_k = exp(-2 pi fc dt) (u'_{k-1} + u_k - u_{k-1}) (subroutine Morison_UpdateDiscState): this
    is the limit dt -> 0. HydroDyn's members take |.| of the component (`coupled=False`); of the filtered vector, and so for
    circles, it is ours. With `SuctionSideLaw` as `law` it has AxFDMod, too, which goes with u' and u alike.

    In a harmonic motion of gain G it takes r + (1 - r) G^3 of the energy that plain drag takes. Where slow and fast motion
    mix it can, for a while, give energy back.
    """

    lines: tuple[int, ...] = eqx.field(static=True)
    cutoff: PerGroup = drag_parameters("Hz", CUTOFF, 0.0, MAX_CUTOFF)
    low_share: PerGroup = drag_parameters("-", LOW_SHARE, 0.0, MAX_SLOW_SHARE, 1.0)
    law: AbstractDragLaw = ConstantLaw()
    source: ClassVar[str] = "OpenFAST HydroDyn, Morison.f90, Morison_UpdateDiscState and GetDistDrag_Rec, pull request 2895"

    @classmethod
    def of(cls, hull: Hull, *, cutoff: PerGroup, low_share: PerGroup, law: AbstractDragLaw = ConstantLaw()) -> "HighPassLaw":
        """Law on the lines of a hull whose drag coefficients have these cut-offs.

        Args:
            hull: The hull.
            cutoff: Cut-off frequencies (Hz).
            low_share: Fractions of the coefficients that slow motion feels.
            law: Law of the filtered and of the whole velocity.
        """
        return cls(lines_of(hull, cutoff), cutoff, low_share, law)

    def rest(self) -> FilterMemory:
        return FilterMemory(jnp.zeros(len(self.lines)), self.law.rest())

    def memory_rate(self, now: Instant, memory: FilterMemory) -> FilterMemory:
        lines, cutoff = (
            jnp.array(self.lines, dtype=int),
            (DragFlow(now, ends, False).spread(self.cutoff, 0.0) for ends in (False, True)),
        )
        fast = relative_velocity(now)[lines] - memory.slow
        return FilterMemory(2 * math.pi * now.hull.join(*cutoff)[lines] * fast, self.law.memory_rate(now, memory.law))

    def signed_square(self, flow: DragFlow, velocity: Float[Array, "..."], memory: FilterMemory) -> Float[Array, "..."]:
        fast = velocity - flow.part(on_all_lines(flow.now.hull, memory.slow, self.lines))
        share = flow.spread(self.low_share, 1.0)
        slow, quick = (self.law.signed_square(flow, u, memory.law) for u in (velocity, fast))
        return share * slow + (1 - share) * quick


class SlowMotionLaw(AbstractDragLaw):
    """Drag with one coefficient for the platform's low-passed motion and another for the rest.

    (1 - r) |u'| u' + r |u| u, on strips and on ends; u' = u + w, w that of the low-passed motion.

    u is the water's relative velocity, w a strip's own velocity by the platform's low-passed one: dm/dt = 2 pi fc (v - m), m
    and v of six components in body axes. So u' is u without the platform's slow motion, and that motion feels r Cd where
    fast motion and waves feel Cd. r = 1 is plain drag exactly, whatever fc; r above 1 gives slow motion more drag than fast.
    Another `law` may take the place of |u| u, such as `SpeedPowerLaw`.

    The idea is that of OpenFAST HydroDyn's filtered drag (AxVnCOff and AxFDLoFSc, Morison.f90), which is `HighPassLaw`.
    There the relative velocity of every line is filtered, water included, so that a current and slow second-order flow have
    the small coefficient, too. Here only the platform's own motion is filtered, and one r and one fc serve all. The state
    has six entries instead of one per line, which keeps derivatives cheap.

    Low-passing along body axes neglects their slow turning. The law is not passive at every instant. With r above 1, or
    where slow and fast motion mix, it can give energy back for a while.
    """

    low_share: Float[Array, ""] = parameter(
        "-", "share of all drag coefficients that the platform's slow motion feels", 0.0, 3.0, 1.0
    )
    cutoff: Float[Array, ""] = parameter("Hz", "frequency below which the platform's motion is slow", 0.005, 0.08, 0.03)
    law: AbstractDragLaw = ConstantLaw()
    label_prefix: ClassVar[str] = "sea_state_dependent_drag"
    source: ClassVar[str] = "OpenFAST HydroDyn, Morison.f90 (AxVnCOff, AxFDLoFSc); filtering the platform's motion is ours"

    def rest(self) -> FilterMemory:
        return FilterMemory(jnp.zeros(6), self.law.rest())

    def memory_rate(self, now: Instant, memory: FilterMemory) -> FilterMemory:
        slow = 2 * math.pi * self.cutoff * (now.velocity - memory.slow)
        return FilterMemory(slow, self.law.memory_rate(now, memory.law))

    def signed_square(self, flow: DragFlow, velocity: Float[Array, "..."], memory: FilterMemory) -> Float[Array, "..."]:
        still, turning = (memory.slow @ flow.now.hull.motion).reshape(2, -1)
        fast = velocity + flow.part(still + turning * flow.now.lines.away)
        whole, quick = (self.law.signed_square(flow, u, memory.law) for u in (velocity, fast))
        return self.low_share * whole + (1 - self.low_share) * quick
