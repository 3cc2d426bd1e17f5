"""Drag with coefficients that depend on the Keulegan-Carpenter number."""

import math
from collections.abc import Mapping
from typing import ClassVar, NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.hull.hull import Hull
from jaxhydro.loads.coefficients import PerGroup
from jaxhydro.loads.drag.abstract_law import AbstractDragLaw, drag_parameters
from jaxhydro.loads.drag.drag_flow import DragFlow, lines_of, on_all_lines, relative_velocity
from jaxhydro.loads.instant import Instant

MIN_NUMBER = 0.1  # the Keulegan-Carpenter number below which the coefficient no longer changes
INITIAL_WINDOW_SHARE = 1 / 30  # share of the window that is open at the start

MEANING = "exponent of the {way} drag coefficient of {group} in the Keulegan-Carpenter number"


class RecentFlow(NamedTuple):
    """Recent flow past some lines.

    Attributes:
        elapsed: Time since the start (s).
        displacement: Displacement (m) of the water past the lines from its mean, (k,).
        variance: Variance of that displacement (m²), (k,).
    """

    elapsed: Float[Array, ""]
    displacement: Float[Array, " k"]
    variance: Float[Array, " k"]


class KeuleganCarpenterLaw(AbstractDragLaw):
    """Drag coefficients that are a power of the Keulegan-Carpenter number.

    ((K^2 + e^2)/(K0^2 + e^2))^(n/2) |u| u on strips and ends, K their Keulegan-Carpenter number.

    K = U T/D = 2 pi a/D (Keulegan and Carpenter 1958, J. Res. Nat. Bur. Standards 60, 423-440), D the extent across the
    flow, of an end its diameter. That Cd depends on K is theirs and Sarpkaya and Isaacson's (1981, Mechanics of Wave Forces
    on Offshore Structures, chapter 3); a power of it is what Graham (1980, J. Fluid Mech. 97, 331-346) derives for vortices
    shed by edges at low K: n = -1/3 at a plate's, 0 at a right angle's. Cd is the coefficient at K = K0, the `reference`; n
    = 0 is `ConstantLaw`. e = 0.1 keeps it bounded at rest.

    The package's own part is how K follows at every instant. The amplitude a is that of the water's displacement past the
    strip. It needs no period, so that one law serves a slow decay and waves. a^2 = 2 s, with s the displacement's variance
    in a window that forgets exponentially,

        dd/dt = u - d/w,   ds/dt = (d^2 - s)/w,   w = W (1 - (1 - 1/30) exp(-t/W)),

    with d the displacement from its mean there, and W the `window` (s). w is the part of the window since the start: half a
    cycle after a release a is about right. A harmonic flow has K = (U T/D)/(1 + (T/(2 pi W))^2)^0.5 in the mean. s swings
    about it by 1/(1 + (4 pi W/T)^2)^0.5: take W about the longest period. A current counts as 2 pi 2^0.5 u W/D. `coupled`: a
    of both directions together.
    """

    reference: Float[Array, " k"]
    window: Float[Array, " k"]
    lines: tuple[int, ...] = eqx.field(static=True)
    exponent: PerGroup = drag_parameters("-", MEANING, -1.0, 1.0)
    source: ClassVar[str] = "Keulegan and Carpenter 1958; Sarpkaya and Isaacson 1981, chapter 3; Graham 1980"

    @classmethod
    def of(
        cls,
        hull: Hull,
        exponent: PerGroup,
        *,
        reference: Mapping[tuple[str, str], float],
        window: Mapping[tuple[str, str], float],
        coupled: bool = True,
    ) -> "KeuleganCarpenterLaw":
        """Law on the lines of a hull whose drag coefficients have these exponents.

        The other direction of a strip is remembered too, by the longest window.

        Args:
            hull: The hull.
            exponent: Exponents.
            reference: Keulegan-Carpenter number K0 by coefficient.
            window: Time W (s) by coefficient.
            coupled: Whether the amplitude is that of both directions together.
        """
        lines = lines_of(hull, exponent, both=coupled)
        constants = np.array([np.ones(len(lines)), np.full(len(lines), max(window.values()))])
        for key in reference:
            constants[:, np.isin(lines, lines_of(hull, [key]))] = [[reference[key]], [window[key]]]
        return cls(jnp.asarray(constants[0]), jnp.asarray(constants[1]), lines, exponent)

    def rest(self) -> RecentFlow:
        return RecentFlow(jnp.zeros(()), *(jnp.zeros(len(self.lines)) for _ in range(2)))

    def memory_rate(self, now: Instant, memory: RecentFlow) -> RecentFlow:
        age = self.window * (1 - (1 - INITIAL_WINDOW_SHARE) * jnp.exp(-memory.elapsed / self.window))
        relative, swept = relative_velocity(now)[jnp.array(self.lines, dtype=int)], memory.displacement
        return RecentFlow(jnp.ones(()), relative - swept / age, (swept**2 - memory.variance) / age)

    def signed_square(self, flow: DragFlow, velocity: Float[Array, "..."], memory: RecentFlow) -> Float[Array, "..."]:
        # never below 0 but for the error of a time step
        variance, reference = (
            flow.part(on_all_lines(flow.now.hull, values, self.lines))
            for values in (jnp.maximum(memory.variance, 0.0), self.reference)
        )
        number_squared = 8 * math.pi**2 * flow.together(variance) / flow.extent**2
        exponent = flow.spread(self.exponent, 0.0)
        return flow.signed_square(velocity) * jnp.exp(exponent * log_ratio(number_squared, reference))


def log_ratio(square: Array | float, reference: Array | float) -> Array:
    """ln of what is raised to the exponent: of ((K^2 + e^2)/(K0^2 + e^2))^(1/2), from K^2."""
    return 0.5 * jnp.log((square + MIN_NUMBER**2) / (reference**2 + MIN_NUMBER**2))
