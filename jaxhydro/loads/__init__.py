"""The loads, by name. A new effect is one file here and one line in `LOADS`."""

from jaxhydro.loads.added_mass import AddedMass
from jaxhydro.loads.base import AbstractLoad, Action, Instant, Parameter
from jaxhydro.loads.end_drag import EndDrag
from jaxhydro.loads.end_inertia import EndInertia
from jaxhydro.loads.high_pass_drag import HighPassDrag
from jaxhydro.loads.hydrostatics import Buoyancy
from jaxhydro.loads.keulegan_carpenter_drag import KeuleganCarpenterDrag
from jaxhydro.loads.linear_damping import LinearDamping
from jaxhydro.loads.mooring_lines import MooringLines
from jaxhydro.loads.quadratic_damping import QuadraticDamping
from jaxhydro.loads.stiffness import Stiffness
from jaxhydro.loads.strip_drag import StripDrag
from jaxhydro.loads.strip_inertia import StripInertia
from jaxhydro.loads.suction_side_drag import SuctionSideDrag
from jaxhydro.loads.weight import Weight

LOADS: dict[str, type[AbstractLoad]] = {
    "weight": Weight,
    "buoyancy": Buoyancy,
    "mooring_lines": MooringLines,
    "stiffness": Stiffness,
    "linear_damping": LinearDamping,
    "quadratic_damping": QuadraticDamping,
    "added_mass": AddedMass,
    "strip_inertia": StripInertia,
    "strip_drag": StripDrag,
    "end_inertia": EndInertia,
    "end_drag": EndDrag,
    "high_pass_drag": HighPassDrag,
    "keulegan_carpenter_drag": KeuleganCarpenterDrag,
    "suction_side_drag": SuctionSideDrag,
}

__all__ = ["LOADS", "AbstractLoad", "Action", "Instant", "Parameter", *(load.__name__ for load in LOADS.values())]
