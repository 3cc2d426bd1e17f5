"""Base class of effects on what motion sensors record."""

from jaxtyping import Array, Float

from jaxhydro.parameters import AbstractEffect


class AbstractSensorEffect(AbstractEffect):
    """Base class of effects that change the record of a motion, and not the motion."""

    def seen(self, position: Float[Array, "... 6"]) -> Float[Array, "... 6"]:
        """Reading of the motion sensors at a position (m, rad), (..., 6).

        Args:
            position: Position of the platform (m, rad), (..., 6).
        """
        return position

    def clock_lag(self) -> Float[Array, ""] | None:
        """Lag (s) of the recorded motions behind the waves, or None.

        The record at t shows the motion at t - lag.
        """
        return None
