"""Drag with coefficients that depend on the Keulegan-Carpenter number."""

import math
from collections.abc import Mapping
from typing import ClassVar, NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.hull.hull import Hull
from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.coefficients import PerGroup
from jaxhydro.loads.drag import (
    drag_coefficients,
    end_area,
    law_parameters,
    lines_of,
    of_ends,
    of_strips,
    on_all,
    quadratic,
    strip_area,
)
from jaxhydro.loads.instant import Instant

MIN_NUMBER = 0.1  # the Keulegan-Carpenter number below which the coefficient no longer changes
INITIAL_WINDOW_SHARE = 1 / 30  # share of the window that is open at the start

EXPONENT = "exponent of the {way} drag coefficient of {group} in the Keulegan-Carpenter number"


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


class KeuleganCarpenterDrag(AbstractLoad):
    """Drag with coefficients that are a power of the Keulegan-Carpenter number.

    f = 1/2 rho A Cd ((K^2 + e^2)/(K0^2 + e^2))^(n/2) |u| u on strips and ends, K their Keulegan-Carpenter number.

    K = U T/D = 2 pi a/D (Keulegan and Carpenter 1958, J. Res. Nat. Bur. Standards 60, 423-440), D the extent across the
    flow, of an end its diameter. That Cd depends on K is theirs and Sarpkaya and Isaacson's (1981, Mechanics of Wave Forces
    on Offshore Structures, chapter 3); a power of it is what Graham (1980, J. Fluid Mech. 97, 331-346) derives for vortices
    shed by edges at low K: n = -1/3 at a plate's, 0 at a right angle's. Cd is the coefficient at K = K0, the `reference`; n
    = 0 is plain Morison drag. e = 0.1 keeps it bounded at rest.

    How K is known at every instant is ours. The amplitude a is that of the water's displacement past the strip, which needs
    no period, so that one law serves a slow decay and waves: a^2 = 2 s, s the displacement's variance in a window that
    forgets exponentially,

        dd/dt = u - d/w,   ds/dt = (d^2 - s)/w,   w = W (1 - (1 - 1/30) exp(-t/W)),

    d the displacement from its mean there, W the `window` (s). w is what there is of it since the start: half a cycle after
    a release a is about right. A harmonic flow has K = (U T/D)/(1 + (T/(2 pi W))^2)^0.5 in the mean, and s swings about it
    by 1/(1 + (4 pi W/T)^2)^0.5: W about the longest period. A current counts as 2 pi 2^0.5 u W/D. `coupled`: a of both
    directions together.
    """

    reference: Float[Array, " k"]
    window: Float[Array, " k"]
    lines: tuple[int, ...] = eqx.field(static=True)
    Cd: PerGroup = drag_coefficients()
    drag_exponent: PerGroup = law_parameters("-", EXPONENT, -1.0, 1.0)
    coupled: bool = eqx.field(static=True, default=True)
    source: ClassVar[str] = "Keulegan and Carpenter 1958; Sarpkaya and Isaacson 1981, chapter 3; Graham 1980"

    @classmethod
    def of(
        cls,
        hull: Hull,
        coefficients: PerGroup,
        *,
        drag_exponent: PerGroup,
        reference: Mapping[tuple[str, str], float],
        window: Mapping[tuple[str, str], float],
        coupled: bool = True,
    ) -> "KeuleganCarpenterDrag":
        """Load on the lines of a hull that have these drag coefficients.

        The other direction of a strip is remembered too, by the longest window.

        Args:
            hull: The hull.
            coefficients: Drag coefficients.
            drag_exponent: Exponents.
            reference: Keulegan-Carpenter number K0 by coefficient.
            window: Time W (s) by coefficient.
            coupled: Whether the amplitude is that of both directions together.
        """
        lines = lines_of(hull, coefficients, both=coupled)
        constants = np.array([np.ones(len(lines)), np.full(len(lines), max(window.values()))])
        for key in reference:
            mine = np.isin(lines, lines_of(hull, [key]))
            constants[:, mine] = [[reference[key]], [window[key]]]
        return cls(jnp.asarray(constants[0]), jnp.asarray(constants[1]), lines, coefficients, drag_exponent, coupled)

    def rest(self) -> RecentFlow:
        return RecentFlow(jnp.zeros(()), *(jnp.zeros(len(self.lines)) for _ in range(2)))

    def act(self, now: Instant, memory: RecentFlow) -> Action:
        hull, density = now.hull, now.environment.density
        relative = hull.join(now.strip_flow.relative, now.end_flow.relative)
        age = self.window * (1 - (1 - INITIAL_WINDOW_SHARE) * jnp.exp(-memory.elapsed / self.window))
        swept, own = memory.displacement, jnp.array(self.lines, dtype=int)
        rate = RecentFlow(jnp.ones(()), relative[own] - swept / age, (swept**2 - memory.variance) / age)

        count = relative.shape[0]
        # never below 0 but for the error of a time step
        variance, end_variance = hull.split(on_all(jnp.maximum(memory.variance, 0.0), self.lines, count))
        reference, end_reference = hull.split(on_all(self.reference, self.lines, count))
        if self.coupled:
            variance = variance.sum(axis=0)
        factor = _power(variance, extents(now), reference, of_strips(now, self.drag_exponent, 0.0))
        strip_force = quadratic(density, strip_area(now, self.Cd), now.strip_flow.relative, self.coupled) * factor
        diameter = jnp.where(hull.ends.radius > 0, 2 * hull.ends.radius, 1.0)
        factor = _power(end_variance, diameter, end_reference, of_ends(now, self.drag_exponent, 0.0))
        end_force = quadratic(density, end_area(now, self.Cd), now.end_flow.relative) * factor
        return Action(strip_force=strip_force, end_force=end_force, memory_rate=rate)


def extents(now: Instant) -> Float[Array, "2 n"]:
    """Size (m) of strips across the flow along either direction, (2, n)."""
    strips, away = now.hull.strips, now.hull.split(now.lines.away)[0]
    return (strips.size + strips.taper * away)[::-1]


def _power(variance: Array, extent: Array, reference: Array, exponent: Array) -> Array:
    """((K^2 + e^2)/(K0^2 + e^2))^(n/2) with K^2 = (2 pi/D)^2 2 s."""
    square = 8 * math.pi**2 * variance / extent**2
    return jnp.exp(exponent * log_ratio(square, reference))


def log_ratio(square: Array | float, reference: Array | float) -> Array:
    """ln of what is raised to the exponent: of ((K^2 + e^2)/(K0^2 + e^2))^(1/2), from K^2."""
    return 0.5 * jnp.log((square + MIN_NUMBER**2) / (reference**2 + MIN_NUMBER**2))
