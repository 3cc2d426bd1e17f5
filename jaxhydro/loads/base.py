"""What a load is: one force law with named parameters, and the instant at which it acts."""

import abc
import math
from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from jaxhydro.environment import Environment
from jaxhydro.hull.hull import Hull, Wetted
from jaxhydro.waves.excitation import Excitation
from jaxhydro.waves.flow import EndFlow, StripFlow
from jaxhydro.waves.sea import AbstractSea
from jaxhydro.waves.sea_state import SeaState
from jaxhydro.waves.transfer import Transfer


class Parameter(NamedTuple):
    """What a load's parameter means: its unit, the range in which a fit looks for it, and where the load is silent.

    A `lower` end of 0 or more says that the quantity has a sign by physics, as drag, stiffness and times have: it may not be
    negative (`check`). All other ends are of fits only: published values beyond them, a Cd of 30 for a plate, are not wrong.
    """

    unit: str
    meaning: str
    lower: float = float("-inf")
    upper: float = float("inf")
    null: float = 0.0
    of_hull: bool = True  # bounds that are lengths or times follow the platform's size; not where a wave gauge may have stood

    def check(self, label: str, value: Any) -> None:
        """Raise ValueError for a value of the parameter `label` that is no finite number, or negative where it cannot be."""
        try:
            numbers = np.asarray(value, float)
        except (TypeError, ValueError):
            raise ValueError(f"{label}: expected a number ({self.unit}), found {value!r}") from None
        least = 0.0 if self.lower >= 0 else -math.inf
        if not (np.isfinite(numbers) & (numbers >= least)).all():
            expected = "a finite number" if least < 0 else "a finite number of 0 or more"
            found = ", ".join(f"{one:g}" for one in numbers.ravel()[:3])
            raise ValueError(f"{label}: expected {expected} ({self.unit}: {self.meaning}), found {found}")

    def sized(self, size: float, pace: float) -> "Parameter":
        """With the bounds of a platform of other `size` and `pace` (-, `scales`), where they are lengths or times."""
        factor = {"m": size, "s": pace, "Hz": 1 / pace, "m/s": size / pace}.get(self.unit, 1.0)
        lower, upper = min(self.lower * factor, self.null), max(self.upper * factor, self.null)
        return self if factor == 1.0 or not self.of_hull else self._replace(lower=lower, upper=upper)


class StripShape(NamedTuple):
    """What of each strip is under water: displaced volume (m3), and the area (m2) that a flow along either direction sees."""

    volume: Float[Array, " n"]
    facing: Float[Array, "2 n"]


class EndShape(NamedTuple):
    """What ends and faces are: the area (m2) on which pressure acts, that which a flow along the axis sees, and the volume (m3)
    to which added mass refers. Of a face it is that of the wet part of its strip; an end is wet by `EndFlow.wet`. The end of
    a member that lies at the surface has the area of the wet section beside it.

    A face of a strip over which the section A grows by dA has the area dA, against the axis, and the volume r dA, A = pi r^2:
    over a step that makes 2/3 pi (R^3 - r^3), the difference of two half spheres. OpenFAST HydroDyn, Morison module (tapered
    members); RAFT, raft_member.py, getHydroConstants.
    """

    area: Float[Array, " m"]
    facing: Float[Array, " m"]
    volume: Float[Array, " m"]

    @classmethod
    def of(cls, hull: Hull, wetted: Wetted, covered: Float[Array, " n"], extent: Float[Array, "2 n"]) -> "EndShape":
        """Those of a hull's ends and faces; `covered` (m) is the wet length of every strip, `extent` (m) its size."""
        ends, strips, area = hull.ends, hull.strips, hull.ends.area
        if ends.afloat:
            at, beside, part = (jnp.array(column) for column in zip(*ends.afloat, strict=True))
            area = area.at[at].set(area[at] / part * wetted.length[beside] / hull.elements.length[beside])
        own = cls(area, ends.facing, ends.volume)
        if not ends.strip:
            return own
        of = jnp.array(ends.strip, dtype=int)
        shape, (width, height), (wider, higher) = strips.shape[of], extent[:, of], strips.taper[:, of]
        grown = shape * (wider * height + higher * width) * covered[of]
        faces = slice(len(ends.label) - len(ends.strip), None)
        facing = jnp.where(ends.radius[faces] > 0, jnp.abs(grown), 0.0)
        radius = jnp.sqrt(shape * width * height / math.pi)
        found = (-ends.outward[faces] * grown, facing, radius * facing)
        return cls(*(one.at[faces].set(face) for one, face in zip(own, found, strict=True)))


class Lines(NamedTuple):
    """Lines of strips, ends and faces: distance (m) from the element's start, centripetal acceleration along them (m/s2)."""

    away: Float[Array, " l"]
    inward: Float[Array, " l"]


class Instant(eqx.Module):
    """Everything a load may read, worked out once per evaluation of the equation of motion.

    `position` is surge, sway, heave (m), roll, pitch, yaw (rad) of the reference point; `rotation` takes body to earth axes;
    `velocity` is the velocity of the reference point and the angular velocity in body axes (m/s, rad/s), `earth_velocity()` the
    same along earth axes. `wetted`, `strip_shape` and `end_shape` say what of elements, strips and faces is under water,
    `strip_flow` and `end_flow` how the water moves past strips and ends. `drift` (m2) and `excitation` (N, N m) are those of
    the sea: see `AbstractSea.drift`, `AbstractSea.excitation`. `lid` is pressure over density
    (m2/s2) and acceleration (m/s2, body axes) of the water at the points of `Hull.leaning`.
    """

    time: Float[Array, ""]
    position: Float[Array, "6"]
    rotation: Float[Array, "3 3"]
    velocity: Float[Array, "6"]
    environment: Environment
    hull: Hull
    wetted: Wetted
    strip_shape: StripShape
    end_shape: EndShape
    strip_flow: StripFlow
    end_flow: EndFlow
    lines: Lines
    drift: Float[Array, " d"] | None = None
    excitation: Float[Array, "6"] | None = None
    lid: tuple[Float[Array, " k"], Float[Array, "3 k"]] | None = None

    def earth_velocity(self) -> Float[Array, "6"]:
        """Velocity of the reference point and angular velocity along earth axes (m/s, rad/s)."""
        return jnp.concatenate([self.rotation @ self.velocity[:3], self.rotation @ self.velocity[3:]])

    def diffracting(self) -> Bool[Array, " n"]:
        """Which strips diffract the waves."""
        return jnp.array(self.hull.strips.diffracts) > 0

    def over_strips(self, elements: Float[Array, "2 e"]) -> Float[Array, "2 n"]:
        """What is given by direction and element, by direction and strip."""
        return elements[:, jnp.array(self.hull.strips.element, dtype=int)]


class Action(NamedTuple):
    """What a load does at an instant; leave out what it does not.

    `force` (N, N m) acts on the reference point along earth axes, `body_force` along body axes; `strip_force` and `end_force`
    (N) act on strips along their two directions and on ends along their axes. Added mass multiplies acceleration: `added_mass`
    (kg, kg m, kg m2) that of the reference point in body axes, `element_mass` (kg/m3, per displaced volume, by direction and
    element) and `end_mass` (kg) that of strips and ends, the centripetal part included. `memory_rate` is the rate of the load's
    own state.
    """

    force: Float[Array, "6"] | None = None
    body_force: Float[Array, "6"] | None = None
    added_mass: Float[Array, "6 6"] | None = None
    strip_force: Float[Array, "2 n"] | None = None
    element_mass: Float[Array, "2 e"] | None = None
    end_force: Float[Array, " m"] | None = None
    end_mass: Float[Array, " m"] | None = None
    memory_rate: Any = None


class AbstractLoad(eqx.Module):
    """A physical phenomenon: a differentiable force law with parameters that have names, units, bounds and a null.

    `values` holds what may be calibrated, by label; `about` tells what a label means. A load knows nothing of batches, of the
    model around it or of calibration. What is no force has a method of its own: `stream` and `through` for the water, `seen`
    and `clock_lag` for the sensors.
    """

    values: eqx.AbstractVar[Mapping[str, Float[Array, ""]]]
    source: ClassVar[str] = ""
    moves: ClassVar[bool] = False  # the sea, with all that others make of it

    def rest(self) -> Any:
        """Its memory before t = 0; None where it has none (not `()`: diffrax cannot carry it)."""
        return None

    def settled(self, displacement: Float[Array, "6"]) -> Any:
        """Its memory after having been moved slowly to a displacement (m, rad, from rest) and held there."""
        return self.rest()

    def fastest(self) -> float:
        """Largest rate (1/s) of its memory by itself, which a time step has to resolve; 0: it has none, or slow ones only."""
        return 0.0

    def in_sea(self, state: SeaState) -> "AbstractLoad":
        """The load as it is in a sea state; itself where it does not depend on that."""
        return self

    def stream(self) -> Float[Array, "3"] | None:
        """Steady velocity (m/s, earth axes) that it adds to the water everywhere; None: none."""
        return None

    def through(self, sea: AbstractSea) -> AbstractSea:
        """The sea as the platform meets it; itself where the load does not touch it."""
        return sea

    def drifts(self) -> Transfer | None:
        """What of second order an irregular sea has to be prepared with for it; None: nothing."""
        return None

    def excites(self) -> Excitation | None:
        """What of first order an irregular sea has to be prepared with for it; None: nothing."""
        return None

    def covers(self) -> tuple[str, float, float] | None:
        """Key in the platform file, lowest and highest frequency (rad/s) of what was computed for it; None: it has no table."""
        return None

    def replaces(self) -> Float[Array, ""] | None:
        """Share of what accelerations and pressures of the water do to strips and ends that it stands for; None: none."""
        return None

    def seen(self, position: Float[Array, "... 6"]) -> Float[Array, "... 6"]:
        """What the motion sensors make of a position (m, rad)."""
        return position

    def clock_lag(self) -> Float[Array, ""] | None:
        """Lag (s) of the recorded motions behind the waves: what is recorded at t is y(t - lag), the motion a lag earlier."""
        return None

    @abc.abstractmethod
    def about(self, label: str) -> Parameter:
        """What the parameter `label` of this load means."""

    def act(self, now: Instant, memory: Any) -> Action:
        """The load at an instant; none where all it does is something else."""
        return Action()
