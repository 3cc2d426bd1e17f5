"""Computed hydrostatic stiffness that couples heave, roll and pitch."""

from typing import Any, ClassVar

from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant


class HydrostaticCoupling(AbstractLoad):
    """Hydrostatic stiffness that couples heave, roll and pitch.

    F = -C q about the reference position: C34, C35 and C45 beyond those that members have (Newman 1977, Marine
    Hydrodynamics, chapter 6, Hydrostatics).

    q is the displacement of the reference point (m) and roll, pitch, yaw (rad), C in N/m, N and N m/rad. Its own stiffness
    of each motion is that of `Buoyancy`.
    """

    stiffness: Float[Array, "6 6"]
    source: ClassVar[str] = "Newman 1977, chapter 6, Hydrostatics"

    def act(self, now: Instant, memory: Any) -> Action:
        return Action(force=-self.stiffness @ now.position)
