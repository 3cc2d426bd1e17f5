"""Irregular sea prepared for a time integration: fast evaluation at displaced positions."""

from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float, Int

from jaxhydro.environment import Environment
from jaxhydro.waves.envelope import Envelope
from jaxhydro.waves.flow import Cylinders, Flow
from jaxhydro.waves.integration_clock import between
from jaxhydro.waves.sea import AbstractSea, Stretching, stretched
from jaxhydro.waves.support_fields import field, support_slope, surface


class Reflection(NamedTuple):
    """Reflected waves: the sea mirrored about the origin, later and weaker.

    Attributes:
        share: Reflection coefficient (-).
        delay: Delay (s).
        seen: Fraction (-) of the reflected waves that the sea already includes as if they were incident.
        middle: Middle of the prepared sea's box (m, along the waves); the origin is at -`middle` in it.
    """

    share: Float[Array, ""]
    delay: Float[Array, ""]
    seen: Float[Array, ""]
    middle: Float[Array, ""]


class SupportSea(AbstractSea):
    """An irregular sea of one heading for one hull and one clock: see `supports` for how it works.

    `series` holds the amplitudes of the supports, real then imaginary, by step, node and quantity. The quantities are, in
    this order:

    - `forces` of the first order on a platform (none, six or a multiple);
    - horizontal velocity and acceleration, and pressure over density;
    - horizontal excitation of cylinders of each radius (and `Flow.tuned` for each);
    - vertical velocity and acceleration, and vertical excitation of the cylinders;
    - elevation;
    - where bound waves act `apart`, at the origin only and on the whole platform: their horizontal velocity and
      acceleration, and their horizontal excitation of cylinders of each radius.

    Only times of the clock may be asked for, but of `drift`, which `envelope` holds. `moved` shifts the box with the sea,
    and the envelope with the group velocity. Waves do not come `back` before their delay. `excitation`, `drift` and waves
    that act `apart` are not reflected.
    """

    environment: Environment
    series: Float[Array, "t s f 2*r"]
    fine: Float[Array, "h f 2*r"] | None
    wavenumber: Float[Array, " r"]
    fade: Float[Array, " r"]  # exp(-2kh)
    middle: Float[Array, ""]  # m, of the box along the waves
    along: Float[Array, "2"]
    start: Float[Array, ""]
    step: Float[Array, ""]
    nodes: tuple[float, ...] = eqx.field(static=True)
    stretching: Stretching = eqx.field(static=True)
    half: float = eqx.field(static=True)  # m, of the box
    forces: int = eqx.field(static=True, default=0)
    envelope: Envelope | None = None
    back: Reflection | None = None
    apart: bool = eqx.field(static=True, default=False)

    def from_step(self, index: Int[Array, ""], steps: int) -> "SupportSea":
        """The same sea for an integration that starts `index` steps after the clock's start.

        Beyond the clock's end the sea stands still. Values at the middle of its first steps are interpolated between
        `integration_clock.INTERPOLATION_STEPS` steps (Lagrange): to 1e-6 for a wave of 20 steps, to 2e-3 for one of 8.
        """
        total = self.series.shape[0]
        fine = None
        if self.fine is not None:
            near, weight = between(index + jnp.arange(self.fine.shape[0]) + 0.5, total)
            fine = jnp.einsum("hp,hpfr->hfr", weight, self.series[near, 0])
        series = self.series[jnp.minimum(index + jnp.arange(steps + 1), total - 1)]
        start = self.start + index * self.step
        restarted = eqx.tree_at(lambda sea: (sea.series, sea.start), self, (series, start))
        restarted = eqx.tree_at(lambda sea: sea.fine, restarted, fine, is_leaf=lambda leaf: leaf is None)
        if self.envelope is None:
            return restarted
        # its series is kept whole, for what it is read ahead
        return eqx.tree_at(lambda sea: sea.envelope.lead, restarted, self.envelope.lead + index * self.step)

    def rows(self, time: Float[Array, ""]) -> Float[Array, "f 2*r"]:
        """Amplitudes of the supports at a time of the clock."""
        steps = (time - self.start) / self.step
        whole = jnp.floor(steps + 1e-6)
        share = steps - whole
        node = jnp.argmin(jnp.abs(share - jnp.array(self.nodes))) if len(self.nodes) > 1 else 0
        index = jnp.clip(whole.astype(int), 0, self.series.shape[0] - 1)
        values = self.series[index, node]
        if self.fine is not None:
            halfway = jnp.abs(share - 0.5) < 0.25
            values = jnp.where(halfway, self.fine[jnp.minimum(index, self.fine.shape[0] - 1)], values)
        return values

    def _sets(self, time: Float[Array, ""]) -> Float[Array, "s f 2*r"]:
        """`rows` without forces; where waves are reflected, sets of reflected waves as well.

        The sets are the incident waves, the reflected waves, their slope by the delay, and the incident waves a delay
        earlier.
        """
        incident = self.rows(time)[self.forces :]
        if self.back is None:
            return incident[None]
        total = self.series.shape[0]
        turn = jnp.exp(-2j * self.wavenumber * self.back.middle)
        families = self.families(len(incident))
        # horizontal velocity, acceleration, and what cylinders are excited by turn round
        sign = jnp.ones(len(incident)).at[jnp.array([0, 1, *range(3, 3 + families)])].set(-1.0)

        def delayed(delay: Float[Array, ""]) -> tuple[Float[Array, "f 2*r"], ...]:
            steps, weight = between((time - delay - self.start) / self.step, total)
            then = jnp.einsum("h,hfr->fr", weight, self.series[steps, 0, self.forces :])
            real, imaginary = jnp.split(then, 2, axis=-1)
            mirrored = sign[:, None] * jnp.conj((real + 1j * imaginary) * jnp.conj(turn))
            return jnp.concatenate([mirrored.real, mirrored.imag], axis=-1) - seen * then, then

        delay, seen = jax.lax.stop_gradient((self.back.delay, self.back.seen))
        (back, then), (later, _) = jax.jvp(delayed, (delay,), (jnp.ones_like(delay),))
        begun = time - delay > self.start - 1e-6 * self.step
        return jnp.stack([incident, *(jnp.where(begun, rows, 0.0) for rows in (back, later, then))])

    def families(self, rows: int) -> int:
        """Number of cylinder excitations among `rows` quantities."""
        return (rows - 8) // 3 if self.apart else (rows - 6) // 2

    def _met(self, parts: Float[Array, "s ..."]) -> Array:
        """Sum of incident and reflected waves.

        Derivatives by reflection and delay cost no more than the value.
        """
        if self.back is None:
            return parts[0]
        late, seen = (value - jax.lax.stop_gradient(value) for value in (self.back.delay, self.back.seen))
        return parts[0] + self.back.share * (parts[1] + late * parts[2] - seen * parts[3])

    def flow(
        self,
        time: Float[Array, ""],
        points: Float[Array, "3 n"],
        cylinders: Cylinders | None = None,
        gradient: bool = False,
    ) -> Flow:
        sets, k, fade = self._sets(time), self.wavenumber, self.fade
        families = self.families(sets.shape[1])
        even, odd = (sets[:, : 3 + families], sets[:, 3 + families : 5 + 2 * families])
        even, odd = (part.reshape(-1, sets.shape[2]) for part in (even, odd))
        slopes = sets[:, 0] if gradient else sets[:0, 0]  # of the horizontal velocity, along the waves and upwards
        tanh = jnp.tile((1 - fade) / (1 + fade), 2)
        along_waves, upwards = (support_slope(slopes, jnp.tile(k, 2)), slopes * jnp.tile(k, 2) * tanh)
        distance = self.along @ points[:2] - self.middle
        level, above = stretched(self, self.stretching, time, points, self.environment.depth)
        if above is None:
            quantities = (jnp.concatenate([even, along_waves]), jnp.concatenate([odd, upwards]))
            along, up = field(*quantities, k, distance, level, fade)
        else:
            slope = jnp.tile(k, 2) * tanh
            quantities = (
                jnp.concatenate([even, odd * slope / tanh**2, along_waves]),
                jnp.concatenate([odd, even * slope, upwards]),
            )
            along, up = field(*quantities, k, distance, level, fade)
        changes = [part[len(part) - len(slopes) :] for part in (along, up)]
        along, up = (part[: len(part) - len(slopes)] for part in (along, up))
        if above is not None:
            along, up = along[: len(even)] + above * up[len(odd) :], up[: len(odd)] + above * along[len(even) :]
        along, up = (self._met(part.reshape(len(sets), len(part) // len(sets), part.shape[1])) for part in (along, up))
        if self.apart:
            rows = sets[0, 6 + 2 * families :]  # of which nothing comes back, and nothing is extrapolated
            at_origin, _ = field(rows, rows[:0], k, jnp.full_like(distance, -self.middle), level, fade)
            along = along.at[jnp.array([0, 1, *range(3, 3 + families)])].add(at_origin)
        excited: list[Array] = []
        if cylinders is not None and families:
            radius_index, radii = jnp.array(cylinders.radius_index), cylinders.radius.size
            for first in range(0, families, radii):
                horizontal = sum(jnp.where(radius_index == i, along[3 + first + i], 0.0) for i in range(radii))
                vertical = sum(jnp.where(radius_index == i, up[2 + first + i], 0.0) for i in range(radii))
                excited.append(jnp.stack([horizontal, vertical]))
        axes = jnp.zeros((3, 2)).at[:2, 0].set(self.along).at[2, 1].set(1.0)
        diffracted, tuned = [*excited, None, None][:2]
        velocity, acceleration = (jnp.stack([along[i], up[i]]) for i in (0, 1))
        flow_gradient = None
        if gradient:  # the flow has no divergence and no rotation
            stretching, shear = map(self._met, changes)
            flow_gradient = jnp.stack([jnp.stack([stretching, shear]), jnp.stack([shear, -stretching])])
        return Flow(velocity, acceleration, along[2], diffracted, tuned, axes, flow_gradient)

    def elevation(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> Float[Array, " n"]:
        distance = self.along @ points - self.middle
        sets = self._sets(time)
        rows = sets[:, 5 + 2 * self.families(sets.shape[1])]
        return self._met(jax.vmap(surface, (0, None, None))(rows, self.wavenumber, distance))

    def surface(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> Float[Array, " n"] | None:
        return None if self.stretching == "none" else self.elevation(time, points)

    def drift(self, time: Float[Array, ""]) -> Float[Array, " d"] | None:
        if self.envelope is None:
            return None
        return self.envelope.at((time + self.envelope.lead - self.start) / self.step)

    def excitation(self, time: Float[Array, ""], position: Float[Array, "2"]) -> Float[Array, "6"] | None:
        if not self.forces:
            return None
        along = (self.along @ position - self.middle)[None]
        return jax.vmap(surface, (0, None, None))(self.rows(time)[: self.forces], self.wavenumber, along)[:, 0]

    def direction(self) -> Float[Array, "2"]:
        return self.along

    def moved(self, distance: Float[Array, ""]) -> "SupportSea":
        shifted = eqx.tree_at(lambda sea: sea.middle, self, self.middle + distance)
        if self.envelope is None:
            return shifted
        # at the origin is now what was at -distance, and came to where the origin was that much later
        lead = self.envelope.lead + distance * self.envelope.slowness
        return eqx.tree_at(lambda sea: sea.envelope.lead, shifted, lead)
