"""Wave spectra: Pierson-Moskowitz, JONSWAP, white noise and tables.

Spectra S(omega) (m² s/rad) are one-sided over angular frequency, with m0 = integral of S = Hs² / 16. All functions are pure.
Arguments are checked unless they are traced: under jit or grad nothing can be raised.
"""

import math
from collections.abc import Callable
from typing import Any

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
    if is_concrete(gamma) and not np.all((np.asarray(gamma) >= 1) & (np.asarray(gamma) <= MAX_ENHANCEMENT)):
        raise ValueError(f"peak_enhancement lies from 1 to {MAX_ENHANCEMENT:g}, found {gamma}")
    return smooth * _peaked(jnp.asarray(omega), jnp.asarray(peak_period), jnp.asarray(gamma))


@jax.jit
def _peaked(omega, peak_period, gamma):
    peak = 2 * math.pi / peak_period
    width = jnp.where(omega <= peak, 0.07, 0.09)
    log = jnp.log(gamma)
    return (1 - 0.287 * log) * jnp.exp(log * jnp.exp(-0.5 * ((omega / peak - 1) / width) ** 2))


_default_enhancement = peak_enhancement  # the argument of `jonswap` has the function's name

SPECTRA: dict[str, Callable[..., Float[Array, "..."]]] = {  # by name: S of omega, Hs, Tp and gamma
    "jonswap": jonswap,
    "pierson-moskowitz": lambda omega, hs, tp, gamma: pierson_moskowitz(omega, hs, tp),
}


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
    if is_concrete(low) and is_concrete(high) and not 0 <= float(low) < float(high):
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
    if is_concrete(frequencies) and is_concrete(values):
        x, y = np.asarray(frequencies), np.asarray(values)
        if x.ndim != 1 or x.shape != y.shape or len(x) < 2:
            raise ValueError(f"a tabulated spectrum needs two columns of 2 or more, found shapes {x.shape} and {y.shape}")
        if not (np.all(np.diff(x) > 0) and x[0] >= 0):
            raise ValueError("frequencies of a tabulated spectrum ascend from 0 or above, found some that do not")
        if not np.all(y >= 0):
            raise ValueError(f"values of a tabulated spectrum are not negative, found {float(y.min()):g} m2 s/rad")
    return jnp.interp(omega, frequencies, values, left=0.0, right=0.0)


def is_concrete(value: Any) -> bool:
    """Whether a value is a number or an array, and not traced by JAX."""
    return not isinstance(value, jax.core.Tracer)


def _positive(name: str, value: Any, unit: str) -> None:
    if is_concrete(value) and not np.all((np.asarray(value) > 0) & np.isfinite(value)):
        raise ValueError(f"{name} is above 0 {unit}, found {value}")
