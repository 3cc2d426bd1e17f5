"""Linearisation of a right-hand side along its state and its driver, and derivatives of the schemes made of it."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import one_program

from jaxhydro.integrators import adams_bashforth, runge_kutta
from jaxhydro.integrators.linearised_rate import linearised_rate

MEMORY = 40  # entries
STEPS, STEP = 21, 0.05


def rate(driver, time, y):
    """Position, acceleration and a long memory, all of them nonlinear, of a driver in several leaves."""
    position, velocity, memory = y[:2], y[2:4], y[4:]
    force = -driver["stiffness"] * jnp.sin(position) - driver["damping"] * velocity * jnp.abs(velocity)
    force = force + driver["wave"] * jnp.cos(time) + driver["weights"] @ memory
    return velocity * jnp.cos(position), force / (1 + position**2), driver["pole"] * (jnp.tanh(velocity.sum()) - memory)


@pytest.fixture(name="driver")
def driver_fixture():
    rng = np.random.default_rng(4)
    values = {"stiffness": [2.0, 3.0], "damping": 0.4, "wave": [0.5, 0.2], "pole": 1 + rng.random(MEMORY)}
    return {name: np.asarray(value) for name, value in values.items()} | {"weights": rng.normal(size=(2, MEMORY))}


@pytest.fixture(name="start")
def start_fixture():
    return np.random.default_rng(5).normal(size=4 + MEMORY) * 0.3


def test_slopes_are_those_of_the_whole_right_hand_side(driver, start) -> None:
    """By the state and along a direction, of which one leaf has no part."""
    rng = np.random.default_rng(6)
    d_driver = {name: rng.normal(size=value.shape) for name, value in driver.items()} | {"wave": None}
    linearised = one_program(lambda driver, d_driver, time, y: linearised_rate(rate, driver, d_driver)(time, y))
    slope, push = linearised(driver, d_driver, 0.7, start)
    whole = one_program(jax.jacfwd(lambda y: jnp.concatenate(rate(driver, 0.7, y))))(start)
    along = d_driver | {"wave": np.zeros(2)}
    moved = one_program(lambda *d: jax.jvp(lambda d: jnp.concatenate(rate(d, 0.7, start)), d[:1], d[1:])[1])(driver, along)
    assert_allclose(slope, whole, rtol=1e-12, atol=1e-14)
    assert_allclose(push, moved, rtol=1e-12, atol=1e-14)
    still = {name: None for name in driver}
    slope, push = linearised(driver, still, 0.7, start)
    assert_allclose(slope, whole, rtol=1e-12, atol=1e-14)
    assert not np.asarray(push).any()


@pytest.mark.parametrize("scheme", ["ab4", "rk4"])
def test_derivatives_forward_and_in_reverse_agree(scheme: str, driver, start) -> None:
    """Of a long state, by driver and initial state, in an array for more steps than are taken."""
    loop = adams_bashforth if scheme == "ab4" else runge_kutta
    options = {"rate": rate} | ({} if scheme == "ab4" else {"scheme": runge_kutta.RK4})
    weights = np.asarray(np.random.default_rng(7).normal(size=(STEPS + 1, 4)))

    def forward(driver, y):
        path = loop.forward(driver, y, jnp.asarray(0.3), jnp.asarray(STEP), jnp.asarray(STEPS), capacity=30, shown=4, **options)
        return (path[: STEPS + 1] * weights).sum()

    def backward(driver, y):
        path = loop.backward(driver, y, jnp.asarray(0.3), jnp.asarray(STEP), jnp.asarray(STEPS), capacity=STEPS, **options)
        return (path[:, :4] * weights).sum()

    assert_allclose(jax.jit(forward)(driver, start), jax.jit(backward)(driver, start), rtol=1e-12)
    forward_slopes = jax.jit(jax.jacfwd(forward, argnums=(0, 1)))(driver, start)
    expected = jax.jit(jax.grad(backward, argnums=(0, 1)))(driver, start)
    for actual, reference in zip(jax.tree.leaves(forward_slopes), jax.tree.leaves(expected), strict=True):
        assert_allclose(actual, reference, rtol=1e-9, atol=1e-12)
        assert (np.abs(reference) > 1e-9).all()
