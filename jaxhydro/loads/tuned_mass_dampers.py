"""Tuned mass dampers: masses on damped springs that slide along a line of the hull."""

import math
from collections.abc import Mapping
from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Complex, Float

from jaxhydro.environment import STANDARD_GRAVITY
from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import Parameter, parameters
from jaxhydro.rotations import cross


class TunedMassDampers(AbstractLoad):
    """Masses that slide along a line of the hull, each held by a spring and a damper.

    m (n . a) = m n . (g - g0) - m w0^2 e - 2 zeta m w0 de/dt. e is the displacement along the line n from where the mass
    rests in the upright hull. a is the acceleration of the mass, and w0 = 2 pi/period. The hull takes the opposite force,
    and that with which guides hold the mass on its line. This is exact for any finite rotation (Goldstein, Poole and Safko
    2002, Classical Mechanics, eq. 4.91, with the Coriolis acceleration of the sliding mass). The spring bears the weight of
    the mass along the line of the upright hull, g0.

    Den Hartog 1956, Mechanical Vibrations, section 3.2: the dynamic vibration absorber. The memory is e and the velocity
    n . v of the mass. It starts at rest. The mass is not part of the rigid body. Labels are `tuned_mass_dampers.NAME.mass`
    (kg), `.period` (s) and `.damping_ratio` (-), of the damper with the hull held.

    Attributes:
        names: Of every damper, in the order of what follows.
        points: Where every mass rests (m), from the reference point, body axes.
        directions: Unit vector along every line, body axes.
        mass: Masses (kg) by name.
        period: Periods (s) of the dampers with the hull held, by name.
        damping_ratio: Damping ratios (-) with the hull held, by name.
        gravity: Acceleration of gravity (m/s²) of the natural modes.
    """

    names: tuple[str, ...] = eqx.field(static=True)
    points: Float[Array, "k 3"]
    directions: Float[Array, "k 3"]
    mass: Mapping[str, Float[Array, ""] | float] = parameters(
        lambda load, name: Parameter("kg", f"mass of the damper {name}", 0.0)
    )
    period: Mapping[str, Float[Array, ""] | float] = parameters(
        lambda load, name: Parameter("s", f"period of the damper {name}, the hull held", 0.5, 500.0, 20.0)
    )
    damping_ratio: Mapping[str, Float[Array, ""] | float] = parameters(
        lambda load, name: Parameter("-", f"damping ratio of the damper {name}, the hull held", 0.0, 1.0)
    )
    gravity: float = eqx.field(static=True, default=STANDARD_GRAVITY)
    source: ClassVar[str] = "Den Hartog 1956, Mechanical Vibrations, section 3.2, the dynamic vibration absorber"

    def rest(self) -> Float[Array, "2 k"]:
        return jnp.zeros((2, len(self.names)))

    def retardation(self, omega: float) -> Complex[np.ndarray, "6 6"]:
        """Response of the masses along their lines, with the dampers held.

        It is that of their inertia, and of their weight on a lean. Natural modes of the hull are those with its dampers
        held.
        """
        added = np.zeros((6, 6))
        for name, point, direction in zip(self.names, np.asarray(self.points), np.asarray(self.directions), strict=True):
            lever = np.concatenate([direction, np.cross(point, direction)])
            lean = np.concatenate([np.zeros(3), np.cross([0.0, 0.0, 1.0], direction)])
            weight = self.gravity * np.outer(lever, lean)  # per mass, along the line: it makes the hull less stiff
            added += float(self.mass[name]) * (np.outer(lever, lever) + weight / omega**2)
        return 1j * omega * added

    def act(self, now: Instant, memory: Any) -> Action:
        velocity, spin = now.velocity[:3], now.velocity[3:]
        gravity = -now.environment.gravity * now.rotation[2]  # in body axes
        force, inertia, rates = jnp.zeros(6), jnp.zeros((6, 6)), []
        for i, name in enumerate(self.names):
            mass, along, (displaced, speed) = self.mass[name], self.directions[i], memory[:, i]
            frequency = 2 * math.pi / self.period[name]
            point = self.points[i] + displaced * along
            carried = velocity + cross(spin, point)  # velocity of the hull at the mass
            sliding = speed - along @ carried
            pull = frequency**2 * displaced + 2 * self.damping_ratio[name] * frequency * sliding  # per mass
            upright = -now.environment.gravity * along[2]
            turning = cross(spin, along) @ carried  # n turns with the hull
            rates.append(jnp.stack([sliding, along @ gravity - upright - pull + turning]))
            inward = cross(spin, cross(spin, point)) + 2 * sliding * cross(spin, along) - gravity
            across = jnp.eye(3) - along[:, None] * along
            arm = jnp.concatenate([jnp.eye(3), jnp.stack([cross(point, axis) for axis in jnp.eye(3)], axis=1)])  # (6, 3)
            inertia = inertia + mass * arm @ across @ arm.T
            force = force + mass * arm @ ((pull + upright) * along - across @ inward)
        return Action(body_force=force, added_mass=inertia, memory_rate=jnp.stack(rates, axis=1))
