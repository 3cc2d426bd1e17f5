"""Moments of a wave spectrum, and the significant height and periods made of them."""

import math
from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float


class SpectralMoments(NamedTuple):
    """Spectral moments m_n = integral of omega^n S (m² (rad/s)^n), and periods made of them.

    Attributes:
        minus_one: m(-1).
        zero: m0, the variance.
        one: m1.
        two: m2.
        four: m4.
    """

    minus_one: Float[Array, ""]
    zero: Float[Array, ""]
    one: Float[Array, ""]
    two: Float[Array, ""]
    four: Float[Array, ""]

    @property
    def significant_height(self) -> Float[Array, ""]:
        """Hm0 = 4 sqrt(m0) (m)."""
        return 4 * jnp.sqrt(self.zero)

    @property
    def energy_period(self) -> Float[Array, ""]:
        """T(-1) = 2 pi m(-1) / m0 (s)."""
        return 2 * math.pi * self.minus_one / self.zero

    @property
    def mean_period(self) -> Float[Array, ""]:
        """T1 = 2 pi m0 / m1 (s)."""
        return 2 * math.pi * self.zero / self.one

    @property
    def zero_crossing_period(self) -> Float[Array, ""]:
        """Tz = 2 pi sqrt(m0 / m2) (s), of a Gaussian process (Rice 1944)."""
        return 2 * math.pi * jnp.sqrt(self.zero / self.two)


def moments(omega: Float[Array, " w"], spectrum: Float[Array, " w"]) -> SpectralMoments:
    """Spectral moments by the trapezoidal rule, between the first and the last frequency.

    The fourth moment of an omega⁻⁵ tail grows with the logarithm of the last frequency: it depends on the cutoff.

    Args:
        omega: Ascending angular frequencies (rad/s), (w,).
        spectrum: Spectral density (m² s/rad), (w,).
    """
    moving = omega > 0
    inverse = jnp.where(moving, 1 / jnp.where(moving, omega, 1.0), 0.0)
    powers = (inverse, jnp.ones_like(omega), omega, omega**2, omega**4)
    return SpectralMoments(*(jnp.trapezoid(power * spectrum, omega) for power in powers))
