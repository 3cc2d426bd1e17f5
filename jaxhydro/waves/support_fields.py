"""Wave fields as sums over support wavenumbers, with derivatives by position that cost little."""

import math
from functools import partial

import jax
import jax.numpy as jnp
from jax.custom_derivatives import SymbolicZero
from jaxtyping import Array, Float


def cosine_sine(x: Float[Array, "..."]) -> tuple[Float[Array, "..."], Float[Array, "..."]]:
    """cos x and sin x to 1e-11 for |x| up to about 1000, in vectorisable arithmetic.

    Reduction to |r| <= pi/2 by half turns, which only change both signs, and Taylor's series (Abramowitz and Stegun 1964,
    4.3.65 and 4.3.66).
    """
    half = jnp.round(x * (1 / math.pi))
    r = (x - half * math.pi) - half * 1.2246467991473532e-16  # pi less its float64
    sign = 1 - 2 * (half - 2 * jnp.floor(0.5 * half))
    square = r * r
    return sign * _taylor(square, 16), (sign * r) * _taylor(square, 15)


def _taylor(square: Float[Array, "..."], last: int) -> Float[Array, "..."]:
    """Series of cos x up to x^last; where `last` is odd, series of sin x / x.

    It is evaluated by Horner's rule, without division.

    Args:
        square: x².
        last: Highest power of x, in sin x where it is odd.
    """
    terms = [(-1) ** (power // 2) / math.factorial(power) for power in range(last, -1, -2)]
    total = jnp.full_like(square, terms[0])
    for term in terms[1:]:
        total = total * square + term
    return total


@jax.custom_jvp
def field(
    even: Float[Array, "p 2*r"],
    odd: Float[Array, "q 2*r"],
    k: Float[Array, " r"],
    x: Float[Array, " n"],
    z: Float[Array, " n"],
    fade: Float[Array, " r"],
) -> tuple[Float[Array, "p n"], Float[Array, "q n"]]:
    """Sums over supports at points, Re sum c_r P(k_r, z) exp(-i k_r x).

    P is cosh k(z+h) / cosh kh for `even`, sinh k(z+h) / sinh kh for `odd`. Amplitudes are real parts, then imaginary ones;
    `fade` is exp(-2kh). Derivatives by x and z are worked out once for all directions asked for.
    """
    cosh, sinh = _terms(k, x, z, fade)
    return even @ cosh, odd @ sinh


def _terms(k, x, z, fade) -> tuple[Float[Array, "2*r n"], Float[Array, "2*r n"]]:
    cosine, sine = cosine_sine(k[:, None] * x)
    down = jnp.exp(k[:, None] * z)
    # barriers: else XLA works them out anew for every product that reads them
    cosine, sine, down = jax.lax.optimization_barrier((cosine, sine, down))
    fade = fade[:, None]
    up = fade / down
    cosh, sinh = (down + up) * (1 / (1 + fade)), (down - up) * (1 / (1 - fade))
    return jnp.concatenate([cosh * cosine, cosh * sine]), jnp.concatenate([sinh * cosine, sinh * sine])


@partial(field.defjvp, symbolic_zeros=True)
def _field_jvp(primals, tangents):
    even, odd, k, x, z, fade = primals
    d_even, d_odd, _, d_x, d_z, _ = tangents
    cosh, sinh = jax.lax.optimization_barrier(_terms(k, x, z, fade))
    p, q, k, tanh = len(even), len(odd), jnp.concatenate([k, k]), jnp.tile((1 - fade) / (1 + fade), 2)
    # d/dz of cosh/cosh kh is k tanh kh times sinh/sinh kh, and the other way round
    with_cosh = jnp.concatenate([even, support_slope(even, k), odd * (k / tanh)]) @ cosh
    with_sinh = jnp.concatenate([odd, support_slope(odd, k), even * (k * tanh)]) @ sinh
    with_cosh, with_sinh = jax.lax.optimization_barrier((with_cosh, with_sinh))
    d_along = with_cosh[p : 2 * p] * _zeros(d_x) + with_sinh[2 * q :] * _zeros(d_z)
    d_up = with_sinh[q : 2 * q] * _zeros(d_x) + with_cosh[2 * p :] * _zeros(d_z)
    if not isinstance(d_even, SymbolicZero):
        d_along = d_along + d_even @ cosh
    if not isinstance(d_odd, SymbolicZero):
        d_up = d_up + d_odd @ sinh
    return (with_cosh[:p], with_sinh[:q]), (d_along, d_up)


def support_slope(amplitude: Float[Array, "p 2*r"], k: Float[Array, " 2*r"]) -> Float[Array, "p 2*r"]:
    """Amplitudes of the derivative by x: d/dx cos kx = -k sin kx."""
    real, imaginary = jnp.split(amplitude, 2, axis=-1)
    return jnp.concatenate([imaginary, -real], axis=-1) * k


def _zeros(tangent):
    """A tangent as an array."""
    return jnp.zeros(tangent.shape, tangent.dtype) if isinstance(tangent, SymbolicZero) else tangent


@jax.custom_jvp
def surface(amplitude: Float[Array, " 2*r"], k: Float[Array, " r"], x: Float[Array, " n"]) -> Float[Array, " n"]:
    """Re sum c_r exp(-i k_r x): `field` at z = 0, for one quantity."""
    return amplitude @ jnp.concatenate(cosine_sine(k[:, None] * x))


@partial(surface.defjvp, symbolic_zeros=True)
def _surface_jvp(primals, tangents):
    amplitude, k, x = primals
    d_amplitude, _, d_x = tangents
    terms = jax.lax.optimization_barrier(jnp.concatenate(cosine_sine(k[:, None] * x)))
    sums = jnp.stack([amplitude, support_slope(amplitude, jnp.concatenate([k, k]))]) @ terms
    tangent = sums[1] * _zeros(d_x)
    return sums[0], tangent if isinstance(d_amplitude, SymbolicZero) else tangent + d_amplitude @ terms
