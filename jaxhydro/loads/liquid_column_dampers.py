"""Tuned liquid column dampers: U-tubes in the hull, in which liquid swings."""

from collections.abc import Mapping
from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Complex, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import Parameter, parameters
from jaxhydro.rotations import cross, skew

HALF_GAUSS = 0.5 / np.sqrt(3.0)  # of a rod's length: distance of its two Gauss points from its middle


class LiquidColumnDampers(AbstractLoad):
    """U-tubes of one cross-section, whose liquid swings between two columns.

    For a hull that moves along the tube (Sakai, Takaeda and Tamaki 1989; Gao, Kwok and Samali 1997, equation 1):

        rho A L y'' + 1/2 rho A xi |y'| y' + 2 rho A g y = -rho A B x''.

    y is the rise of the liquid in the column ahead, and B the width of the tube. L = B + 2 h is the length of the liquid,
    and xi the head loss. The hull takes the opposite of the force that moves the liquid.

    Here the hull moves in six degrees of freedom. The liquid's kinetic energy is

        1/2 v M v + rho A y' c v + 1/2 rho A L y'^2,

    with v the velocity of the body and M the mass matrix of the liquid at rest in the tube. c = (integral of dl, integral of
    s x dl) along the tube. The equations are Kirchhoff's (Lamb 1932, Hydrodynamics, section 124) with one more coordinate.
    Gravity acts on the liquid where it is. The change of M with y is left out, and so is a column that runs dry.

    The memory is y and p = c v + L y', from rest. The liquid is not part of the rigid body. Labels are
    `liquid_column_dampers.NAME.area` (m²) and `.head_loss` (-).

    Attributes:
        names: Of every damper, in the order of what follows.
        points: Middle of the tube between the columns (m), from the reference point, body axes.
        directions: Unit vector along the tube, body axes, horizontal in the upright hull.
        sizes: Width B, height h of the liquid in the columns at rest (m), and density (kg/m³).
        area: Cross-sections (m²) by name.
        head_loss: Head losses (-) by name.
    """

    names: tuple[str, ...] = eqx.field(static=True)
    points: Float[Array, "k 3"]
    directions: Float[Array, "k 3"]
    sizes: Float[Array, "k 3"]
    area: Mapping[str, Float[Array, ""] | float] = parameters(
        lambda load, name: Parameter("m2", f"cross-section of the damper {name}", 0.0)
    )
    head_loss: Mapping[str, Float[Array, ""] | float] = parameters(
        lambda load, name: Parameter("-", f"head loss of the damper {name}", 0.0)
    )
    source: ClassVar[str] = "Gao, Kwok and Samali 1997, Engineering Structures 19, 476-486, equation 1"

    def rest(self) -> Float[Array, "2 k"]:
        return jnp.zeros((2, len(self.names)))

    def circulation(self, i: int) -> Float[Array, "6"]:
        """Flow along a tube per motion of the body, c (m, m²), (6,)."""
        along, width, height = self.directions[i], self.sizes[i, 0], self.sizes[i, 1]
        up = jnp.array([0.0, 0.0, 1.0])
        turned = cross(self.points[i], along) + height * cross(along, up)
        return width * jnp.concatenate([along, turned])

    def particles(self, i: int) -> tuple[Float[Array, "6 3"], Float[Array, " 6"]]:
        """Positions (m, body axes) and lengths of tube (m) of six particles of the liquid at rest.

        The six particles stand for all the liquid, exactly.
        """
        along, width, height = self.directions[i], self.sizes[i, 0], self.sizes[i, 1]
        up = jnp.array([0.0, 0.0, 1.0])
        ends = [self.points[i] + sign * 0.5 * width * along + 0.5 * height * up for sign in (-1, 1)]
        rods = [(self.points[i], width * along), *((end, height * up) for end in ends)]
        places = [middle + sign * HALF_GAUSS * rod for middle, rod in rods for sign in (-1, 1)]
        return jnp.stack(places), 0.5 * jnp.stack([width, width, *4 * [height]])

    def retardation(self, omega: float) -> Complex[np.ndarray, "6 6"]:
        """Response of the liquid along its tubes when it is held: i omega times its mass, (6, 6).

        Natural modes of the hull are those with its dampers held.
        """
        added = np.zeros((6, 6))
        for i, name in enumerate(self.names):
            flow, (width, height, density) = np.asarray(self.circulation(i)), np.asarray(self.sizes[i])
            added += density * float(self.area[name]) / (width + 2 * height) * np.outer(flow, flow)
        return 1j * omega * added

    def act(self, now: Instant, memory: Any) -> Action:
        velocity, spin = now.velocity[:3], now.velocity[3:]
        gravity, up = -now.environment.gravity * now.rotation[2], jnp.array([0.0, 0.0, 1.0])
        force, inertia, rates = jnp.zeros(6), jnp.zeros((6, 6)), []
        for i, name in enumerate(self.names):
            along, (width, height, density) = self.directions[i], self.sizes[i]
            length, flow, line = width + 2 * height, self.circulation(i), density * self.area[name]
            rise, momentum = memory[:, i]
            rising = (momentum - flow @ now.velocity) / length
            pushed = width * gravity @ along + 2 * rise * gravity @ up - 0.5 * self.head_loss[name] * jnp.abs(rising) * rising
            rates.append(jnp.stack([rising, pushed]))
            places, lengths = self.particles(i)
            arms = jnp.concatenate([jnp.tile(jnp.eye(3), (6, 1, 1)), jnp.stack([skew(point) for point in places])], axis=1)
            still = line * jnp.einsum("q,qij,qkj->ik", lengths, arms, arms)
            added = still - line / length * flow[:, None] * flow
            carried = still @ now.velocity + line * flow * rising  # momentum of the liquid
            turning = jnp.concatenate([cross(spin, carried[:3]), cross(spin, carried[3:]) + cross(velocity, carried[:3])])
            moved = line * (rise * width * along + rise**2 * up)  # first moment (kg m) of what has gone from column to column
            weight = line * jnp.einsum("q,qij,j->i", lengths, arms, gravity)
            lean = jnp.concatenate([jnp.zeros(3), cross(moved, gravity)])
            inertia = inertia + added
            force = force + added[:, :3] @ cross(spin, velocity) - line / length * flow * pushed - turning + weight + lean
        return Action(body_force=force, added_mass=inertia, memory_rate=jnp.stack(rates, axis=1))
