"""Effects on the sea that the platform meets, and the registry `WATER_EFFECTS` by name."""

from jaxhydro.water.current import Current
from jaxhydro.water.current_profile import CurrentProfile
from jaxhydro.water.water_effect import AbstractWaterEffect
from jaxhydro.water.wave_gauge_position import WaveGaugePosition
from jaxhydro.water.wave_reflection import WaveReflection

WATER_EFFECTS: dict[str, type[AbstractWaterEffect]] = {
    "current": Current,
    "current_profile": CurrentProfile,
    "wave_gauge_position": WaveGaugePosition,
    "wave_reflection": WaveReflection,
}

__all__ = ["WATER_EFFECTS", "AbstractWaterEffect", *(effect.__name__ for effect in WATER_EFFECTS.values())]
