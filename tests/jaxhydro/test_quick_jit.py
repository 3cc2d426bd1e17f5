"""Programs that several threads ask for."""

import time
from concurrent.futures import ThreadPoolExecutor

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from jaxhydro.quick_jit import jit_once


class Scaled(eqx.Module):
    size: object
    power: int = eqx.field(static=True)


def test_threads_share_one_compilation() -> None:
    traced = []

    @jit_once
    def raised(scaled: Scaled, x: object) -> object:
        traced.append(scaled.power)
        time.sleep(0.2)  # as a compilation takes
        return scaled.size * x**scaled.power

    with ThreadPoolExecutor(4) as pool:
        jobs = [pool.submit(raised, Scaled(jnp.asarray(2.0), power), jnp.arange(3.0)) for power in (2, 3) * 3]
        results = [np.asarray(job.result()) for job in jobs]
    for power, values in zip((2, 3) * 3, results, strict=True):
        np.testing.assert_allclose(values, 2 * np.arange(3.0) ** power)
    assert sorted(traced) == [2, 3]
    raised(Scaled(jnp.asarray(2.0), 2), jnp.arange(4.0))  # of another shape
    assert sorted(traced) == [2, 2, 3]
    for _ in range(2):
        raised.prepare(Scaled(jnp.asarray(2.0), 4), jnp.arange(4.0))
    assert traced.count(4) == 1
