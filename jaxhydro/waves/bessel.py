"""Derivatives J1' and Y1' of Bessel functions in JAX, by Chebyshev series.

The series are summed by Clenshaw's rule. Their forms are those of Abramowitz and Stegun (1964), 9.1.11 below x = 8 and
9.2.11, 9.2.12 above. The coefficients are printed by benchmarks/make_bessel_series.py: interpolation at Chebyshev points in
40-digit arithmetic, cut where terms no longer count.
"""

import math
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

SWITCH = 8.0  # between the series in x^2 and those in (8/x)^2
BELOW_J = (  # J1', t = x^2 / 32 - 1
    0.076683125149232, 0.1402517027147999, 0.1041793508461271, -0.28741450210583186,
    0.13585346267713122, -0.03124682881063961, 0.004414146296632122, -0.00042807061753770247,
    3.0474451416013565e-05, -1.6667270601946464e-06, 7.239450216509067e-08, -2.5614508682880844e-09,
    7.532680856444664e-11, -1.871617134340499e-12, 3.982999155599235e-14, -7.344088396285642e-16,
)  # fmt: skip
BELOW_Y = (  # x^2 (Y1' - 2/pi ln(x/2) J1'), t = x^2 / 32 - 1
    -2.5664240484769127, -1.2123300392019822, 7.929999189035198, 5.319476815932716,
    -1.5943238218405915, -0.5997985152316669, 0.30768450442138146, -0.05951503767683334,
    0.006924513246015539, -0.0005576364500383247, 3.340524096813786e-05, -1.5578673864256953e-06,
    5.839638182083079e-08, -1.8022343502200251e-09, 4.666534530484763e-11, -1.0293668045211633e-12,
    1.9590417181984338e-14, -3.251391498601068e-16,
)  # fmt: skip
ABOVE_R = (  # r below, t = 2 (8/x)^2 - 1
    0.9965397463192818, -0.0034541449696136274, 6.027387044437093e-06, -7.897984794981547e-08,
    2.2356716621224846e-09, -1.0153801620351086e-10, 6.423250851701224e-12, -5.210304940529202e-13,
    5.136149768684743e-14, -5.928286887647393e-15, 7.798786990371015e-16, -1.1458769037935406e-16,
    1.8512863494056717e-17,
)  # fmt: skip
ABOVE_S = (  # s x / 8, t = 2 (8/x)^2 - 1
    0.1095570255021647, 0.0001807589285618591, -1.2398603786671782e-06, 2.5694499698774364e-08,
    -9.611779373249203e-10, 5.322234237116531e-11, -3.91985537604609e-12, 3.593544564755524e-13,
    -3.921856158321238e-14, 4.936809402251051e-15, -7.002577736924302e-16, 1.0995590109595184e-16,
    -1.885010436639269e-17,
)  # fmt: skip


def bessel_primes(x: Float[Array, "..."]) -> tuple[Float[Array, "..."], Float[Array, "..."]]:
    """Derivatives of the Bessel functions of the first and second kind and order one.

    Args:
        x: Arguments (-), above 0.

    Returns:
        J1'(x) and Y1'(x), in the shape of `x`.

    References:
        Abramowitz and Stegun (1964), 9.1.11, 9.2.11 and 9.2.12.
    """
    x = jnp.asarray(x, float)
    j, y = scaled_bessel_primes(x)
    return j, y / x**2


@jax.jit
def scaled_bessel_primes(x: Float[Array, "..."]) -> tuple[Float[Array, "..."], Float[Array, "..."]]:
    """J1'(x) and x² Y1'(x) for x >= 0.

    Both, and their first derivatives, are finite at x = 0, where they are 1/2 and 2/pi.
    """
    x = jnp.asarray(x, float)
    near = x <= SWITCH
    j_near, y_near = _below(jnp.where(near, x, SWITCH))
    j_far, y_far = _above(jnp.where(near, SWITCH, x))
    return jnp.where(near, j_near, j_far), jnp.where(near, y_near, y_far)


def _below(x: Float[Array, "..."]) -> tuple[Float[Array, "..."], Float[Array, "..."]]:
    t = x**2 * (2 / SWITCH**2) - 1
    j = _series(BELOW_J, t)
    # x^2 ln x and its slope vanish at zero: so does what stands here, and ln 0 never enters the derivative
    log = jnp.log(jnp.where(x > 1e-100, x, 2.0) / 2)
    return j, 2 / math.pi * x**2 * log * j + _series(BELOW_Y, t)


def _above(x: Float[Array, "..."]) -> tuple[Float[Array, "..."], Float[Array, "..."]]:
    t = 2 * (SWITCH / x) ** 2 - 1
    r, s = _series(ABOVE_R, t), SWITCH / x * _series(ABOVE_S, t)
    # J1' + i Y1' = i sqrt(2 / pi x) (r + i s) exp(i (x - 3 pi/4)); by sin x and cos x, so that x - 3 pi/4 is not rounded
    minus, plus = jnp.sin(x) - jnp.cos(x), jnp.sin(x) + jnp.cos(x)
    root = 1 / jnp.sqrt(math.pi * x)
    return root * (r * plus - s * minus), root * x**2 * (r * minus + s * plus)


@partial(jax.custom_jvp, nondiff_argnums=(0,))
def _series(terms: tuple[float, ...], t: Float[Array, "..."]) -> Float[Array, "..."]:
    """Sum of terms_n T_n(t), |t| <= 1."""
    ahead = after = jnp.zeros_like(t)
    for term in terms[:0:-1]:
        ahead, after = term + 2 * t * ahead - after, ahead
    return terms[0] + t * ahead - after


@_series.defjvp
def _series_jvp(terms, primals, tangents):
    # the slope's own series: one more sum, instead of the recursion's tangents, which reverse mode would have to store
    (t,), (d_t,) = primals, tangents
    slope = tuple(float(term) for term in np.polynomial.chebyshev.chebder(terms))
    return _series(terms, t), _series(slope, t) * d_t
