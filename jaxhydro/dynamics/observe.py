"""Readings of the motion sensors from a simulated motion, and the reverse.

Everything that is compared with a measurement goes through `observe`: calibrations, simulated campaigns, diagnoses.
"""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.dynamics.integrate import Grid
from jaxhydro.dynamics.model import Model


def observe(
    model: Model,
    motion: Grid,
    times: Float[Array, " t"],
    origin: Float[Array, "6"] | None = None,
    *,
    in_waves: bool,
) -> Float[Array, "t 6"]:
    """Readings of the motion sensors, counted from their reading at the position `origin`.

    reading(t) = seen(q(t - lag)) - seen(origin). Here q is the position of the reference point, and `Model.seen` the point
    that is tracked. `Model.clock_lag` is the lag of the motions' clock behind that of the waves. In still water there is no
    other clock, and the lag is left out: the release takes it up. Before its first and after its last step a motion is held.

    Args:
        model: Platform whose loads may include sensor effects.
        motion: Simulated motion of the reference point.
        times: Instants (s) of the record.
        origin: Position (m, rad) at which the sensors read zero; None: the reference position.
        in_waves: Whether the motion is compared with waves that were recorded beside it.

    Returns:
        Surge, sway, heave (m), roll, pitch, yaw (rad) by instant.
    """
    lag = model.clock_lag() if in_waves else None
    position = motion.at(times if lag is None else times - lag)[0]
    zero = jnp.zeros(6) if origin is None else origin
    return model.seen(position) - model.seen(zero)


def motion_behind(
    model: Model, reading: Float[Array, "6"], rate: Float[Array, "6"]
) -> tuple[Float[Array, "6"], Float[Array, "6"]]:
    """Position and rate of the reference point from recorded ones: the inverse of `Model.seen`.

    One step of Newton's method is exact for a tracked point, which adds a displacement that depends on the attitude alone.

    Args:
        model: Platform whose loads may include sensor effects.
        reading: Recorded position (m, rad).
        rate: Recorded rate (m/s, rad/s).

    Returns:
        Position (m, rad) and rate (m/s, rad/s) of the reference point.
    """
    if not model.senses:
        return reading, rate
    position = 2 * reading - model.seen(reading)
    _, seen_rate = jax.jvp(model.seen, (position,), (rate,))
    return position, 2 * rate - seen_rate
