"""Cubic damping in each degree of freedom."""

from collections.abc import Sequence
from typing import Any, ClassVar, Self

from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.per_dof import about, all_dofs, both_units, dofs_only, entries, nulls
from jaxhydro.parameters import Parameter

PARAMETERS = {"coefficient": both_units("N s3/m3", "N m s3/rad3", "cubic damping in {dof}", 0.0)}


class CubicDamping(AbstractLoad):
    """Cubic damping in each degree of freedom.

    F_i = -c_i v_i^3 along body axes.

    v is the velocity of the reference point (m/s) and the angular velocity (rad/s). An empirical third term after linear and
    quadratic damping, or a smooth one in place of the quadratic: a ship's roll at large angles, viscous damping whose
    coefficient grows with amplitude. It says nothing of what happens beyond the velocities that it was fitted to.

    Dalzell 1978, A note on the form of ship roll damping (Journal of Ship Research 22, 178-185). Labels are
    `cubic_damping.surge.coefficient` and so on.
    """

    values: dict[str, Float[Array, ""]]
    source: ClassVar[str] = "Dalzell 1978, Journal of Ship Research 22, 178-185"

    @classmethod
    def null(cls, dofs: Sequence[str]) -> Self:
        """Load at its neutral value, in some degrees of freedom."""
        return cls(nulls("cubic_damping", dofs, PARAMETERS))

    def about(self, label: str) -> Parameter:
        return about(label, PARAMETERS)

    def act(self, now: Instant, memory: Any) -> Action:
        velocity = dofs_only(now.velocity, self.values)
        return Action(body_force=all_dofs(-entries(self.values, "coefficient") * velocity**3, self.values))
