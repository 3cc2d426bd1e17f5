"""Parts of a prepared sea that seas of equal frequencies and heading share."""

import math
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Complex, Float

from jaxhydro.environment import Environment
from jaxhydro.exported_programs import exported_jit
from jaxhydro.waves.components import Components, PlaneWaves
from jaxhydro.waves.diffraction import long_waves, maccamy_fuchs
from jaxhydro.waves.envelope import envelope
from jaxhydro.waves.excitation import Excitation
from jaxhydro.waves.integration_clock import Clock
from jaxhydro.waves.pair_sums import sum_over_pairs
from jaxhydro.waves.quadratic_transfer import Transfer
from jaxhydro.waves.sea import growth
from jaxhydro.waves.second_order import Kind
from jaxhydro.waves.support_sea import SupportSea
from jaxhydro.waves.supports import weights


class Preparation(eqx.Module):
    """Preparation that seas of the same frequencies and heading share; amplitudes and phases differ.

    It holds support wavenumbers and their weights, the hull's cylinders and computed forces, and a clock. `of` may be
    vectorised over the amplitudes and phases.
    """

    like: Any  # `IrregularSea`, that makes it
    table: Float[Array, "g r"]
    spacing: float
    wavenumber: Float[Array, " r"]
    fade: Float[Array, " r"]
    middle: Float[Array, ""]
    along: Float[Array, "2"]
    radius: Float[Array, " c"]
    options: tuple[bool, bool, bool] = eqx.field(static=True)
    exciting: Excitation | None
    transfer: Transfer | None
    weight: Float[Array, " w"]  # of `envelope`
    share: Float[Array, " t"]
    fundamental: float  # rad/s
    size: int = eqx.field(static=True)  # steps in a period
    clock: Clock = eqx.field(static=True)
    half: float = eqx.field(static=True)  # m, of the box

    def of(self, waves: Components) -> SupportSea:
        """The prepared sea of these components."""
        like, clock = self.like, self.clock
        arrays = (self.table, self.spacing, self.middle, self.along, self.radius)
        order = 1 if like.acting == "nowhere" else like.order
        apart = order == 2 and like.acting == "at the origin"
        options = (*self.options, apart)
        pairs = (like.kinds, like.highest_difference)
        spectrum = _spectrum(waves, like.environment, order, pairs, options, *arrays, self.exciting)
        series, fine = _series(spectrum, self.fundamental, self.size, clock, like.ramp)
        start = jnp.asarray(clock.start)
        return SupportSea(
            like.environment,
            series,
            fine,
            self.wavenumber,
            self.fade,
            self.middle,
            self.along,
            start,
            jnp.asarray(clock.step),
            clock.nodes,
            like.stretching,
            self.half,
            0 if self.exciting is None else len(self.exciting.force),
            envelope(waves, like.environment, self.weight, self.share, self.size, start, self.transfer),
            apart=apart,
        )


@exported_jit
def _spectrum(
    waves: Components,
    environment: Environment,
    order: int,
    pairs: tuple[tuple[Kind, ...], float | None],
    options: tuple[bool, bool, bool, bool],
    table: Float[Array, "g r"],
    spacing: float,
    middle: Float[Array, ""],
    along: Float[Array, "2"],
    radius: Float[Array, " c"],
    exciting: Excitation | None,
) -> Complex[Array, "b f r"]:
    """Fourier amplitudes of the quantities of `SupportSea.series`, by harmonic."""
    lag, diffract_bound, ramp, apart = options
    depth = environment.depth
    # seen from the middle of the box
    phase = waves.phase - waves.wavenumber * middle
    waves = Components(waves.amplitude, waves.omega, waves.wavenumber, waves.heading, phase, waves.first)

    def families(omega, vector, elevation, potential, diffracting):
        k = along @ vector
        rate = 1j * omega
        speed = k * potential
        upward = 1j * k * jnp.tanh(k * depth) * potential
        factor = maccamy_fuchs(jnp.abs(k) * radius[:, None])
        factor = factor if lag else jnp.abs(factor).astype(complex)
        factor = jnp.concatenate([factor, long_waves(jnp.abs(k) * radius[:, None])]) if ramp else factor
        excited = rate * factor if diffracting else jnp.zeros_like(factor)
        even = jnp.concatenate([jnp.stack([speed, rate * speed, omega * potential]), excited * speed])
        odd = jnp.concatenate([jnp.stack([upward, rate * upward]), excited * upward])
        return jnp.concatenate([even, odd, elevation[None]]), jnp.abs(k)

    def split(rows, moved):
        """Rows followed by those of horizontal flow and its excitation of cylinders.

        If `moved`, these keep their values behind only, and elevation alone stays in its row. Else zeros follow.
        """
        flow = jnp.concatenate([rows[:2], rows[3 : len(rows) // 2]])
        return jnp.concatenate([0 * rows[:-1], rows[-1:], flow] if moved else [rows, 0 * flow])

    def sums(omega, vector, elevation, potential):
        rows, k = families(omega, vector, elevation, potential, diffract_bound)
        rows = split(rows, True) if apart else rows
        return jnp.concatenate([rows.real, rows.imag]) @ weights(table, spacing, k)

    first, last = waves.harmonics
    free = PlaneWaves.free(waves, environment)
    rows, k = families(free.omega, free.vector, free.elevation, free.potential, True)
    rows = split(rows, False) if apart else rows
    if exciting is not None:
        rows = jnp.concatenate([exciting.at(free.omega) * free.elevation, rows])
    spectrum = jnp.swapaxes(rows, 0, 1)[:, :, None] * weights(table, spacing, k)[:, None]
    if order == 1:
        return jnp.pad(spectrum, ((first, 0), (0, 0), (0, 0)))
    real, imaginary = jnp.split(sum_over_pairs(waves, environment, sums, *pairs), 2, axis=1)
    bound = real + 1j * imaginary
    if exciting is not None:
        bound = jnp.pad(bound, ((0, 0), (len(exciting.force), 0), (0, 0)))
    return bound.at[first : last + 1].add(spectrum)


@exported_jit
def _series(
    spectrum: Complex[Array, "b f r"], fundamental: float, size: int, clock: Clock, ramp: float
) -> tuple[Float[Array, "t s f 2*r"], Float[Array, "h f 2*r"] | None]:
    """Real and imaginary parts at the times of a clock, by one inverse Fourier transform per node."""
    omega = fundamental * jnp.arange(spectrum.shape[0])
    count = clock.steps + 1
    times = clock.start + clock.step * jnp.arange(count)

    def series_at(node: Float[Array, ""]) -> Float[Array, "t f 2*r"]:
        shifted = spectrum * jnp.exp(1j * omega * (clock.start + node * clock.step))[:, None, None]

        def transformed(rows):  # (b, r)
            values = jnp.fft.ifft(rows, n=size, axis=0) * size
            values = jnp.concatenate([values] * math.ceil(count / size))[:count] if count > size else values[:count]
            return jnp.concatenate([values.real, values.imag], axis=1)

        share = growth(times + node * clock.step, ramp)
        return share[:, None, None] * jnp.swapaxes(jax.lax.map(transformed, jnp.swapaxes(shifted, 0, 1)), 0, 1)

    series = jnp.stack([series_at(jnp.asarray(node)) for node in clock.nodes], axis=1)
    if not clock.fine:
        return series, None
    middle = times[: clock.fine] + 0.5 * clock.step
    halves = jnp.einsum("tb,bfr->tfr", growth(middle, ramp)[:, None] * jnp.exp(1j * omega * middle[:, None]), spectrum)
    return series, jnp.concatenate([halves.real, halves.imag], axis=2)
