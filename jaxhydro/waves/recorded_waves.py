"""First-order waves of a measured elevation, apart from the second-order waves that they bind.

They are separated once per record, in NumPy; the results go into jitted code.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Complex, Float

from jaxhydro.choices import check
from jaxhydro.environment import Environment
from jaxhydro.exported_programs import exported_jit
from jaxhydro.waves.components import Components
from jaxhydro.waves.dispersion import wavenumber
from jaxhydro.waves.irregular import harmonic_components
from jaxhydro.waves.pair_sums import elevation_spectrum
from jaxhydro.waves.record_harmonics import measured_harmonics
from jaxhydro.waves.second_order import KINDS, Kind

TOLERANCE = 1e-4  # of the record in the band, by root mean square, that first and second order together may miss
MAX_ROUNDS = 30  # of the iteration for the first-order part; 4 to 8 are usual, more in steep seas

second_order_elevation = exported_jit(elevation_spectrum)  # once per band and record length, not once per round


class Separation(NamedTuple):
    """First-order waves of a record.

    Attributes:
        waves: The components.
        mismatch: Root mean square difference from the record within the band, over that of the record (-).
        rounds: Number of iterations.
    """

    waves: Components
    mismatch: float
    rounds: int


def record_components(
    times: Float[np.ndarray, " t"],
    elevation: Float[np.ndarray, " t"],
    environment: Environment,
    *,
    position: tuple[float, float] = (0.0, 0.0),
    heading: float = 0.0,
    low: float,
    cutoff: float,
    order: int = 2,
    tolerance: float = TOLERANCE,
    kinds: tuple[Kind, ...] = KINDS,
    highest_difference: float | None = None,
) -> Components:
    """First-order waves of a measured elevation; an error where they do not reproduce it.

    Args:
        times: Sample times (s), (t,), even.
        elevation: Elevation (m), (t,).
        environment: Water depth and gravity.
        position: Position of the gauge (m, earth axes).
        heading: Direction that the waves travel to (rad).
        low: Lowest frequency (Hz).
        cutoff: Highest frequency (Hz).
        order: 1 or 2, as in `separated_record`.
        tolerance: Largest accepted mismatch (-).
        kinds: As in `separated_record`.
        highest_difference: As in `separated_record`.

    Returns:
        The components.

    Raises:
        ValueError: As `separated_record`, or the mismatch is above `tolerance`.
    """
    separation = separated_record(
        times,
        elevation,
        environment,
        position=position,
        heading=heading,
        low=low,
        cutoff=cutoff,
        order=order,
        tolerance=tolerance,
        kinds=kinds,
        highest_difference=highest_difference,
    )
    if separation.mismatch > tolerance:
        raise ValueError(
            f"first and second order miss {separation.mismatch:.2%} of the record after {separation.rounds} rounds, expected "
            f"below {tolerance:.2%}. Take a cutoff below {cutoff:g} Hz, a larger tolerance, or order 1"
        )
    return separation.waves


def separated_record(
    times: Float[np.ndarray, " t"],
    elevation: Float[np.ndarray, " t"],
    environment: Environment,
    *,
    position: tuple[float, float] = (0.0, 0.0),
    heading: float = 0.0,
    low: float,
    cutoff: float,
    order: int = 2,
    tolerance: float = TOLERANCE,
    kinds: tuple[Kind, ...] = KINDS,
    highest_difference: float | None = None,
) -> Separation:
    """Long-crested first-order waves of an elevation recorded by a gauge.

    They are the Fourier components of the record without its mean, from `low` to `cutoff`. Phases are those at the origin,
    on the clock of `times`. There is no taper, which would lower the waves near the ends: at the gauge the components are
    the band-passed record at every sample.

    The period is the record's own length where its end meets its start. Otherwise it is about twenty of the shortest waves
    longer, and the record is continued until there (`continued`), since it would ring near its ends.

    With `order` 2, eta1 = eta - eta2(eta1) within the band is iterated, by half steps where it diverges. The best iterate is
    returned. The bound set-down at low frequencies and the sums above `cutoff` follow; they are not matched.

    Args:
        times: Sample times (s), (t,), even.
        elevation: Elevation (m), (t,).
        environment: Water depth and gravity.
        position: Position of the gauge (m, earth axes).
        heading: Direction that the waves travel to (rad).
        low: Lowest frequency (Hz).
        cutoff: Highest frequency (Hz).
        order: 1: the record is taken as linear. 2: bound second-order waves are separated.
        tolerance: Mismatch (-) that the iteration should reach.
        kinds: Pairs that bind: at sums or differences of their frequencies, or both.
        highest_difference: Highest difference frequency (Hz) of bound waves; None: all.

    Returns:
        The waves, and their mismatch.

    Raises:
        ValueError: The times are uneven, the record has gaps or no waves in the band, or the band is out of range.
    """
    check(order=(order, (1, 2)))
    for kind in kinds:
        check(kinds=(kind, KINDS))
    (measured,), omega, first = measured_harmonics(times, [elevation], low, cutoff)
    k = np.asarray(wavenumber(jnp.asarray(omega), jnp.asarray(environment.depth), jnp.asarray(environment.gravity)))
    to_origin = np.exp(1j * k * (position[0] * math.cos(heading) + position[1] * math.sin(heading)))

    def waves(at_gauge: np.ndarray) -> Components:
        a = at_gauge * to_origin
        return harmonic_components(np.abs(a), omega, environment, np.full(omega.shape, float(heading)), np.angle(a), first)

    if order == 1:
        return Separation(waves(measured), 0.0, 0)
    band = slice(first, first + omega.size)

    def bound(at_gauge: np.ndarray) -> np.ndarray:
        return np.asarray(second_order_elevation(waves(at_gauge), environment, position, kinds, highest_difference))[band]

    best, mismatch, rounds = first_order_part(measured, bound, tolerance)
    return Separation(waves(best), mismatch, rounds)


def first_order_part(
    measured: Complex[np.ndarray, "*g w"], bound: Callable[[np.ndarray], np.ndarray], tolerance: float
) -> tuple[Complex[np.ndarray, "*g w"], float, int]:
    """First-order part of measured amplitudes, eta1 = eta - eta2(eta1), by iteration.

    Args:
        measured: Complex amplitudes (m) at one gauge or several.
        bound: From first-order amplitudes at the gauges to the second-order amplitudes there (m).
        tolerance: Mismatch (-) that the iteration should reach.

    Returns:
        First-order amplitudes (m), mismatch (-) and number of iterations.
    """
    size = np.linalg.norm(measured)
    best, trial, share, rounds = measured, measured, 1.0, 0
    residual, least = measured, np.inf  # what the best trial misses, and its norm over the record's
    while rounds < MAX_ROUNDS and least > 0.1 * tolerance and share > 1e-3:
        rounds += 1
        missed = measured - trial - bound(trial)
        mismatch = float(np.linalg.norm(missed) / size)
        if mismatch < least:
            best, residual, least = trial, missed, mismatch
        else:
            share *= 0.5  # gone too far: a shorter step from the best
        trial = best + share * residual
    return best, least, rounds
