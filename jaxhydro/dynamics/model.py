"""Model of a platform: a rigid body, its loads, water effects and sensor effects.

The equation of motion is (M + sum A_k) dv/dt = sum F_k.
"""

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.dynamics.combined_loads import excitation_of, transfer_of
from jaxhydro.dynamics.conventions import Conventions
from jaxhydro.dynamics.kinematics import instant as instant_at
from jaxhydro.dynamics.model_parameters import about_parameter, check_values, shared_hint
from jaxhydro.dynamics.newton_euler import LoadSum, body_acceleration, sum_of_loads
from jaxhydro.dynamics.rigid_body import RigidBody
from jaxhydro.dynamics.state import State, body_velocity, position_rate
from jaxhydro.environment import Environment
from jaxhydro.hull.hull import Hull
from jaxhydro.loads.base import AbstractLoad
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import AbstractEffect, Parameter, strongly_typed
from jaxhydro.remarks import Remark
from jaxhydro.scales import pace_of, size_of
from jaxhydro.sensors.sensor_effect import AbstractSensorEffect
from jaxhydro.water.water_effect import AbstractWaterEffect
from jaxhydro.waves.directional_transfer import AnyTransfer
from jaxhydro.waves.excitation import AnyExcitation
from jaxhydro.waves.flow import Cylinders
from jaxhydro.waves.sea import AbstractSea, StillWater
from jaxhydro.waves.sea_state import SeaState

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Model(eqx.Module):
    """Platform model: a rigid body, its strips, and the loads on it.

    Attributes:
        environment: Water and gravity.
        body: Mass and inertia.
        hull: Members cut into strips and ends.
        loads: Loads on the platform.
        water: Effects on the sea that the platform meets.
        sensors: Effects on what motion sensors record.
        conventions: Form of the strip model.
        remarks: Remarks on the files that the platform was read from.
    """

    environment: Environment
    body: RigidBody
    hull: Hull
    loads: tuple[AbstractLoad, ...]
    water: tuple[AbstractWaterEffect, ...] = ()
    sensors: tuple[AbstractSensorEffect, ...] = ()
    conventions: Conventions = eqx.field(static=True, default=Conventions())
    remarks: tuple[Remark, ...] = eqx.field(static=True, default=())

    def __repr__(self) -> str:
        """Mass, strips, loads and parameters; shapes where the numbers are not computed yet."""
        from jaxhydro.display.summaries import has_numbers, model_summary

        return model_summary(self) if has_numbers(self) else eqx.Module.__repr__(self)

    def _repr_html_(self) -> str | None:
        from jaxhydro.display.data_frames import model_html

        return model_html(self)

    def plot(self) -> "list[Axes]":
        """Plot the hull from the side, with still water, and from above.

        Returns:
            Axes of the two views (m); `axes[0].figure` is the figure.

        Raises:
            ValueError: The platform has no members.
        """
        from jaxhydro.display.axes import model_axes

        return model_axes(self)

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
        return dataclasses.replace(self.hull.cylinders, lag=how.lag, bound=how.bound, ramp=how.diffraction == "ramp")

    @property
    def effects(self) -> tuple[AbstractEffect, ...]:
        """All loads, water effects and sensor effects."""
        return (*self.loads, *self.water, *self.sensors)

    @property
    def values(self) -> dict[str, Float[Array, ""]]:
        """Every parameter of every effect, by label."""
        return {label: value for effect in self.effects for label, value in effect.values.items()}

    def about(self, label: str) -> Parameter:
        """Unit, meaning, bounds and neutral value of a parameter.

        Args:
            label: Label of the parameter, such as "column.Cd_t".

        Returns:
            The parameter; bounds that are lengths or times are scaled to the platform's size.

        Raises:
            UnknownName: No effect has a parameter of that label.
        """
        return about_parameter(self, label)

    def shared_hint(self, label: str) -> str:
        """Hint that a coefficient is shared, with the label that it has; empty for other labels.

        Args:
            label: Label that the coefficient would have in a group that shares it.
        """
        return shared_hint(self, label)

    def with_values(self, values: Mapping[str, Float[Array, ""] | float]) -> "Model":
        """This model with some parameters changed.

        Values are checked unless they are traced: under jit or grad nothing can be raised.

        Args:
            values: New values by label, in the units of `about`.

        Returns:
            A new model.

        Raises:
            UnknownName: No effect has a parameter of a label.
            ValueError: A value is not finite, or is negative where physics does not allow it (`Parameter.check`).
        """
        check_values(self, values)
        return self.at_values(values)

    def at_values(self, values: Mapping[str, Float[Array, ""] | float]) -> "Model":
        """This model with some parameters changed, without checks.

        Fitted values may exceed a physical limit by rounding.

        Args:
            values: Values by label.
        """
        loads = tuple(load.at_values(values) for load in self.loads)
        water = tuple(effect.at_values(values) for effect in self.water)
        sensors = tuple(effect.at_values(values) for effect in self.sensors)
        return dataclasses.replace(self, loads=loads, water=water, sensors=sensors)

    def with_conventions(self, **changed: str | bool) -> "Model":
        """This model with some conventions changed, such as `with_conventions(wetting="mean")`.

        Raises:
            UnknownName: There is no such convention, or it has no such value.
        """
        return dataclasses.replace(self, conventions=self.conventions.changed(**changed))

    def with_effect(self, effect: AbstractEffect) -> "Model":
        """This model with one more load, water effect or sensor effect.

        Raises:
            TypeError: The effect is none of the three.
        """
        families = {AbstractLoad: "loads", AbstractWaterEffect: "water", AbstractSensorEffect: "sensors"}
        for kind, name in families.items():
            if isinstance(effect, kind):
                changed: dict[str, Any] = {name: (*getattr(self, name), strongly_typed(effect))}
                return dataclasses.replace(self, **changed)
        raise TypeError(f"expected a load, a water effect or a sensor effect, found {type(effect).__name__}")

    def in_sea(self, state: SeaState) -> "Model":
        """This model with the coefficients that it has in a sea state."""
        loads = tuple(load.in_sea(state) for load in self.loads)
        return self if all(a is b for a, b in zip(loads, self.loads)) else eqx.tree_at(lambda m: m.loads, self, loads)

    @property
    def transfer(self) -> AnyTransfer | None:
        """Difference-frequency transfer function with which irregular seas are prepared, or None; ValueError for two."""
        return transfer_of(self.loads)

    @property
    def excitation(self) -> AnyExcitation | None:
        """First-order excitation with which irregular seas are prepared, or None; ValueError for two."""
        return excitation_of(self.loads)

    def through(self, sea: AbstractSea) -> AbstractSea:
        """The sea that the platform meets: with the computed forces of its loads, and all water effects."""
        exciting, transfer = self.excitation, self.transfer
        if exciting is not None or transfer is not None:
            sea = sea.with_tables(exciting, transfer)
        for effect in sorted(self.water, key=lambda effect: effect.comes_last):
            sea = effect.through(sea)
        return sea

    def rest(self) -> State:
        """State at the reference position, without motion."""
        return State(jnp.zeros(6), jnp.zeros(6), tuple(load.rest() for load in self.loads))

    def settled(self, displacement: Float[Array, "6"]) -> tuple[Any, ...]:
        """Memories of all loads after a slow displacement (m, rad, from rest) that is held."""
        return tuple(load.settled(displacement) for load in self.loads)

    def instant(self, time: Float[Array, ""], state: State, sea: AbstractSea) -> Instant:
        """Motion, submerged geometry and flow at a time (s), in a state and a sea before water effects."""
        return instant_at(self, time, state, self.through(sea))

    def sum_of_loads(self, now: Instant, memory: tuple[Any, ...]) -> LoadSum:
        """Sum of all loads in body axes, at an instant and with the memory of each load."""
        return sum_of_loads(self.loads, now, memory)

    def rate(self, time: Float[Array, ""], state: State, sea: AbstractSea) -> State:
        """Time derivative of the state at a time (s), by Newton and Euler (`body_acceleration`)."""
        total = sum_of_loads(self.loads, self.instant(time, state, sea), state.memory)
        acceleration = body_acceleration(self.body, state.velocity, total, self.conventions.directions == "earth")
        return State(self.position_rate(state.position, state.velocity), acceleration, total.memory_rate)

    position_rate = staticmethod(position_rate)
    body_velocity = staticmethod(body_velocity)

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
