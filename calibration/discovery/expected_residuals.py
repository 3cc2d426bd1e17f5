"""Expected size of residuals in waves where an unknown force acts: the weights of wave tests.

A missing force F leaves a residual H F, which is largest at resonance. With equal weights, least squares reduces it by damping
slow motion away. Weighed by the residual of an unknown force, a resonance counts as the few frequencies that it is.

    P_i = sum over j of |H_ij|^2 S_j + floor_i^2,    H = (-omega^2 + i omega C + K)^-1

C and K are mean tangents of the model's accelerations along its motion in that sea: forces count per unit of mass. S_j is the
spectrum of the missing force, constant below the wave frequencies, and in every band among them. It is estimated from F = H^-1
r, less the floor's part; lines that are mostly floor count less. Motions that were not measured, and loads' memories, stay at
rest.

References:
    Ljung 1999, System Identification, 2nd ed., section 3.2: prediction errors filtered by the inverse disturbance model.
    Whittle 1953: their likelihood is the sum over frequencies of |r|^2 / P + ln P.
"""

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from calibration.discovery.frequency_bands import FourierRows
from calibration.discovery.linearisations import Point
from calibration.discovery.residual_slopes import SeaRecord
from calibration.discovery.study import Study
from jaxhydro.dynamics.model import State
from jaxhydro.exported_programs import exported_jit

MAX_INSTANTS = 256  # instants at which forces are linearised
SPECTRUM_ITERATIONS = 6  # iterations of the force's spectrum


@exported_jit
def _tangents(record: SeaRecord, x: Float[Array, " p"]) -> Float[Array, "6 12"]:
    model, _, grid = record.simulated(x)
    stride = max(1, record.steps // MAX_INSTANTS)
    times = record.times[0] + record.step * stride * jnp.arange(1, record.steps // stride)
    position, rate, _ = grid.at(times)
    memory = model.rest().memory

    def acceleration(both: Float[Array, "12"], time: Float[Array, ""]) -> Float[Array, "6"]:
        displacement, speed = both[:6], both[6:]
        velocity = model.body_velocity(displacement, speed)
        moved = model.rate(time, State(displacement, velocity, memory), record.sea)
        return jax.jvp(model.position_rate, (displacement, velocity), (speed, moved.velocity))[1]

    def tangent(sum_, instant):
        return sum_ + jax.jacfwd(acceleration)(jnp.concatenate(instant[:2]), instant[2]), None

    total, _ = jax.lax.scan(tangent, jnp.zeros((6, 12)), (position, rate, times))
    return total / len(times)


def impedance(record: SeaRecord, x: np.ndarray, frequency: np.ndarray) -> np.ndarray:
    """Impedance of a model in its sea: force per unit of mass over motion (f, c, c).

    Args:
        record: The run.
        x: Parameter coordinates (p,).
        frequency: Frequencies (Hz; f,).
    """
    tangents = -np.asarray(_tangents(record, jnp.asarray(x)))
    dofs = np.ix_(record.dofs, record.dofs)
    omega = 2 * np.pi * frequency[:, None, None]
    return -(omega**2) * np.eye(len(record.dofs)) + 1j * omega * tangents[:, 6:][dofs] + tangents[:, :6][dofs]


def force_spectrum(power: np.ndarray, noise: np.ndarray, pool: np.ndarray) -> np.ndarray:
    """Spectrum of a force by line (f,), constant in every pool of bands.

    Args:
        power: Squares of the force's lines, noise included (f,).
        noise: Expected squares of the noise (f,).
        pool: Pool of bands of every line (f,).
    """
    spectrum = np.zeros(len(power))
    for number in np.unique(pool):
        mine = pool == number
        level = 0.0
        for _ in range(SPECTRUM_ITERATIONS):
            weight = 1 / (level + noise[mine]) ** 2
            level = max(float((weight * (power[mine] - noise[mine])).sum() / weight.sum()), 0.0)
        spectrum[mine] = level
    return spectrum


def expected_rows(study: Study, point: Point) -> np.ndarray:
    """Expected size of every row (n,) over its floor, from the residual at a point."""
    residual = study.residual(point, "all")
    parts = [np.ones(2 * len(study.cuts[0].take))] if study.decays is not None else []
    begin = sum(len(part) for part in parts)
    for record, cut in zip(study.seas, study.cuts[len(parts) :]):
        rows = slice(begin, begin := begin + 2 * len(cut.take))
        parts.append(_of_sea(study, record, cut, point, residual[rows], rows))
    return np.concatenate(parts)


def _of_sea(study: Study, record: SeaRecord, cut: FourierRows, point: Point, residual: np.ndarray, rows: slice) -> np.ndarray:
    shape = (len(record.tests), len(record.dofs), -1, 2)
    floor = study.floor.ravel()[study.cell[rows]].reshape(shape)[..., 0]
    pool = (study.pool[rows] % study.dof.shape[1]).reshape(shape)[0, 0, :, 0]
    duration = record.duration
    stiffness = impedance(record, point.x, cut.take[: len(pool)] / duration)
    expected = [
        expected_over_floor(lines, mine, pool, stiffness) for lines, mine in zip(residual.reshape(shape) @ [1, 1j], floor)
    ]
    return np.repeat(np.array(expected).ravel(), 2)


def expected_over_floor(lines: np.ndarray, floor: np.ndarray, pool: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """Expected residual over the floor, sqrt(P) / floor (c, f).

    Args:
        lines: Fourier lines of a residual (c, f).
        floor: Floor of the lines (c, f).
        pool: Pool of bands of every line (f,).
        stiffness: Impedance (f, c, c).
    """
    forces = np.abs(np.einsum("fji,if->jf", stiffness, lines)) ** 2 / 2
    noise = np.einsum("fji,if->jf", np.abs(stiffness) ** 2, floor**2)
    missing = np.stack([force_spectrum(power, of_floor, pool) for power, of_floor in zip(forces, noise)])
    response = np.abs(np.linalg.inv(stiffness)) ** 2
    return np.sqrt(1 + np.einsum("fij,jf->if", response, missing) / floor**2)
