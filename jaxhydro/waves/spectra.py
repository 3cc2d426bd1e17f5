"""Wave spectra: Pierson-Moskowitz, JONSWAP, white noise and tables; moments and directional spreading.

Spectra S(omega) (m² s/rad) are one-sided over angular frequency, with m0 = integral of S = Hs² / 16. All functions are pure.
Arguments are checked unless they are traced: under jit or grad nothing can be raised.
"""

import math
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

Scalar = Float[Array, ""] | float
MAX_ENHANCEMENT = 7.0  # peak enhancement up to which the normalisation of `jonswap` holds


def peak_enhancement(significant_height: Scalar, peak_period: Scalar) -> Float[Array, ""]:
    """Default peak enhancement gamma (-) of a JONSWAP spectrum.

    5 up to Tp / sqrt(Hs) = 3.6, exp(5.75 - 1.15 Tp / sqrt(Hs)) above, 1 above 5 (m, s). The exponential is 5.003 at 3.6; it
    is cut at 5, so that there is no step.

    Args:
        significant_height: Significant wave height Hs (m).
        peak_period: Peak period Tp (s).

    Raises:
        ValueError: Hs or Tp is not above 0.

    References:
        IEC 61400-3-1:2019, Annex B; DNV-RP-C205, section 3.5.5.
    """
    _positive("significant_height", significant_height, "m")
    _positive("peak_period", peak_period, "s")
    return _enhancement(jnp.asarray(significant_height), jnp.asarray(peak_period))


@jax.jit
def _enhancement(significant_height, peak_period):
    return jnp.exp(jnp.clip(5.75 - 1.15 * peak_period / jnp.sqrt(significant_height), 0.0, math.log(5.0)))


def pierson_moskowitz(omega: Float[Array, "..."], significant_height: Scalar, peak_period: Scalar) -> Float[Array, "..."]:
    """Pierson-Moskowitz spectrum (m² s/rad) of a fully developed sea.

    S = 5/16 Hs² wp⁴ omega⁻⁵ exp(-5/4 (wp / omega)⁴), wp = 2 pi / Tp. m0 is exactly Hs² / 16.

    Args:
        omega: Angular frequencies (rad/s).
        significant_height: Significant wave height Hs (m).
        peak_period: Peak period Tp (s).

    Returns:
        S, in the shape of `omega`.

    Raises:
        ValueError: Hs or Tp is not above 0.

    References:
        Pierson and Moskowitz (1964); DNV-RP-C205, section 3.5.5.
    """
    _positive("significant_height", significant_height, "m")
    _positive("peak_period", peak_period, "s")
    return _smooth(jnp.asarray(omega), jnp.asarray(significant_height), jnp.asarray(peak_period))


@jax.jit
def _smooth(omega, significant_height, peak_period):
    peak = 2 * math.pi / peak_period
    has_energy = omega > 0.1 * peak  # below, S underflows to 0, and its factors overflow
    ratio = peak / jnp.where(has_energy, omega, peak)
    shape = ratio**5 * jnp.exp(-1.25 * ratio**4) / peak
    return jnp.where(has_energy, 0.3125 * significant_height**2 * shape, 0.0)


def jonswap(
    omega: Float[Array, "..."], significant_height: Scalar, peak_period: Scalar, peak_enhancement: Scalar | None = None
) -> Float[Array, "..."]:
    """JONSWAP spectrum (m² s/rad).

    S = (1 - 0.287 ln gamma) gamma^exp(-(omega - wp)² / (2 s² wp²)) times `pierson_moskowitz`, with s = 0.07 up to wp and
    0.09 above.

    The normalisation is a fit. m0 is within -0.33 % and +0.29 % of Hs² / 16 for gamma from 1 to 5: exact at 1 and (to 3e-6)
    at 5, +0.24 % at 3.3. It is -0.7 % off at 6 and -1.8 % at 7.

    Args:
        omega: Angular frequencies (rad/s).
        significant_height: Significant wave height Hs (m).
        peak_period: Peak period Tp (s).
        peak_enhancement: gamma (-), 1 to 7; None: the default of `peak_enhancement`.

    Returns:
        S, in the shape of `omega`.

    Raises:
        ValueError: Hs or Tp is not above 0, or gamma is not from 1 to 7.

    References:
        IEC 61400-3-1:2019, Annex B; DNV-RP-C205, section 3.5.5.
    """
    smooth = pierson_moskowitz(omega, significant_height, peak_period)
    gamma = _default_enhancement(significant_height, peak_period) if peak_enhancement is None else peak_enhancement
    if _concrete(gamma) and not np.all((np.asarray(gamma) >= 1) & (np.asarray(gamma) <= MAX_ENHANCEMENT)):
        raise ValueError(f"peak_enhancement lies from 1 to {MAX_ENHANCEMENT:g}, found {gamma}")
    return smooth * _peaked(jnp.asarray(omega), jnp.asarray(peak_period), jnp.asarray(gamma))


@jax.jit
def _peaked(omega, peak_period, gamma):
    peak = 2 * math.pi / peak_period
    width = jnp.where(omega <= peak, 0.07, 0.09)
    log = jnp.log(gamma)
    return (1 - 0.287 * log) * jnp.exp(log * jnp.exp(-0.5 * ((omega / peak - 1) / width) ** 2))


_default_enhancement = peak_enhancement  # the argument of `jonswap` has the function's name


def white_noise(omega: Float[Array, "..."], significant_height: Scalar, low: Scalar, high: Scalar) -> Float[Array, "..."]:
    """White-noise spectrum (m² s/rad) between two frequencies, for measuring RAOs.

    S = Hs² / 16 / (high - low) from `low` to `high`, both included, and 0 elsewhere.

    Args:
        omega: Angular frequencies (rad/s).
        significant_height: Significant wave height Hs (m).
        low: Lowest frequency (rad/s).
        high: Highest frequency (rad/s).

    Returns:
        S, in the shape of `omega`.

    Raises:
        ValueError: Hs is not above 0, or not 0 <= low < high.
    """
    _positive("significant_height", significant_height, "m")
    if _concrete(low) and _concrete(high) and not 0 <= float(low) < float(high):
        raise ValueError(f"white noise needs 0 <= low < high, found {low} and {high} rad/s")
    return jnp.where((omega >= low) & (omega <= high), significant_height**2 / 16 / (high - low), 0.0)


def tabulated(omega: Float[Array, "..."], frequencies: Float[Array, " n"], values: Float[Array, " n"]) -> Float[Array, "..."]:
    """Spectrum (m² s/rad) interpolated linearly in a table, 0 outside it.

    Args:
        omega: Angular frequencies (rad/s).
        frequencies: Ascending angular frequencies of the table (rad/s), (n,).
        values: Spectral density (m² s/rad), (n,). Divide values over hertz by 2 pi.

    Returns:
        S, in the shape of `omega`.

    Raises:
        ValueError: Shapes differ, frequencies do not ascend from 0 or above, or values are negative.
    """
    if _concrete(frequencies) and _concrete(values):
        x, y = np.asarray(frequencies), np.asarray(values)
        if x.ndim != 1 or x.shape != y.shape or len(x) < 2:
            raise ValueError(f"a tabulated spectrum needs two columns of 2 or more, found shapes {x.shape} and {y.shape}")
        if not (np.all(np.diff(x) > 0) and x[0] >= 0):
            raise ValueError("frequencies of a tabulated spectrum ascend from 0 or above, found some that do not")
        if not np.all(y >= 0):
            raise ValueError(f"values of a tabulated spectrum are not negative, found {float(y.min()):g} m2 s/rad")
    return jnp.interp(omega, frequencies, values, left=0.0, right=0.0)


class Moments(NamedTuple):
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


def moments(omega: Float[Array, " w"], spectrum: Float[Array, " w"]) -> Moments:
    """Spectral moments by the trapezoidal rule, between the first and the last frequency.

    The fourth moment of an omega⁻⁵ tail grows with the logarithm of the last frequency: it depends on the cutoff.

    Args:
        omega: Ascending angular frequencies (rad/s), (w,).
        spectrum: Spectral density (m² s/rad), (w,).
    """
    moving = omega > 0
    inverse = jnp.where(moving, 1 / jnp.where(moving, omega, 1.0), 0.0)
    powers = (inverse, jnp.ones_like(omega), omega, omega**2, omega**4)
    return Moments(*(jnp.trapezoid(power * spectrum, omega) for power in powers))


def spreading(heading: Float[Array, "..."], mean: Scalar = 0.0, exponent: Scalar = 10.0) -> Float[Array, "..."]:
    """Directional spreading D (1/rad) over the whole circle.

    D = Gamma(s + 1) / (2 sqrt(pi) Gamma(s + 1/2)) |cos((heading - mean) / 2)|^(2 s). The mean resultant is s / (s + 1), so
    the standard deviation is about sqrt(2 / (s + 1)) rad. DNV-RP-C205 section 3.5.8 has cos^n of the whole angle over half
    the circle, which is close at s = 2 n + 1.

    Args:
        heading: Directions (rad).
        mean: Mean direction (rad).
        exponent: s (-); 0: all directions alike.

    Returns:
        D, in the shape of `heading`.

    Raises:
        ValueError: s is negative.

    References:
        Longuet-Higgins, Cartwright and Smith (1963).
    """
    if _concrete(exponent) and not float(exponent) >= 0:
        raise ValueError(f"the exponent of a spreading is not negative, found {exponent}")
    s = jnp.asarray(exponent, float)
    scale = jnp.exp(jax.lax.lgamma(s + 1) - jax.lax.lgamma(s + 0.5)) / (2 * math.sqrt(math.pi))
    return scale * (0.5 + 0.5 * jnp.cos(heading - mean)) ** s  # cos^2 of the half angle


def _concrete(value: Any) -> bool:
    return not isinstance(value, jax.core.Tracer)


def _positive(name: str, value: Any, unit: str) -> None:
    if _concrete(value) and not np.all((np.asarray(value) > 0) & np.isfinite(value)):
        raise ValueError(f"{name} is above 0 {unit}, found {value}")
