"""Mass, first and second moments of tapered members.

Members are frustums of circular or rectangular section, solid or hollow.

A section has two sizes, which vary linearly along the axis. So its area is a quadratic in the position z = s L, and its
second moments are quartics. Their integrals over 0 <= s <= 1 are sums of Euler's beta integrals (Abramowitz and Stegun
1964, eq. 6.2.1 and 6.2.2):

    B(i, n) = integral of s^i (1 - s)^(n - i) ds = i! (n - i)! / (n + 1)!

For a circle of radii r1 and r2 they are the textbook forms (Weisstein, Conical Frustum, MathWorld):

    volume: pi L (r1^2 + r1 r2 + r2^2) / 3
    second moment about the axis: pi L (r1^4 + r1^3 r2 + r1^2 r2^2 + r1 r2^3 + r2^4) / 10

RAFT has other formulas (helpers.py at e6cb69e: FrustumVCV, FrustumMOI, RectangularFrustumMOI). They agree, but for the
volume of a rectangular frustum whose two sides taper by different ratios. RAFT takes the geometric mean of the areas there.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

Sizes = Sequence[float] | Float[np.ndarray, "2"]
AREA = {True: math.pi / 4, False: 1.0}  # of a section over the product of its sizes; True: circular
SECOND_MOMENT = {True: math.pi / 64, False: 1 / 12}  # over size^3 times the other size


@dataclass(frozen=True)
class Moments:
    """Mass and its moments in a member's axes: z along the member, 1 and 2 across it.

    Attributes:
        mass: Integral of dm (kg), or the volume (m³).
        first: Integral of z dm (kg m).
        second: Integral of z² dm (kg m²).
        across: Integrals of x1² dm and x2² dm (kg m²).
    """

    mass: float = 0.0
    first: float = 0.0
    second: float = 0.0
    across: tuple[float, float] = (0.0, 0.0)

    def __add__(self, other: "Moments") -> "Moments":
        across = (self.across[0] + other.across[0], self.across[1] + other.across[1])
        return Moments(self.mass + other.mass, self.first + other.first, self.second + other.second, across)

    def times(self, factor: float) -> "Moments":
        """The same body with its density multiplied by a factor (kg/m³, or -1 for a hole)."""
        across = (factor * self.across[0], factor * self.across[1])
        return Moments(factor * self.mass, factor * self.first, factor * self.second, across)

    def shifted(self, distance: float) -> "Moments":
        """The same body farther along z by a distance (m): Steiner's theorem."""
        first = self.first + distance * self.mass
        second = self.second + 2 * distance * self.first + distance**2 * self.mass
        return Moments(self.mass, first, second, self.across)

    @property
    def centre(self) -> float:
        """Position (m) of the centre of mass along z."""
        return self.first / self.mass

    def inertia(self) -> tuple[float, float, float]:
        """Moments of inertia (kg m²) about axes 1, 2 and z through the centre of mass."""
        along = self.second - self.first**2 / self.mass
        return along + self.across[1], along + self.across[0], self.across[0] + self.across[1]


def solid_frustum(first: Sizes, last: Sizes, length: float, circular: bool) -> Moments:
    """Volume of a solid frustum and its moments about the centre of its first face.

    Args:
        first: The two sizes (m) of the face at z = 0: a diameter twice, or two sides.
        last: The two sizes (m) of the face at z = length.
        length: Between the faces, m.
        circular: Whether the section is a circle, else a rectangle.

    Returns:
        Moments for a density of 1: m³, m⁴ and m⁵.
    """
    size1, size2 = ((float(first[k]), float(last[k])) for k in (0, 1))
    area, cubic = AREA[circular] * length, SECOND_MOMENT[circular] * length
    volume, moment, second = (area * length**k * _integral([size1, size2], k) for k in range(3))
    return Moments(volume, moment, second, (cubic * _integral([size1] * 3 + [size2]), cubic * _integral([size1] + [size2] * 3)))


def hollow_frustum(
    first: Sizes,
    last: Sizes,
    inner_first: Sizes,
    inner_last: Sizes,
    length: float,
    circular: bool,
) -> Moments:
    """Frustum less a hole of the same length: see `solid_frustum`.

    Args:
        first: The two sizes (m) of the face at z = 0.
        last: The two sizes (m) of the face at z = length.
        inner_first: Sizes (m) of the hole at z = 0.
        inner_last: Sizes (m) of the hole at z = length.
        length: Between the faces, m.
        circular: Whether the section is a circle, else a rectangle.
    """
    outer = solid_frustum(first, last, length, circular)
    return outer + solid_frustum(inner_first, inner_last, length, circular).times(-1.0)


def _integral(factors: Sequence[tuple[float, float]], power: int = 0) -> float:
    """Integral over 0 <= s <= 1 of s^power times a product of linear functions of s.

    Args:
        factors: Values of each linear function at s = 0 and s = 1.
        power: Power of s.
    """
    terms: Float[np.ndarray, " n"] = np.ones(1)  # of s^i (1 - s)^(n - i), i = 0 ... n
    for at_first, at_last in (*factors, *[(0.0, 1.0)] * power):
        terms = np.append(at_first * terms, 0.0) + np.append(0.0, at_last * terms)
    n = len(terms) - 1
    return float(sum(term * math.factorial(i) * math.factorial(n - i) for i, term in enumerate(terms))) / math.factorial(n + 1)
