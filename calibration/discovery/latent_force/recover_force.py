"""Recovery of the latent force from the residual, by the model's equation of motion.

The latent force is the force that makes the model follow every record. The residual r, measured minus simulated
and tapered at its ends, is put into the model's equation of motion. If that is linear, r = H F, and r is divided by H. If not,
accelerations a along the recorded path and along the simulated path y are subtracted:

    F = M (d2r/dt2 - a(y + r) + a(y)),  M with the added mass at rest.

Noise in F grows with the square of the frequency and is filtered by the gain g = max(0, 1 - 3 N / P). P is the periodogram of F
over neighbouring lines, N that of |1 / H| times the noise. This is a Wiener filter, g = |S|^2 / (|S|^2 + |N|^2), with more than
N taken off, since the periodogram of noise scatters. A gain found from r would let through the effect of tapering r.

A force below the noise, or faster than `highest`, is not recovered; the ends are left out. Loads' memories, and motions that
were not measured, stay at rest. Sensors are assumed to read the motion.

References:
    Press et al. 1992, Numerical Recipes in C, section 13.3, eqs. 13.3.3 and 13.3.6.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import jax
import jax.numpy as jnp
import numpy as np
import scipy  # its parts are imported when they are used: that takes a second
from jaxtyping import Array, Float

from calibration.discovery.campaign_study import highest_frequency
from calibration.discovery.effect_fits import EffectFits
from calibration.discovery.latent_force.describe_force import described
from calibration.discovery.latent_force.force_law import law_of
from calibration.discovery.latent_force.recovered_force import RecoveredForce, ResampledTest, filtered
from calibration.discovery.reported_forces import LatentForce
from calibration.result import Calibration
from jaxhydro.dynamics.model import Model, State
from jaxhydro.dynamics.statics import equilibrium, linearised
from jaxhydro.environment import DOFS
from jaxhydro.exported_programs import exported_jit
from jaxhydro.waves.sea import AbstractSea, StillWater

LINES_AVERAGED = 5  # Fourier lines over which the periodogram is averaged
MAX_HARMONIC = 6.0  # times a decay's own frequency: faster forces are not reconstructed
NOISE_FACTOR = 3.0  # times the noise, which the filter takes off
DAMPING_RATIO = 0.03  # of the impedance by which noise becomes force
MAX_TAPERED_SHARE = 0.1  # of the record, at each end
INSTANTS_AT_ONCE = 512  # instants in one call


def peak_of(values: np.ndarray) -> int:
    """Number of cycles of a series at its highest spectral peak."""
    return max(int(np.abs(np.fft.rfft(values - values.mean())).argmax()), 1)


def windows(residual: np.ndarray) -> tuple[np.ndarray, np.ndarray, slice]:
    """Tapers of residual and force, and the part of the record away from its ends.

    Returns:
        Taper of the residual (n,), taper of the force (n,), and the slice.
    """
    n = len(residual)
    ends = int(min(MAX_TAPERED_SHARE * n, max(0.5 * n / peak_of(residual), LINES_AVERAGED)))
    ramp = 0.5 - 0.5 * np.cos(np.pi * (np.arange(ends) + 0.5) / ends)
    first, second = (
        np.concatenate([np.zeros(off), ramp, np.ones(n - 2 * ends - 2 * off), ramp[::-1], np.zeros(off)]) for off in (0, ends)
    )
    return first, second, slice(2 * ends, n - 2 * ends)


def noise_level(residual: np.ndarray, noise: float) -> float:
    """Standard deviation of noise: the sensor's, or that at the highest frequencies if larger."""
    window = np.hanning(len(residual))
    power = np.abs(np.fft.rfft(residual * window)) ** 2 / (window**2).sum()
    return max(noise, float(np.median(power[3 * len(power) // 4 :]) / np.log(2)) ** 0.5)  # lines of noise are exponential


def filter_gain(force: np.ndarray, taper: np.ndarray, noise: np.ndarray) -> tuple[np.ndarray, float]:
    """Gain of the Wiener filter of a force, and its highest peak over the noise, in power.

    Args:
        force: The force (n,).
        taper: Its taper (n,).
        noise: Variance of its noise by Fourier line.
    """
    level = scipy.ndimage.maximum_filter1d(noise, LINES_AVERAGED, mode="nearest") * float((taper**2).sum())
    ratio = scipy.ndimage.uniform_filter1d(np.abs(np.fft.rfft(force * taper)) ** 2 / level, LINES_AVERAGED, mode="nearest")
    return np.clip(1 - NOISE_FACTOR / np.maximum(ratio, 1e-300), 0.0, None), float(ratio.max())


@exported_jit
def _accelerations(
    model: Model, sea: AbstractSea, time: Float[Array, " t"], position: Float[Array, "t 6"], rate: Float[Array, "t 6"]
) -> Float[Array, "t 6"]:
    memory = model.rest().memory

    def acceleration(time, position, rate):
        velocity = model.body_velocity(position, rate)
        moved = model.rate(time, State(position, velocity, memory), sea)
        return jax.jvp(model.position_rate, (position, velocity), (rate, moved.velocity))[1]

    return jax.vmap(acceleration)(time, position, rate)


def accelerations(model: Model, sea: AbstractSea, time: np.ndarray, position: np.ndarray, rate: np.ndarray) -> np.ndarray:
    """Accelerations (t, 6) of surge ... yaw that the model has along a path.

    Args:
        model: The model.
        sea: The sea.
        time: Times (s; t,).
        position: Positions (m, rad; t, 6).
        rate: Their rates (m/s, rad/s; t, 6).
    """
    n = len(time)
    indices = np.minimum(np.arange(-(-n // INSTANTS_AT_ONCE) * INSTANTS_AT_ONCE), n - 1).reshape(-1, INSTANTS_AT_ONCE)
    parts = [
        _accelerations(model, sea, *(jnp.asarray(values[chunk]) for values in (time, position, rate))) for chunk in indices
    ]
    return np.concatenate(parts)[:n]


def forces_of(model: Model, test: ResampledTest, base: np.ndarray, highest: float) -> dict[str, RecoveredForce]:
    """Latent force of every measured motion of a test; `base` (6,) is where motions count from."""
    n, names = len(test.time), [dof for dof in DOFS if dof in test.measured]
    frequency = np.fft.rfftfreq(n, test.step)
    omega = 2 * np.pi * frequency
    rest = equilibrium(model)
    mass, stiffness = (np.asarray(matrix) for matrix in linearised(model, rest))
    position, rate = np.tile(np.asarray(rest), (n, 1)), np.zeros((n, 6))
    more, faster, pushed = np.zeros((n, 6)), np.zeros((n, 6)), np.zeros((n, 6))
    cut, fades, noise = {}, {}, np.zeros(6)
    for name in names:
        j, residual = DOFS.index(name), test.measured[name] - test.simulated[name]
        cut[name], noise[j] = windows(residual), noise_level(residual, test.noise[name])
        fastest = MAX_HARMONIC * peak_of(test.measured[name]) / (n * test.step) if test.kind == "decay" else highest
        fades[name] = 0.5 + 0.5 * np.cos(np.pi * np.clip(5 * (frequency / min(fastest, highest) - 0.8), 0.0, 1.0))
        lines = fades[name] * np.fft.rfft(residual * cut[name][0])
        more[:, j], faster[:, j], pushed[:, j] = (np.fft.irfft(lines * (1j * omega) ** k, n) for k in range(3))
        position[:, j] = base[j] + test.simulated[name]
        rate[:, j] = scipy.interpolate.CubicSpline(test.time, test.simulated[name])(test.time, 1)
    along_recorded, along_simulated = (
        accelerations(model, test.sea, test.time, position + k * more, rate + k * faster) for k in (1, 0)
    )
    force = (pushed - along_recorded + along_simulated) @ mass.T
    path, speed = position + more - np.asarray(rest), rate + faster
    # what noise in the residual makes of the force, line by line: DAMPING stands for a damping that it is not sensitive to
    impedance = (stiffness - omega[:, None, None] ** 2 * mass) ** 2 + (
        2 * DAMPING_RATIO * omega[:, None, None] ** 2 * mass
    ) ** 2
    forces = {}
    for name in names:
        j, (_, taper, inside) = DOFS.index(name), cut[name]
        through = impedance[:, j] @ noise**2
        gain, peak = filter_gain(force[:, j], taper, through)
        gain = gain * fades[name]
        remaining_noise = float(np.sqrt(2 * (gain**2 * through).sum() / n))
        forces[name] = RecoveredForce(
            test,
            name,
            filtered(force[:, j] * taper, gain),
            path[:, j],
            speed[:, j],
            np.gradient(speed[:, j], test.step),
            (position[:, j] - np.asarray(rest)[j], rate[:, j]),
            gain,
            taper,
            inside,
            remaining_noise,
            peak,
        )
    return forces


def latent_forces(
    model: Model, tests: Sequence[ResampledTest], motions: Sequence[str], from_rest: bool
) -> tuple[LatentForce, ...]:
    """Latent force by motion, with its description and a law of few terms.

    Args:
        model: The model.
        tests: The tests on even clocks.
        motions: The motions.
        from_rest: Whether motions count from the static equilibrium, or from the reference position.
    """
    base, highest = np.asarray(equilibrium(model)) * from_rest, highest_frequency(model)
    every = [forces_of(model, test, base, highest) for test in tests]
    described_forces = []
    for motion in motions:
        mine = [forces[motion] for forces in every if motion in forces]
        if any(recovered.visible for recovered in mine):
            described_forces.append(described(motion, mine, law_of(motion, mine)))
    return tuple(sorted(described_forces, key=lambda force: DOFS.index(force.motion)))


def latent_of(fits: EffectFits, fitted: Calibration) -> tuple[LatentForce, ...]:
    """Latent forces of a diagnosis's final model. See `latent_forces`."""
    from_rest = fits.campaign.manifest.zero is not None
    return latent_forces(fitted.model, list(resampled_tests(fits, fitted)), fits.setup.motions, from_rest)


def resampled_tests(fits: EffectFits, fitted: Calibration) -> Iterator[ResampledTest]:
    """Tests on even clocks; in waves on the clock of their sea."""
    seas = {name: sea for sea in fits.study.seas for name in sea.tests}
    records = {record.id: record for record in fits.campaign.records}
    for test in fitted.tests:
        step, first, last = float(np.median(np.diff(test.time))), float(test.time[0]), float(test.time[-1])
        wave, sea, record = None, seas.get(test.id), records[test.id]
        water: AbstractSea = StillWater()
        time = np.linspace(first, last, round((last - first) / step) + 1)
        if sea is not None:
            begin, tick = float(sea.times[0]), float(sea.step)
            stride = max(1, round(step / tick))
            ticks = np.arange(np.ceil((first - begin) / tick - 1e-6), np.floor((last - begin) / tick + 1e-6) + 1, stride)
            water, time = sea.sea, begin + tick * ticks
            wave = None if record.wave is None else np.interp(time, record.time, record.wave)
        both = [
            {series.channel: scipy.interpolate.CubicSpline(test.time, values)(time) for series, values in rows}
            for rows in ([(s, s.measured) for s in test.series], [(s, s.simulated) for s in test.series])
        ]
        noise = {series.channel: series.noise for series in test.series}
        yield ResampledTest(test.id, test.use, test.kind, time, both[0], both[1], noise, water, wave)
