"""Second-order waves against the equations they solve, published closed forms, limits, and OpenFAST's."""

import gzip
import math
from pathlib import Path

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from one_program import one_program
from scipy.optimize import brentq

from jaxhydro.environment import Environment
from jaxhydro.quick_jit import on_device
from jaxhydro.waves import second_order
from jaxhydro.waves.components import Components, PlaneWaves, components
from jaxhydro.waves.pair_sums import elevation_spectrum, sum_over_pairs

DEEP = Environment(1025.0, 200.0, 9.81)
SHALLOW = Environment(1025.0, 30.0, 9.81)
bound_waves = eqx.filter_jit(second_order.bound_waves)
transfer, spectrum_of = one_program(second_order.transfer), one_program(elevation_spectrum)

OPENFAST = Path(__file__).resolve().parents[3] / "shared" / "reference" / "openfast" / "seastate"


def number(omega: float, environment: Environment) -> float:
    """Wavenumber by root finding."""
    g, h = environment.gravity, environment.depth
    upper = omega**2 / g + omega / math.sqrt(g * h)
    return brentq(lambda k: g * k * math.tanh(k * h) - omega**2, 0.0, upper, xtol=1e-300, rtol=1e-15)


def pair(environment: Environment, kind: str, *periods: float, headings=(0.0, 0.0)) -> tuple[float, float]:
    """`transfer` of two waves given by period and heading."""
    waves = []
    for period, heading in zip(periods, headings, strict=True):
        omega = 2 * math.pi / period
        k = number(omega, environment)
        waves.append((np.array([omega]), k * np.array([[math.cos(heading)], [math.sin(heading)]])))
    e, phi = transfer(*waves, environment, kind)
    return float(e[0]), float(phi[0])


def random_sea(environment: Environment, n: int = 23, first: int = 5, period: float = 97.0, seed: int = 1) -> Components:
    """Short-crested components on harmonics, one of no amplitude."""
    random = np.random.default_rng(seed)
    amplitude = random.uniform(0.1, 1.0, n)
    amplitude[n // 2] = 0.0
    omega = (first + np.arange(n)) * 2 * math.pi / period
    heading, phase = random.normal(0.0, 0.5, n), random.uniform(0.0, 2 * math.pi, n)
    return components(amplitude, omega, environment, heading=heading, phase=phase, first=first)


def profile(waves: PlaneWaves, environment: Environment, z, xp=jnp) -> tuple:
    """|k|, cosh k(z+h) / cosh kh and sinh k(z+h) / cosh kh."""
    k = xp.linalg.norm(waves.vector, axis=0)
    down, up = xp.exp(k * z), xp.exp(-k * (z + 2 * environment.depth))
    scale = 1 / (1 + xp.exp(-2 * k * environment.depth))
    return k, scale * (down + up), scale * (down - up)


@jax.jit
def elevation(waves: PlaneWaves, x, t):
    return (waves.elevation * jnp.exp(1j * (waves.omega * t - x[:2] @ waves.vector))).real.sum()


@eqx.filter_jit
def potential(waves: PlaneWaves, environment: Environment, x, t):
    c = profile(waves, environment, x[2])[1]
    return (1j * waves.potential * c * jnp.exp(1j * (waves.omega * t - x[:2] @ waves.vector))).real.sum()


# against the equations


@pytest.mark.parametrize("environment", [DEEP, SHALLOW], ids=["200 m", "30 m"])
@pytest.mark.parametrize("spread", [0.0, 1.0], ids=["long-crested", "short-crested"])
def test_bound_waves_solve_the_equations_of_second_order(environment: Environment, spread: float) -> None:
    """Both free-surface conditions expanded to second order about z = 0, by automatic differentiation of the fields.

    With equal frequencies of different headings among them, and of the same.
    """
    heading = spread * np.array([0.0, 0.7, -1.2, 0.4, 0.4, 2.9])
    sea = components(
        [1.0, 0.7, 1.3, 0.4, 0.6, 0.8],
        [0.5, 0.61, 0.61, 0.8, 0.8, 1.1],
        environment,
        heading=heading,
        phase=np.array([0.3, 2.0, -1.0, 0.5, 4.0, 1.0]),
    )
    free, bound = PlaneWaves.free(sea, environment), bound_waves(sea, environment)

    def eta(waves):
        return lambda x, t: elevation(waves, x, t)

    def phi(waves):
        return lambda x, t: potential(waves, environment, x, t)

    @jax.jit
    def conditions(x, t):
        g = environment.gravity
        slope, u = jax.grad(eta(free))(x, t), jax.grad(phi(free))(x, t)
        phi_xx, phi_tx = jax.hessian(phi(free))(x, t), jax.jacfwd(jax.grad(phi(free)), 1)(x, t)
        kinematic = jnp.stack(
            [
                jax.grad(eta(bound), 1)(x, t),
                -jax.grad(phi(bound))(x, t)[2],
                u[:2] @ slope[:2],
                -eta(free)(x, t) * phi_xx[2, 2],
            ]
        )
        dynamic = jnp.stack([jax.grad(phi(bound), 1)(x, t), g * eta(bound)(x, t), 0.5 * u @ u, eta(free)(x, t) * phi_tx[2]])
        laplace = jnp.diag(jax.hessian(phi(bound))(x + jnp.array([0.0, 0.0, -3.0]), t))
        bottom = jax.grad(phi(bound))(x.at[2].set(-environment.depth), t)
        return kinematic, dynamic, laplace, bottom

    for x, y, t in np.random.default_rng(2).uniform(-100, 100, (20, 3)):
        kinematic, dynamic, laplace, bottom = map(np.asarray, conditions(np.array([x, y, 0.0]), t))
        for terms in (kinematic, dynamic, laplace):
            assert abs(terms.sum()) < 2e-13 * (1 + np.abs(terms).max())
        assert abs(bottom[2]) < 1e-14


# published numbers and forms


@pytest.mark.parametrize(
    ("periods", "depth", "total", "beat"),
    [
        ((10.0, 12.0), 200.0, 0.0341086, -0.0062597),
        ((10.0, 12.0), 30.0, 0.0805185, -0.0495613),
        ((8.0, 9.0), 200.0, 0.0563005, -0.0066768),
        ((8.0, 9.0), 30.0, 0.0749829, -0.0299645),
    ],
)
def test_two_waves_by_hand(periods: tuple, depth: float, total: float, beat: float) -> None:
    """Elevation per product of amplitudes (Sharma and Dean 1981)."""
    environment = Environment(1025.0, depth)
    assert pair(environment, "sum", *periods)[0] == pytest.approx(total, abs=1e-7)
    assert pair(environment, "difference", *periods)[0] == pytest.approx(beat, abs=1e-7)


def sharma_and_dean(environment: Environment, sign: int, periods: tuple, headings: tuple) -> tuple[float, float]:
    """The double sums' terms as they are printed, (i, j) and (j, i) together, in terms of R = k tanh kh."""
    g, h = environment.gravity, environment.depth
    (wi, wj), (hi, hj) = (2 * math.pi / period for period in periods), headings
    ki, kj = number(wi, environment), number(wj, environment)
    ri, rj, dot = wi**2 / g, wj**2 / g, ki * kj * math.cos(hi - hj)
    k = math.sqrt(ki**2 + kj**2 + 2 * sign * dot)
    root = math.sqrt(ri) + sign * math.sqrt(rj)
    d = root * (math.sqrt(rj) * (ki**2 - ri**2) + sign * math.sqrt(ri) * (kj**2 - rj**2))
    d = (d + 2 * root**2 * (dot - sign * ri * rj)) / (root**2 - k * math.tanh(k * h))
    e = 0.5 * ((d - (dot - sign * ri * rj)) / math.sqrt(ri * rj) + ri + rj)
    return e, 0.5 * g**2 / (wi * wj) * d / (wi + sign * wj)


@pytest.mark.parametrize("kind", ["sum", "difference"])
@pytest.mark.parametrize("headings", [(0.0, 0.0), (0.2, -0.5), (0.0, math.pi), (1.0, 2.7)])
@pytest.mark.parametrize("environment", [DEEP, SHALLOW], ids=["200 m", "30 m"])
def test_printed_form_of_sharma_and_dean(environment: Environment, headings: tuple, kind: str) -> None:
    """Elevation and potential, either order of the pair."""
    sign = 1 if kind == "sum" else -1
    for periods in ((10.0, 12.0), (4.0, 17.0), (9.0, 8.9)):
        expected = sharma_and_dean(environment, sign, periods, headings)
        transfer_pair = pair(environment, kind, *periods, headings=headings)
        turned = pair(environment, kind, *periods[::-1], headings=headings[::-1])
        assert_allclose(transfer_pair, expected, rtol=1e-10, atol=1e-13)
        assert_allclose(turned, (transfer_pair[0], sign * transfer_pair[1]), rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize(("depth", "expected"), [(200.0, 0.0201284), (30.0, 0.0374631)])
def test_one_wave_is_that_of_stokes(depth: float, expected: float) -> None:
    """k cosh kh (2 + cosh 2kh) / (4 sinh^3 kh), potential 3 omega cosh 2kh / (8 sinh^4 kh), set-down -k / (2 sinh 2kh)."""
    amplitude, omega, environment = 1.7, 2 * math.pi / 10, Environment(1025.0, depth)
    k = number(omega, environment)
    kh = k * environment.depth
    double, mean = (
        bound_waves(components([amplitude], [omega], environment), environment, [kind]) for kind in ("sum", "difference")
    )
    stokes = k / 4 * math.cosh(kh) * (2 + math.cosh(2 * kh)) / math.sinh(kh) ** 3
    assert stokes == pytest.approx(expected, abs=1e-7)
    double, mean = (jax.tree.map(np.asarray, waves) for waves in (double, mean))
    assert complex(double.elevation[0]) == pytest.approx(amplitude**2 * stokes, rel=1e-12)
    steep = 3 / 8 * omega * math.cosh(2 * kh) / math.sinh(kh) ** 4
    assert complex(double.potential[0]) == pytest.approx(amplitude**2 * steep, rel=1e-9, abs=1e-13)
    assert complex(mean.elevation[0]) == pytest.approx(-(amplitude**2) * k / (2 * math.sinh(2 * kh)), rel=1e-9)
    assert float(mean.omega[0]) == np.abs(mean.vector).max() == abs(complex(mean.potential[0])) == 0
    if depth == 30.0:
        assert mean.elevation[0].real / amplitude**2 == pytest.approx(-0.0029486, abs=1e-7)


def test_deep_water() -> None:
    """(k1 + k2)/2 without flow and -(k1 - k2)/2 with potential -omega1 (Longuet-Higgins and Stewart 1962), no overflow."""
    abyss = Environment(1025.0, 1e5, 9.81)
    w1, w2 = 2 * math.pi / 3, 2 * math.pi / 5
    k1, k2 = w1**2 / 9.81, w2**2 / 9.81
    assert_allclose(pair(abyss, "sum", 3.0, 5.0), ((k1 + k2) / 2, 0.0), rtol=1e-13, atol=1e-15)
    assert_allclose(pair(abyss, "difference", 3.0, 5.0), (-(k1 - k2) / 2, -w1), rtol=1e-13)


# where it is delicate


def test_slow_beats_are_accurate() -> None:
    """Under long groups the level is -Sxx / (rho (g h - c_g^2)) (Longuet-Higgins and Stewart 1962).

    Sxx = rho g a^2 (2 n - 1/2) / 2 with n = c_g / c, and the product of a pair is half of a^2.
    """
    omega, g, h = 0.6, SHALLOW.gravity, SHALLOW.depth
    k = number(omega, SHALLOW)
    n = 0.5 * (1 + 2 * k * h / math.sinh(2 * k * h))
    group = n * omega / k
    limit = -g * (2 * n - 0.5) / (g * h - group**2)
    for part, tolerance in ((1e-3, 2e-2), (1e-5, 2e-4), (1e-7, 1e-5)):
        two = 2 * math.pi / omega, 2 * math.pi / (omega * (1 - part))
        assert pair(SHALLOW, "difference", *two)[0] == pytest.approx(limit, rel=tolerance)


def test_equal_frequencies_of_two_headings_stand() -> None:
    """No flow, and elevation (omega^2 - g^2 k^2 cos / omega^2) / 2 g; rounding of the frequencies changes nothing."""
    for omega in (0.7, 1.3):
        k, g = number(omega, SHALLOW), SHALLOW.gravity
        sea = components([1.0, 1.0], [omega, omega * (1 + 1e-15)], SHALLOW, heading=np.array([0.2, 1.1]))
        waves = jax.tree.map(np.asarray, bound_waves(sea, SHALLOW, ["difference"], set_down=False))
        assert abs(float(waves.omega[0])) < 1e-14 and np.linalg.norm(waves.vector) > 0.8 * k
        assert complex(waves.elevation[0]) == pytest.approx((omega**2 - (g * k / omega) ** 2 * math.cos(0.9)) / (2 * g))
        assert abs(complex(waves.potential[0])) == 0
        nearly = components([1.0, 1.0], [omega, omega * (1 + 1e-7)], SHALLOW, heading=np.array([0.2, 1.1]))
        beside = bound_waves(nearly, SHALLOW, ["difference"], set_down=False)
        assert_allclose(beside.elevation, waves.elevation, rtol=1e-5)
        assert abs(complex(beside.potential[0])) < 1e-5


def test_frequencies_are_not_negative() -> None:
    """Components in any order make the same waves."""
    sea = components([1.0, 0.5, 0.8], [0.5, 0.9, 0.7], SHALLOW, heading=[0.0, 1.0, -0.4], phase=np.arange(3.0))
    turned = jax.tree.map(lambda x: on_device(np.asarray(x)[[1, 2, 0]]), sea)
    given, turned_waves = bound_waves(sea, SHALLOW), bound_waves(turned, SHALLOW)
    assert np.asarray(given.omega).min() == np.asarray(turned_waves.omega).min() == 0.0
    for x, t in ((np.array([3.0, 4.0, -2.0]), 1.0), (np.array([-30.0, 14.0, -12.0]), 11.0)):
        assert float(elevation(given, x, t)) == pytest.approx(float(elevation(turned_waves, x, t)), rel=1e-12)
        assert float(potential(given, SHALLOW, x, t)) == pytest.approx(float(potential(turned_waves, SHALLOW, x, t)), rel=1e-12)


@pytest.mark.slow
def test_a_wave_of_no_frequency_binds_nothing() -> None:
    """Exact zeros, and derivatives that are numbers."""
    sea = components([1.0, 2.0, 0.0, 1.5], 0.3 * np.arange(4), SHALLOW, first=0)
    alone = components([2.0, 0.0, 1.5], 0.3 * np.arange(1, 4), SHALLOW, first=1)
    actual = spectrum_of(sea, SHALLOW, (3.0, 4.0))
    assert_allclose(actual, spectrum_of(alone, SHALLOW, (3.0, 4.0)), rtol=1e-14, atol=1e-17)

    def loss(sea):
        waves = bound_waves(sea, SHALLOW)
        return (
            sum(jnp.abs(x).sum() for x in (waves.elevation, waves.potential))
            + jnp.abs(elevation_spectrum(sea, SHALLOW, (3.0, 4.0))).sum()
        )

    for x in jax.tree.leaves(one_program(jax.grad(loss))(sea)):
        assert np.isfinite(x).all()


# sums over pairs of one frequency


def field(x, environment: Environment):
    """Elevation, velocity potential and vertical velocity at a point, complex."""

    def reduce(omega, vector, elevation, potential):
        k, c, s = profile(PlaneWaves(omega, vector, elevation, potential), environment, x[2])
        turn = jnp.exp(-1j * (x[:2] @ vector))
        velocity = vector * (potential * c * turn)
        return (elevation * turn).sum(), velocity.sum(axis=1), (1j * k * potential * s * turn).sum()

    return reduce


BOTH = ("sum", "difference")


def test_differences_above_the_highest_bind_nothing() -> None:
    """All pairs written out, and their elevation by harmonics: only differences are left out, and the highest stays."""
    sea = random_sea(SHALLOW, 23)
    highest = 9 / float(sea.period)
    all_pairs, low_pairs = bound_waves(sea, SHALLOW), bound_waves(sea, SHALLOW, highest_difference=highest)
    binding = np.asarray(all_pairs.elevation) != 0
    difference = np.arange(len(binding)) >= 23 * 24 // 2
    expected = binding & ~(difference & (np.asarray(all_pairs.omega) > 9.5 * 2 * np.pi / float(sea.period)))
    assert_array_equal(np.asarray(low_pairs.elevation) != 0, expected)
    whole, part = (np.asarray(spectrum_of(sea, SHALLOW, (3.0, 4.0), BOTH, to)) for to in (None, highest))
    sums = np.asarray(spectrum_of(sea, SHALLOW, (3.0, 4.0), ("sum",)))
    differs = np.abs(whole - part) > 1e-15
    assert_array_equal(np.flatnonzero(differs), np.arange(10, 23))
    assert_allclose(part[10:], sums[10:], atol=1e-15)


@pytest.mark.parametrize(("n", "kinds"), [(1, BOTH), (2, BOTH), (23, ("sum",)), (23, ("difference",)), (150, BOTH)])
def test_fold_is_the_sum_over_all_pairs(n: int, kinds: tuple) -> None:
    """Elevation and velocities at points and times, against all pairs written out; also of more components than one tile."""
    sea = random_sea(SHALLOW, n)
    if n == 1:
        sea = eqx.tree_at(lambda sea: sea.amplitude, sea, on_device(np.ones(1)))
    pairs, period = jax.tree.map(np.asarray, bound_waves(sea, SHALLOW, kinds)), float(sea.period)
    folded = jax.jit(lambda sea, x: sum_over_pairs(sea, SHALLOW, field(x, SHALLOW), kinds))
    direct = jax.jit(lambda waves, x: field(x, SHALLOW)(waves.omega, waves.vector, waves.elevation, waves.potential))
    for x in (np.array([3.0, -7.0, -2.0]), np.array([-50.0, 20.0, -15.0])):
        actual = tuple(map(np.asarray, folded(sea, x)))
        for t in (0.0, 13.7):
            turn = np.exp(1j * pairs.omega * t)
            moved = PlaneWaves(pairs.omega, pairs.vector, pairs.elevation * turn, pairs.potential * turn)
            expected = map(np.asarray, direct(moved, x))
            spin = np.exp(2j * np.pi * np.arange(actual[0].size) * t / period)
            for a, b in zip(actual, expected, strict=True):
                assert a.shape[0] == 2 * (sea.first + n - 1) + 1
                assert_allclose((a.T @ spin).real, b.real, rtol=1e-9, atol=1e-11)


def test_elevation_spectrum_is_the_elevation() -> None:
    """At a position, set-down included, jitted and over several seas at once."""
    seas = [random_sea(SHALLOW, seed=seed) for seed in (1, 2, 3)]
    stacked = jax.tree.map(lambda *x: np.stack(x), *seas)
    actual = np.asarray(jax.jit(jax.vmap(lambda sea: elevation_spectrum(sea, SHALLOW, (12.0, -5.0))))(stacked))
    for sea, spectrum in zip(seas, actual, strict=True):
        pairs = bound_waves(sea, SHALLOW)
        assert abs(spectrum[0].imag) < 1e-15 and spectrum[0].real < 0
        for t in (0.0, 31.4):
            spin = np.exp(2j * np.pi * np.arange(spectrum.size) * t / float(sea.period))
            expected = elevation(pairs, np.array([12.0, -5.0, 0.0]), t)
            assert float((spectrum @ spin).real) == pytest.approx(float(expected), rel=1e-10)


def test_gradient_with_respect_to_amplitudes() -> None:
    """Reverse and forward against central differences, which are exact for a quadratic form."""
    sea = random_sea(SHALLOW)
    x = jnp.array([3.0, -7.0, -2.0])

    @jax.jit
    def loss(amplitude):
        moved = eqx.tree_at(lambda sea: sea.amplitude, sea, amplitude)
        folded = sum_over_pairs(moved, SHALLOW, field(x, SHALLOW))
        return sum(part.real.sum() - 2 * part.imag.sum() for part in folded)

    amplitude = np.asarray(sea.amplitude)
    reverse, forward = (np.asarray(one_program(slope(loss))(amplitude)) for slope in (jax.grad, jax.jacfwd))
    assert_allclose(reverse, forward, rtol=1e-11, atol=1e-11)
    for i in (0, 11, 22):  # 11 has no amplitude
        step = 1e-2 * np.eye(23)[i]
        difference = (float(loss(amplitude + step)) - float(loss(amplitude - step))) / 2e-2
        assert float(reverse[i]) == pytest.approx(float(difference), rel=1e-9)


def test_gradient_with_respect_to_headings_and_frequencies() -> None:
    """Through pairs of any kind, the water's depth too."""
    omega, heading = np.array([0.5, 0.62, 0.9]), np.array([0.0, 0.6, -0.2])

    @jax.jit
    def loss(omega, heading, depth):
        water = Environment(1025.0, depth, 9.81)
        waves = bound_waves(components(jnp.ones(3), omega, water, heading=heading), water)
        return (waves.elevation.real + 0.1 * waves.potential.real).sum()

    at = (omega, heading, np.array(30.0))
    gradient = list(map(np.asarray, one_program(jax.grad(loss, (0, 1, 2)))(*at)))
    for which, i in ((0, 0), (0, 2), (1, 1), (2, ())):
        step = np.zeros_like(at[which])
        step[i] = 1e-6
        high, low = (loss(*at[:which], at[which] + sign * step, *at[which + 1 :]) for sign in (1, -1))
        assert float(gradient[which][i]) == pytest.approx(float((high - low) / 2e-6), rel=1e-6, abs=1e-9)


def test_components_on_no_grid_cannot_be_folded() -> None:
    with pytest.raises(ValueError, match="successive harmonics"):
        elevation_spectrum(components([1.0, 1.0], [0.5, 0.9], SHALLOW), SHALLOW, (0.0, 0.0))


# against OpenFAST


def seastate(name: str) -> dict[str, np.ndarray]:
    """A table of SeaState's by column."""
    with gzip.open(OPENFAST / f"{name}.csv.gz", "rt") as lines:
        names = lines.readline().strip().split(",")
        return dict(zip(names, np.loadtxt(lines, delimiter=",").T, strict=True))


@pytest.mark.skipif(not OPENFAST.is_dir(), reason=f"no OpenFAST results in {OPENFAST}")
@pytest.mark.parametrize("x", [0, 50])
@pytest.mark.parametrize("case", ["reg", "comp"])
def test_against_openfast(case: str, x: int) -> None:
    """Second order less first: elevation, velocity, acceleration and pressure, which has no set-down there."""
    omega, amplitude, phase, _ = np.loadtxt(OPENFAST / f"{case}_components.csv", delimiter=",", skiprows=1, ndmin=2).T
    first_order, second = seastate(f"{case}_o1_x{x}"), seastate(f"{case}_o2_x{x}")
    sea = components(amplitude, omega, DEEP, phase=np.radians(phase))
    waves = jax.tree.map(np.asarray, bound_waves(sea, DEEP, set_down=False))
    spin = np.exp(1j * (waves.omega * second["Time"][:, None] - x * waves.vector[0]))
    expected = {"Wave1Elv2": (spin @ waves.elevation).real}
    for j, z in enumerate((0.0, -5.0, -10.0, -20.0, -50.0), 1):
        k, c, s = profile(waves, DEEP, z, np)
        u, w = spin * (waves.vector[0] * waves.potential * c), spin * (1j * k * waves.potential * s)
        expected[f"FVel{j}xi"], expected[f"FVel{j}zi"] = u.real.sum(axis=1), w.real.sum(axis=1)
        expected[f"FAcc{j}xi"] = (1j * waves.omega * u).real.sum(axis=1)
        expected[f"FAcc{j}zi"] = (1j * waves.omega * w).real.sum(axis=1)
        expected[f"FDynP{j}"] = 1025.0 * (spin * (waves.omega * waves.potential * c)).real.sum(axis=1)
    for channel, ours in expected.items():
        openfast = second[channel] - first_order[channel]
        rounding = 1e-5 * np.abs(second[channel]).max()  # six digits are printed of the sum of both orders
        assert np.abs(ours - openfast).max() < 1e-4 * np.abs(openfast).max() + rounding, channel
        if case == "comp":  # a single wave's potential is nothing in 200 m
            assert float(ours @ openfast / (ours @ ours)) == pytest.approx(1.0, abs=1e-4), channel
