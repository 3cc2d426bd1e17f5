"""Irregular seas of first and second order."""

import dataclasses
import math
from typing import Literal, get_args

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Complex, Float

from jaxhydro.choices import check
from jaxhydro.environment import Environment
from jaxhydro.exported_programs import exported_jit
from jaxhydro.quick_jit import as_data, on_device, quick_jit
from jaxhydro.waves.components import Components, PlaneWaves
from jaxhydro.waves.directional_transfer import AnyTransfer
from jaxhydro.waves.excitation import AnyExcitation
from jaxhydro.waves.flow import Cylinders, Flow
from jaxhydro.waves.integration_clock import Clock
from jaxhydro.waves.pair_sums import elevation_spectrum
from jaxhydro.waves.sea import DRIFT_REFERENCE_FREQUENCY, AbstractSea, Stretching, direction, growth
from jaxhydro.waves.second_order import KINDS, Kind, bound_waves
from jaxhydro.waves.shared_preparation import Preparation
from jaxhydro.waves.support_sea import SupportSea
from jaxhydro.waves.supports import Box, supports
from jaxhydro.waves.wave_sea import WaveSea

Acting = Literal["everywhere", "at the origin", "nowhere"]
_elevation = exported_jit(elevation_spectrum)
ONE_HEADING = 1e-12  # rad, by which headings of a long-crested sea may differ
EXCURSION = 20.0  # m times the platform's size, that it may drift along the waves before its sea is prepared anew


class IrregularSea(AbstractSea):
    """Irregular sea on successive harmonics of a period, with bound waves where `order` is 2.

    `flow`, `elevation` and `drift` are direct summations, for few points and components, and only where bound waves act
    everywhere. Simulations call `prepared`.

    Attributes:
        components: First-order waves.
        environment: Water depth and gravity.
        order: 1 or 2.
        stretching: Kinematics above still water, as in `WaveSea`.
        ramp: Time (s) over which waves grow from rest, as in `WaveSea`.
        kinds: Frequencies of bound waves: "sum", "difference" or both.
        highest_difference: Highest difference frequency (Hz) of bound waves, as OpenFAST's `WvHiCOffD`; None: all.
        acting: Where bound waves act on the platform. "everywhere": as waves. "at the origin": the whole platform feels
            their horizontal flow at the origin, without vertical flow or pressure. Programs do so that take long waves for a
            changing current. "nowhere": only gauges measure them. Their elevation is always everywhere.
    """

    components: Components
    environment: Environment
    order: Literal[1, 2] = eqx.field(static=True, default=1)
    stretching: Stretching = eqx.field(static=True, default="vertical")
    ramp: float = 0.0
    kinds: tuple[Kind, ...] = eqx.field(static=True, default=KINDS)
    highest_difference: float | None = eqx.field(static=True, default=None)
    acting: Acting = eqx.field(static=True, default="everywhere")

    def __check_init__(self) -> None:
        """Raise UnknownName for another order, stretching, kind or value of `acting`."""
        check(order=(self.order, (1, 2)), stretching=(self.stretching, get_args(Stretching)))
        check(acting=(self.acting, get_args(Acting)))
        for kind in self.kinds:
            check(kinds=(kind, KINDS))

    def __repr__(self) -> str:
        """Order, water and components; shapes where the numbers are not computed yet."""
        from jaxhydro.display.summaries import are_numbers, irregular_sea_summary

        computed = are_numbers((self.components, self.environment.depth, self.ramp)) and self.components.amplitude.ndim == 1
        return irregular_sea_summary(self) if computed else eqx.Module.__repr__(self)

    def direct(self) -> WaveSea:
        """The same sea by direct summation: exact, with N components and N² pairs at every point.

        Raises:
            ValueError: Bound waves do not act everywhere.
        """
        if self.order == 2 and self.acting != "everywhere":
            raise ValueError(f"bound waves that act {self.acting} are for simulations: `prepared`")
        waves = PlaneWaves.free(self.components, self.environment)
        bound = None
        if self.order == 2:
            bound = bound_waves(self.components, self.environment, self.kinds, highest_difference=self.highest_difference)
        return WaveSea(waves, self.environment, self.ramp, self.stretching, bound)

    @property
    def long_crested(self) -> bool:
        """Whether all components travel one way; not of a traced sea."""
        return float(np.ptp(np.asarray(self.components.heading))) <= ONE_HEADING

    def flow(
        self,
        time: Float[Array, ""],
        points: Float[Array, "3 n"],
        cylinders: Cylinders | None = None,
        gradient: bool = False,
    ) -> Flow:
        return self.direct().flow(time, points, cylinders, gradient)

    def elevation(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> Float[Array, " n"]:
        return self.direct().elevation(time, points)

    def surface(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> Float[Array, " n"] | None:
        return None if self.stretching == "none" else self.elevation(time, points)

    def drift(self, time: Float[Array, ""]) -> Float[Array, " d"]:
        return self.direct().drift(time)

    def with_tables(self, exciting: AnyExcitation | None, transfer: AnyTransfer | None) -> WaveSea:
        return self.direct().with_tables(exciting, transfer)

    def direction(self) -> Float[Array, "2"]:
        return direction(self.components.vector(), self.components.amplitude**2)

    def moved(self, distance: Float[Array, ""]) -> "IrregularSea":
        phase = self.components.phase + distance * (self.direction() @ self.components.vector())
        return eqx.tree_at(lambda sea: sea.components.phase, self, phase)

    def gauge(
        self, times: Float[np.ndarray, " t"], position: tuple[float, float] = (0.0, 0.0), order: int | None = None
    ) -> Float[np.ndarray, " t"]:
        """Elevation (m) at a fixed horizontal position.

        Args:
            times: Times (s), (t,).
            position: Position (m, earth axes).
            order: 1 or 2 for one order alone; None: all orders of the sea.

        Returns:
            Elevation (m), (t,).
        """
        check(order=(order, (1, 2, None)))
        waves, times = self.components, np.asarray(times, float)
        first, last = waves.harmonics
        spectrum = np.zeros(2 * last + 1, complex)
        if order != 2:
            at_gauge = _at_gauge(dataclasses.replace(waves, first=None), as_data(position))
            spectrum[first : last + 1] = np.asarray(at_gauge).reshape(waves.trains, -1).sum(axis=0)
        if order != 1 and self.order == 2:
            spectrum += np.asarray(self.bound_elevation(position))
        elevation = _harmonic_sum(2 * math.pi / float(waves.period) * times, spectrum)
        return elevation * np.asarray(growth(on_device(times), self.ramp))

    def bound_elevation(self, position: tuple[float, float] = (0.0, 0.0)) -> Complex[Array, " b"]:
        """`elevation_spectrum` (m) of the bound waves, also for a sea of first order."""
        point = jnp.asarray(position, float)
        return _elevation(self.components, self.environment, point, self.kinds, self.highest_difference)

    def prepared(
        self,
        points: Float[np.ndarray, "3 p"],
        cylinders: Cylinders | None,
        clock: Clock,
        excursion: float = EXCURSION,
        transfer: AnyTransfer | None = None,
        exciting: AnyExcitation | None = None,
    ) -> "SupportSea":
        """The sea prepared for one hull and one clock, for fast evaluation in a simulation.

        Args:
            points: Extremities of the hull (m), (3, p).
            cylinders: Cylinders that diffract, or None.
            clock: Times of the integration.
            excursion: Distance (m) by which the hull may move.
            transfer: Difference-frequency transfer function, whose forces `drift` then has.
            exciting: First-order excitation, which `excitation` then has.

        Returns:
            The prepared sea.

        Raises:
            ValueError: Components have several headings or are not harmonics, or the clock's steps do not divide the period
                or are too long for the highest frequency.
        """
        shared = self.preparation(points, cylinders, clock, excursion, transfer, exciting)
        return shared.of(self.components)

    def preparation(
        self,
        points: Float[np.ndarray, "3 p"],
        cylinders: Cylinders | None,
        clock: Clock,
        excursion: float = EXCURSION,
        transfer: AnyTransfer | None = None,
        exciting: AnyExcitation | None = None,
    ) -> Preparation:
        """The part of `prepared` that all seas of these frequencies and this heading share.

        Arguments and errors are those of `prepared`.
        """
        waves, depth = self.components, float(self.environment.depth)
        omega, first = np.asarray(waves.omega), waves.harmonics[0]
        heading, period = float(np.asarray(waves.heading)[0]), first * 2 * math.pi / float(omega[0])
        if not self.long_crested:
            raise ValueError("a short-crested sea is evaluated directly: it has no support wavenumbers of one heading")
        if self.acting == "at the origin":  # that flow is looked up there
            points = np.concatenate([points, np.zeros((3, 1))], axis=1)
        middle, box = Box.of(points, heading, depth, excursion)
        free = float(np.asarray(waves.wavenumber)[-1])
        support_set = supports(box, free, 2 * free if self.order == 2 and "sum" in self.kinds else 0.0)
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
            on_device(support_set.table),
            support_set.spacing,
            on_device(support_set.wavenumber),
            on_device(np.exp(-2 * support_set.wavenumber * depth)),
            on_device(middle),
            on_device(np.array([math.cos(heading), math.sin(heading)])),
            jnp.zeros(0) if cylinders is None else cylinders.radius,
            (True, True, False) if cylinders is None else (cylinders.lag, cylinders.bound, cylinders.ramp),
            None if exciting is None else exciting.towards(heading),
            None if transfer is None else transfer.towards(heading),
            on_device((omega / DRIFT_REFERENCE_FREQUENCY) ** 2),
            on_device(share),
            2 * math.pi / period,
            size,
            clock,
            box.half,
        )


def _harmonic_sum(angle: Float[np.ndarray, " t"], spectrum: Complex[np.ndarray, " w"]) -> Float[np.ndarray, " t"]:
    """Real part of sum_n spectrum_n exp(i n angle). Exponentials are computed for each digit of n, not for each n."""
    base = math.isqrt(spectrum.size - 1) + 1
    digits = np.zeros((base, base), complex)
    digits.flat[: spectrum.size] = spectrum
    turns = (1j * np.outer(part, np.arange(base)) for part in np.array_split(angle, max(1, angle.size * base // 500_000)))
    return np.concatenate([((np.exp(turn) @ digits.T) * np.exp(base * turn)).sum(axis=1).real for turn in turns])


@quick_jit
def _at_gauge(waves: Components, position: Float[Array, "2"]) -> Complex[Array, " w"]:
    """Complex amplitudes (m) of first-order waves at a horizontal position."""
    return waves.complex_amplitude() * jnp.exp(-1j * (position @ waves.vector()))
