"""Waves that a beach or a wall sends back."""

from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Parameter
from jaxhydro.waves.flow import Cylinders, Flow
from jaxhydro.waves.irregular_sea import SupportSea
from jaxhydro.waves.sea import AbstractSea, StillWater


class ReflectedSea(AbstractSea):
    """A sea and, `coefficient` (-) times, its mirror image `delay` (s) later, from `begin` (s) + `delay` on."""

    sea: Any  # AbstractSea
    along: Float[Array, "2"]
    coefficient: Float[Array, ""]
    delay: Float[Array, ""]
    begin: Float[Array, ""]

    @property
    def middle(self) -> Float[Array, ""]:
        """That of the sea's box (m)."""
        return self.sea.middle

    def _share(self, time: Float[Array, ""]) -> Float[Array, ""]:
        return jnp.where(time - self.delay < self.begin - 1e-6, 0.0, self.coefficient)

    def _mirror(self, points: Float[Array, "2 n"]) -> Float[Array, "2 n"]:
        return points - 2 * self.along[:, None] * (self.along @ points)

    def flow(self, time: Float[Array, ""], points: Float[Array, "3 n"], cylinders: Cylinders | None = None) -> Flow | None:
        here = self.sea.flow(time, points, cylinders)
        back = self.sea.flow(time - self.delay, jnp.concatenate([self._mirror(points[:2]), points[2:]]), cylinders)
        if here is None or back is None:
            return here
        normal = jnp.concatenate([self.along, jnp.zeros(1)])
        normal = normal if here.axes is None else here.axes.T @ normal
        share = self._share(time)

        def both(name: str) -> Any:
            one, other = getattr(here, name), getattr(back, name)
            return None if one is None else one + share * (other - 2 * normal[:, None] * (normal @ other))

        velocity, acceleration, diffracted, tuned = map(both, ("velocity", "acceleration", "diffracted", "tuned"))
        return Flow(velocity, acceleration, here.pressure + share * back.pressure, diffracted, tuned, here.axes)

    def elevation(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> Float[Array, " n"] | None:
        back = self.sea.elevation(time - self.delay, self._mirror(points))
        return None if back is None else self.sea.elevation(time, points) + self._share(time) * back

    def surface(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> Float[Array, " n"] | None:
        back = self.sea.surface(time - self.delay, self._mirror(points))
        return None if back is None else self.sea.surface(time, points) + self._share(time) * back

    def drift(self, time: Float[Array, ""]) -> Float[Array, " d"] | None:
        return self.sea.drift(time)

    def excitation(self, time: Float[Array, ""], place: Float[Array, "2"]) -> Float[Array, "6"] | None:
        return self.sea.excitation(time, place)

    def direction(self) -> Float[Array, "2"]:
        return self.along

    def moved(self, distance: Float[Array, ""]) -> "ReflectedSea":
        return eqx.tree_at(lambda sea: sea.sea, self, self.sea.moved(distance))


class WaveReflection(AbstractLoad):
    """eta(x, t) = eta_i(x, t) + r eta_i(-x, t - T): the incident sea, and r times its mirror image about the origin, T later.

    x is along the waves, T the `delay` from the platform to the beach and back. One real r for all frequencies: beaches
    reflect long waves more, and their r is measured by component (Goda and Suzuki 1976, Estimation of incident and
    reflected waves in random wave experiments, Coastal Engineering Proceedings 15). With dispersion the delay is the group
    velocity's at one period and the phase is not the beach's: r of either sign and a search over T stand for that. Bound
    waves are sent back as they are, where a beach sets them free: of order r times second order. In a prepared sea T is
    rounded to whole steps of its clock, so it is a shape, not a parameter, and nothing comes back before T. The squared
    envelope stays that of the incident waves. Twice the cost of the sea's kinematics, at r = 0 as well.
    """

    values: dict[str, Float[Array, ""]]
    delay: Float[Array, ""] = eqx.field(default_factory=lambda: jnp.zeros(()))  # s, 0 .. 600 makes sense
    source: ClassVar[str] = "Goda and Suzuki 1976 (incident and reflected waves); one r and one delay are ours"

    @classmethod
    def null(cls, delay: float = 0.0) -> "WaveReflection":
        """Nothing comes back, `delay` (s) after it has passed."""
        return cls({"wave_reflection.coefficient": jnp.zeros(())}, jnp.asarray(delay, float))

    def about(self, label: str) -> Parameter:
        return Parameter("-", "share of the waves' height that comes back", -0.3, 0.3)

    def through(self, sea: AbstractSea) -> AbstractSea:
        if isinstance(sea, StillWater):
            return sea
        delay, begin = self.delay, jnp.asarray(-jnp.inf)
        if isinstance(sea, SupportSea):  # which knows times of its clock only
            delay, begin = jnp.round(delay / sea.step) * sea.step, sea.start
        return ReflectedSea(sea, sea.direction(), self.values["wave_reflection.coefficient"], delay, begin)
