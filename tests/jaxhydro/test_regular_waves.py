"""Regular waves of second order against closed forms, and stream-function waves against raschii and the lower orders."""

import json
import math
import sys
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import elevation, flow, one_program

import jaxhydro as jh
from jaxhydro.waves import regular_waves as module
from jaxhydro.waves.components import components
from jaxhydro.waves.regular_waves import regular_wave, series_remarks
from jaxhydro.waves.stream_function import HINT, SteepWave, StreamFunction, stream_function
from jaxhydro.waves.wave_errors import BreakingError

RASCHII = json.loads((Path(__file__).parents[1] / "data" / "stream-function-raschii.json").read_text())["waves"]
HEIGHT, PERIOD, WATER = 2.5, 9.0, jh.Environment(1025.0, 18.0, 9.81)


@one_program
def at_points(sea, time, points):
    flow = sea.flow(time, points)
    return sea.elevation(time, points[:2]), flow.velocity, flow.acceleration, flow.pressure


def at(sea, time, x, z):
    """Elevation (m), velocity (m/s), acceleration (m/s2) and pressure over density at points of a vertical plane."""
    points = np.stack([np.asarray(x, float), np.zeros(len(x)), np.asarray(z, float)])
    eta, velocity, acceleration, pressure = map(np.asarray, at_points(sea, time, points))
    return eta, velocity[::2], acceleration[::2], pressure


def test_second_order_is_stokes_closed_form() -> None:
    """Elevation, velocity, acceleration and pressure of the equations that the docstring cites, written out."""
    sea, first = regular_wave(HEIGHT, PERIOD, WATER, order=2), regular_wave(HEIGHT, PERIOD, WATER)
    omega, k, h = 2 * math.pi / PERIOD, float(first.waves.vector[0, 0]), float(WATER.depth)
    x, z, time = np.array([0.0, 11.0, -35.0]), np.array([-1.0, -6.0, -18.0]), 1.7
    theta, t = k * x - omega * time, math.tanh(k * h)
    eta, velocity, acceleration, pressure = (b - a for a, b in zip(at(first, time, x, z), at(sea, time, x, z)))
    scale = 3 / 32 * HEIGHT**2 * omega / math.sinh(k * h) ** 4
    assert_allclose(eta, HEIGHT**2 * k * (3 - t**2) / (16 * t**3) * np.cos(2 * theta), rtol=1e-9)
    up, over = np.cosh(2 * k * (z + h)), np.sinh(2 * k * (z + h))
    assert_allclose(
        velocity, 2 * k * scale * np.stack([up * np.cos(2 * theta), over * np.sin(2 * theta)]), rtol=1e-9, atol=1e-12
    )
    expected = 4 * k * omega * scale * np.stack([up * np.sin(2 * theta), -over * np.cos(2 * theta)])
    assert_allclose(acceleration, expected, rtol=1e-9, atol=1e-12)
    assert_allclose(pressure, 2 * omega * scale * up * np.cos(2 * theta), rtol=1e-9)


def test_crests_are_higher_and_troughs_flatter_and_the_height_stays() -> None:
    """Crest less trough is H; the mean is zero; the variance is that of both harmonics."""
    sea = regular_wave(HEIGHT, PERIOD, WATER, order=2, heading=0.6, phase=0.4)
    times = np.linspace(0.0, PERIOD, 721)[:-1]
    eta = np.asarray(one_program(jax.vmap(lambda t: sea.elevation(t, jnp.zeros((2, 1)))[0]))(times))
    assert eta.max() - eta.min() == pytest.approx(HEIGHT, rel=1e-4) and eta.max() > -1.1 * eta.min()
    assert abs(eta.mean()) < 1e-12 and times[np.argmax(eta)] == pytest.approx(PERIOD * (1 - 0.4 / (2 * math.pi)), abs=0.02)
    second = abs(np.asarray(sea.bound.elevation)[0])
    assert eta.var() == pytest.approx((HEIGHT / 2) ** 2 / 2 + second**2 / 2, rel=1e-9)


def test_an_irregular_sea_of_one_component_is_the_same_wave() -> None:
    """But for the set-down, which a regular wave's mean level includes."""
    sea = regular_wave(HEIGHT, PERIOD, WATER, order=2)
    irregular = jh.IrregularSea(components(np.array([HEIGHT / 2]), np.array([2 * math.pi / PERIOD]), WATER, first=1), WATER, 2)
    points = np.array([[0.0, 20.0], [0.0, 5.0], [-2.0, -9.0]])
    assert_allclose(flow(sea, 2.0, points).velocity, flow(irregular, 2.0, points).velocity, atol=1e-12)
    apart = np.asarray(elevation(sea, 2.0, points[:2])) - np.asarray(elevation(irregular, 2.0, points[:2]))
    assert_allclose(apart, apart[0], atol=1e-12)


@pytest.fixture
def coefficients(monkeypatch):
    """Stream functions from the stored coefficients, so that raschii need not be installed."""

    def stored(height, period, depth, gravity, order):
        wave = next(w for w in RASCHII if (w["height"], w["period"], w["depth"], w["order"]) == (height, period, depth, order))
        return StreamFunction(wave["wavenumber"], np.array(wave["E"]), np.array(wave["B"]))

    monkeypatch.setattr(module, "stream_function", stored)


@pytest.mark.parametrize("wave", RASCHII, ids=lambda wave: f"{wave['height']:g}m-{wave['depth']:g}m")
def test_our_sums_are_raschii_s(coefficients, wave) -> None:
    """Elevation everywhere; velocity and acceleration below the surface, above still water level, too."""
    water = jh.Environment(1025.0, wave["depth"], 9.81)
    sea = regular_wave(wave["height"], wave["period"], water, order=wave["order"])
    for i, time in enumerate(wave["t"]):
        eta, velocity, acceleration, _ = at(sea, time, wave["x"], wave["z"])
        assert_allclose(eta, wave["eta"][i], atol=1e-7 * wave["height"])
        wet = np.asarray(wave["z"]) < eta
        assert wet.sum() >= 2
        for ours, raschii in ((velocity, wave["velocity"]), (acceleration, wave["acceleration"])):
            assert_allclose(ours[:, wet], np.asarray(raschii[i]).T[:, wet], rtol=1e-6, atol=1e-7)


def test_a_low_steep_wave_is_stokes_and_airy(coefficients) -> None:
    """H = 2 m, 10 s, 50 m deep, ka = 0.043: apart by (ka)² relative to the first order, far less than the second is of it."""
    wave = RASCHII[0]
    water = jh.Environment(1025.0, wave["depth"], 9.81)
    first, second, steep = (regular_wave(wave["height"], wave["period"], water, order=order) for order in (1, 2, wave["order"]))
    x, z = np.linspace(-40.0, 40.0, 9), np.full(9, -3.0)
    of_first, of_second, of_steep = (at(sea, 0.7, x, z) for sea in (first, second, steep))
    ka = wave["height"] / 2 * float(first.waves.vector[0, 0])
    for stokes, exact in zip(of_second, of_steep):
        size = np.abs(exact).max()
        assert np.abs(stokes - exact).max() < 2.0 * ka**2 * size
    assert np.abs(of_first[0] - of_steep[0]).max() > 5 * np.abs(of_second[0] - of_steep[0]).max()
    assert np.abs(of_first[0] - of_steep[0]).max() < 1.2 * ka * np.abs(of_steep[0]).max()


def test_the_flow_of_a_steep_wave_obeys_its_surface_condition(coefficients) -> None:
    """No water through the surface, w = eta_t + u eta_x, with derivatives by JAX; 12 m in 10 s, 50 m deep."""
    wave = RASCHII[1]
    sea = regular_wave(wave["height"], wave["period"], jh.Environment(1025.0, wave["depth"], 9.81), order=wave["order"])

    def eta(x, time):
        return sea.elevation(time, jnp.array([[x], [0.0]]))[0]

    @one_program
    def at_surface(x, time):
        flow = sea.flow(time, jnp.array([[x], [0.0], [eta(x, time)]]))
        return jax.grad(eta, argnums=(0, 1))(x, time), flow.velocity[:, 0]

    for x, time in ((0.0, 0.5), (20.0, 0.5), (-33.0, 2.0)):
        (slope, rise), velocity = at_surface(x, time)
        u, _, w = map(float, velocity)
        assert w == pytest.approx(float(rise) + u * float(slope), abs=1e-2)  # of 3.9 m/s


@pytest.mark.slow
def test_a_platform_is_moved_by_steep_waves(coefficients) -> None:
    """Finite motion, larger crests than troughs in the recorded wave."""
    wave = RASCHII[2]
    model = jh.load_model("volturnus-s")
    water = jh.Environment(1025.0, wave["depth"], 9.81)
    sea = regular_wave(wave["height"], wave["period"], water, order=wave["order"], ramp=12.0)
    assert isinstance(sea, SteepWave)
    motion = jh.simulate(model, np.arange(0.0, 20.0, 1.0), sea, step=0.25)
    assert np.isfinite(np.asarray(motion.position)).all() and float(np.ptp(np.asarray(motion["surge"]))) > 0.5


def test_a_series_cut_short_is_remarked(coefficients) -> None:
    wave = RASCHII[1]
    sea = regular_wave(wave["height"], wave["period"], jh.Environment(1025.0, 50.0, 9.81), order=wave["order"])
    assert series_remarks(sea, wave["order"]) == [] and series_remarks(regular_wave(2.0, 9.0, WATER, order=2), 2) == []
    short = module._steep(StreamFunction(0.05, np.array([1.0, 0.1, 0.02]), np.ones(3)), 0.7, WATER, 0.0, 0.0, 0.0, "vertical")
    (remark,) = series_remarks(short, 3)
    assert remark.warning and "the last of 3 harmonics of the elevation has 2.0% of the first" in remark.text


def test_what_cannot_be_is_told() -> None:
    with pytest.raises(BreakingError, match="breaks above a height of"):
        regular_wave(20.0, 8.0, WATER, order=2)
    with pytest.raises(BreakingError, match="breaks above a height of"):
        regular_wave(20.0, 8.0, WATER, order=7)
    with pytest.raises(ValueError, match="order of a regular wave is 1 or more, found 0"):
        regular_wave(2.0, 8.0, WATER, order=0)
    with pytest.raises(ValueError, match="no stretching by wheeler"):
        regular_wave(2.0, 8.0, WATER, order=5, stretching="wheeler")


def test_without_raschii_a_message_says_what_to_install(monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "raschii", None)
    with pytest.raises(ImportError) as error:
        stream_function(2.0, 8.0, 50.0, 9.81, 5)
    assert str(error.value) == HINT


def test_raschii_itself_gives_the_stored_coefficients() -> None:
    pytest.importorskip("raschii")
    wave = RASCHII[0]
    computed = stream_function(wave["height"], wave["period"], wave["depth"], 9.81, wave["order"])
    assert computed.wavenumber == pytest.approx(wave["wavenumber"], rel=1e-9)
    assert_allclose(computed.elevation, wave["E"], atol=1e-9)
    assert_allclose(computed.potential, wave["B"], atol=1e-9)
