"""Incident and reflected waves of elevations that two gauges measured.

They are separated once per pair of records, in NumPy; the results go into jitted code.
"""

import dataclasses
import math
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Complex, Float

from jaxhydro.choices import check
from jaxhydro.environment import Environment
from jaxhydro.waves.components import Components, components
from jaxhydro.waves.continuation_of_gauges import continued_together
from jaxhydro.waves.dispersion import wavenumber
from jaxhydro.waves.irregular import harmonics
from jaxhydro.waves.record_harmonics import measured_harmonics
from jaxhydro.waves.recorded_waves import TOLERANCE, first_order_part, second_order_elevation
from jaxhydro.waves.wave_errors import GaugeSpacingError

REFLECTED_DEVIATION = 0.3  # of the incident amplitude: prior standard deviation of the reflected one
GAUGE_DEVIATION = 0.03  # of the incident amplitude: standard deviation of a gauge's noise and calibration error
PRIOR_WEIGHT = (GAUGE_DEVIATION / REFLECTED_DEVIATION) ** 2  # of the squared reflected amplitude beside the squared errors
SEPARATED_SPACING = (0.05, 0.45)  # of the wavelength: spacings of gauges that tell the two directions apart
MIN_SEPARATED_SHARE = 0.5  # of the waves' energy that two gauges have to separate


class IncidentAndReflected(NamedTuple):
    """Incident and reflected waves at two gauges.

    Attributes:
        waves: Components of two wave trains: the incident waves, then the reflected ones with the opposite heading.
        band: Lowest and highest frequency (Hz) at which the gauges separate: their spacing is 0.05 to 0.45 wavelengths.
        share_outside: Fraction of the waves' energy outside `band`.
        significant_heights: Significant wave heights of the incident and of the reflected waves (m): 4 standard deviations of
            their elevations at the first gauge, within the record.
        mismatch: As in `Separation`; both gauges together (-).
        rounds: Number of iterations.
    """

    waves: Components
    band: tuple[float, float]
    share_outside: float
    significant_heights: tuple[float, float]
    mismatch: float
    rounds: int

    @property
    def reflection_coefficient(self) -> float:
        """Square root of the reflected over the incident energy within `band` (-)."""
        frequency = np.asarray(self.waves.omega).reshape(2, -1)[0] / (2 * math.pi)
        inside = (frequency >= self.band[0]) & (frequency <= self.band[1])
        incident, reflected = (np.asarray(self.waves.amplitude).reshape(2, -1)[:, inside] ** 2).sum(axis=1)
        return math.sqrt(reflected / incident) if incident > 0 else 0.0


def incident_and_reflected(
    times: Float[np.ndarray, " t"],
    elevations: tuple[Float[np.ndarray, " t"], Float[np.ndarray, " t"]],
    environment: Environment,
    *,
    positions: tuple[tuple[float, float], tuple[float, float]],
    heading: float = 0.0,
    low: float,
    cutoff: float,
    order: int = 1,
    tolerance: float = TOLERANCE,
) -> IncidentAndReflected:
    """Separate long-crested waves at two gauges into incident and reflected ones.

    At each harmonic a gauge at distance s along the heading has the complex amplitude

        y(s) = a_I exp(-i k s) + a_R exp(i k s) + e

    with k of linear dispersion. Two gauges give two equations. They are singular where the spacing is a multiple of half a
    wavelength, sin(k ds) = 0. A prior closes the gap: e is normal with standard deviation `GAUGE_DEVIATION` A, and a_R is
    normal about 0 with `REFLECTED_DEVIATION` A, where A is the incident amplitude. The most likely amplitudes minimise

        sum |y - a_I exp(-i k s) - a_R exp(i k s)|² + r |a_R|²,    r = (GAUGE_DEVIATION / REFLECTED_DEVIATION)² = 0.01

    A drops out of r, which is `PRIOR_WEIGHT`. Without noise the prior lowers a_R by the factor 2 sin²(k ds) / (2 sin²(k ds) +
    r): to 0.95 at spacings of 0.05 and 0.45 wavelengths, to 0.995 at a quarter. At a multiple of half a wavelength a_R is 0,
    and a_I is the mean of both gauges. Waves without reflection and noise are returned exactly at all frequencies.

    With `order` 2 the bound waves of both directions are first subtracted at both gauges, as in `separated_record`.

    Args:
        times: Sample times (s), (t,), even.
        elevations: Elevation (m) at each of the gauges, (t,) each.
        environment: Water depth and gravity.
        positions: Positions of the gauges (m, earth axes).
        heading: Direction that the incident waves travel to (rad).
        low: Lowest frequency (Hz).
        cutoff: Highest frequency (Hz).
        order: 1: the records are taken as linear. 2: bound second-order waves are separated.
        tolerance: Mismatch (-) that the iteration of order 2 should reach.

    Returns:
        The incident and the reflected waves, with phases at the origin.

    Raises:
        GaugeSpacingError: The gauges are at one position along the waves, or separate less than half of the energy, or the
            reflected waves are the higher ones.
        ValueError: As in `separated_record`.

    References:
        Goda and Suzuki (1976), Proceedings of the 15th Conference on Coastal Engineering, 828-845: amplitudes from two gauges,
            which these are for r = 0; spacings of 0.05 to 0.45 wavelengths; reflection coefficient from the energies there.
    """
    check(order=(order, (1, 2)))
    along = np.array([x * math.cos(heading) + y * math.sin(heading) for x, y in positions])
    spacing = float(abs(along[1] - along[0]))
    if not spacing > 1e-6 * float(environment.depth):
        raise GaugeSpacingError("two gauges apart along the waves", f"{spacing:g} m between them")

    def wavenumbers(omega: np.ndarray) -> np.ndarray:
        return np.asarray(wavenumber(jnp.asarray(omega), jnp.asarray(environment.depth), jnp.asarray(environment.gravity)))

    def together(levels: list[np.ndarray], step: float, length: int) -> list[np.ndarray]:
        numbers = np.arange(*(harmonics(low, cutoff, length * step) + np.array([0, 1])))
        turn = _turn(wavenumbers(2 * math.pi / (length * step) * numbers), along)
        return continued_together(np.stack(levels), numbers, turn, PRIOR_WEIGHT, length)

    measured, omega, first = measured_harmonics(times, elevations, low, cutoff, together)
    k = wavenumbers(omega)
    at_gauges = np.stack(measured)
    band = separated_band(spacing, environment)
    share_outside = _share_outside(at_gauges, omega, band)
    if 1 - share_outside < MIN_SEPARATED_SHARE:
        raise GaugeSpacingError(
            "two gauges that separate half of the waves' energy or more",
            f"{spacing:g} m between them, for {band[0]:.3g} to {band[1]:.3g} Hz, with {1 - share_outside:.0%} of the energy",
        )

    def waves(amplitudes: np.ndarray) -> Components:
        both = separated_amplitudes(amplitudes, k, along).ravel()
        towards = np.repeat([heading, heading + math.pi], omega.size)
        made = components(
            jnp.asarray(np.abs(both)),
            jnp.asarray(np.tile(omega, 2)),
            environment,
            heading=jnp.asarray(towards),
            phase=jnp.asarray(np.angle(both)),
            first=first,
        )
        return dataclasses.replace(made, trains=2)

    def result(amplitudes: np.ndarray, mismatch: float, rounds: int) -> IncidentAndReflected:
        made = waves(amplitudes)
        trains = np.asarray(made.complex_amplitude()).reshape(2, -1) * _turn(k, along)[:, 0].T
        heights = _heights(trains, omega, first, np.asarray(times, float))
        both = IncidentAndReflected(made, band, share_outside, heights, mismatch, rounds)
        if both.reflection_coefficient > 1:
            raise GaugeSpacingError(
                "positions for which incident waves are higher than reflected ones",
                f"a reflection coefficient of {both.reflection_coefficient:.3g}: are the gauges exchanged, or the heading?",
            )
        return both

    if order == 1:
        return result(at_gauges, 0.0, 0)

    def bound(amplitudes: np.ndarray) -> np.ndarray:
        made, inside = waves(amplitudes), slice(first, first + omega.size)
        return np.stack([np.asarray(second_order_elevation(made, environment, at))[inside] for at in positions])

    return result(*first_order_part(at_gauges, bound, tolerance))


def separated_amplitudes(
    measured: Complex[np.ndarray, "2 w"], k: Float[np.ndarray, " w"], along: Float[np.ndarray, "2"]
) -> Complex[np.ndarray, "2 w"]:
    """Incident and reflected complex amplitudes (m) at the origin, as derived in `incident_and_reflected`.

    Args:
        measured: Complex amplitudes at the gauges (m), (2, w).
        k: Wavenumbers (rad/m), (w,).
        along: Distances of the gauges along the heading of the incident waves (m), (2,).

    Returns:
        The amplitudes, incident and reflected, (2, w).
    """
    matrix = _turn(k, along)
    adjoint = matrix.conj().swapaxes(1, 2)
    prior = np.diag([0.0, PRIOR_WEIGHT])
    return np.linalg.solve(adjoint @ matrix + prior, adjoint @ measured.T[:, :, None])[:, :, 0].T


def _turn(k: Float[np.ndarray, " w"], along: Float[np.ndarray, "2"]) -> Complex[np.ndarray, "w 2 2"]:
    """Amplitudes at each gauge (second axis) of unit incident and reflected waves (third axis)."""
    turn = np.exp(-1j * np.outer(k, along))
    return np.stack([turn, turn.conj()], axis=-1)


def separated_band(spacing: float, environment: Environment) -> tuple[float, float]:
    """Lowest and highest frequency (Hz) at which two gauges separate.

    Args:
        spacing: Distance of the gauges along the waves (m).
        environment: Water depth and gravity.

    Returns:
        The two frequencies (Hz), at which the spacing is 0.05 and 0.45 wavelengths.

    References:
        Goda and Suzuki (1976), as in `incident_and_reflected`: the two spacings.
    """
    depth, gravity = float(environment.depth), float(environment.gravity)
    low, high = (2 * math.pi * part / spacing for part in SEPARATED_SPACING)  # wavenumbers, rad/m
    return tuple(math.sqrt(gravity * k * math.tanh(k * depth)) / (2 * math.pi) for k in (low, high))  # type: ignore[return-value]


def _heights(
    trains: Complex[np.ndarray, "2 w"], omega: Float[np.ndarray, " w"], first: int, times: Float[np.ndarray, " t"]
) -> tuple[float, float]:
    """4 standard deviations (m) of the elevation of each wave train within the record, without its continuation."""
    step = (times[-1] - times[0]) / (times.size - 1)
    length = round(first * 2 * math.pi / omega[0] / step)
    spectrum = np.zeros((2, length // 2 + 1), complex)
    spectrum[:, first : first + omega.size] = 0.5 * length * trains * np.exp(1j * omega * times[0])
    incident, reflected = 4 * np.fft.irfft(spectrum, length)[:, : times.size].std(axis=1)
    return float(incident), float(reflected)


def _share_outside(measured: Complex[np.ndarray, "2 w"], omega: Float[np.ndarray, " w"], band: tuple[float, float]) -> float:
    energy = (np.abs(measured) ** 2).sum(axis=0)
    outside = (omega < 2 * math.pi * band[0]) | (omega > 2 * math.pi * band[1])
    return float(energy[outside].sum() / energy.sum())
