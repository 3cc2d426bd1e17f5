"""Linear dispersion in finite depth: omega^2 = g k tanh(k h) (Dean and Dalrymple 1991, Water Wave Mechanics, chapter 3)."""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float


@jax.custom_jvp
def wavenumber(omega: Float[Array, "..."], depth: Float[Array, "..."], gravity: Float[Array, "..."]) -> Float[Array, "..."]:
    """Wavenumber k (rad/m) of angular frequency omega >= 0 (rad/s) in water of depth h (m), to rounding.

    Newton's iteration from the explicit formula of Guo (2002), Coastal Engineering 45, 71-74. Derivatives are implicit.
    omega = 0 gives k = 0.
    """
    return _newton(omega, depth, gravity)


@jax.jit
def _newton(omega, depth, gravity):
    safe = jnp.where(omega > 0, omega, 1.0)
    deep = safe**2 * depth / gravity  # k0 h
    kh = deep * (1 - jnp.exp(-(deep ** (2.4901 / 2)))) ** (-1 / 2.4901)
    for _ in range(4):
        tanh = jnp.tanh(kh)
        kh = kh - (kh * tanh - deep) / (tanh + kh * (1 - tanh**2))
    return jnp.where(omega > 0, kh / depth, 0.0)


@wavenumber.defjvp
def _wavenumber_jvp(primals, tangents):
    omega, depth, gravity = primals
    d_omega, d_depth, d_gravity = tangents
    k = wavenumber(omega, depth, gravity)
    tanh = jnp.tanh(k * depth)
    sech2 = 1 - tanh**2
    slope = gravity * (tanh + k * depth * sech2)
    shallow = jnp.sqrt(gravity * depth)
    numerator = 2 * omega * d_omega - d_gravity * k * tanh - gravity * k**2 * sech2 * d_depth
    moving = omega > 0
    return k, jnp.where(moving, numerator / jnp.where(moving, slope, 1.0), d_omega / shallow)
