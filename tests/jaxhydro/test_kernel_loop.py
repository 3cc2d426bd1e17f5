"""Time loop in one GPU kernel: interpreted against XLA's loop, and lowered for CUDA without a GPU."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxhydro as jh
from jaxhydro.dynamics.integrate import clock, integrate
from jaxhydro.integrators import adams_bashforth, kernel_loop
from jaxhydro.integrators.kernel_trace import KernelError

STEPS, STEP = 12, 0.1


def all_operations(driver, time, y):
    """Rates of a state of 7 by every kind of operation that a kernel has: moves, sums of each size, look-ups, roundings."""
    matrix, wide, series = driver
    row = series[jnp.floor(time / STEP + 1e-6).astype(int)]
    backwards = jnp.concatenate([y[:3], -y[5:2:-1]])
    short = matrix @ backwards  # few terms
    long = (wide[:3] @ jnp.tile(jnp.sin(y), 30)[:200]) / 200  # many terms, few results
    table = jnp.cos(wide[:, :100] * y[0] + jnp.arange(100.0))
    loop = (wide.T @ table).sum(axis=0)[:7] / 1e4  # many of both
    picked = backwards[jnp.array([0, 2, 2, 5])]
    drag = jnp.sqrt((picked**2).sum() + 1e-12) * picked
    bent = jnp.where(y > 0.2, jnp.round(3 * y) / 9, jnp.exp(-y)).at[jnp.array([1, 4])].set(0.1 * row[:2])
    extreme = jnp.stack([y.max(), y.min(), jnp.prod(jnp.cos(y[:4]))])
    nearest = series[jnp.clip(jnp.array([1, 2, 0]) + (y[:3] > 0).astype(int), 0, 3), 1]
    spring = jnp.concatenate([short, long[:2]]) - y
    return (spring[:4] - 0.3 * drag, spring[4:] + 0.1 * extreme + 0.01 * nearest + 0.05 * (bent + loop)[:3])


@pytest.fixture(scope="module")
def problem():
    draw = np.random.default_rng(3)
    drivers = [tuple(jnp.asarray(draw.normal(size=size)) for size in ((5, 6), (40, 200), (20, 4))) for _ in range(2)]
    return jax.tree.map(lambda *x: jnp.stack(x), *drivers), jnp.asarray(draw.normal(size=7))


def kernel(interpret: bool):
    def one(driver, y):
        options = {"rate": all_operations, "capacity": STEPS, "shown": 5, "interpret": interpret}
        return kernel_loop.march(driver, y, jnp.zeros(()), jnp.asarray(STEP), **options)

    return jax.jit(jax.vmap(one, in_axes=(0, None)))


def test_a_kernel_gives_what_the_loop_gives(problem):
    def one(driver, y):
        options = {"rate": all_operations, "capacity": STEPS, "shown": 5}
        return adams_bashforth.forward(driver, y, jnp.zeros(()), jnp.asarray(STEP), jnp.asarray(STEPS), **options)

    exact = np.asarray(jax.jit(jax.vmap(one, in_axes=(0, None)))(*problem))
    states = np.asarray(kernel(True)(*problem))
    assert states.shape == exact.shape == (2, STEPS + 1, 5)
    np.testing.assert_allclose(states, exact, rtol=0, atol=1e-12 * np.abs(exact).max())
    assert np.abs(exact[0] - exact[1]).max() > 1e-3  # each has its own driver


def test_a_kernel_is_one_program_for_cuda(problem):
    text = kernel(False).trace(*problem).lower(lowering_platforms=("cuda",)).as_text()
    assert text.count("__gpu$xla.gpu.triton") == 1
    assert "stablehlo.while" not in text


def test_what_a_kernel_cannot_do_is_told():
    def sorting(driver, time, y):
        return (jnp.sort(y),)

    with pytest.raises(KernelError, match=r"the kernel cannot do sort on float64\[7\]"):
        jax.jit(lambda y: kernel_loop.march((), y, jnp.zeros(()), jnp.asarray(STEP), rate=sorting, capacity=STEPS, shown=7))(
            jnp.zeros(7)
        )


def test_arrays_without_elements_are_no_part_of_a_kernel():
    def rate(driver, time, y):
        empty = -y[:0]
        return (jnp.concatenate([-y, empty]) + empty.sum() + jnp.zeros((3, 0)) @ empty,)

    y, start, step = jnp.arange(3.0), jnp.zeros(()), jnp.asarray(STEP)
    options = {"rate": rate, "capacity": 4, "shown": 3}
    march = jax.vmap(lambda driver: kernel_loop.march(driver, y, start, step, interpret=True, **options))
    states = jax.jit(march)((np.zeros((2, 1)),))
    exact = jax.jit(lambda y: adams_bashforth.forward((), y, start, step, jnp.asarray(4), **options))(y)
    np.testing.assert_allclose(states[0], exact, rtol=0, atol=1e-14)


def test_a_kernel_is_for_one_scheme():
    with pytest.raises(ValueError, match="the kernel is for method 'ab4' with adjoint 'forward', found 'rk4' with 'forward'"):
        integrate(None, None, None, None, None, 3, "rk4", kernel="gpu")


@pytest.mark.slow
def test_a_platform_in_seas_moves_in_a_kernel_as_elsewhere():
    model, steps, step = jh.load_model("volturnus-s-focal"), 16, 0.25
    start = jh.State(jh.equilibrium(model) + jnp.array([1.0, 2.0, 0.5, 0.02, 0.03, 0.01]), jnp.zeros(6), model.rest().memory)
    seas = []
    for seed in (1, 2):
        waves = jh.spectrum_components(
            lambda omega: jh.jonswap(omega, 8.0, 12.0), 60.0, model.environment, low=0.03, cutoff=0.3, seed=seed
        )
        sea = jh.IrregularSea(waves, model.environment, 2, "vertical")
        seas.append(sea.prepared(model.hull.extremities(), model.cylinders, clock("ab4", 0.0, step, steps)))
    static = eqx.partition(seas[0], eqx.is_array)[1]
    arrays = jax.tree.map(lambda *x: jnp.stack(x), *(eqx.filter(sea, eqx.is_array) for sea in seas))

    def moved(kernel, precision="double"):
        def one(arrays):
            sea = eqx.combine(arrays, static)
            options = {"kernel": kernel, "precision": precision}
            return integrate(model, sea, start, jnp.zeros(()), jnp.asarray(step), steps, "ab4", **options).position

        return jax.jit(jax.vmap(one))

    exact, positions = (np.asarray(moved(kernel)(arrays)) for kernel in ("off", "interpreted"))
    np.testing.assert_allclose(positions, exact, rtol=0, atol=1e-12 * np.abs(exact).max())
    assert np.abs(exact[0] - exact[1]).max() > 1e-3
    text = moved("gpu", "mixed").trace(arrays).lower(lowering_platforms=("cuda",)).as_text()
    assert text.count("__gpu$xla.gpu.triton") == 1
