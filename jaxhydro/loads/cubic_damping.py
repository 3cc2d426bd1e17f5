"""Cubic damping in each degree of freedom."""

from typing import Any, ClassVar

from jaxhydro.loads.base import Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.per_dof import AbstractLoadPerDof, PerDof, by_dof


class CubicDamping(AbstractLoadPerDof):
    """Cubic damping in each degree of freedom.

    F_i = -c_i v_i^3 along body axes.

    v is the velocity of the reference point (m/s) and the angular velocity (rad/s). An empirical third term after linear and
    quadratic damping, or a smooth one in place of the quadratic: a ship's roll at large angles, viscous damping whose
    coefficient grows with amplitude. It says nothing of what happens beyond the velocities that it was fitted to.

    Dalzell 1978, A note on the form of ship roll damping (Journal of Ship Research 22, 178-185). Labels are
    `cubic_damping.surge.coefficient` and so on.
    """

    coefficient: PerDof = by_dof("N s3/m3", "N m s3/rad3", "cubic damping in {dof}", 0.0)
    source: ClassVar[str] = "Dalzell 1978, Journal of Ship Research 22, 178-185"

    def act(self, now: Instant, memory: Any) -> Action:
        velocity = self.dofs_only(now.velocity)
        return Action(body_force=self.all_dofs(-self.entries(self.coefficient) * velocity**3))
