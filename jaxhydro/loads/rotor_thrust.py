"""Thrust of a rotor, and the damping that it gives."""

from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import parameter
from jaxhydro.rotations import cross


class RotorThrust(AbstractLoad):
    """Thrust of a rotor in a steady wind along x, linear in the speed of the hub.

    F = T - b u at the hub, along the body's x axis, with u the speed of the hub along that axis. T is the thrust at rest,
    positive down-wind. b = dT/dU is the slope of the thrust over the wind speed. Below rated wind it is positive; with a
    controller that keeps the power it may be negative for slow motion. Torque, gyroscopic moments, yawed inflow and the
    delay of the controller are left out.

    Jonkman 2008, Influence of Control on the Pitch Damping of a Floating Wind Turbine, NREL/CP-500-42589: T = T0 - dT/dV x'.
    Labels are `rotor.thrust` (N) and `rotor.damping` (N s/m).
    """

    hub: Float[Array, "3"] = eqx.field(default_factory=lambda: jnp.zeros(3))  # m, body axes
    thrust: Float[Array, ""] = parameter("N", "thrust of the rotor on the hull at rest, along the body's x axis")
    damping: Float[Array, ""] = parameter("N s/m", "slope of the rotor's thrust over the wind speed")
    label_prefix: ClassVar[str] = "rotor"
    source: ClassVar[str] = "Jonkman 2008, NREL/CP-500-42589"

    def act(self, now: Instant, memory: Any) -> Action:
        speed = now.velocity[0] + cross(now.velocity[3:], self.hub)[0]
        zero = jnp.zeros(())
        force = jnp.stack([self.thrust - self.damping * speed, zero, zero])
        return Action(body_force=jnp.concatenate([force, cross(self.hub, force)]))
