"""Diffraction of long-crested waves by a vertical circular cylinder."""

import math

import jax.numpy as jnp
from jaxtyping import Array, Complex, Float

from jaxhydro.waves.bessel import scaled_bessel_primes

LONG_WAVE_KA = 0.3  # ka (rad) of the waves for which a cylinder's tuned coefficient has faded out by 1/e in `long_waves`


def maccamy_fuchs(ka: Float[Array, "..."]) -> Complex[Array, "..."]:
    """Complex inertia coefficient (-) of a vertical circular cylinder in waves.

        C(ka) = 4 (Y1' - i J1') / (pi (ka)² (J1'² + Y1'²)),    force per length Re rho pi a² C A exp(i omega t),

    where Re A exp(i omega t) is the undisturbed horizontal acceleration (m/s²) on the axis. A negative angle is a lag. The
    coefficient is all of the excitation, in place of 1 + Ca. At ka = 0 it is 2 and its slope 0. It holds for linear waves
    and a cylinder from the bed through the surface, or one whose ends the waves do not reach; end effects are left out.

    Args:
        ka: Wavenumber times radius (rad), not negative.

    Returns:
        C, in the shape of `ka`.

    References:
        MacCamy and Fuchs (1954), Beach Erosion Board TM-69; Dean and Dalrymple (1991), Water Wave Mechanics, chapter 8.
    """
    # The part of exp(-ikx) that varies with cos(theta), -2i J1(kr), and what is scattered outwards, H = J1 - i Y1, without
    # flow through r = a, leave -2i (J1 H' - J1' H) / H' of the pressure there, -4 / (pi ka H') by the Wronskian. (ka)^2
    # goes into Y1', which that makes regular at zero: long waves need no series of their own.
    x = jnp.asarray(ka, float)
    j, y = scaled_bessel_primes(x)
    j = x**2 * j
    scale = 4 / (math.pi * (j**2 + y**2))
    return scale * y - 1j * (scale * j)


def long_waves(ka: Float[Array, "..."]) -> Float[Array, "..."]:
    """Fraction r(ka) = exp(-(ka / 0.3)²) of a tuned added mass that is kept in long waves.

    The inertia coefficient is then C = C_MF + (Ca - 1) r. This is a convention of this package, smooth and even in ka. It
    removes the step from 1 + Ca to C_MF = 2 in long waves. At a radius of 6.25 m it has fallen to 1/e in waves of 9 s.

    Args:
        ka: Wavenumber times radius (rad).
    """
    return jnp.exp(-((ka / LONG_WAVE_KA) ** 2))
