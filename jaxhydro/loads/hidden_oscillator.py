"""Undeclared oscillator in the hull, such as sloshing in a tank."""

import math
from typing import Any, ClassVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.per_dof import AbstractLoadPerDof, PerDof, by_dof


class HiddenOscillator(AbstractLoadPerDof):
    """Mass on a damped spring in the hull, in each degree of freedom.

    F_i = m (w0^2 e + 2 zeta w0 (w - v)), de/dt = w - v, m dw/dt = -F: a mass on a spring in the hull, along earth axes.

    v is the velocity of the hull's reference point (m/s) and its angular velocity (rad/s), w that of the mass. e is the
    displacement of the mass in the hull, from where it rests. Typical causes are a slack tank's first mode, a damper that is
    not locked, a flexible tower, a hanging load.

    m is the mass that moves, not all of a tank's water. The rigid body of the model is taken WITHOUT it, so slow motion has
    the mass M + m. A rigid body that includes all of it is too heavy by m (`mass_error`).

    The weight of the mass is left out. So is the effect of a tilted hull on it: a mass that swings in surge pulls with m g
    theta, a tank has a free surface. The law is for small angles, and the mass sits at the reference point. A mass that sits
    elsewhere shows in more than one degree of freedom: give it all of them. It starts at rest.

    Den Hartog 1956, Mechanical Vibrations, chapter 3, the dynamic vibration absorber. Labels are
    `hidden_oscillator.surge.mass` (kg, kg m2), `.period` (2 pi/w0; s), `.damping_ratio` (zeta).
    """

    mass: PerDof = by_dof("kg", "kg m2", "what swings in {dof}, on top of the declared mass", 0.0)
    period: PerDof = by_dof("s", "s", "period of what swings in {dof}, the hull held", 0.5, 500.0, 20.0)
    damping_ratio: PerDof = by_dof("-", "-", "damping ratio of what swings in {dof}, the hull held", 0.0, 1.0, 0.03)
    source: ClassVar[str] = "Den Hartog 1956, Mechanical Vibrations, chapter 3, the dynamic vibration absorber"

    def rest(self) -> Float[Array, "2 k"]:
        return jnp.zeros((2, self.entries(self.mass).shape[0]))

    def act(self, now: Instant, memory: Any) -> Action:
        mass, period, ratio = map(self.entries, (self.mass, self.period, self.damping_ratio))
        displaced, velocity = memory
        frequency = 2 * math.pi / period
        apart = velocity - self.dofs_only(now.earth_velocity())
        pull = frequency**2 * displaced + 2 * ratio * frequency * apart  # per mass
        return Action(force=self.all_dofs(mass * pull), memory_rate=jnp.stack([apart, -pull]))
