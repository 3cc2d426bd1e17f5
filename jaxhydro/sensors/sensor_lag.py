"""Clock lag between recorded motions and waves."""

from typing import ClassVar

from jaxtyping import Array, Float

from jaxhydro.parameters import parameter
from jaxhydro.sensors.sensor_effect import AbstractSensorEffect

MAX_LAG = 60.0  # s
DELAY = "delay of the recorded motions behind the waves: y_rec(t) = y(t - delay)"


class SensorLag(AbstractSensorEffect):
    """Lag of the recorded motions behind the waves.

    y_rec(t) = y(t - delay): what is recorded at t is the motion a delay earlier; all channels alike, the waves on time.

    A delay above 0 means that the motions were recorded late, below 0 early: a filter's group delay, or two loggers started
    one after the other. Its sign is a phase that is linear in frequency and the same in all motions, exp(-i omega delay).
    This is the shift theorem (Bracewell 2000, The Fourier Transform and Its Applications, chapter 6). In a free decay the
    release takes it up. No force: the motion is the same.
    """

    delay: Float[Array, ""] = parameter("s", DELAY, -MAX_LAG, MAX_LAG)
    source: ClassVar[str] = "Bracewell 2000, chapter 6 (shift theorem)"

    def clock_lag(self) -> Float[Array, ""]:
        return self.delay
