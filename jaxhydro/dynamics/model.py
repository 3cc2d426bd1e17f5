"""Model of a platform: a rigid body and its loads, (M + sum A_k) dv/dt = sum F_k."""

import dataclasses
from collections.abc import Mapping
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.choices import unknown
from jaxhydro.dynamics.conventions import Conventions
from jaxhydro.dynamics.kinematics import instant as instant_at
from jaxhydro.dynamics.load_sum import LoadSum, sum_of_loads
from jaxhydro.dynamics.rigid_body import RigidBody
from jaxhydro.dynamics.solve6 import accelerate
from jaxhydro.environment import Environment
from jaxhydro.hull.coefficient_labels import shared_hint, sharing
from jaxhydro.hull.hull import Hull
from jaxhydro.loads.base import AbstractLoad, Parameter
from jaxhydro.loads.instant import Instant
from jaxhydro.remarks import Remark
from jaxhydro.rotations import angular_velocity, attitude_rates_of, cosines, cross, rotation, rotation_of
from jaxhydro.scales import pace_of, size_of
from jaxhydro.waves.excitation import Excitation
from jaxhydro.waves.flow import Cylinders
from jaxhydro.waves.sea import AbstractSea, StillWater
from jaxhydro.waves.sea_state import SeaState
from jaxhydro.waves.transfer import Transfer


class State(eqx.Module):
    """Position, velocity and memory of the platform.

    Attributes:
        position: Surge, sway, heave (m), roll, pitch, yaw (rad) of the reference point.
        velocity: Velocity of the reference point and angular velocity, body axes (m/s, rad/s).
        memory: One entry per load; None for a load without memory.
    """

    position: Float[Array, "6"]
    velocity: Float[Array, "6"]
    memory: tuple[Any, ...]


def strongly_typed(tree: Any) -> Any:
    """A model or load without JAX's weak types.

    Programs are compiled by type. Without this, a model whose numbers were changed would compile again.
    """
    return jax.tree.map(lambda x: jnp.asarray(x, x.dtype) if eqx.is_array(x) else x, tree)


class Model(eqx.Module):
    """Platform model: a rigid body, its strips, and the loads on it.

    Attributes:
        environment: Water and gravity.
        body: Mass and inertia.
        hull: Members cut into strips and ends.
        loads: Loads on the platform.
        conventions: Form of the strip model.
        remarks: Remarks on the files that the platform was read from.
    """

    environment: Environment
    body: RigidBody
    hull: Hull
    loads: tuple[AbstractLoad, ...]
    conventions: Conventions = eqx.field(static=True, default=Conventions())
    remarks: tuple[Remark, ...] = eqx.field(static=True, default=())

    @property
    def size(self) -> Float[Array, ""]:
        """Length scale (-) relative to VolturnUS-S, by displaced volume (`jaxhydro.scales`)."""
        return size_of(self.body.mass, self.environment.density)

    @property
    def pace(self) -> Float[Array, ""]:
        """Time scale (-) relative to VolturnUS-S, by Froude's similarity."""
        return pace_of(self.size, self.environment.gravity)

    @property
    def cylinders(self) -> Cylinders | None:
        """Strips, then ends, that diffract the waves; None where none do."""
        how = self.conventions
        if how.diffraction == "none" or not self.hull.cylinders.radius.size:
            return None
        ramp = how.diffraction == "ramp"
        return dataclasses.replace(self.hull.cylinders, lag=how.lag, bound=how.bound, ramp=ramp)

    @property
    def values(self) -> dict[str, Float[Array, ""]]:
        """Every parameter of every load, by label."""
        return {label: value for load in self.loads for label, value in load.values.items()}

    def about(self, label: str) -> Parameter:
        """Unit, meaning, bounds and neutral value of a parameter.

        Args:
            label: Label of the parameter, such as "column.Cd_t".

        Returns:
            The parameter; bounds that are lengths or times are scaled to the platform's size.

        Raises:
            UnknownName: No load has a parameter of that label.
        """
        for load in self.loads:
            if label in load.values:
                found = load.about(label).sized(float(self.size), float(self.pace))
                others = sharing(label, self.hull.elements.shares)
                return found._replace(meaning=f"{found.meaning}; shared by {', '.join(others)}") if others else found
        raise unknown("parameter", label, sorted(self.values), shared_hint(label, self.hull.elements.shares))

    def with_values(self, values: Mapping[str, Float[Array, ""] | float]) -> "Model":
        """This model with some parameters changed.

        Values are checked unless they are traced: under jit or grad nothing can be raised.

        Args:
            values: New values by label, in the units of `about`.

        Returns:
            A new model.

        Raises:
            UnknownName: No load has a parameter of a label.
            ValueError: A value is not finite, or is negative where physics does not allow it (`Parameter.check`).
        """
        about = {label: load.about for load in self.loads for label in load.values}
        for label, value in values.items():
            if label not in about:
                raise unknown("parameter", label, sorted(about), shared_hint(label, self.hull.elements.shares))
            if not isinstance(value, jax.core.Tracer):
                about[label](label).check(label, value)
        return self.at_values(values)

    def at_values(self, values: Mapping[str, Float[Array, ""] | float]) -> "Model":
        """This model with some parameters changed, unchecked.

        It is for fitted values, which may exceed a physical limit by rounding.
        """

        def changed(load: AbstractLoad) -> AbstractLoad:
            new = {label: jnp.asarray(values.get(label, old), float) for label, old in load.values.items()}
            return eqx.tree_at(lambda x: x.values, load, new) if new else load

        loads = tuple(changed(load) for load in self.loads)
        return eqx.tree_at(lambda m: m.loads, self, loads)

    def with_conventions(self, **changed: str | bool) -> "Model":
        """This model with some conventions changed, such as `with_conventions(wetting="mean")`.

        Raises:
            UnknownName: There is no such convention, or it has no such value.
        """
        names = [field.name for field in dataclasses.fields(Conventions)]
        for name in changed:
            if name not in names:
                raise unknown("convention", name, names)
        changes: dict[str, Any] = dict(changed)
        return dataclasses.replace(self, conventions=dataclasses.replace(self.conventions, **changes))

    def with_load(self, load: AbstractLoad) -> "Model":
        """This model with one more load."""
        return eqx.tree_at(lambda m: m.loads, self, (*self.loads, strongly_typed(load)))

    def in_sea(self, state: SeaState) -> "Model":
        """This model with the coefficients that it has in a sea state."""
        loads = tuple(load.in_sea(state) for load in self.loads)
        return self if all(a is b for a, b in zip(loads, self.loads)) else eqx.tree_at(lambda m: m.loads, self, loads)

    @property
    def transfer(self) -> Transfer | None:
        """Difference-frequency transfer function with which irregular seas are prepared, or None.

        Raises:
            ValueError: Two loads have one.
        """
        found = [one for load in self.loads if (one := load.drifts()) is not None]
        if len(found) > 1:
            raise ValueError("two loads have a difference-frequency transfer function: expected one")
        return found[0] if found else None

    @property
    def excitation(self) -> Excitation | None:
        """First-order excitation with which irregular seas are prepared, or None.

        Raises:
            ValueError: Two loads have one.
        """
        found = [one for load in self.loads if (one := load.excites()) is not None]
        if len(found) > 1:
            raise ValueError("two loads have a computed excitation: expected one")
        return found[0] if found else None

    def through(self, sea: AbstractSea) -> AbstractSea:
        """The sea as changed by all loads."""
        # what belongs to the waves themselves before what becomes of them
        for load in sorted(self.loads, key=lambda load: (load.drifts() is None and load.excites() is None, load.moves)):
            sea = load.through(sea)
        return sea

    def stream(self) -> Float[Array, "3"] | None:
        """Sum of the loads' steady currents (m/s, earth axes), or None."""
        return _sum([load.stream() for load in self.loads])

    @property
    def senses(self) -> bool:
        """Whether any load changes what the motion sensors read."""
        return any(type(load).seen is not AbstractLoad.seen for load in self.loads)

    def seen(self, position: Float[Array, "... 6"]) -> Float[Array, "... 6"]:
        """Reading of the motion sensors at a position (m, rad), (..., 6)."""
        for load in self.loads:
            position = load.seen(position)
        return position

    def clock_lag(self) -> Float[Array, ""] | None:
        """Lag (s) of the recorded motions behind the waves, or None.

        The record at t shows the motion at t - lag.
        """
        return _sum([load.clock_lag() for load in self.loads])

    def rest(self) -> State:
        """State at the reference position, without motion."""
        return State(jnp.zeros(6), jnp.zeros(6), tuple(load.rest() for load in self.loads))

    def settled(self, displacement: Float[Array, "6"]) -> tuple[Any, ...]:
        """Memories of all loads after a slow displacement (m, rad, from rest) that is held."""
        return tuple(load.settled(displacement) for load in self.loads)

    def instant(self, time: Float[Array, ""], state: State, sea: AbstractSea) -> Instant:
        """Motion, submerged geometry and flow at an instant.

        Args:
            time: Time (s).
            state: Position, velocity and memory.
            sea: The sea, before the loads change it.

        Returns:
            What the loads read.
        """
        return instant_at(
            time,
            state.position,
            state.velocity,
            self.through(sea),
            environment=self.environment,
            hull=self.hull,
            conventions=self.conventions,
            cylinders=self.cylinders,
            current=self.stream(),
            replaced=_sum([load.replaces() for load in self.loads]),
        )

    def sum_of_loads(self, now: Instant, memory: tuple[Any, ...]) -> LoadSum:
        """Sum of all loads in body axes.

        Args:
            now: Motion, geometry and flow at the instant.
            memory: Memory of each load.
        """
        return sum_of_loads(self.loads, now, memory)

    def rate(self, time: Float[Array, ""], state: State, sea: AbstractSea) -> State:
        """Time derivative of the state: Newton and Euler about the reference point, body axes.

        Args:
            time: Time (s).
            state: Position, velocity and memory.
            sea: The sea.

        References:
            Fossen (2011), section 3.3.
        """
        now = self.instant(time, state, sea)
        total = self.sum_of_loads(now, state.memory)
        spin, linear, body = state.velocity[3:], state.velocity[:3], self.body
        inertia = body.inertia_at_reference()
        gyroscopic = jnp.concatenate([body.mass * cross(spin, cross(spin, body.centre)), cross(spin, inertia @ spin)])
        # the solution is the acceleration of the reference point, not the rate of its body-axes velocity
        mass, masses, moments = body.mass_matrix() + total.added_mass, total.masses, total.moments
        if self.conventions.directions == "earth":  # they turn with the attitude, and `accelerate` takes them for constant
            mass, masses, moments = mass + moments @ masses, masses[:0], moments[..., :0]
        acceleration = accelerate(mass, total.force - gyroscopic, masses, moments)
        turning = jnp.concatenate([cross(spin, linear), jnp.zeros(3)])
        return State(self.position_rate(state.position, state.velocity), acceleration - turning, total.memory_rate)

    @staticmethod
    def position_rate(position: Float[Array, "6"], velocity: Float[Array, "6"]) -> Float[Array, "6"]:
        """Rates of surge ... yaw (m/s, rad/s) from a velocity in body axes."""
        both = cosines(position[3:])
        return jnp.concatenate([rotation_of(both) @ velocity[:3], attitude_rates_of(both, velocity[3:])])

    @staticmethod
    def body_velocity(position: Float[Array, "6"], rates: Float[Array, "6"]) -> Float[Array, "6"]:
        """Velocity in body axes from rates of surge ... yaw: the inverse of `position_rate`."""
        attitude = position[3:]
        return jnp.concatenate([rotation(attitude).T @ rates[:3], angular_velocity(attitude, rates[3:])])

    def force_at_rest(self, position: Float[Array, "6"], sea: AbstractSea | None = None) -> Float[Array, "6"]:
        """Force and moment (N, N m, earth axes) on the motionless platform at a position.

        Args:
            position: Position (m, rad), (6,).
            sea: The sea; None: still water.
        """
        state = State(position, jnp.zeros(6), self.rest().memory)
        now = self.instant(jnp.zeros(()), state, StillWater() if sea is None else sea)
        total = self.sum_of_loads(now, state.memory)
        return jnp.concatenate([now.rotation @ total.force[:3], now.rotation @ total.force[3:]])


def _sum(parts: list[Array | None]) -> Array | None:
    """Sum of the terms that are not None; None where there are none."""
    there = [part for part in parts if part is not None]
    return sum(there[1:], there[0]) if there else None
