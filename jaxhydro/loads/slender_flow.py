"""Flow past slender members to second order, and the forces on their added mass that follow from it."""

from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.hull.hull import Hull
from jaxhydro.hull.submerged import EndShape, StripShape


class SlenderFlow(NamedTuple):
    """Relative velocity of the water and its slopes at strips and ends, body axes.

    Across a strip the relative velocity is w (m/s), along its axis W. M is its added mass per length along its directions d1
    and d2. E is the gradient of the water's velocity (1/s), s the strip's axis, and Omega the angular velocity of the body.

    Attributes:
        share: Fraction (-) of the forces that acts.
        across: w of strips along their directions (m/s), (2, n).
        axial: W of strips (m/s), (n,).
        stretching: s . E s at strips (1/s), (n,).
        shear: d1 . E d2 at strips (1/s), (n,).
        spin: Omega . s (rad/s), (n,).
        turning: d . (Omega x s) of both directions (rad/s), (2, n).
        end_point: Positions of ends and faces (m), (3, m).
        end_across: w at ends and faces (m/s) along the directions of the strips beside them, (2, m).
        end_axial: W at ends and faces (m/s), (m,).
    """

    share: Float[Array, ""]
    across: Float[Array, "2 n"]
    axial: Float[Array, " n"]
    stretching: Float[Array, " n"]
    shear: Float[Array, " n"]
    spin: Float[Array, " n"]
    turning: Float[Array, "2 n"]
    end_point: Float[Array, "3 m"]
    end_across: Float[Array, "2 m"]
    end_axial: Float[Array, " m"]

    def on_strips(
        self, hull: Hull, shape: StripShape, mass: Float[Array, "2 n"]
    ) -> tuple[Float[Array, "2 n"], Float[Array, "6"]]:
        """Second-order force on strips, and the moment about their axes.

        The force is that beyond M times the water's and the strip's acceleration:

        f_d = M_d w_d (s . E s) - 2 M_d W d . (Omega x s) + (M_e - M_d) w_e (d . E e + d . (Omega x e)), e the other
        direction, and the moment (M_1 - M_2) w_1 w_2 about the axis.

        Args:
            hull: The hull.
            shape: Submerged part of the strips.
            mass: Added mass per displaced volume (kg/m³) by direction, (2, n).

        Returns:
            Force (N) along the directions, (2, n), and force and moment (N, N m) on the reference point, (6,).
        """
        added = self.share * mass * shape.volume
        other, change = self.across[::-1], added[::-1] - added
        lean = self.shear - jnp.stack([self.spin, -self.spin])
        force = added * (self.across * self.stretching - 2 * self.axial * self.turning) + change * other * lean
        first, second = hull.strips.directions[:, 0], hull.strips.directions[:, 1]
        moment = jnp.cross(first, second, axis=0) @ ((added[0] - added[1]) * self.across[0] * self.across[1])
        return force, jnp.concatenate([jnp.zeros(3), moment])

    def on_ends(
        self, hull: Hull, shape: EndShape, mass: Float[Array, "2 n"], wet: Float[Array, " m"]
    ) -> tuple[Float[Array, " m"], Float[Array, "6"]]:
        """Force where the added mass of members ends: along the axis, and across it.

        With M the added mass per length beside the end, the pressure is lower by M w²/2 over the section. Water takes the
        momentum M w with it. The forces are n w . M w / 2 and -(n . s) W M w, with n the outward normal. They close the
        strip's forces: on a body under still water all together are Kirchhoff's.

        Args:
            hull: The hull.
            shape: Areas of ends and faces.
            mass: Added mass of strips per displaced volume (kg/m³) by direction, (2, n).
            wet: 1 under water, 0 above, (m,).

        Returns:
            Force (N) along the axes, (m,), and force and moment (N, N m) on the reference point, (6,).
        """
        beside = jnp.array(hull.ends.beside, dtype=int)
        carried = self.share * mass[:, beside] * shape.area * hull.ends.outward * wet * self.end_across
        along = 0.5 * (carried * self.end_across).sum(axis=0)
        force = -self.end_axial * (carried * hull.strips.directions[:, :, beside]).sum(axis=1)
        moment = jnp.cross(self.end_point, force, axis=0)
        return along, jnp.concatenate([force, moment]).sum(axis=1)


def slender_flow(
    share: Float[Array, ""],
    velocity: Float[Array, "6"],
    hull: Hull,
    reach: Float[Array, " n"],
    water: Float[Array, "3 p"] | None,
    gradient: Float[Array, "3 3 p"] | None,
) -> SlenderFlow:
    """`SlenderFlow` of a hull.

    Args:
        share: Fraction (-) of the forces that acts.
        velocity: Velocity of the reference point and angular velocity, body axes (m/s, rad/s).
        hull: The hull.
        reach: Distance (m) of each strip from the start of its element, (n,).
        water: Velocity of the water (m/s, body axes) at strips, then ends without faces; None in still water.
        gradient: Gradient of that velocity (1/s, body axes); None in still water.
    """
    strips, ends, n, whole = hull.strips, hull.ends, len(hull.strips.element), hull.ends_without_faces
    of_faces = jnp.array(ends.strip, dtype=int)
    at_ends = jnp.concatenate([jnp.arange(n, n + whole), of_faces])
    point = strips.start + reach * strips.axis
    end_point = jnp.concatenate([ends.position[:, :whole], point[:, of_faces]], axis=1)
    linear, turn = velocity[:3, None], jnp.broadcast_to(velocity[3:, None], (3, 1))
    relative = -(linear + jnp.cross(turn, point, axis=0))
    end_relative = -(linear + jnp.cross(turn, end_point, axis=0))
    first, second = strips.directions[:, 0], strips.directions[:, 1]
    axis = jnp.cross(first, second, axis=0)
    stretching = shear = jnp.zeros(n)
    if water is not None and gradient is not None:
        relative, end_relative = relative + water[:, :n], end_relative + water[:, at_ends]
        slopes = gradient[:, :, :n]
        stretching = jnp.einsum("in,ijn,jn->n", axis, slopes, axis)
        shear = jnp.einsum("in,ijn,jn->n", first, slopes, second)

    def along(direction: Float[Array, "3 n"]) -> Float[Array, " n"]:
        return (direction * relative).sum(axis=0)

    spin, turning = velocity[3:] @ axis, jnp.stack([velocity[3:] @ second, -(velocity[3:] @ first)])
    end_axial = (ends.axis * end_relative).sum(axis=0)
    end_across = (strips.directions[:, :, jnp.array(ends.beside, dtype=int)] * end_relative[:, None]).sum(axis=0)
    across = jnp.stack([along(first), along(second)])
    return SlenderFlow(share, across, along(axis), stretching, shear, spin, turning, end_point, end_across, end_axial)
