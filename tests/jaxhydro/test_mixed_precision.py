"""Loads in float32 within a time integration in float64."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from fake_sweep import written

import jaxhydro as jh
from jaxhydro.integrators.mixed_precision import in_float32
from jaxhydro.sweep import load_sweep
from jaxhydro.sweep.cases import Plan
from jaxhydro.sweep.prepared_sweep import prepared

STATISTICS = {"mean": np.mean, "standard deviation": np.std, "largest": np.max, "least": np.min}


def test_what_depends_on_the_state_is_in_float32():
    seen = {}

    def rate(driver, time, y):
        seen["phase"] = jnp.cos(driver * time)
        return (seen["phase"] * jnp.sin(y), y.at[0].set(1 / 3)[:1])

    text = str(jax.make_jaxpr(in_float32(rate))(jnp.asarray(0.3), jnp.asarray(2.0), jnp.ones(3)))
    lines = {name: next(line for line in text.splitlines() if f" = {name} " in line) for name in ("cos", "sin")}
    assert "f64[]" in lines["cos"]
    assert "f32[3]" in lines["sin"]
    rates = in_float32(rate)(jnp.asarray(0.3), jnp.asarray(2.0), jnp.ones(3))
    assert [value.dtype for value in rates] == [jnp.float64, jnp.float64]
    exact = np.cos(0.6) * np.sin(1.0)
    np.testing.assert_allclose(rates[0], exact, rtol=2e-7)
    assert abs(float(rates[0][0]) - exact) > 0  # it is rounded


@pytest.mark.slow
def test_statistics_of_a_sea_hardly_change():
    model = jh.load_model("volturnus-s")
    waves = jh.spectrum_components(
        lambda omega: jh.jonswap(omega, 8.0, 12.0), 600.0, model.environment, low=0.03, cutoff=0.2, seed=1
    )
    sea, times = jh.IrregularSea(waves, model.environment, 1, "vertical"), 0.5 * np.arange(1201)
    double, mixed = (
        np.asarray(jh.simulate(model, times, sea, precision=precision).position) for precision in ("double", "mixed")
    )
    for i in (0, 2, 4):
        deviation = double[:, i].std()
        for name, statistic in STATISTICS.items():
            assert abs(statistic(mixed[:, i]) - statistic(double[:, i])) < 1e-4 * deviation, (i, name)
        assert 0 < np.abs(mixed[:, i] - double[:, i]).max() < 1e-4 * deviation


@pytest.mark.slow
def test_a_sea_of_several_headings_has_the_precision_too():
    model = jh.load_model("volturnus-s-focal")
    waves = jh.spectrum_components(
        lambda omega: jh.jonswap(omega, 3.0, 9.0), 60.0, model.environment, low=0.08, cutoff=0.14, seed=1
    )
    sea = jh.IrregularSea(dataclasses.replace(waves, heading=jnp.linspace(-0.2, 0.2, waves.omega.size)), model.environment)
    double, mixed = (
        np.asarray(jh.simulate(model, np.arange(0.0, 20.0), sea, precision=precision).position)
        for precision in ("double", "mixed")
    )
    assert 0 < np.abs(mixed - double).max() < 1e-4 * double[:, 2].std()


def test_a_sweep_states_its_precision(tmp_path):
    made = prepared(load_sweep(written(tmp_path, precision="mixed")), "sweep.yaml")
    assert made.inputs.plan.precision == "mixed"
    assert Plan.from_json(made.inputs.plan.to_json()) == made.inputs.plan
    assert any("float32" in note for note in made.notes)
    with pytest.raises(jh.InputError, match="precision"):
        load_sweep(written(tmp_path, precision="half"))


def test_a_precision_that_is_not_known_is_named():
    with pytest.raises(ValueError, match="precision"):
        jh.simulate(None, np.arange(3.0), precision="half")
