"""Morison drag, the contract of its laws, and the registry `DRAG_LAWS` by name.

A new law is one file in this folder and one line in `DRAG_LAWS`.
"""

from jaxhydro.loads.drag.abstract_law import AbstractDragLaw
from jaxhydro.loads.drag.constant_law import ConstantLaw
from jaxhydro.loads.drag.drag_flow import DragFlow
from jaxhydro.loads.drag.keulegan_carpenter_law import KeuleganCarpenterLaw
from jaxhydro.loads.drag.morison_drag import MorisonDrag
from jaxhydro.loads.drag.speed_power_law import SpeedPowerLaw
from jaxhydro.loads.drag.suction_side_law import SuctionSideLaw
from jaxhydro.loads.drag.velocity_filters import HighPassLaw, SlowMotionLaw

DRAG_LAWS: dict[str, type[AbstractDragLaw]] = {
    "constant": ConstantLaw,
    "high_pass": HighPassLaw,
    "keulegan_carpenter": KeuleganCarpenterLaw,
    "suction_side": SuctionSideLaw,
    "speed_power": SpeedPowerLaw,
    "slow_motion": SlowMotionLaw,
}

__all__ = ["DRAG_LAWS", "AbstractDragLaw", "DragFlow", "MorisonDrag", *(law.__name__ for law in DRAG_LAWS.values())]
