"""Two modes of one: a hull's motion and what swings in it, found back from decays of two coupled oscillators."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from calibration.discovery.effects.mode_splitting import modes_of, oscillator_from_modes, oscillator_in_decay

STEP = 0.16  # s


def two_modes(share: float, period: float, ratio: float, hull: float = 2.58, loss: float = 0.004):
    """Eigenvalues and amplitudes of a hull's two modes, released from rest by 1 with what swings in it: of the matrices."""
    own, omega = 2 * np.pi / period, 2 * np.pi / hull
    k, c = share * own**2, 2 * ratio * own * share
    # hull, mass; per unit of the hull's mass
    mass, stiffness = np.diag([1.0, share]), np.array([[omega**2 + k, -k], [-k, k]])
    damping = np.array([[2 * loss * omega + c, -c], [-c, c]])
    matrix = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, damping)]])
    value, vectors = np.linalg.eig(matrix)
    amplitude = vectors[0] * np.linalg.solve(vectors, np.array([1.0, 1.0, 0.0, 0.0]))
    upper = value.imag > 0
    return value[upper], 2 * amplitude[upper]


def decay(value: np.ndarray, amplitude: np.ndarray, noise: float = 0.0) -> np.ndarray:
    time = STEP * np.arange(400)
    motion = (np.exp(np.outer(time, value)) @ amplitude).real
    return motion + np.random.default_rng(0).normal(0, noise, time.size)


def test_modes_of_a_record_are_those_that_made_it() -> None:
    value, amplitude = np.array([-0.02 + 2.4j, -0.05 + 2.1j]), np.array([1.0 - 0.2j, 0.3 + 0.1j])
    modes = modes_of(decay(value, amplitude) + 0.5, STEP, 5)  # a mean is a mode, too
    order = np.argsort(-modes.eigenvalue.imag)
    assert_allclose(modes.eigenvalue[order], value, rtol=1e-6)
    assert_allclose(modes.amplitude[order], amplitude, rtol=1e-5)
    assert modes.residual_rms < 1e-8
    noisy = modes_of(decay(value, amplitude, 0.01), STEP, 4)
    assert noisy.residual_rms == pytest.approx(0.01, rel=0.15)


@pytest.mark.parametrize("period", [2.2, 2.58, 2.7, 3.5])
@pytest.mark.parametrize("share", [0.003, 0.02, 0.1])
def test_two_modes_tell_what_swings(share: float, period: float) -> None:
    """The closed form leaves damping out of frequencies and amplitudes: it is right to the square of damping over how far the
    modes are apart, the damping ratio to the first power of that."""
    oscillator = oscillator_from_modes(*two_modes(share, period, 0.01))
    assert oscillator is not None
    assert oscillator.hull_period == pytest.approx(2.58, rel=2e-3)
    assert oscillator.period == pytest.approx(period, rel=2e-3)
    assert oscillator.mass_ratio == pytest.approx(share, rel=0.08)
    assert oscillator.damping_ratio == pytest.approx(0.01, rel=0.25)


def test_a_record_is_split_by_what_swings_alone() -> None:
    """Not by another motion's mode, nor by damping that is not linear, nor by noise."""
    record = decay(*two_modes(0.02, 2.7, 0.01), noise=0.003)
    oscillator, residual = oscillator_in_decay(record, STEP, 2.6, [], 2)
    assert oscillator is not None and oscillator.period == pytest.approx(2.7, rel=0.01)
    assert residual < 0.02
    modes = 2 * np.pi / two_modes(0.02, 2.7, 0.01)[0].imag
    assert oscillator_in_decay(record, STEP, 2.6, [float(modes.max())], 2)[0] is None
    time = STEP * np.arange(400)

    def rate(_, y, linear, quadratic):
        return [y[1], -(2.4**2) * y[0] - linear * y[1] - quadratic * abs(y[1]) * y[1]]

    for linear, quadratic in ((0.03, 0.0), (0.0, 0.05), (0.01, 0.3)):
        motion = solve_ivp(rate, (0, 64), [1.0, 0.0], t_eval=time, args=(linear, quadratic), rtol=1e-9).y[0]
        motion = motion + np.random.default_rng(1).normal(0, 1e-3, time.size)
        assert oscillator_in_decay(motion, STEP, 2.6, [], 2)[0] is None, (linear, quadratic)
