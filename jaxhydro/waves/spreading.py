"""Directional spreading of waves: its law, exponents, directions drawn, and circular moments.

Exponents are those of one law in terms of another.

The law of this package is `spreading`, D ~ |cos((heading - mean) / 2)|^(2 s) over the whole circle. With r its mean
resultant, the first Fourier coefficient of D, r = s / (s + 1); the circular width is sqrt(2 (1 - r)) = sqrt(2 / (s + 1)).

References:
    Longuet-Higgins, Cartwright and Smith (1963), Observations of the directional spectrum of sea waves using the motions of a
        floating buoy, in Ocean Wave Spectra; Mitsuyasu et al. (1975), Journal of Physical Oceanography 5, 750-760, on the
        exponents of wind seas; Kuik, van Vledder and Holthuijsen (1988), Journal of Physical Oceanography 18, 1020-1034, on
        circular moments and width; DNV-RP-C205, section 3.5.8; OpenFAST SeaState, `WaveDirSpread` and `WaveDirRange`.
"""

import math
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.waves.spectra import Scalar, is_concrete

STRATA = 16  # equal parts of a sea's energy, one of each in every so many successive components


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
    if is_concrete(exponent) and not float(exponent) >= 0:
        raise ValueError(f"the exponent of a spreading is not negative, found {exponent}")
    s = jnp.asarray(exponent, float)
    scale = jnp.exp(jax.lax.lgamma(s + 1) - jax.lax.lgamma(s + 0.5)) / (2 * math.sqrt(math.pi))
    return scale * (0.5 + 0.5 * jnp.cos(heading - mean)) ** s  # cos^2 of the half angle


class CircularMoments(NamedTuple):
    """First circular moments of directions.

    Attributes:
        mean: Mean direction (rad).
        resultant: Mean resultant r (-): 1 for one direction, 0 for all alike.
        width: Circular width sqrt(2 (1 - r)) (rad).
    """

    mean: float
    resultant: float
    width: float


def circular_moments(heading: Float[np.ndarray, " w"], energy: Float[np.ndarray, " w"]) -> CircularMoments:
    """Mean direction and width of waves, weighted by energy.

    Args:
        heading: Directions (rad), (w,).
        energy: Energy of each in any unit, (w,).

    References:
        Kuik, van Vledder and Holthuijsen (1988), A method for the routine analysis of pitch-and-roll buoy wave data.
    """
    energy = np.asarray(energy, float)
    first = complex((energy * np.exp(1j * np.asarray(heading, float))).sum() / energy.sum())
    resultant = min(abs(first), 1.0)
    return CircularMoments(math.atan2(first.imag, first.real), resultant, math.sqrt(2 * (1 - resultant)))


def exponent_of_width(width: float) -> float:
    """Exponent s (-) of `spreading` whose circular width (rad) is given, 2 / width² - 1.

    Raises:
        ValueError: The width is not above 0 rad, or above sqrt(2) rad, that of all directions alike.
    """
    if not 0 < width <= math.sqrt(2):
        raise ValueError(f"a circular width is above 0 and up to sqrt(2) rad, found {width:g}")
    return 2 / width**2 - 1


def exponent_of_cosine(n: float) -> float:
    """Exponent s (-) of cos^(2 s) of the half angle with the circular width of cos^n of the whole angle.

    cos^n over half the circle (DNV-RP-C205, 3.5.8) has the mean resultant Gamma(n/2 + 1)² / (Gamma((n+1)/2) Gamma((n+3)/2)).
    It is 5.61 at n = 2 and 9.57 at n = 4. DNV's rule of thumb, 2 n + 1, gives 5 and 9.

    OpenFAST's SeaState has cos^(2 S) of pi (heading - mean) / `WaveDirRange`, S its `WaveDirSpread`. With a range of 360
    degrees S is s; with 180 degrees 2 S is n.

    Args:
        n: Exponent of the cosine of the whole angle (-).

    Raises:
        ValueError: n is negative.
    """
    if not n >= 0:
        raise ValueError(f"the exponent of a spreading is not negative, found {n}")
    r = math.exp(2 * math.lgamma(0.5 * n + 1) - math.lgamma(0.5 * (n + 1)) - math.lgamma(0.5 * (n + 3)))
    return r / (1 - r)


def spread_angle(exponent: float, share: Float[np.ndarray, " w"]) -> Float[np.ndarray, " w"]:
    """Angle (rad) from the mean direction below which a share of the energy travels.

    The law is `spreading`. It is integrated by the trapezoidal rule over 20000 steps, up to ten circular widths from
    the mean.

    Args:
        exponent: s (-).
        share: Shares of the energy, 0 to 1, (w,).

    Returns:
        Angles from -pi to pi, (w,).
    """
    angle = np.linspace(0.0, min(math.pi, 10 * math.sqrt(2 / (exponent + 1))), 20001)
    density = np.abs(np.cos(0.5 * angle)) ** (2 * exponent)
    below = np.r_[0.0, np.cumsum(density[1:] + density[:-1])]
    return np.interp(np.abs(2 * share - 1), below / below[-1], angle) * np.sign(share - 0.5)


def equal_energy_shares(first: int, last: int, seed: int) -> Float[np.ndarray, " w"]:
    """Random shares of a sea's energy, for one direction per frequency component.

    Among `STRATA` successive harmonics each has another of as many equal parts of the energy, in random order, and a random
    point in it. So every direction gets its energy in every narrow band, and no direction is left out of the tails. OpenFAST
    gives `WaveNDir` directions of equal energy to its frequencies in the same way, always at the middle of their part.

    Shares are drawn by harmonic: another band leaves them as they are.

    Args:
        first: Number of the first harmonic.
        last: Number of the last harmonic.
        seed: Seed of the random numbers, that of the sea.

    Returns:
        Shares from 0 to 1 of harmonics `first` to `last`, (w,).

    References:
        Jonkman, SeaState module of OpenFAST; Jefferys (1987), Applied Ocean Research 9, 237-244, on one direction per
        frequency.
    """
    order, within = np.random.default_rng(seed).spawn(5)[3:]  # after those of `spectrum_components`
    runs = -(-last // STRATA)
    part = order.permuted(np.tile(np.arange(STRATA), (runs, 1)), axis=1).reshape(-1)
    inside = within.random(size=(runs, STRATA)).reshape(-1)
    return ((part + inside) / STRATA)[first - 1 : last]
