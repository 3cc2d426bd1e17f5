"""Readings of the motion sensors from a simulated motion, and the reverse.

Everything that is compared with a measurement goes through `observe`: calibrations, simulated campaigns, diagnoses.
"""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.dynamics.integrate import Grid
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.newton_euler import optional_sum
from jaxhydro.sensors.sensor_effect import AbstractSensorEffect


def changes_readings(model: Model) -> bool:
    """Whether any sensor effect changes what the motion sensors read at an instant.

    Args:
        model: Platform whose effects may include sensor effects.
    """
    return any(type(effect).seen is not AbstractSensorEffect.seen for effect in model.sensors)


def reading_at(model: Model, position: Float[Array, "... 6"]) -> Float[Array, "... 6"]:
    """Reading of the motion sensors at a position of the reference point.

    Args:
        model: Platform whose effects may include sensor effects.
        position: Position (m, rad), (..., 6).
    """
    for effect in model.sensors:
        position = effect.seen(position)
    return position


def clock_lag(model: Model) -> Float[Array, ""] | None:
    """Lag (s) of the recorded motions behind the waves, or None: the record at t shows the motion at t - lag.

    Args:
        model: Platform whose effects may include sensor effects.
    """
    return optional_sum([effect.clock_lag() for effect in model.sensors])


def observe(
    model: Model,
    motion: Grid,
    times: Float[Array, " t"],
    origin: Float[Array, "6"] | None = None,
    *,
    in_waves: bool,
) -> Float[Array, "t 6"]:
    """Readings of the motion sensors, counted from their reading at the position `origin`.

    reading(t) = reading_at(q(t - lag)) - reading_at(origin). Here q is the position of the reference point, and `clock_lag` the
    lag of the motions' clock behind that of the waves. In still water there is no other clock, and the lag is left out: the
    release takes it up. Before its first and after its last step a motion is held.

    Args:
        model: Platform whose loads may include sensor effects.
        motion: Simulated motion of the reference point.
        times: Instants (s) of the record.
        origin: Position (m, rad) at which the sensors read zero; None: the reference position.
        in_waves: Whether the motion is compared with waves that were recorded beside it.

    Returns:
        Surge, sway, heave (m), roll, pitch, yaw (rad) by instant.
    """
    lag = clock_lag(model) if in_waves else None
    position = motion.at(times if lag is None else times - lag)[0]
    zero = jnp.zeros(6) if origin is None else origin
    return reading_at(model, position) - reading_at(model, zero)


def motion_behind(
    model: Model, reading: Float[Array, "6"], rate: Float[Array, "6"]
) -> tuple[Float[Array, "6"], Float[Array, "6"]]:
    """Position and rate of the reference point from recorded ones: the inverse of `reading_at`.

    One step of Newton's method is exact for a tracked point, which adds a displacement that depends on the attitude alone.

    Args:
        model: Platform whose loads may include sensor effects.
        reading: Recorded position (m, rad).
        rate: Recorded rate (m/s, rad/s).

    Returns:
        Position (m, rad) and rate (m/s, rad/s) of the reference point.
    """
    if not changes_readings(model):
        return reading, rate
    position = 2 * reading - reading_at(model, reading)
    _, seen_rate = jax.jvp(lambda q: reading_at(model, q), (position,), (rate,))
    return position, 2 * rate - seen_rate
