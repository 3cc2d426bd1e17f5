"""Model of a platform: a rigid body and its loads, (M + sum A_k) dv/dt = sum F_k."""

import dataclasses
from collections.abc import Mapping
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.choices import check, unknown
from jaxhydro.dynamics.solve6 import accelerate
from jaxhydro.environment import Environment
from jaxhydro.hull.coefficient_labels import shared_hint, sharing
from jaxhydro.hull.hull import Hull
from jaxhydro.loads.base import AbstractLoad, EndShape, Instant, Lines, Parameter, StripShape
from jaxhydro.remarks import Remark
from jaxhydro.rotations import angular_velocity, attitude_rates_of, cosines, cross, rotation, rotation_of, skew, turned
from jaxhydro.scales import pace_of, size_of
from jaxhydro.waves.excitation import Excitation
from jaxhydro.waves.flow import Cylinders, EndFlow, StripFlow
from jaxhydro.waves.sea import AbstractSea, StillWater
from jaxhydro.waves.sea_state import SeaState
from jaxhydro.waves.transfer import Transfer

CONVENTIONS: dict[str, tuple[str | bool, ...]] = {
    "wetting": ("instantaneous", "mean"),
    "diffraction": ("maccamy_fuchs", "ramp", "none"),
    "directions": ("body", "earth"),
    "waves_at": ("displaced", "mean"),
    "centripetal": (True, False),
    "lag": (True, False),
    "bound": (True, False),
}


class RigidBody(eqx.Module):
    """Mass and inertia of the platform, body axes.

    Attributes:
        mass: Mass (kg).
        centre: Centre of mass (m) from the reference point.
        inertia: Inertia about the centre of mass (kg m²).
    """

    mass: Float[Array, ""]
    centre: Float[Array, "3"]
    inertia: Float[Array, "3 3"]

    def inertia_at_reference(self) -> Float[Array, "3 3"]:
        """Inertia about the reference point (kg m²), by the parallel-axis theorem."""
        s = skew(self.centre)
        return self.inertia - self.mass * s @ s

    def mass_matrix(self) -> Float[Array, "6 6"]:
        """Mass matrix about the reference point (kg, kg m, kg m²).

        References:
            Fossen (2011), section 3.3.
        """
        lever = self.mass * skew(self.centre)
        upper = jnp.concatenate([self.mass * jnp.eye(3), -lever], axis=1)
        return jnp.concatenate([upper, jnp.concatenate([lever, self.inertia_at_reference()], axis=1)])


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


class LoadSum(NamedTuple):
    """Sum of all loads, body axes.

    Attributes:
        force: Force and moment (N, N m) on the reference point.
        added_mass: Added mass (kg, kg m, kg m²) of the body.
        masses: Added masses of `Hull.masses`, (k,).
        moments: Matrices that multiply `masses`, (6, 6, k).
        memory_rate: Time derivative of each load's memory.
    """

    force: Float[Array, "6"]
    added_mass: Float[Array, "6 6"]
    masses: Float[Array, " k"]
    moments: Float[Array, "6 6 k"]
    memory_rate: tuple[Any, ...]


def strongly_typed(tree: Any) -> Any:
    """A model or load without JAX's weak types.

    Programs are compiled by type. Without this, a model whose numbers were changed would compile again.
    """
    return jax.tree.map(lambda x: jnp.asarray(x, x.dtype) if eqx.is_array(x) else x, tree)


class Model(eqx.Module):
    """Platform model: a rigid body, its strips, and the loads on it.

    The conventions are words; an unknown one raises UnknownName when the model is made. The default of `diffraction`
    replaces Ca in the wave excitation altogether. That is the theory, for a Ca tuned to the added mass. The step from 1 + Ca
    to 2 that it makes cannot be determined by a calibration in still water.

    Attributes:
        environment: Water and gravity.
        body: Mass and inertia.
        hull: Members cut into strips and ends.
        loads: Loads on the platform.
        wetting: Which part of the members is loaded. "instantaneous": up to the water surface at the displaced strip.
            "mean": what is under still water at the upright reference position, in the flow at that depth.
        diffraction: Wave diffraction by the members that diffract. "maccamy_fuchs"; "ramp", the same but with coefficients
            tuned away from Ca = 1 kept in long waves (`diffraction.long_waves`); "none".
        directions: Axes of strips and ends. "body": of the displaced member. "earth": of the undisplaced one, as in
            OpenFAST.
        waves_at: Where the waves are evaluated horizontally. "displaced": where the platform is. "mean": at the reference
            position, as in OpenFAST with WaveDisp = 0 and ExctnDisp = 0.
        centripetal: Whether strips and ends feel the centripetal part of their acceleration. False is for programs whose
            added mass takes accelerations alone.
        lag: As in `Cylinders`.
        bound: As in `Cylinders`.
        remarks: Remarks on the files that the platform was read from.
    """

    environment: Environment
    body: RigidBody
    hull: Hull
    loads: tuple[AbstractLoad, ...]
    wetting: str = eqx.field(static=True, default="instantaneous")
    diffraction: str = eqx.field(static=True, default="maccamy_fuchs")
    directions: str = eqx.field(static=True, default="body")
    waves_at: str = eqx.field(static=True, default="displaced")
    centripetal: bool = eqx.field(static=True, default=True)
    lag: bool = eqx.field(static=True, default=True)
    bound: bool = eqx.field(static=True, default=True)
    remarks: tuple[Remark, ...] = eqx.field(static=True, default=())

    def __check_init__(self) -> None:
        """Raises UnknownName for a word that is none of a convention's."""
        check(**{name: (getattr(self, name), allowed) for name, allowed in CONVENTIONS.items()})

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
        if self.diffraction == "none" or not self.hull.cylinders.radius.size:
            return None
        ramp = self.diffraction == "ramp"
        return dataclasses.replace(self.hull.cylinders, lag=self.lag, bound=self.bound, ramp=ramp)

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
        sea = self.through(sea)
        matrix = rotation(state.position[3:])
        hull = self.hull if self.directions == "body" else self.hull.turned(matrix.T)
        strips, ends, place = hull.strips, hull.ends, state.position[:3]
        n, m, faces = len(strips.element), ends.area.shape[0], jnp.array(ends.strip, dtype=int)
        whole = m - len(ends.strip)
        above, follows = (place[:2], matrix[:2]) if self.waves_at == "displaced" else (jnp.zeros(2), jnp.eye(3)[:2])
        roots = jnp.concatenate([hull.elements.start, ends.position[:, :whole]], axis=1)
        if self.wetting == "mean":
            vertical, depth = jnp.array([0.0, 0.0, 1.0]), -roots[2]
        else:
            vertical = matrix[2]
            depth = -(place[2] + vertical @ roots)
            surface = sea.surface(time, above[:, None] + follows @ hull.gauges)
            depth = depth if surface is None else depth + surface[jnp.array(hull.gauge_of, dtype=int)]
        wetted = hull.wetted(vertical, depth[: roots.shape[1] - whole])
        of = jnp.array(strips.element, dtype=int)
        covered, reach = wetted.length[of] * strips.weight, wetted.reach[of] * strips.fraction
        away = hull.join(jnp.stack([reach, reach]), jnp.concatenate([jnp.zeros(whole), reach[faces]]))
        still, turning = (state.velocity @ hull.motion).reshape(2, -1)
        own, own_end = hull.split(-(still + turning * away))
        if (stream := self.stream()) is not None:
            passing = stream @ matrix
            own = own + (passing[:, None, None] * strips.directions).sum(axis=0)
            own_end = own_end + passing @ ends.axis
        extent = strips.size + strips.taper * reach
        p, q, r = state.velocity[3:]
        square = jnp.stack([p * p, q * q, r * r, p * q, p * r, q * r])
        inward, outgoing = (square @ hull.inward).reshape(2, -1)
        inward = inward + away * outgoing if self.centripetal else jnp.zeros_like(away)
        lines = Lines(away, inward)
        shape = StripShape(covered * strips.shape * extent[0] * extent[1], covered * extent[::-1])
        end_wet = jnp.concatenate([hull.ends_wetted(depth[roots.shape[1] - whole :]), jnp.ones(m - whole)])
        lids = [] if hull.leaning is None else [hull.leaning.point]
        points = jnp.concatenate([strips.start + reach * strips.axis, ends.position[:, :whole], *lids], axis=1)
        where = place[:, None] + turned(matrix, points)
        level = points if self.waves_at == "mean" else where
        where = jnp.concatenate([level[:2], (where if self.wetting == "instantaneous" else points)[2:]])
        flow, replaced = sea.flow(time, where, self.cylinders), _sum([load.replaces() for load in self.loads])
        if flow is not None and replaced is not None:
            flow = flow.weakened(1 - replaced)
        if flow is None:
            past, past_end = StripFlow(own, None), EndFlow(own_end, None, None, end_wet)
        else:
            axes = matrix if flow.axes is None else flow.axes.T @ matrix
            toward = (axes @ strips.directions.reshape(3, 2 * n)).reshape(len(axes), 2, n)
            toward_end = axes @ ends.axis

            def across(field: Float[Array, "a n+m"]) -> Float[Array, "2 n"]:
                return (toward * field[:, None, :n]).sum(axis=0)

            diffracted, tuned = (None if field is None else across(field) for field in (flow.diffracted, flow.tuned))
            moving = (own + across(flow.velocity), across(flow.acceleration))
            past = StripFlow(*moving, diffracted, tuned, flow.pressure[:n])
            at = jnp.concatenate([jnp.arange(n, n + whole), faces]) if ends.strip else slice(n, n + whole)
            at_ends = [(toward_end * field[:, at]).sum(axis=0) for field in (flow.velocity, flow.acceleration)]
            past_end = EndFlow(own_end + at_ends[0], at_ends[1], flow.pressure[at], end_wet)
        return Instant(
            time,
            state.position,
            matrix,
            state.velocity,
            self.environment,
            hull,
            wetted,
            shape,
            EndShape.of(hull, wetted, covered, extent),
            past,
            past_end,
            lines,
            sea.drift(time),
            None if replaced is None else sea.excitation(time, above),
            None if flow is None or not lids else (flow.pressure[n + whole :], axes.T @ flow.acceleration[:, n + whole :]),
        )

    def sum_of_loads(self, now: Instant, memory: tuple[Any, ...]) -> "LoadSum":
        """Sum of all loads in body axes.

        Args:
            now: Motion, geometry and flow at the instant.
            memory: Memory of each load.
        """
        actions = [load.act(now, remembered) for load, remembered in zip(self.loads, memory, strict=True)]

        def total(name: str, zero: Float[Array, "..."]) -> Float[Array, "..."]:
            parts = [part for action in actions if (part := getattr(action, name)) is not None]
            return sum(parts[1:], parts[0]) if parts else zero

        force, earth = total("body_force", jnp.zeros(6)), total("force", jnp.zeros(0))
        if earth.size:
            force = force + jnp.concatenate([earth[:3] @ now.rotation, earth[3:] @ now.rotation])
        hull, on_strips, on_ends = now.hull, jnp.zeros_like(now.strip_flow.relative), jnp.zeros_like(now.end_flow.relative)
        per_volume, end_mass = total("element_mass", jnp.zeros((2, len(hull.elements.length)))), total("end_mass", on_ends)
        line_mass = hull.join(now.over_strips(per_volume) * now.strip_shape.volume, end_mass)
        on_lines = hull.join(total("strip_force", on_strips), total("end_force", on_ends)) - line_mass * now.lines.inward
        return LoadSum(
            force + hull.wrench(on_lines, now.lines.away),
            total("added_mass", jnp.zeros((6, 6))),
            hull.masses(per_volume, end_mass, now.wetted),
            hull.moments,
            tuple(action.memory_rate for action in actions),
        )

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
        if self.directions == "earth":  # they turn with the attitude, and `accelerate` takes them for constant
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
