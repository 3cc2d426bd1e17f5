"""Irregular seas of first and second order, summed as they are or made ready for a time integration."""

import math
from typing import Literal

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Complex, Float

from jaxhydro.environment import Environment
from jaxhydro.waves.components import Components, PlaneWaves
from jaxhydro.waves.diffraction import long_waves, maccamy_fuchs
from jaxhydro.waves.envelope import envelope
from jaxhydro.waves.excitation import Excitation
from jaxhydro.waves.flow import Cylinders, Flow
from jaxhydro.waves.sea import MIDDLE, AbstractSea, Stretching, WaveSea, direction, growth
from jaxhydro.waves.second_order import KINDS, Kind, bound_waves, elevation_spectrum, fold
from jaxhydro.waves.support_sea import Clock, SupportSea
from jaxhydro.waves.supports import Box, supports, weights
from jaxhydro.waves.transfer import Transfer

EXCURSION = 20.0  # m that a platform may drift along the waves before its sea is prepared anew


class IrregularSea(AbstractSea):
    """Components on successive harmonics of a period, with what they bind at second order where `order` is 2: by `kinds` at
    sums and differences of their frequencies, or at one of these alone.

    Stretching and `ramp` (s) are those of `WaveSea`. `flow` and `elevation` are by direct summation, for few points and
    components; simulations call `prepared`.
    """

    components: Components
    environment: Environment
    order: Literal[1, 2] = eqx.field(static=True, default=1)
    stretching: Stretching = eqx.field(static=True, default="vertical")
    ramp: float = 0.0
    kinds: tuple[Kind, ...] = eqx.field(static=True, default=KINDS)

    def direct(self) -> WaveSea:
        """The same sea by direct summation: exact, N components and at second order N^2 pairs at every point."""
        waves = PlaneWaves.free(self.components, self.environment)
        bound = bound_waves(self.components, self.environment, self.kinds) if self.order == 2 else None
        return WaveSea(waves, self.environment, self.ramp, self.stretching, bound)

    def flow(self, time: Float[Array, ""], points: Float[Array, "3 n"], cylinders: Cylinders | None = None) -> Flow:
        return self.direct().flow(time, points, cylinders)

    def elevation(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> Float[Array, " n"]:
        return self.direct().elevation(time, points)

    def surface(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> Float[Array, " n"] | None:
        return None if self.stretching == "none" else self.elevation(time, points)

    def drift(self, time: Float[Array, ""]) -> Float[Array, " d"]:
        return self.direct().drift(time)

    def direction(self) -> Float[Array, "2"]:
        return direction(self.components.vector(), self.components.amplitude**2)

    def moved(self, distance: Float[Array, ""]) -> "IrregularSea":
        phase = self.components.phase + distance * (self.direction() @ self.components.vector())
        return eqx.tree_at(lambda sea: sea.components.phase, self, phase)

    def gauge(
        self, times: Float[np.ndarray, " t"], position: tuple[float, float] = (0.0, 0.0), order: int | None = None
    ) -> Float[np.ndarray, " t"]:
        """Elevation (m) at `times` (s) at a fixed horizontal `position` (m), of all orders or of the `order` asked for."""
        waves, times = self.components, np.asarray(times, float)
        first, last = waves.harmonics
        spectrum = np.zeros(2 * last + 1, complex)
        if order != 2:
            there = waves.complex_amplitude() * jnp.exp(-1j * (jnp.asarray(position) @ waves.vector()))
            spectrum[first : last + 1] = np.asarray(there)
        if order != 1 and self.order == 2:
            spectrum += np.asarray(_elevation(waves, self.environment, jnp.asarray(position, float), self.kinds))
        omega = 2 * math.pi / float(waves.period) * np.arange(spectrum.size)
        parts = np.array_split(times, max(1, times.size * omega.size // 2_000_000))
        found = np.concatenate([(np.exp(1j * np.outer(part, omega)) @ spectrum).real for part in parts])
        return found * np.asarray(growth(jnp.asarray(times), self.ramp))

    def prepared(
        self,
        points: Float[np.ndarray, "3 p"],
        cylinders: Cylinders | None,
        clock: Clock,
        excursion: float = EXCURSION,
        linear: bool = False,
        transfer: Transfer | None = None,
        exciting: Excitation | None = None,
    ) -> "SupportSea":
        """The same sea for the points of a hull (m, their extremities) that moves by up to `excursion` (m), on a clock; of its
        first order alone where `linear`, in arrays of the same shapes. `drift` has the forces of a `transfer`, too, and
        `excitation` those of first order.

        Raises ValueError for components of several headings, that are no harmonics, or where the clock's steps do not divide
        the period or are too long for the highest frequency.
        """
        shared = self.preparation(points, cylinders, clock, excursion, linear, transfer, exciting)
        return shared.of(self.components)

    def preparation(
        self,
        points: Float[np.ndarray, "3 p"],
        cylinders: Cylinders | None,
        clock: Clock,
        excursion: float = EXCURSION,
        linear: bool = False,
        transfer: Transfer | None = None,
        exciting: Excitation | None = None,
    ) -> "Preparation":
        """What `prepared` works out of frequencies and heading alone, for all seas that have these. Raises as it does."""
        waves, depth = self.components, float(self.environment.depth)
        heading, period = float(waves.heading[0]), float(waves.period)
        if np.ptp(np.asarray(waves.heading)) > 1e-12:
            raise ValueError("a short-crested sea is evaluated directly: it has no support wavenumbers of one heading")
        middle, box = Box.of(points, heading, depth, excursion)
        free = float(waves.wavenumber[-1])
        found = supports(box, free, 2 * free if self.order == 2 and "sum" in self.kinds else 0.0)
        size = round(period / clock.step)
        highest = waves.harmonics[1] * (self.order if "sum" in self.kinds else 1)
        if abs(size * clock.step - period) > 1e-6 * clock.step:
            raise ValueError(f"steps of {clock.step:g} s do not divide the sea's period of {period:g} s")
        if highest >= size:
            raise ValueError(
                f"a step of {clock.step:g} s is too long for waves of {highest / period:.3g} Hz: "
                f"below {period / highest:.3g} s expected"
            )
        share = np.asarray(growth(clock.start + clock.step * np.arange(clock.steps + 1), self.ramp)) ** 2
        return Preparation(
            self,
            jnp.asarray(found.table),
            found.spacing,
            jnp.asarray(found.wavenumber),
            jnp.asarray(np.exp(-2 * found.wavenumber * depth)),
            jnp.asarray(middle),
            jnp.asarray(np.array([math.cos(heading), math.sin(heading)])),
            jnp.zeros(0) if cylinders is None else cylinders.radius,
            (True, True, False) if cylinders is None else (cylinders.lag, cylinders.bound, cylinders.ramp),
            exciting,
            transfer,
            jnp.asarray((np.asarray(waves.omega) / MIDDLE) ** 2),
            jnp.asarray(share),
            2 * math.pi / period,
            size,
            clock,
            box.half,
            linear,
        )


class Preparation(eqx.Module):
    """Supports, their weights, a hull's cylinders and computed forces, a clock: what seas of the frequencies, the heading and
    all else of `like` share, whose amplitudes and phases are their own. `of` may be vectorised over these."""

    like: IrregularSea
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
    linear: bool = eqx.field(static=True)

    def of(self, waves: Components) -> SupportSea:
        """The sea of these components, made ready."""
        like, clock = self.like, self.clock
        arrays = (self.table, self.spacing, self.middle, self.along, self.radius)
        order = 1 if self.linear else like.order
        spectrum = _spectrum(waves, like.environment, order, like.kinds, self.options, *arrays, self.exciting)
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
            0 if self.exciting is None else 6,
            envelope(waves, like.environment, self.weight, self.share, self.size, start, self.transfer),
        )


_elevation = eqx.filter_jit(elevation_spectrum)


@eqx.filter_jit
def _spectrum(
    waves: Components,
    environment: Environment,
    order: int,
    kinds: tuple[Kind, ...],
    options: tuple[bool, bool, bool],
    table: Float[Array, "g r"],
    spacing: float,
    middle: Float[Array, ""],
    along: Float[Array, "2"],
    radius: Float[Array, " c"],
    exciting: Excitation | None,
) -> Complex[Array, "b f r"]:
    """Fourier amplitudes of the supports' quantities, by harmonic: see `SupportSea.series`."""
    lag, diffract_bound, ramp = options
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

    def sums(omega, vector, elevation, potential):
        rows, k = families(omega, vector, elevation, potential, diffract_bound)
        return jnp.concatenate([rows.real, rows.imag]) @ weights(table, spacing, k)

    first, last = waves.harmonics
    free = PlaneWaves.free(waves, environment)
    rows, k = families(free.omega, free.vector, free.elevation, free.potential, True)
    if exciting is not None:
        rows = jnp.concatenate([exciting.at(free.omega) * free.elevation, rows])
    found = jnp.swapaxes(rows, 0, 1)[:, :, None] * weights(table, spacing, k)[:, None]
    if order == 1:
        return jnp.pad(found, ((first, 0), (0, 0), (0, 0)))
    real, imaginary = jnp.split(fold(waves, environment, sums, kinds), 2, axis=1)
    bound = real + 1j * imaginary
    if exciting is not None:
        bound = jnp.pad(bound, ((0, 0), (6, 0), (0, 0)))
    return bound.at[first : last + 1].add(found)


@eqx.filter_jit
def _series(
    spectrum: Complex[Array, "b f r"], fundamental: float, size: int, clock: Clock, ramp: float
) -> tuple[Float[Array, "t s f 2*r"], Float[Array, "h f 2*r"] | None]:
    """Real and imaginary parts on the clock, by inverse Fourier transforms, one for each node of the steps."""
    omega = fundamental * jnp.arange(spectrum.shape[0])
    kept = clock.steps + 1
    times = clock.start + clock.step * jnp.arange(kept)

    def at(node: Float[Array, ""]) -> Float[Array, "t f 2*r"]:
        shifted = spectrum * jnp.exp(1j * omega * (clock.start + node * clock.step))[:, None, None]

        def one(rows):  # (b, r)
            values = jnp.fft.ifft(rows, n=size, axis=0) * size
            values = jnp.concatenate([values] * math.ceil(kept / size))[:kept] if kept > size else values[:kept]
            return jnp.concatenate([values.real, values.imag], axis=1)

        share = growth(times + node * clock.step, ramp)
        return share[:, None, None] * jnp.swapaxes(jax.lax.map(one, jnp.swapaxes(shifted, 0, 1)), 0, 1)

    series = jnp.stack([at(jnp.asarray(node)) for node in clock.nodes], axis=1)
    if not clock.fine:
        return series, None
    middle = times[: clock.fine] + 0.5 * clock.step
    halves = jnp.einsum("tb,bfr->tfr", growth(middle, ramp)[:, None] * jnp.exp(1j * omega * middle[:, None]), spectrum)
    return series, jnp.concatenate([halves.real, halves.imag], axis=2)
