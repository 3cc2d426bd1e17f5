"""Diffraction of long-crested waves by a vertical circular cylinder."""

import math

import jax.numpy as jnp
from jaxtyping import Array, Complex, Float

from jaxhydro.waves.bessel import scaled_bessel_primes

LONG = 0.3  # ka (rad) of the waves for which a cylinder's tuned coefficient has faded out by 1/e in `long_waves`


def maccamy_fuchs(ka: Float[Array, "..."]) -> Complex[Array, "..."]:
    """Complex inertia coefficient (-) of a vertical circular cylinder of radius a in waves of wavenumber k; ka >= 0 (rad).

        C(ka) = 4 (Y1' - i J1') / (pi (ka)^2 (J1'^2 + Y1'^2)),    force per length Re rho pi a^2 C A exp(i omega t),

    where Re A exp(i omega t) is the undisturbed horizontal acceleration (m/s2) on the axis: a negative angle is a lag. It is
    all of the excitation, in place of 1 + Ca. At ka = 0 it is 2 and its slope 0. For linear waves and a cylinder from the
    bed through the surface, or one whose ends the waves do not feel; no end effects.
    Source: MacCamy and Fuchs (1954), Beach Erosion Board TM-69; Dean and Dalrymple (1991), Water Wave Mechanics, chapter 8.
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
    """Share r(ka) = exp(-(ka / 0.3)^2) of an added-mass coefficient tuned away from 1 that is kept: C = C_MF + (Ca - 1) r.

    A convention of this package, smooth and even in ka, that takes away the step from 1 + Ca to C_MF = 2 in long waves. At
    radius 6.25 m it has fallen to 1/e in waves of 9 s.
    """
    return jnp.exp(-((ka / LONG) ** 2))
