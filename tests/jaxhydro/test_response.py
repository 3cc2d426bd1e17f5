"""Analysis of decays against decays whose damping is known."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from jaxhydro.dynamics.response import Cycles, decay_cycles, extremes

OMEGA = 2 * math.pi / 25.0


def decay(zeta: float, times: np.ndarray, amplitude: float = 5.0) -> np.ndarray:
    return amplitude * np.exp(-zeta * OMEGA * times) * np.cos(OMEGA * times)


@pytest.mark.parametrize("zeta", [0.002, 0.02, 0.08])
@pytest.mark.parametrize("sampling", [0.1, 0.37])
def test_decrement_and_period_of_a_linear_decay(zeta: float, sampling: float) -> None:
    """exp(-zeta w t) cos wt: decrement 2 pi zeta per cycle, period 2 pi/w, at every amplitude, w the damped one."""
    times = np.arange(0.0, 260.0, sampling)
    cycles = decay_cycles(times, decay(zeta, times))
    assert len(cycles.amplitude) >= 17
    assert_allclose(cycles.decrement, 2 * math.pi * zeta, rtol=5e-3, atol=1e-4)
    assert_allclose(cycles.period, 25.0, rtol=2e-3)
    middle = 5 * np.exp(-zeta * OMEGA * cycles.time) * math.cosh(zeta * math.pi / 2)
    assert_allclose(cycles.amplitude, middle, rtol=0.01)


def test_decrement_of_a_damped_oscillator() -> None:
    """x'' + 2 zeta w x' + w^2 x = 0 by scipy: 2 pi zeta/sqrt(1 - zeta^2), and the damped period."""
    zeta, times = 0.1, np.arange(0.0, 200.0, 0.1)
    solved = solve_ivp(
        lambda t, y: [y[1], -2 * zeta * OMEGA * y[1] - OMEGA**2 * y[0]], (0, 200), [5.0, 0.0], t_eval=times, rtol=1e-10
    )
    cycles = decay_cycles(times, solved.y[0])
    assert_allclose(cycles.decrement[:8], 2 * math.pi * zeta / math.sqrt(1 - zeta**2), rtol=0.01)
    assert_allclose(cycles.period[:8], 25.0 / math.sqrt(1 - zeta**2), rtol=5e-3)


def noisy_cycles(until: float, seed: int) -> Cycles:
    """Cycles of a decay of zeta = 2 % under one per cent of white noise."""
    times = np.arange(0.0, until, 0.1)
    noise = np.random.default_rng(seed).normal(0, 0.05, len(times))
    return decay_cycles(times, decay(0.02, times) + noise, noise=0.05)


def test_noise_makes_no_cycles() -> None:
    """One per cent of noise: one half cycle every 12.5 s, without bias in decrement and period."""
    all_cycles = [noisy_cycles(256.0, seed) for seed in range(8)]
    assert all(18 <= len(cycles.period) <= 20 for cycles in all_cycles)
    assert all(np.abs(cycles.period[1:] / 25 - 1).max() < 0.1 for cycles in all_cycles)
    assert np.mean([cycles.decrement[:12].mean() for cycles in all_cycles]) == pytest.approx(2 * math.pi * 0.02, rel=0.03)
    assert np.mean([cycles.period[:12].mean() for cycles in all_cycles]) == pytest.approx(25.0, rel=3e-3)


def test_a_crest_cut_off_by_the_records_end_is_no_cycle() -> None:
    """The record ends 2.5 s before a crest, in noise: every cycle found is still 25 s long within a tenth."""
    for seed in range(8):
        assert np.abs(noisy_cycles(260.0, seed).period[1:] / 25 - 1).max() < 0.1


def test_slope_of_quadratic_damping() -> None:
    """dA/A per cycle = p + q A, p = 2 pi zeta, q = 8 b2/(3 m): scipy's solution, fitted over the small amplitudes."""
    zeta, b2, times = 0.005, 0.01, np.arange(0.0, 500.0, 0.1)
    solved = solve_ivp(
        lambda t, y: [y[1], -2 * zeta * OMEGA * y[1] - b2 * abs(y[1]) * y[1] - OMEGA**2 * y[0]],
        (0, 500),
        [5.0, 0.0],
        t_eval=times,
        rtol=1e-10,
        atol=1e-12,
    )
    cycles = decay_cycles(times, solved.y[0])
    q, p = np.polyfit(cycles.amplitude, cycles.decrement, 1)
    assert q == pytest.approx(8 * b2 / 3, rel=0.02)
    assert p == pytest.approx(2 * math.pi * zeta, rel=0.03)


def test_extremes_alternate_and_lie_on_the_envelope() -> None:
    """Crests and troughs of a slow decay are half a period apart, A exp(-zeta w t) high, the cut-off ends left out."""
    times = np.arange(3.0, 140.0, 0.2)
    when, value = extremes(times, decay(0.01, times))
    assert np.all(np.sign(value[1:]) == -np.sign(value[:-1]))
    assert_allclose(np.diff(when), 12.5, rtol=2e-3)
    assert when[0] == pytest.approx(12.5, abs=0.1)
    assert_allclose(np.abs(value), 5 * np.exp(-0.01 * OMEGA * when), rtol=2e-3)


@pytest.mark.parametrize("motion", [np.zeros(50), np.full(50, 1e-3), np.linspace(1, 2, 50), np.zeros(0)])
def test_what_does_not_oscillate_has_no_cycles(motion: np.ndarray) -> None:
    """Silence, an offset, a drift and an empty record: no cycle, no error."""
    cycles = decay_cycles(np.arange(len(motion)) * 0.1, motion, noise=0.01)
    assert all(len(part) == 0 for part in cycles)
