"""Starting point for a hidden oscillator: the two modes into which it splits one.

An oscillator with a period close to that of a motion splits its mode into two. First-order slopes do not lead there. Undamped,
with omega_h the hull's own frequency, omega_0 the oscillator's and mu its mass over the hull's:

    omega_1^2 + omega_2^2 = omega_h^2 + (1 + mu) omega_0^2,    omega_1^2 omega_2^2 = omega_h^2 omega_0^2

In mode k the oscillator moves r_k = omega_0^2 / (omega_0^2 - omega_k^2) times as far as the hull. Released from rest together,
A_1 + A_2 = A_1 r_1 + A_2 r_2, which gives the third equation:

    (omega_0^2 - omega_1^2) / (omega_2^2 - omega_0^2) = (A_1 / A_2) omega_1^2 / omega_2^2

References:
    Den Hartog 1956, Mechanical Vibrations, section 3.2, the equation for the natural frequencies.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import jax.numpy as jnp
import numpy as np

from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.statics import equilibrium, linearised, natural_modes, widths
from jaxhydro.environment import DOFS

if TYPE_CHECKING:
    from calibration.discovery.linearisations import Point
    from calibration.discovery.study import Study

StartingValuesFinder = Callable[["Study", "Point", Sequence[int], np.ndarray], tuple[Mapping[str, float], ...]]

SAMPLES_PER_PERIOD = 16  # samples of a decay in a natural period
MIN_SAMPLES_PER_MODE = 16  # samples of a decay for every mode
MAX_PERIOD_RATIO = 2.0  # of the two modes' periods to the natural period
MIN_PERIOD_SEPARATION = 0.03  # relative: modes that are closer are one
DAMPING_RATIO_LIMITS = (0.002, 0.5)  # of the oscillator
PERIOD_ITERATIONS = 4  # iterations to the hull's own period
DIFFERENCE_STEP = 1e-3  # of a direction, for slopes of the period
MAX_STEP_DEVIATIONS = 3.0  # standard deviations of the coefficients


class Modes(NamedTuple):
    """Damped oscillations in a decay.

    Attributes:
        eigenvalue: Eigenvalues above the real axis (rad/s; k,).
        amplitude: Complex amplitudes (k,).
        residual_rms: Root mean square that they leave.
    """

    eigenvalue: np.ndarray
    amplitude: np.ndarray
    residual_rms: float


class OscillatorEstimate(NamedTuple):
    """An oscillator in a hull.

    Attributes:
        hull_period: Natural period of the hull without it (s).
        mass_ratio: Its mass over the hull's.
        period: Its own period (s).
        damping_ratio: Its own damping ratio.
    """

    hull_period: float
    mass_ratio: float
    period: float
    damping_ratio: float


def modes_of(values: np.ndarray, step: float, count: int) -> Modes:
    """Damped oscillations in a record, from the strongest singular vectors of its Hankel matrix.

    Args:
        values: The record (n,).
        step: Time step (s).
        count: Number of singular vectors.

    References:
        Barkhuijsen, De Beer and Van Ormondt 1987, Journal of Magnetic Resonance 73, 553-557, equations 2 to 8.
    """
    hankel = np.lib.stride_tricks.sliding_window_view(values, len(values) // 2).T
    basis = np.linalg.svd(hankel, full_matrices=False)[0][:, :count]
    shift = np.linalg.lstsq(basis[:-1], basis[1:], rcond=None)[0]
    eigenvalue = np.log(np.linalg.eigvals(shift).astype(complex)) / step
    each = np.exp(np.outer(np.arange(len(values)) * step, eigenvalue))
    amplitude = np.linalg.lstsq(each, values.astype(complex), rcond=None)[0]
    residual_rms = float(np.std(values - (each @ amplitude).real))
    upper = eigenvalue.imag > 0
    return Modes(eigenvalue[upper], 2 * amplitude[upper], residual_rms)


def oscillator_from_modes(eigenvalue: np.ndarray, amplitude: np.ndarray) -> OscillatorEstimate | None:
    """The oscillator that splits a hull's mode into two, released from rest; None where none does.

    Damping is what each mode loses: 2 sigma_k (1 + mu r_k^2) = b + 2 zeta omega_0 mu (r_k - 1)^2, b the hull's.

    Args:
        eigenvalue: Eigenvalues of the two modes (rad/s; 2,).
        amplitude: Their complex amplitudes (2,).
    """
    order = np.argsort(eigenvalue.imag)
    loss, square = -eigenvalue.real[order], np.abs(eigenvalue[order]) ** 2
    if (ratio := float((amplitude[order[0]] / amplitude[order[1]]).real)) <= 0:
        return None
    weight = ratio * square[0] / square[1]
    oscillator_square = (square[0] + weight * square[1]) / (1 + weight)
    hull_square = square[0] * square[1] / oscillator_square
    share = (square.sum() - hull_square - oscillator_square) / oscillator_square
    if share <= 0:
        return None
    moved = oscillator_square / (oscillator_square - square)
    both = np.column_stack([np.ones(2), 2 * np.sqrt(oscillator_square) * share * (moved - 1) ** 2])
    damping = np.linalg.solve(both, 2 * loss * (1 + share * moved**2))[1]
    hull_period, period = (2 * math.pi / math.sqrt(omega_square) for omega_square in (hull_square, oscillator_square))
    return OscillatorEstimate(hull_period, float(share), period, float(np.clip(damping, *DAMPING_RATIO_LIMITS)))


def oscillator_in_decay(
    values: np.ndarray, step: float, period: float, others: Sequence[float], count: int
) -> tuple[OscillatorEstimate | None, float]:
    """Estimate an oscillator from the two strongest modes of a decay near its natural period.

    Args:
        values: The decay (n,).
        step: Time step (s).
        period: Natural period (s).
        others: Natural periods of other motions (s).
        count: Number of modes that there may be.

    Returns:
        The oscillator, and the fraction of the decay that all modes leave. It is None without two modes, or where the
        record is too short or too coarse.
    """
    if len(values) < MIN_SAMPLES_PER_MODE * count or step > 2 * period / SAMPLES_PER_PERIOD:
        return None, 1.0
    modes = modes_of(values - values.mean(), step, 2 * count + 1)
    periods = 2 * np.pi / modes.eigenvalue.imag
    near = (np.abs(np.log(periods / period)) < np.log(MAX_PERIOD_RATIO)) & (modes.eigenvalue.real < 0)
    for other_period in others:
        near &= np.abs(np.log(periods / other_period)) > MIN_PERIOD_SEPARATION
    two = np.flatnonzero(near)[np.argsort(-np.abs(modes.amplitude[near]))][:2]
    residual_share = modes.residual_rms / max(float(np.std(values)), 1e-300)
    if len(two) < 2:
        return None, residual_share
    apart = abs(float(np.diff(modes.eigenvalue.imag[two])[0]))
    widths = -float(modes.eigenvalue.real[two].sum())
    if apart < max(widths, MIN_PERIOD_SEPARATION * float(modes.eigenvalue.imag[two].mean())):
        return None, residual_share  # one mode, whose damping or stiffness is not linear
    return oscillator_from_modes(modes.eigenvalue[two], modes.amplitude[two]), residual_share


def natural_mode(model: Model, dof: str) -> tuple[float, float]:
    """Natural period (s) and modal mass (kg, kg m²) of a motion, loads with a memory at rest."""
    position = equilibrium(model)
    modes, mass = natural_modes(model, position), np.asarray(linearised(model, position)[0])
    i = modes.number(dof) or 0
    shape = modes.shape[i] / widths(model)
    return float(modes.period[i]), float(shape @ mass @ shape) / float(shape[DOFS.index(dof)]) ** 2


def oscillator_starts(
    dof: str, study: "Study", point: "Point", base: Sequence[int], width: np.ndarray
) -> tuple[Mapping[str, float], ...]:
    """Starting values for `HiddenOscillator`, from the two modes of a fitted decay.

    Coefficients are moved as little as possible to give the hull its period without the oscillator.

    Args:
        dof: The motion.
        study: The study.
        point: The point that coefficients are moved from.
        base: Directions of the coefficients.
        width: Prior standard deviations of the directions (d,).
    """
    records = [record for record in study.decay_records if record.use == "fit" and record.degree_of_freedom == dof]
    modes = natural_modes(study.space.model(study.model, jnp.asarray(point.x)))
    if not records or not np.isfinite(period := modes.of(dof)):
        return ()
    others = [float(natural_period) for natural_period in modes.period if natural_period != period]
    estimates = []
    for record in records:
        step = max(period / SAMPLES_PER_PERIOD, float(np.diff(record.time).max()))
        time = np.arange(record.time[0], record.time[-1], step)
        values = np.interp(time, record.time, record.values[dof])
        estimates.append(oscillator_in_decay(values, step, period, others, 1 + len(record.values)))
    best = min(
        ((residual_share, oscillator) for oscillator, residual_share in estimates if oscillator is not None),
        key=lambda each: each[0],
        default=None,
    )
    if best is None:
        return ()
    x = coordinates_with_period(study, point.x, base, width, dof, best[1].hull_period)
    mass = natural_mode(study.space.model(study.model, jnp.asarray(x)), dof)[1]
    values = {label: study.value(label, x) for label, before, after in zip(study.labels, point.x, x) if before != after}
    prefix = f"hidden_oscillator.{dof}."
    about = {
        f"{prefix}mass": best[1].mass_ratio * mass,
        f"{prefix}period": best[1].period,
        f"{prefix}damping_ratio": best[1].damping_ratio,
    }
    return (values | about,)


def coordinates_with_period(
    study: "Study", x: np.ndarray, base: Sequence[int], width: np.ndarray, dof: str, period: float
) -> np.ndarray:
    """Coordinates that give a motion a natural `period` (s).

    The step along the `base` directions is the shortest in standard deviations.
    """

    def off(x: np.ndarray) -> float:
        return math.log(natural_mode(study.space.model(study.model, jnp.asarray(x)), dof)[0] / period)

    directions, size = study.directions[list(base)], width[list(base)]
    for _ in range(PERIOD_ITERATIONS):
        now = off(x)
        slopes = np.array([(off(x + DIFFERENCE_STEP * direction) - now) / DIFFERENCE_STEP for direction in directions]) * size
        step = -now * slopes / max(float(slopes @ slopes), 1e-300)
        x = x + (step * size * min(1.0, MAX_STEP_DEVIATIONS / max(float(np.abs(step).max()), 1e-300))) @ directions
    return x
