"""Effects on what motion sensors record, and the registry `SENSOR_EFFECTS` by name."""

from jaxhydro.sensors.sensor_effect import AbstractSensorEffect
from jaxhydro.sensors.sensor_lag import SensorLag
from jaxhydro.sensors.sensor_reference import SensorReference

SENSOR_EFFECTS: dict[str, type[AbstractSensorEffect]] = {
    "sensor_lag": SensorLag,
    "sensor_reference": SensorReference,
}

__all__ = ["SENSOR_EFFECTS", "AbstractSensorEffect", *(effect.__name__ for effect in SENSOR_EFFECTS.values())]
