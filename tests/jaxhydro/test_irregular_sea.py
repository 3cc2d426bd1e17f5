"""Irregular seas evaluated on support wavenumbers against direct summation, and integration and gradients through them."""

import dataclasses

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import elevation, flow, one_program

import jaxhydro as jh
from jaxhydro.dynamics.integrate import clock, integrate
from jaxhydro.dynamics.irregular_simulation import CarriedAwayError
from jaxhydro.waves import Clock, Cylinders
from jaxhydro.waves.support_fields import cosine_sine
from jaxhydro.waves.supports import Box, supports, weights
from jaxhydro.waves.wave_errors import ShortWavesError

WATER = jh.Environment(1025.0, 200.0, 9.81)
HULL = np.array([[-51.75, 0, -20], [25.9, 44.8, -20], [25.9, -44.8, -20], [0, 0, 15.0]]).T
CYLINDERS = Cylinders(jnp.array([5.0, 6.25]), (1, 0, -1, 1, 0))


def sea(order: int = 2, duration: float = 200.0, heading: float = 0.0, height: float = 8.1, **options) -> jh.IrregularSea:
    waves = jh.spectrum_components(
        lambda omega: jh.jonswap(omega, height, 12.8), duration, WATER, low=0.03, cutoff=0.3, seed=1, heading=heading
    )
    return jh.IrregularSea(waves, WATER, order, **options)


# evaluation


def test_cosine_and_sine() -> None:
    """Against NumPy's, far beyond any phase over a hull."""
    x = np.linspace(-900.0, 900.0, 200_001)
    for approximate, exact in zip(one_program(cosine_sine)(x), (np.cos(x), np.sin(x)), strict=True):
        assert_allclose(approximate, exact, atol=1e-11)


def test_weights_reproduce_every_wave() -> None:
    """exp(-ikx) with its profile over depth from those of the supports, at wavenumbers and places of chance."""
    box = Box(75.0, -24.0, 200.0)
    support = supports(box, 0.36, 0.72)
    rng = np.random.default_rng(0)
    k, x, z = rng.uniform(0.0, 0.36, 200), rng.uniform(-75, 75, 50), rng.uniform(-24, 0, 50)

    def field(k):
        return np.cosh(k * (z[:, None] + 200)) / np.cosh(k * 200) * np.exp(-1j * k * x[:, None])

    w = np.asarray(one_program(weights)(support.table, support.spacing, k))
    assert np.abs(field(support.wavenumber) @ w.T - field(k)).max() < 1e-5


def test_a_box_of_many_wavelengths_is_refused() -> None:
    with pytest.raises(ShortWavesError, match="cut the sea off at a lower frequency"):
        supports(Box(600.0, -24.0, 200.0), 1.0)


@pytest.mark.parametrize(
    "order, stretching, heading", [(1, "vertical", 0.0), (2, "vertical", 0.7), (2, "wheeler", 0.0), (2, "extrapolation", 0.0)]
)
def test_against_direct_summation(order: int, stretching: str, heading: float) -> None:
    """All that a hull asks for, at displaced points above and below still water, between steps too, to 1e-5."""
    waves = sea(order, heading=heading, stretching=stretching)
    exact = waves.direct()
    fast = waves.prepared(HULL, CYLINDERS, Clock(10.0, 0.25, 100, (0.0, 0.5), 2))
    rng = np.random.default_rng(0)
    along = rng.uniform(-35.0, 35.0, 5)
    points = np.stack([along * np.cos(heading), along * np.sin(heading), np.array([-20.0, -10.0, -3.0, 0.0, 3.0])])
    for time in (10.0, 10.125, 33.5):
        fast_flow, exact_flow = (flow(s, time, points, CYLINDERS) for s in (fast, exact))
        for name in ("velocity", "acceleration", "pressure", "diffracted"):
            expected = np.asarray(getattr(exact_flow, name))
            assert_allclose(getattr(fast_flow, name), expected, atol=1e-5 * np.abs(expected).max(), err_msg=name)
        surface = [elevation(s, time, points[:2]) for s in (fast, exact)]
        assert_allclose(*surface, atol=5e-5)
        assert_allclose(waves.gauge(np.array([time])), elevation(exact, time, np.zeros((2, 1))), atol=1e-9)


@pytest.mark.slow
def test_bound_waves_that_act_at_the_origin() -> None:
    """First order where the points are, and of what it binds the horizontal flow at x = y = 0, by direct summation."""
    waves = sea(2, heading=0.7, acting="at the origin", kinds=("difference",), highest_difference=0.05)
    fast = waves.prepared(HULL, CYLINDERS, Clock(10.0, 0.25, 100, (0.0, 0.5), 2))
    everywhere = dataclasses.replace(waves, acting="everywhere").direct()
    first = dataclasses.replace(waves, order=1).direct()
    along = np.array([-30.0, -5.0, 0.0, 10.0, 33.0])
    points = jnp.asarray(np.stack([along * np.cos(0.7), along * np.sin(0.7), np.array([-20.0, -10.0, -3.0, 0.0, 3.0])]))
    origin = points.at[:2].set(0.0)
    for time in (10.0, 10.125, 33.5):
        now = jnp.asarray(time)
        restricted_flow, free = (eqx.filter_jit(s.flow)(now, points, CYLINDERS).earth() for s in (fast, first))
        second_order, alone = (s.flow(now, origin, CYLINDERS).earth() for s in (everywhere, first))
        for name in ("velocity", "acceleration", "diffracted"):
            bound = np.asarray(getattr(second_order, name) - getattr(alone, name))
            expected = np.asarray(getattr(free, name)) + bound * [[1.0], [1.0], [0.0]]
            scale = np.abs(expected).max()
            assert np.abs(bound[:2]).max() > 1e-3 * scale
            assert_allclose(getattr(restricted_flow, name), expected, atol=1e-5 * scale, err_msg=name)
        assert_allclose(restricted_flow.pressure, free.pressure, atol=1e-5 * np.abs(free.pressure).max())
        assert_allclose(fast.elevation(now, points[:2]), everywhere.elevation(now, points[:2]), atol=5e-5)
    with pytest.raises(ValueError, match="for simulations"):
        waves.direct()


@pytest.mark.slow
def test_slopes_of_the_field() -> None:
    """Derivatives by place, which have a rule of their own, against finite differences; reverse against forward."""
    fast = sea().prepared(HULL, CYLINDERS, Clock(10.0, 0.25, 100, (0.0,)))
    now = jnp.asarray(12.5)

    def at(p):
        flow = fast.flow(now, p[:, None], Cylinders(CYLINDERS.radius, (1,))).earth()
        parts = (flow.velocity[:, 0], flow.acceleration[:, 0], flow.pressure, flow.diffracted[:, 0])
        return jnp.concatenate([*parts, fast.elevation(now, p[:2, None])])

    position = jnp.array([12.0, 5.0, -7.0])
    forward = jax.jacfwd(at)(position)
    step = 1e-4 * np.eye(3)
    differences = np.stack([(at(position + d) - at(position - d)) / 2e-4 for d in step], axis=1)
    assert_allclose(forward, differences, atol=1e-7 * np.abs(differences).max())
    assert_allclose(jax.jacrev(at)(position), forward, atol=1e-12 * np.abs(differences).max())


@pytest.mark.parametrize(
    "change, message",
    [
        ({"step": 0.3}, "do not divide the sea's period"),
        ({"step": 2.0}, "too long for waves of 0.6 Hz"),
    ],
)
def test_clocks_that_do_not_fit(change: dict, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        sea().prepared(HULL, None, Clock(0.0, change["step"], 10, (0.0,)))


def test_a_short_crested_sea_says_what_it_is() -> None:
    waves = sea()
    turned = dataclasses.replace(waves.components, heading=waves.components.heading.at[3].set(0.4))
    with pytest.raises(ValueError, match="short-crested"):
        jh.IrregularSea(turned, WATER, 1).prepared(HULL, None, Clock(0.0, 0.25, 10, (0.0,)))


# simulation


@pytest.fixture(scope="module")
def model() -> jh.Model:
    return jh.load_model("volturnus-s-focal")


@pytest.mark.slow
def test_simulation_on_supports_against_direct_summation(model: jh.Model) -> None:
    """The same 60 s of sea by Runge-Kutta in both seas, and by Adams-Bashforth."""
    waves = sea(duration=60.0)
    times = np.arange(0.0, 60.1, 0.5)
    exact = jh.simulate(model, times, waves.direct(), method="rk4", step=0.5).position
    size = np.asarray(exact).std(axis=0)[[0, 2, 4]]
    for method, step, tolerance in (("rk4", 0.5, 2e-5), ("ab4", 0.125, 2e-3)):
        positions = jh.simulate(model, times, waves, method=method, step=step).position
        error = np.abs(np.asarray(positions - exact)).max(axis=0)[[0, 2, 4]]
        assert (error < tolerance * size).all(), (method, error / size)


@pytest.mark.slow
def test_order_of_adams_bashforth(model: jh.Model) -> None:
    """Halving the step divides the error by 16, in a smooth problem: a decay without drag."""
    smooth = model.with_values({label: 0.0 for label in model.values if ".Cd_" in label})
    times = np.arange(0.0, 41.0, 1.0)
    paths = {
        step: np.asarray(jh.free_decay(smooth, {"heave": 1.0, "pitch": 0.02}, times, method="ab4", step=step).position)
        for step in (0.03125, 0.125, 0.25, 0.5)
    }
    errors = [np.abs(paths[step] - paths[0.03125]).max() for step in (0.5, 0.25, 0.125)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert_allclose(orders, 4.0, atol=0.35)


@pytest.mark.slow
def test_gradients_through_a_sea(model: jh.Model) -> None:
    """reverse = forward = finite difference to 1e-6, by Adams-Bashforth, for a drag and an added-mass coefficient."""
    waves = sea(duration=60.0)
    fast = waves.prepared(model.hull.extremities(), model.cylinders, clock("ab4", 0.0, 0.25, 100))
    equilibrium = jh.equilibrium(model)
    labels = ("column.Cd_t", "pontoon.Ca_z")
    start = jnp.stack([model.values[label] for label in labels])

    def loss(x, adjoint):
        changed = model.with_values(dict(zip(labels, x, strict=True)))
        state = jh.State(equilibrium, jnp.zeros(6), changed.rest().memory)
        grid = integrate(changed, fast, state, jnp.zeros(()), jnp.asarray(0.25), 100, "ab4", adjoint)
        return jnp.mean((grid.position[:101] * jnp.array([1.0, 1, 1, 50, 50, 50])) ** 2)

    forward = jax.jit(jax.jacfwd(lambda x: loss(x, "forward")))(start)
    reverse = jax.jit(jax.grad(lambda x: loss(x, "reverse")))(start)
    value = jax.jit(lambda x: loss(x, "forward"))
    steps = 1e-4 * np.diag(np.asarray(start))
    differences = np.array([(value(start + s) - value(start - s)) / (2 * s.sum()) for s in steps])
    assert_allclose(reverse, forward, rtol=1e-9)
    assert_allclose(forward, differences, rtol=1e-6)


@pytest.mark.slow
def test_a_platform_that_drifts_gets_a_larger_box(model: jh.Model) -> None:
    """A release 40 m off, beyond the box that is tried first: the same motion as in a sea prepared wide at once."""
    waves = sea(order=1, duration=60.0)
    times = np.arange(0.0, 30.1, 0.5)
    positions = jh.simulate(model, times, waves, position={"surge": 40.0}, method="rk4", step=0.5).position
    exact = jh.simulate(model, times, waves.direct(), position={"surge": 40.0}, method="rk4", step=0.5).position
    assert_allclose(positions, exact, atol=1e-3)


@pytest.mark.slow
def test_a_platform_that_drifts_without_end_is_told(model: jh.Model) -> None:
    """A kilometre off, further than the boxes that are tried."""
    times = np.arange(0.0, 30.1, 0.5)
    with pytest.raises(CarriedAwayError, match=r"carried 1\.\d+e\+03 m along the waves"):
        jh.simulate(model, times, sea(order=1, duration=60.0), position={"surge": 1000.0}, method="rk4", step=0.5)
