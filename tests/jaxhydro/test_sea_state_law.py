"""Coefficients that depend on the sea state: the law, the sea state of components, the platform file's key."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from ruamel.yaml import YAML
from test_loads import BODY, COEFFICIENTS, COLUMN, EVERYTHING, RHO, G, build, force

import jaxhydro as jh
from jaxhydro.loads.sea_state_law import SeaStateLaw, exponent_label, exponents_of, with_exponents
from jaxhydro.waves.components import components
from jaxhydro.waves.sea_state import SeaState, peak_period, state_of

REFERENCE = SeaState(4.0, 10.0)
LAWS = {
    "reference": {"significant_height": 4.0, "peak_period": 10.0},
    "exponents": {
        "column.Cd_t": {"significant_height": -0.5, "peak_period": 1.0},
        "linear_damping.B11": {"significant_height": 0.8},
    },
}


@pytest.fixture(scope="module")
def models() -> tuple[jh.Model, jh.Model]:
    """Without and with laws."""
    return build(**EVERYTHING), build(**EVERYTHING, sea_state_laws=LAWS)


@pytest.mark.slow
def test_a_power_of_height_and_period(models) -> None:
    """In its reference sea, and in still water, the model is the plain one; elsewhere its coefficients are the power law's."""
    plain, laws = models
    velocity = (1.0, 0.5, -0.3, 0.02, 0.01, 0.03)
    assert_allclose(force(laws, velocity), force(plain, velocity), rtol=1e-15)
    assert_allclose(force(laws.in_sea(REFERENCE), velocity), force(plain, velocity), rtol=1e-15)
    factor = {"column.Cd_t": 2.0**-0.5 * 1.2, "linear_damping.B11": 2.0**0.8}
    changed = plain.with_values({label: f * plain.values[label] for label, f in factor.items()})
    assert_allclose(force(laws.in_sea(SeaState(8.0, 12.0)), velocity), force(changed, velocity), rtol=1e-12)
    returned = laws.in_sea(SeaState(1.0, 5.0)).in_sea(REFERENCE)
    assert_allclose(force(returned, velocity), force(plain, velocity), rtol=1e-15)
    assert plain.in_sea(SeaState(8.0, 12.0)) is plain


@pytest.mark.slow
def test_exponents_are_parameters_like_others(models) -> None:
    """Named, bounded, silent at their neutral value; the slope to one is the coefficient's share times the logarithm."""
    _, laws = models
    label = exponent_label("column.Cd_t", "significant_height")
    assert label == "column.Cd_t.Hs_exponent" and label in exponents_of(laws.loads) <= laws.values.keys()
    assert float(laws.values[label]) == -0.5
    about = laws.about(label)
    assert about.neutral == 0 and about.lower < 0 < about.upper and "Hs/4 m" in about.meaning
    in_sea = laws.in_sea(SeaState(8.0, 10.0))

    def surge(values):
        model = in_sea.with_values(values)
        state = jh.State(jnp.zeros(6), jnp.array([1.0, 0, 0, 0, 0, 0]), model.rest().memory)
        return model.sum_of_loads(model.instant(jnp.zeros(()), state, jh.StillWater()), state.memory).force[0]

    slopes = jax.grad(surge)({k: laws.values[k] for k in ("column.Cd_t", label)})
    assert_allclose(slopes[label], slopes["column.Cd_t"] * laws.values["column.Cd_t"] * np.log(2.0), rtol=1e-12)
    assert float(jax.grad(surge)({label: laws.values[label]})[label]) != 0


def test_exponents_added_to_what_is_there(models) -> None:
    plain, laws = models
    label = exponent_label("pontoon.Cd_z", "peak_period")
    key = ("pontoon.Cd_z", "peak_period")
    extended = with_exponents(laws.loads, {key: 0.0}, REFERENCE)
    assert [type(a) for a in extended] == [type(b) for b in laws.loads]
    law = next(load for load in extended if isinstance(load, SeaStateLaw) and label in load.values)
    assert float(law.values[exponent_label("column.Cd_t", "peak_period")]) == 1.0
    assert with_exponents(plain.loads, {}, REFERENCE) == plain.loads
    with pytest.raises(KeyError, match=r"no coefficient 'colunm\.Cd_t'"):
        with_exponents(plain.loads, {("colunm.Cd_t", "peak_period"): 0.0}, REFERENCE)
    with pytest.raises(ValueError, match="expected the reference"):
        with_exponents(laws.loads, {key: 0.0}, SeaState(5.0, 10.0))
    with pytest.raises(ValueError, match="above 0"):
        with_exponents(plain.loads, {key: 0.0}, SeaState(0.0, 10.0))


@pytest.mark.parametrize("height, period, seed", [(8.1, 12.8, None), (2.0, 7.0, 3)])
def test_the_sea_state_of_components(height: float, period: float, seed: int | None) -> None:
    """Height and peak period of a JONSWAP sea by its components: deterministic amplitudes, and Rayleigh's."""
    environment = jh.Environment(1025.0, 200.0)
    amplitudes = "deterministic" if seed is None else "rayleigh"
    options = {"low": 0.03, "cutoff": 0.5, "seed": seed or 0, "amplitudes": amplitudes}
    waves = jh.spectrum_components(lambda w: jh.jonswap(w, height, period), 3600.0, environment, **options)
    state = state_of(waves)
    assert state.significant_height == pytest.approx(height, rel=0.02 if seed is None else 0.15)
    assert state.peak_period == pytest.approx(period, rel=0.03 if seed is None else 0.08)
    with pytest.raises(ValueError, match="expected a sea"):
        state_of(components(jnp.zeros(3), jnp.array([0.5, 0.6, 0.7]), environment))


def test_peak_period_of_a_symmetric_peak() -> None:
    f = np.linspace(0.0, 0.2, 401)
    assert peak_period(f, np.exp(-(((f - 0.1) / 0.01) ** 2))) == pytest.approx(10.0, rel=1e-6)


@pytest.mark.slow
def test_simulations_take_the_coefficients_of_their_sea() -> None:
    """`simulate` in a sea equals the plain model with the coefficients that the power law gives for it."""
    plain = jh.load_model("volturnus-s-focal")
    powers = {"column.Cd_t": -0.5, "linear_damping.B11": 0.8}
    exponents = {(label, "significant_height"): power for label, power in powers.items()}
    laws = dataclasses.replace(plain, loads=with_exponents(plain.loads, exponents, REFERENCE))
    waves = jh.spectrum_components(lambda w: jh.jonswap(w, 6.0, 11.0), 200.0, plain.environment, low=0.03, cutoff=0.25, seed=1)
    sea, times = jh.IrregularSea(waves, plain.environment), np.arange(0.0, 60.0, 0.5)
    height = state_of(waves).significant_height / REFERENCE.significant_height
    assert height > 1.3
    changed = plain.with_values({label: height**power * plain.values[label] for label, power in powers.items()})
    positions, expected = (np.asarray(jh.simulate(model, times, sea).position) for model in (laws, changed))
    assert_allclose(positions, expected, atol=1e-9 * np.abs(expected).max())
    assert np.abs(positions - np.asarray(jh.simulate(plain, times, sea).position)).max() > 1e-3


@pytest.mark.parametrize(
    "change, pattern",
    [
        ({"exponents": {"colunm.Cd_t": {"peak_period": 1.0}}}, "sea_state_laws.exponents.colunm.Cd_t"),
        ({"exponents": {"column.Cd_t": {"peak_perod": 1.0}}}, "peak_perod"),
        ({"exponents": {"column.Cd_t": {"peak_period": 7.0}}}, ">= -3 and <= 3"),
        ({"reference": {"significant_height": 0.0, "peak_period": 10.0}}, "significant_height"),
    ],
)
def test_messages(change: dict, pattern: str, tmp_path) -> None:
    data = {
        "name": "test",
        "water": {"density": RHO, "depth": 200.0, "gravity": G},
        "rigid_body": BODY,
        "members": [COLUMN],
        "coefficients": {"column": COEFFICIENTS},
        "sea_state_laws": LAWS | {"exponents": {}} | change,
    }
    path = tmp_path / "platform.yaml"
    YAML().dump(data, path)
    with pytest.raises(jh.InputError, match=pattern):
        jh.load_model(path)
