"""Plane waves of any order by direct summation: the reference for faster seas."""

import dataclasses
from typing import get_args

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.choices import check
from jaxhydro.environment import Environment
from jaxhydro.waves.components import PlaneWaves
from jaxhydro.waves.diffraction import long_waves, maccamy_fuchs
from jaxhydro.waves.directional_transfer import AnyTransfer
from jaxhydro.waves.excitation import AnyExcitation
from jaxhydro.waves.flow import Cylinders, Flow
from jaxhydro.waves.sea import DRIFT_REFERENCE_FREQUENCY, AbstractSea, Stretching, direction, growth, profiles, stretched


class WaveSea(AbstractSea):
    """Plane waves of any order by direct summation: the reference for faster seas.

    Kinematics are those at the point's own position. Above still water they follow `stretching`:

    - "vertical": those of z = 0;
    - "extrapolation": those of z = 0 and their slope;
    - "wheeler": the profile moved with the surface, z' = h (z - eta) / (h + eta), 0 at most;
    - "none": as "vertical", and the platform is wetted up to still water level.

    Attributes:
        waves: First-order waves.
        environment: Water depth and gravity.
        ramp: Time (s) over which the waves grow from rest by a half cosine; 0: full height from the start.
        stretching: Kinematics above still water.
        bound: Waves bound at second order, or None.
        transfer: Difference-frequency forces of a platform, or None.
        exciting: First-order forces of a platform, or None.

    References:
        Wheeler (1970), Journal of Petroleum Technology 22, 359-367; Rodenbusch and Forristall (1986), on extrapolation.
    """

    waves: PlaneWaves
    environment: Environment
    ramp: Float[Array, ""] | float = 0.0
    stretching: Stretching = eqx.field(static=True, default="vertical")
    bound: PlaneWaves | None = None
    transfer: AnyTransfer | None = None
    exciting: AnyExcitation | None = None

    def __check_init__(self) -> None:
        """Raise UnknownName for another stretching."""
        check(stretching=(self.stretching, get_args(Stretching)))

    def flow(
        self,
        time: Float[Array, ""],
        points: Float[Array, "3 n"],
        cylinders: Cylinders | None = None,
        gradient: bool = False,
    ) -> Flow:
        level, above = self.levels(time, points)
        free = self._of(self.waves, time, points, level, above, cylinders, gradient)
        if self.bound is None:
            return free
        bound = self._of(self.bound, time, points, level, above, cylinders, gradient)
        if cylinders is not None and not cylinders.bound:
            diffracted, tuned = (None if x is None else jnp.zeros_like(x) for x in (bound.diffracted, bound.tuned))
            bound = dataclasses.replace(bound, diffracted=diffracted, tuned=tuned)
        return jax.tree.map(jnp.add, free, bound)

    def levels(
        self, time: Float[Array, ""], points: Float[Array, "3 n"]
    ) -> tuple[Float[Array, " n"], Float[Array, " n"] | None]:
        """Levels at which the profiles of the flow are read, as `stretched` gives them."""
        return stretched(self, self.stretching, time, points, self.environment.depth)

    def _of(self, waves: PlaneWaves, time, points, level, above, cylinders: Cylinders | None, gradient: bool) -> Flow:
        square = (waves.vector**2).sum(axis=0)
        k = jnp.where(square > 0, jnp.sqrt(jnp.where(square > 0, square, 1.0)), 0.0)
        c, s = level_profiles = profiles(k[:, None], level, self.environment.depth)
        if above is not None:
            c, s = c + above * k[:, None] * s, s + above * k[:, None] * c
        turn = self.growth(time) * jnp.exp(1j * (waves.omega[:, None] * time - waves.vector.T @ points[:2]))
        along, upward = c * turn, s * turn
        horizontal, rate = waves.vector * waves.potential, 1j * waves.omega
        up = 1j * k * waves.potential
        velocity = jnp.concatenate([(horizontal @ along).real, (up @ upward).real[None]])
        acceleration = jnp.concatenate([((rate * horizontal) @ along).real, ((rate * up) @ upward).real[None]])
        pressure = ((waves.omega * waves.potential) @ along).real
        slopes = None
        if gradient:  # of the level at which the profiles are read
            c, s = (turn * profile for profile in level_profiles)
            across = jnp.einsum("iw,jw,w,wn->ijn", waves.vector, waves.vector, -1j * waves.potential, c).real
            mixed = ((k * horizontal) @ s).real[:, None]
            upright = ((1j * k**2 * waves.potential) @ c).real[None, None]
            slopes = jnp.concatenate(
                [jnp.concatenate([across, mixed], axis=1), jnp.concatenate([jnp.swapaxes(mixed, 0, 1), upright], axis=1)]
            )
        if cylinders is None or not cylinders.radius.size:
            return Flow(velocity, acceleration, pressure, gradient=slopes)
        radius_index, ka = jnp.array(cylinders.radius_index), k * cylinders.radius[:, None]

        def excited(factors):
            horizontally = sum(
                ((rate * factor * horizontal) @ along).real * (radius_index == i) for i, factor in enumerate(factors)
            )
            vertically = sum(((rate * factor * up) @ upward).real * (radius_index == i) for i, factor in enumerate(factors))
            return jnp.concatenate([horizontally, vertically[None]])

        factors = maccamy_fuchs(ka)
        diffracted = excited(factors if cylinders.lag else jnp.abs(factors))
        tuned = excited(long_waves(ka)) if cylinders.ramp else None
        return Flow(velocity, acceleration, pressure, diffracted, tuned, gradient=slopes)

    def elevation(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> Float[Array, " n"]:
        every = self.waves if self.bound is None else self.waves + self.bound
        angle = every.omega[:, None] * time - every.vector.T @ points
        return self.growth(time) * (every.elevation @ jnp.exp(1j * angle)).real

    def surface(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> Float[Array, " n"] | None:
        return None if self.stretching == "none" else self.elevation(time, points)

    def drift(self, time: Float[Array, ""]) -> Float[Array, " d"]:
        omega = self.waves.omega
        amplitudes = self.growth(time) * self.waves.elevation * jnp.exp(1j * omega * time)
        every = amplitudes.sum().conj()
        sooner = jnp.sign(omega[:, None] - omega)
        pairs = (sooner * (amplitudes[:, None] * amplitudes.conj()).imag).sum()
        mean = (amplitudes * amplitudes.conj()).real.sum()
        plain = jnp.stack(
            [
                (every * every.conj()).real,
                pairs,
                (((omega / DRIFT_REFERENCE_FREQUENCY) ** 2 * amplitudes).sum() * every).real,
                mean,
            ]
        )
        if self.transfer is None:
            return plain
        return jnp.concatenate([plain, self.transfer.of_waves(omega, self.headings(), amplitudes)])

    def excitation(self, time: Float[Array, ""], position: Float[Array, "2"]) -> Float[Array, "6"] | None:
        if self.exciting is None:
            return None
        exciting = self.exciting.at(self.waves.omega, self.headings())
        angle = self.waves.omega * time - position @ self.waves.vector
        return self.growth(time) * (exciting @ (self.waves.elevation * jnp.exp(1j * angle))).real

    def with_tables(self, exciting: AnyExcitation | None, transfer: AnyTransfer | None) -> "WaveSea":
        exciting, transfer = exciting or self.exciting, transfer or self.transfer
        return dataclasses.replace(self, exciting=exciting, transfer=transfer)

    def direction(self) -> Float[Array, "2"]:
        return direction(self.waves.vector, jnp.abs(self.waves.elevation) ** 2)

    def moved(self, distance: Float[Array, ""]) -> "WaveSea":
        way = distance * self.direction()

        def on(waves: PlaneWaves) -> PlaneWaves:
            turn = jnp.exp(1j * (way @ waves.vector))
            return PlaneWaves(waves.omega, waves.vector, waves.elevation * turn, waves.potential * turn)

        bound = None if self.bound is None else on(self.bound)
        return dataclasses.replace(self, waves=on(self.waves), bound=bound)

    def headings(self) -> Float[Array, " w"]:
        """Directions that the first-order waves travel to (rad), (w,)."""
        return jnp.arctan2(self.waves.vector[1], self.waves.vector[0])

    def growth(self, time: Float[Array, "..."]) -> Float[Array, "..."]:
        """Fraction (0 to 1) of their full height that the waves have at a time (s)."""
        return growth(time, self.ramp)
