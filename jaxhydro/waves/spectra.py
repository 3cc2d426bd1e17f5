"""Wave spectra, one-sided over angular frequency: S(omega) (m2 s/rad), with m0 = integral of S = Hs^2 / 16. Pure functions.

Arguments are checked where they are concrete; under jit or grad nothing can be raised and bad ones give what the formula gives.
"""

import math
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

Scalar = Float[Array, ""] | float
SHARPEST = 7.0  # peak enhancement up to which the normalisation of `jonswap` holds


def peak_enhancement(significant_height: Scalar, peak_period: Scalar) -> Float[Array, ""]:
    """Default gamma of a sea: 5 up to Tp / sqrt(Hs) = 3.6, exp(5.75 - 1.15 Tp / sqrt(Hs)) between, 1 above 5 (m, s).

    IEC 61400-3-1:2019, Annex B; DNV-RP-C205 section 3.5.5. The exponential is 5.003 at 3.6: it is cut at 5, so that there is
    no step. Raises ValueError for Hs or Tp <= 0.
    """
    _positive("significant_height", significant_height, "m")
    _positive("peak_period", peak_period, "s")
    return _enhancement(jnp.asarray(significant_height), jnp.asarray(peak_period))


@jax.jit
def _enhancement(significant_height, peak_period):
    return jnp.exp(jnp.clip(5.75 - 1.15 * peak_period / jnp.sqrt(significant_height), 0.0, math.log(5.0)))


def pierson_moskowitz(omega: Float[Array, "..."], significant_height: Scalar, peak_period: Scalar) -> Float[Array, "..."]:
    """S = 5/16 Hs^2 wp^4 omega^-5 exp(-5/4 (wp / omega)^4), wp = 2 pi / Tp: a fully developed sea (rad/s, m, s).

    m0 = Hs^2 / 16 exactly. Pierson and Moskowitz 1964 as in DNV-RP-C205 section 3.5.5. Raises ValueError for Hs or Tp <= 0.
    """
    _positive("significant_height", significant_height, "m")
    _positive("peak_period", peak_period, "s")
    return _smooth(jnp.asarray(omega), jnp.asarray(significant_height), jnp.asarray(peak_period))


@jax.jit
def _smooth(omega, significant_height, peak_period):
    peak = 2 * math.pi / peak_period
    there = omega > 0.1 * peak  # below, S underflows to 0, and its factors overflow
    ratio = peak / jnp.where(there, omega, peak)
    shape = ratio**5 * jnp.exp(-1.25 * ratio**4) / peak
    return jnp.where(there, 0.3125 * significant_height**2 * shape, 0.0)


def jonswap(
    omega: Float[Array, "..."], significant_height: Scalar, peak_period: Scalar, peak_enhancement: Scalar | None = None
) -> Float[Array, "..."]:
    """S = (1 - 0.287 ln gamma) gamma^exp(-(omega - wp)^2 / (2 s^2 wp^2)) times `pierson_moskowitz`, s = 0.07 up to wp, 0.09
    above (rad/s, m, s). gamma None: `peak_enhancement(Hs, Tp)`.

    The normalisation is that of IEC 61400-3-1:2019, Annex B, and DNV-RP-C205 section 3.5.5, the same in both: a fit, with m0
    within -0.33 % and +0.29 % of Hs^2 / 16 for gamma from 1 to 5, exact at 1 and (to 3e-6) at 5, +0.24 % at 3.3, -0.7 % at 6
    and -1.8 % at 7. Raises ValueError for Hs or Tp <= 0 or gamma outside 1 to 7.
    """
    smooth = pierson_moskowitz(omega, significant_height, peak_period)
    gamma = _default_enhancement(significant_height, peak_period) if peak_enhancement is None else peak_enhancement
    if _concrete(gamma) and not np.all((np.asarray(gamma) >= 1) & (np.asarray(gamma) <= SHARPEST)):
        raise ValueError(f"peak_enhancement lies from 1 to {SHARPEST:g}, found {gamma}")
    return smooth * _peaked(jnp.asarray(omega), jnp.asarray(peak_period), jnp.asarray(gamma))


@jax.jit
def _peaked(omega, peak_period, gamma):
    peak = 2 * math.pi / peak_period
    width = jnp.where(omega <= peak, 0.07, 0.09)
    log = jnp.log(gamma)
    return (1 - 0.287 * log) * jnp.exp(log * jnp.exp(-0.5 * ((omega / peak - 1) / width) ** 2))


_default_enhancement = peak_enhancement  # the argument of `jonswap` has the function's name


def white_noise(omega: Float[Array, "..."], significant_height: Scalar, low: Scalar, high: Scalar) -> Float[Array, "..."]:
    """S = Hs^2 / 16 / (high - low) from `low` to `high`, both rad/s and both included, 0 elsewhere: what RAOs are measured in.

    Raises ValueError for Hs <= 0, low < 0 or high <= low.
    """
    _positive("significant_height", significant_height, "m")
    if _concrete(low) and _concrete(high) and not 0 <= float(low) < float(high):
        raise ValueError(f"white noise needs 0 <= low < high, found {low} and {high} rad/s")
    return jnp.where((omega >= low) & (omega <= high), significant_height**2 / 16 / (high - low), 0.0)


def tabulated(omega: Float[Array, "..."], frequencies: Float[Array, " n"], values: Float[Array, " n"]) -> Float[Array, "..."]:
    """S between `values` (m2 s/rad) at ascending `frequencies` (rad/s) by straight lines, 0 outside them.

    Values over hertz are to be divided by 2 pi. Raises ValueError where frequencies do not ascend or values are negative.
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
    """Spectral moments m_n = integral of omega^n S, n = -1, 0, 1, 2, 4 (m2 (rad/s)^n), and what is named after them."""

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
    """Moments of values (m2 s/rad) at ascending frequencies (rad/s), by the trapezoidal rule: only what lies between the first
    and the last. The fourth moment of an omega^-5 tail grows with the log of the last frequency: it belongs to the cutoff."""
    moving = omega > 0
    inverse = jnp.where(moving, 1 / jnp.where(moving, omega, 1.0), 0.0)
    powers = (inverse, jnp.ones_like(omega), omega, omega**2, omega**4)
    return Moments(*(jnp.trapezoid(power * spectrum, omega) for power in powers))


def spreading(heading: Float[Array, "..."], mean: Scalar = 0.0, exponent: Scalar = 10.0) -> Float[Array, "..."]:
    """D = Gamma(s + 1) / (2 sqrt(pi) Gamma(s + 1/2)) |cos((heading - mean) / 2)|^(2 s), per rad, over the whole circle (rad).

    s: `exponent`, 0 for every direction alike; mean resultant s / (s + 1), so a standard deviation of about sqrt(2 / (s + 1))
    rad. Longuet-Higgins, Cartwright and Smith 1963. The law of DNV-RP-C205 section 3.5.8, cos^n of the whole angle over half
    the circle, is close to it at s = 2 n + 1. Raises ValueError for s < 0.
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
