"""J1' and Y1' against SciPy; the inertia coefficient against potentials summed on the wall, and Capytaine's panels."""

import math
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import jvp, yvp
from wall_pressure import COEFFICIENTS, wall_coefficient

from jaxhydro.waves.bessel import SWITCH, bessel_primes
from jaxhydro.waves.diffraction import maccamy_fuchs

TABLE = Path(__file__).parents[1] / "data" / "maccamy_fuchs_capytaine.csv"
GRID = np.geomspace(1e-3, 200.0, 2001)


def pair(x):
    """(J1', Y1') as one array."""
    return jnp.stack(bessel_primes(x))


def parts(ka):
    """Real and imaginary part of the coefficient."""
    return jnp.stack([maccamy_fuchs(ka).real, maccamy_fuchs(ka).imag])


def scipys(x, order=1):
    """The derivatives of J1 and Y1 of some order, and their modulus."""
    derivatives = np.stack([jvp(1, x, order), yvp(1, x, order)])
    return derivatives, np.hypot(*derivatives)


slope_forward = {f: jax.jit(jax.vmap(jax.jacfwd(f), out_axes=1)) for f in (pair, parts)}
slope_reverse = {f: jax.jit(jax.vmap(jax.jacrev(f), out_axes=1)) for f in (pair, parts)}


# Bessel functions


def test_bessel_primes_against_scipy() -> None:
    expected, modulus = scipys(GRID)
    primes = pair(GRID)
    assert primes.dtype == jnp.float64
    assert np.max(np.abs(primes - expected) / modulus) < 3e-14
    small = GRID < 1.0  # J1' is far below the modulus there; neither has a zero
    assert_allclose(primes[:, small], expected[:, small], rtol=3e-14)


def test_derivatives_of_bessel_primes_against_scipy() -> None:
    expected, modulus = scipys(GRID, 2)
    slopes = slope_forward[pair](GRID)
    assert np.max(np.abs(slopes - expected) / modulus) < 3e-14
    assert_allclose(slopes[0, GRID < 1.0], expected[0, GRID < 1.0], rtol=3e-14)


def test_second_derivatives_of_bessel_primes_against_scipy() -> None:
    expected, modulus = scipys(GRID, 3)
    bend = jax.jit(jax.vmap(jax.jacfwd(jax.jacfwd(pair)), out_axes=1))(GRID)
    assert np.max(np.abs(bend - expected) / modulus) < 1e-12


@pytest.mark.parametrize("function", [pair, parts])
def test_reverse_is_forward_and_compiled_is_eager(function) -> None:
    forward, reverse = slope_forward[function](GRID), slope_reverse[function](GRID)
    assert np.max(np.abs(reverse - forward) / np.hypot(*forward)) < 1e-14
    values = function(GRID)
    one_by_one = np.stack([jax.jit(function)(x) for x in GRID[::100]], axis=1)
    for transformed in (jax.jit(function)(GRID)[:, ::100], jax.vmap(function, out_axes=1)(GRID)[:, ::100], one_by_one):
        assert np.max(np.abs(transformed - values[:, ::100]) / np.hypot(*values[:, ::100])) < 1e-14


@pytest.mark.parametrize("function", [pair, parts])
def test_no_step_between_the_series(function) -> None:
    ends = np.array([SWITCH, np.nextafter(SWITCH, np.inf)])
    for quantity in (function(ends), slope_forward[function](ends)):
        size = np.hypot(*np.asarray(quantity[:, 0]))
        assert np.max(np.abs(quantity[:, 1] - quantity[:, 0])) < 2e-14 * size


def test_shapes_are_kept() -> None:
    grid = np.linspace(0.5, 20.0, 12).reshape(3, 2, 2)
    assert bessel_primes(grid)[1].shape == maccamy_fuchs(grid).shape == grid.shape
    assert maccamy_fuchs(1.0).shape == ()


# the coefficient


def test_coefficient_and_slope_against_scipy() -> None:
    """With w = J1' + i Y1' and C = -4i / (pi x^2 conj w): both by SciPy's functions."""
    j, y = scipys(GRID)[0]
    j2, y2 = scipys(GRID, 2)[0]
    expected = 4 / (np.pi * GRID**2 * (y + 1j * j))
    assert np.max(np.abs(maccamy_fuchs(GRID) / expected - 1)) < 3e-14
    slope = -expected * (2 / GRID + (y2 + 1j * j2) / (y + 1j * j))
    slopes = slope_forward[parts](GRID)
    # the two terms of the slope cancel in long waves: SciPy's error is of the size of one of them
    assert np.all(np.abs(slopes[0] + 1j * slopes[1] - slope) < 3e-14 * np.abs(expected) * (2 / GRID + 1))


def test_coefficient_is_the_pressure_on_the_wall() -> None:
    """Of the incident and of the scattered waves, summed over angular orders."""
    for ka in (0.03, 0.4, 1.0, 3.0, 9.0):
        coefficient, through = wall_coefficient(ka)
        assert through < 1e-13
        assert_allclose(maccamy_fuchs(ka), coefficient, rtol=1e-12)


@pytest.mark.parametrize(("ka", "magnitude", "lag"), COEFFICIENTS)
def test_magnitude_and_lag(ka: float, magnitude: float, lag: float) -> None:
    """Numbers worked out elsewhere, to their last digit."""
    coefficient = complex(maccamy_fuchs(ka))
    assert abs(coefficient) == pytest.approx(magnitude, abs=0.51e-5)
    assert -math.degrees(np.angle(coefficient)) == pytest.approx(lag, abs=0.51e-3)


def test_long_waves() -> None:
    """C = 2 - x^2 (ln(x/2) + gamma + 1/2) - i pi x^2 / 2 to fourth order, from the ascending series of Y1."""
    x = np.array([1e-9, 1e-7, 1e-5, 1e-4, 1e-3])
    log = np.log(x / 2) + np.euler_gamma
    real, imaginary = np.asarray(parts(x))
    assert_allclose(real - 2, -(x**2) * (log + 0.5), rtol=1e-5, atol=1e-14)
    assert_allclose(imaginary, -np.pi * x**2 / 2, rtol=2e-5)
    real, imaginary = np.asarray(slope_forward[parts](x))
    assert_allclose(real, -2 * x * (log + 1), rtol=3e-5)
    assert_allclose(imaginary, -np.pi * x, rtol=5e-5)


def test_at_no_wavenumber_and_next_to_it() -> None:
    x = np.array([0.0, 5e-324, 1e-310, 1e-200, 1e-100, 1.1e-100, 1e-20])
    assert_allclose(parts(x), [np.full(x.size, 2.0), np.zeros(x.size)], rtol=1e-14, atol=1e-14)
    for slope in (slope_forward, slope_reverse):
        assert_allclose(slope[parts](x), np.zeros((2, x.size)), atol=1e-17)
        assert np.all(slope[parts](x)[:, 0] == 0)


def test_the_phase_does_not_wrap() -> None:
    """The value turns smoothly. Short waves push the front, a radius ahead of the axis: the force leads by ka - 3 pi / 4."""
    ka = np.linspace(0.0, 100.0, 20001)
    turned = np.unwrap(np.angle(maccamy_fuchs(ka)))
    assert np.max(np.abs(np.diff(turned))) < 0.01
    assert turned[-1] == pytest.approx(100.0 - 3 * np.pi / 4, abs=0.01)
    far = np.abs(maccamy_fuchs(ka[-1])) * ka[-1] ** 1.5
    assert far == pytest.approx(math.sqrt(8 / np.pi), rel=1e-3)  # |H1'| to sqrt(2 / pi x)


def test_against_panels() -> None:
    """Capytaine's force on the whole depth over the depth's acceleration: all depths have one coefficient."""
    ka, _, magnitude, lag = np.loadtxt(TABLE, delimiter=",", comments="#", skiprows=4, unpack=True)
    assert ka.min() <= 0.05 and ka.max() >= 2.5
    coefficients = maccamy_fuchs(ka)
    assert_allclose(np.abs(coefficients), magnitude, rtol=1e-3)
    assert_allclose(-np.degrees(np.angle(coefficients)), lag, rtol=0, atol=0.03)
