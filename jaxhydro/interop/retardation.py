"""Retardation function of computed radiation damping, and its state-space realisation."""

import math
from typing import NamedTuple

import numpy as np
from jaxtyping import Complex, Float

from jaxhydro.interop.radiation_coefficients import RadiationCoefficients

TAIL_POWER = 4  # power of 1/omega with which damping ends: that of an even kernel without a kink at t = 0
TAIL_END = 3.0  # times the last frequency, where the tail is let go
STEPS_PER_INTERVAL = 8  # integration steps between the two nearest frequencies
MAX_MISSED_ENERGY = 2e-5  # of the squares: what lies above the frequencies that are sampled for, and after the last sample
SAMPLES_PER_HALF_PERIOD = 1.5  # per half period of the highest of these frequencies
MIN_SAMPLES, MAX_SAMPLES = 16, 480  # samples
MIN_COUPLING = 0.003  # of the motions' own: what is coupled less is taken apart
NEGLIGIBLE_DAMPING = 1e-6  # of the largest of translations or of rotations
MAX_NEGATIVE_DAMPING = 0.02  # of the largest damping: what of it may be below zero, as computed coefficients are
CHECKED_FREQUENCIES = 400  # frequencies at which that is looked for


class Realisation(NamedTuple):
    """State space of a retardation function: dr/dt = rates r + drive v, force = -output r.

    v is the velocity (m/s, rad/s). `misfit` is the largest difference, of any pair of motions, between its step response and
    the computed one. It is the root mean square over time, over the geometric mean of the two motions' own. `least_damping`
    is the least eigenvalue of its radiation damping at any frequency over the largest, each motion scaled alike. Below 0 the
    state space generates energy.
    """

    rates: Float[np.ndarray, "n n"]
    drive: Float[np.ndarray, "n 6"]
    output: Float[np.ndarray, "6 n"]
    misfit: float
    least_damping: float

    @property
    def order(self) -> int:
        """Number of states."""
        return len(self.rates)

    def transfer(self, omega: Float[np.ndarray, " w"]) -> Complex[np.ndarray, "w 6 6"]:
        """Damping and added mass B + i omega (A - A_inf) at frequencies (rad/s), (w, 6, 6)."""
        return _transfer(self.rates, self.drive, self.output, omega)


class Damping(NamedTuple):
    """Radiation damping (N s/m, N s, N m s/rad) at even frequencies (rad/s) from 0 to where it vanishes."""

    omega: Float[np.ndarray, " w"]
    damping: Float[np.ndarray, "w 6 6"]

    @classmethod
    def of(cls, coefficients: RadiationCoefficients) -> "Damping":
        """Damping by a cubic spline between the file's frequencies.

        It is symmetric, and even about frequency 0 where the file has none. Beyond the last frequency it falls with the
        fourth power of frequency.
        """
        from scipy.interpolate import CubicSpline

        last = coefficients.omega[-1]
        nodes = np.concatenate([-coefficients.omega[::-1], [0.0], coefficients.omega])
        symmetric = 0.5 * (coefficients.damping + coefficients.damping.transpose(0, 2, 1))
        even = np.concatenate([symmetric[::-1], np.zeros((1, 6, 6)), symmetric])
        omega = np.arange(0.0, TAIL_END * last, float(np.diff(nodes).min()) / STEPS_PER_INTERVAL)
        inside = CubicSpline(nodes, even)(np.minimum(omega, last))
        return cls(omega, inside * (last / np.maximum(omega, last))[:, None, None] ** TAIL_POWER)

    def kernel(self, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t 6 6"]:
        """Retardation function K(t) = 2/pi int_0^inf B cos(omega t) d omega (N/m, N, N m/rad) at times (s)."""
        weight = np.full(len(self.omega), self.omega[1])
        weight[[0, -1]] *= 0.5
        return 2 / math.pi * np.tensordot(np.cos(np.outer(time, self.omega)) * weight, self.damping, 1)

    def step_response(self, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t 6 6"]:
        """Step response int_0^t K ds = 2/pi int_0^inf B/omega sin(omega t) d omega.

        Its units are N s/m, N s, N m s/rad. It is minus the force at times (s) after a unit velocity began.
        """
        weight = np.concatenate([[0.0], self.omega[1] / self.omega[1:]])
        return 2 / math.pi * np.tensordot(np.sin(np.outer(time, self.omega)) * weight, self.damping, 1)


def realise(coefficients: RadiationCoefficients, tolerance: float = 0.01, order: int = 40) -> Realisation:
    """State space of least order whose step response follows the computed one within `tolerance`.

    Where none of up to `order` states does, it is the nearest of them: see `Realisation.misfit`.

    The retardation function is K(t) = 2/pi int_0^inf B(omega) cos(omega t) d omega. Its integral is the step response. That of
    all 36 pairs at once becomes C exp(A t) B, by the eigenvalues of its Hankel matrix. The logarithms of the discrete poles are
    the continuous ones. C is fitted anew under C B = 0, as nothing acts at once. The kernel's state space is then A, B, C A. It
    is without damping at frequency 0 and without force on what rests, and K(0) is finite.

    The step response rather than K is followed because it weighs an error in force by 1/omega, as added mass does. Slow motion,
    where a platform resonates, is met best. What is too fast for a simulation's step counts least.

    Poles that grow are never taken. Nor is a state space whose damping goes below zero by more than `MAX_NEGATIVE_DAMPING` of
    the largest. Only damping is used: A(omega) of the file is left for a check.

    Args:
        coefficients: Radiation coefficients.
        tolerance: Misfit below which a state space is taken.
        order: Largest number of states.

    Raises:
        ValueError: There is no damping, or no such state space.

    References:
        Cummins (1962), Schiffstechnik 9, 101-109; Ogilvie (1964), 5th Symposium on Naval Hydrodynamics: retardation function.
        Ho and Kalman (1966), Regelungstechnik 14, 545-548; Kung (1978), 12th Asilomar Conference: Hankel matrix.
        Kristiansen, Hjulstad and Egeland (2005), Ocean Engineering 32, 2195-2216: the same for radiation.
        Perez and Fossen (2008), Modeling, Identification and Control 29, 1-19: properties of the kernel.
    """
    damping = Damping.of(coefficients)
    fine = (damping.damping[1:] / damping.omega[1:, None, None]).diagonal(axis1=1, axis2=2) ** 2
    size = fine.sum(axis=0)
    active = np.flatnonzero(size > NEGLIGIBLE_DAMPING**2 * np.repeat([size[:3].max(), size[3:].max()], 3))
    if not active.size:
        raise ValueError("no radiation damping")
    highest = damping.omega[1 + _enough((fine[:, active] / size[active]).sum(axis=1))]
    step = math.pi / (SAMPLES_PER_HALF_PERIOD * highest)
    response = damping.step_response(step * np.arange(MAX_SAMPLES))[:, active[:, None], active]
    size = (response**2).sum(axis=0).diagonal() ** 0.25
    power = ((response / np.outer(size, size)) ** 2).sum(axis=(1, 2))
    half = min(max(_enough(power) + 1, MIN_SAMPLES), MAX_SAMPLES) // 2
    response = response[: 2 * half]
    size = (response**2).mean(axis=0).diagonal() ** 0.25
    hankel = _Hankel(response / np.outer(size, size), step)
    onto = np.eye(6)[:, active] * size
    best: Realisation | None = None
    for n in range(2, min(order, len(hankel.values)) + 1):
        rates, drive, output, misfit = hankel.space(n)
        if (
            len(rates)
            and (best is None or misfit < best.misfit)
            and (least := _least(rates, drive, output)) > -MAX_NEGATIVE_DAMPING
        ):
            best = Realisation(rates, drive @ onto.T, onto @ output, misfit, least)
            if misfit < tolerance:
                break
    if best is None:
        raise ValueError(f"no state space of up to {order} states that is stable and takes energy")
    return best


class _Hankel:
    """Hankel matrix of a step response sampled every `step` (s), each motion scaled to unit RMS."""

    def __init__(self, response: Float[np.ndarray, "t m m"], step: float) -> None:
        self.response, self.step, self.time = response, step, step * np.arange(len(response))
        half, self.motions = len(response) // 2, response.shape[1]
        values, vectors = [], []
        for group in _groups(np.sqrt((response**2).mean(axis=0)) > MIN_COUPLING):
            blocks = response[:, group[:, None], group][np.add.outer(np.arange(half), np.arange(half))]
            eigenvalues, eigenvectors = np.linalg.eigh(blocks.transpose(0, 2, 1, 3).reshape(half * group.size, -1))
            whole = np.zeros((half, self.motions, len(eigenvalues)))
            whole[:, group] = eigenvectors.reshape(half, group.size, -1)
            values.append(eigenvalues)
            vectors.append(whole.reshape(half * self.motions, -1))
        every = np.concatenate(values)
        falling = np.argsort(-np.abs(every))
        self.values, self.vectors = every[falling], np.concatenate(vectors, axis=1)[:, falling]

    def space(self, order: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
        """Rates, drive, output and misfit of a state space of `order` states, without growing ones."""
        size = np.sqrt(np.abs(self.values[:order]))
        vectors = self.vectors[:, :order]
        earlier, later, last = vectors[: -self.motions], vectors[self.motions :], vectors[-self.motions :]
        shift = np.linalg.solve(np.eye(order) - last.T @ last, earlier.T @ later) * size / size[:, None]  # least squares
        poles, modes = np.linalg.eig(shift)
        drive = (np.sign(self.values[:order]) * size * vectors)[: self.motions].T
        driven = np.linalg.solve(modes, drive.astype(complex))
        selected = (np.abs(poles) < 1) & (poles.imag >= 0) & ((poles.imag > 0) | (poles.real > 0))
        rate, driven = np.log(poles[selected]) / self.step, driven[selected]
        driven /= np.linalg.norm(driven, axis=1, keepdims=True)
        paired = np.flatnonzero(rate.imag > 0)

        def real(modal: np.ndarray) -> np.ndarray:
            return np.concatenate([modal.real, modal.imag[paired]])

        drive = real(driven)
        left_vectors, strength, _ = np.linalg.svd(drive)
        free = left_vectors[:, int((strength > 1e-9 * strength.max(initial=0.0)).sum()) :]
        rates = np.diag(real(rate.real * (1 + 1j)))
        turned = len(rate) + np.arange(len(paired))
        rates[paired, turned], rates[turned, paired] = -rate.imag[paired], rate.imag[paired]
        if not free.shape[1]:
            return rates[:0, :0], drive[:0], drive[:0].T, math.inf
        rows = real(np.exp(np.multiply.outer(rate, self.time))[:, None] * driven[..., None]).reshape(len(rates), -1)
        wanted = self.response.transpose(1, 2, 0).reshape(self.motions, -1)
        output = (free @ np.linalg.lstsq(rows.T @ free, wanted.T, rcond=None)[0]).T
        apart = ((output @ rows - wanted) ** 2).reshape(self.motions, self.motions, -1)
        return rates, drive, output @ rates, math.sqrt(apart.mean(axis=2).max())


def _enough(power: np.ndarray) -> int:
    """Index after which no more than `MAX_MISSED_ENERGY` of the whole is left."""
    total = power.cumsum()
    return int(np.searchsorted(total, (1 - MAX_MISSED_ENERGY) * total[-1]))


def _groups(coupled: np.ndarray) -> list[np.ndarray]:
    """Motions that a matrix couples, directly or by others."""
    reach = np.linalg.matrix_power(coupled.astype(int), len(coupled)) > 0
    return [np.flatnonzero(row) for row in np.unique(reach, axis=0)]


def _transfer(rates: np.ndarray, drive: np.ndarray, output: np.ndarray, omega: np.ndarray) -> np.ndarray:
    system = 1j * np.asarray(omega, float)[:, None, None] * np.eye(len(rates)) - rates
    return output @ np.linalg.solve(system, drive.astype(complex))


def _least(rates: np.ndarray, drive: np.ndarray, output: np.ndarray) -> float:
    """Least eigenvalue of the damping of a state space, over its largest."""
    poles = np.abs(np.linalg.eigvals(rates))
    transfer = _transfer(rates, drive, output, np.geomspace(0.05 * poles.min(), 20 * poles.max(), CHECKED_FREQUENCIES))
    values = np.linalg.eigvalsh(0.5 * (transfer + transfer.conj().transpose(0, 2, 1)))
    return float(values.min() / np.abs(values).max())
