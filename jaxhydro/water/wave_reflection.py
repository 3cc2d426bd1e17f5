"""Waves reflected by a beach or wall."""

from dataclasses import replace
from typing import Any, ClassVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.parameters import parameter
from jaxhydro.water.water_effect import AbstractWaterEffect
from jaxhydro.waves.flow import Cylinders, Flow
from jaxhydro.waves.sea import AbstractSea, StillWater
from jaxhydro.waves.support_sea import Reflection, SupportSea

COEFFICIENT, DELAY, SEEN = "wave_reflection.coefficient", "wave_reflection.delay", "wave_reflection.seen"
DEFAULT_DELAY, MAX_DELAY = 60.0, 600.0  # s


class ReflectedSea(AbstractSea):
    """A sea with its reflection by a beach.

    The reflection is the mirror image about the origin, `coefficient` (-) times, `delay` (s) later. From it, `seen` (-)
    times the sea itself so much later is subtracted.
    """

    sea: Any  # AbstractSea
    along: Float[Array, "2"]
    coefficient: Float[Array, ""]
    delay: Float[Array, ""]
    seen: Float[Array, ""]
    origin: Float[Array, ""]  # m along the waves

    def _mirror(self, points: Float[Array, "2 n"]) -> Float[Array, "2 n"]:
        return points - 2 * self.along[:, None] * (self.along @ points - self.origin)

    def _met(self, incident: Array, reflected: Array, delayed: Array) -> Array:
        return incident + self.coefficient * (reflected - self.seen * delayed)

    def _level(self, elevation: Any, time: Float[Array, ""], points: Float[Array, "2 n"]) -> Float[Array, " n"] | None:
        incident, then = (elevation(now, points) for now in (time, time - self.delay))
        return None if incident is None else self._met(incident, elevation(time - self.delay, self._mirror(points)), then)

    def flow(
        self,
        time: Float[Array, ""],
        points: Float[Array, "3 n"],
        cylinders: Cylinders | None = None,
        gradient: bool = False,
    ) -> Flow | None:
        mirrored = jnp.concatenate([self._mirror(points[:2]), points[2:]])
        incident, then = (self.sea.flow(now, points, cylinders, gradient) for now in (time, time - self.delay))
        back = self.sea.flow(time - self.delay, mirrored, cylinders, gradient)
        if incident is None or back is None:
            return incident
        normal = jnp.concatenate([self.along, jnp.zeros(1)])
        normal = normal if incident.axes is None else incident.axes.T @ normal

        def both(name: str) -> Any:
            direct, reflected, late = getattr(incident, name), getattr(back, name), getattr(then, name)
            return None if direct is None else self._met(direct, reflected - 2 * normal[:, None] * (normal @ reflected), late)

        velocity, acceleration, diffracted, tuned = map(both, ("velocity", "acceleration", "diffracted", "tuned"))
        pressure = self._met(incident.pressure, back.pressure, then.pressure)
        slopes = None
        if gradient:
            mirror = jnp.eye(len(normal)) - 2 * jnp.outer(normal, normal)
            turned = jnp.einsum("ia,abn,jb->ijn", mirror, back.gradient, mirror)
            slopes = self._met(incident.gradient, turned, then.gradient)
        return Flow(velocity, acceleration, pressure, diffracted, tuned, incident.axes, slopes)

    def elevation(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> Float[Array, " n"] | None:
        return self._level(self.sea.elevation, time, points)

    def surface(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> Float[Array, " n"] | None:
        return self._level(self.sea.surface, time, points)

    def drift(self, time: Float[Array, ""]) -> Float[Array, " d"] | None:
        return self.sea.drift(time)

    def excitation(self, time: Float[Array, ""], position: Float[Array, "2"]) -> Float[Array, "6"] | None:
        return self.sea.excitation(time, position)

    def direction(self) -> Float[Array, "2"]:
        return self.along

    def moved(self, distance: Float[Array, ""]) -> "ReflectedSea":
        return replace(self, sea=self.sea.moved(distance), origin=self.origin + distance)


class WaveReflection(AbstractWaterEffect):
    """Reflection of the waves by a beach.

    eta(x, t) = eta_g(x, t) + r (eta_g(-x, t - T) - s eta_g(x, t - T)), with eta_g the sea of the wave record. Its mirror
    image about the origin, T later, is added r times. The part of that which the record has already is subtracted.

    x is along the waves, T from the platform to the beach and back. s is 0 where the record is of incident waves alone, as a
    row of gauges separates them. It is 1 where the record is of one gauge at the origin, which measured the reflected waves,
    too. Then the elevation there is as measured, and the flow is not. Terms of r^2 are neglected.

    One real r stands for all frequencies. Beaches reflect long waves more; their r is measured by component (Goda and Suzuki
    1976, Estimation of incident and reflected waves in random wave experiments, Coastal Engineering Proceedings 15). With
    dispersion the delay is the group velocity's at one period and the phase is not the beach's: r of either sign and a
    search over T stand for that. Bound waves are sent back as they are, where a beach sets them free: of order r times
    second order.

    In a prepared sea T is between the steps of its clock by interpolation. Nothing comes back before T, and the reflected
    waves cost little. The squared envelope stays that of the incident waves, and so does a computed excitation.

    Labels are `wave_reflection.coefficient` (r; -), `wave_reflection.delay` (T; s) and `wave_reflection.seen` (s; -).
    """

    coefficient: Float[Array, ""] = parameter("-", "share of the waves' height that comes back", -0.3, 0.3)
    delay: Float[Array, ""] = parameter("s", "from the platform to the beach and back", 0.0, MAX_DELAY, DEFAULT_DELAY)
    seen: Float[Array, ""] = parameter("-", "share of what comes back that the wave record has", 0.0, 1.0)
    source: ClassVar[str] = "Goda and Suzuki 1976 (incident and reflected waves); one r, a delay and what a gauge saw are ours"

    def through(self, sea: AbstractSea) -> AbstractSea:
        share, delay, seen = self.coefficient, self.delay, self.seen
        if isinstance(sea, StillWater):
            return sea
        if isinstance(sea, SupportSea):  # which knows times of its clock only
            return replace(sea, back=Reflection(share, delay, seen, sea.middle))
        return ReflectedSea(sea, sea.direction(), share, delay, seen, jnp.zeros(()))
