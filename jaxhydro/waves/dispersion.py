"""Linear dispersion in finite depth: omega² = g k tanh(k h).

References: Dean and Dalrymple (1991), Water Wave Mechanics, chapter 3.
"""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float


@jax.custom_jvp
def wavenumber(omega: Float[Array, "..."], depth: Float[Array, "..."], gravity: Float[Array, "..."]) -> Float[Array, "..."]:
    """Wavenumber (rad/m) of linear waves in finite depth, accurate to rounding.

    Newton's method starts from Guo's explicit formula. Derivatives are implicit.

    Args:
        omega: Angular frequency (rad/s), not negative; 0 gives 0.
        depth: Water depth (m).
        gravity: Acceleration of gravity (m/s²).

    Returns:
        Wavenumber (rad/m), in the common shape of the arguments.

    References:
        Guo (2002), Coastal Engineering 45, 71-74.
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
