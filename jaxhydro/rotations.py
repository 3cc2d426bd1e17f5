"""Finite rotations of the platform, and small smooth functions that loads share.

Attitude is roll, pitch, yaw. R = Rz(yaw) Ry(pitch) Rx(roll) takes body axes to earth axes (Fossen 2011, Handbook of Marine
Craft Hydrodynamics and Motion Control, section 2.2). It is singular at 90 degrees of pitch.
"""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float


def cosines(attitude: Float[Array, "3"]) -> tuple[Float[Array, "3"], Float[Array, "3"]]:
    """Cosines and sines of roll, pitch, yaw.

    The barrier keeps XLA from working them out anew in every kernel, and for every entry of a matrix, that reads them.
    """
    return jax.lax.optimization_barrier((jnp.cos(attitude), jnp.sin(attitude)))


def rotation(attitude: Float[Array, "3"]) -> Float[Array, "3 3"]:
    """Rotation matrix from body to earth axes, (3, 3).

    Args:
        attitude: Roll, pitch, yaw (rad).

    References:
        Fossen (2011), section 2.2.
    """
    return rotation_of(cosines(attitude))


def rotation_of(both: tuple[Float[Array, "3"], Float[Array, "3"]]) -> Float[Array, "3 3"]:
    """`rotation` from cosines and sines."""
    (cr, cp, cy), (sr, sp, sy) = both
    return jnp.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def attitude_rates(attitude: Float[Array, "3"], angular: Float[Array, "3"]) -> Float[Array, "3"]:
    """Rates of roll, pitch, yaw (rad/s) from an angular velocity in body axes.

    Args:
        attitude: Roll, pitch, yaw (rad).
        angular: Angular velocity (rad/s).

    References:
        Fossen (2011), section 2.2.
    """
    return attitude_rates_of(cosines(attitude), angular)


def attitude_rates_of(both: tuple[Float[Array, "3"], Float[Array, "3"]], angular: Float[Array, "3"]) -> Float[Array, "3"]:
    """`attitude_rates` from cosines and sines."""
    (cr, cp, _), (sr, sp, _) = both
    p, q, r = angular
    turn = (q * sr + r * cr) / cp
    return jnp.stack([p + turn * sp, q * cr - r * sr, turn])


def angular_velocity(attitude: Float[Array, "3"], rates: Float[Array, "3"]) -> Float[Array, "3"]:
    """Angular velocity in body axes (rad/s) from rates of roll, pitch, yaw (rad/s)."""
    roll, pitch, yaw = rates
    (cr, cp, _), (sr, sp, _) = cosines(attitude)
    return jnp.stack([roll - yaw * sp, pitch * cr + yaw * cp * sr, -pitch * sr + yaw * cp * cr])


def turned(matrix: Float[Array, "3 3"], vectors: Float[Array, "3 n"]) -> Float[Array, "3 n"]:
    """Rotated vectors R v, (3, n), in elementwise form.

    XLA's product of batches of such small matrices is several times slower, and every tangent is one.
    """
    x, y, z = vectors
    return jnp.stack([row[0] * x + row[1] * y + row[2] * z for row in matrix])


def cross(a: Float[Array, "3"], b: Float[Array, "3"]) -> Float[Array, "3"]:
    """Cross product a x b in elementwise form, which fuses where `jnp.cross` does not."""
    return jnp.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def skew(a: Float[Array, "3"]) -> Float[Array, "3 3"]:
    """Skew-symmetric matrix S with S b = a x b."""
    zero = jnp.zeros_like(a[0])
    return jnp.array([[zero, -a[2], a[1]], [a[2], zero, -a[0]], [-a[1], a[0], zero]])


def ramp(x: Float[Array, "..."]) -> Float[Array, "..."]:
    """max(0, x) smoothed over |x| < 1, twice continuously differentiable and exact beyond.

    The kernel is Epanechnikov's.
    """
    inner = jnp.clip(x, -1.0, 1.0)
    square = inner * inner
    smooth = 0.1875 + 0.5 * inner + 0.375 * square - 0.0625 * square * square
    return smooth + jnp.maximum(x - 1.0, 0.0)


def step(x: Float[Array, "..."]) -> Float[Array, "..."]:
    """Derivative of `ramp`: 0 below -1, 1 above 1."""
    inner = jnp.clip(x, -1.0, 1.0)
    return 0.5 + inner * (0.75 - 0.25 * inner * inner)
