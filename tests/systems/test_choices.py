"""What cannot be is refused where it is said, with the nearest word that is known; what can be, and what is traced, passes."""

import dataclasses
from typing import get_args

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxhydro as jh
from calibration.campaign.load_campaign import load_campaign
from calibration.commands import calibrate_command
from calibration.fitting.decay_fit import labels_of, space_of
from calibration.fitting.joint_fit import calibrate_jointly
from calibration.fitting.sea_fit import calibrate_in_waves
from calibration.residuals.wave_options import Options
from jaxhydro.choices import UnknownName, check, nearest, unknown
from jaxhydro.dynamics.conventions import Conventions, allowed_values
from jaxhydro.dynamics.integrate import Method, clock
from jaxhydro.dynamics.statics import stable_modes
from jaxhydro.dynamics.time_steps import default_step, memory_step
from jaxhydro.errors import InputError
from jaxhydro.interop.wamit_tables import to_omega
from jaxhydro.loads import LOADS
from jaxhydro.loads.sea_state_law import exponent_label, with_exponents
from jaxhydro.parameters import Parameter
from jaxhydro.platform.convergence import with_elements
from jaxhydro.waves.components import PlaneWaves
from jaxhydro.waves.pair_sums import elevation_spectrum
from jaxhydro.waves.recorded_waves import separated_record
from jaxhydro.waves.sea import Stretching
from jaxhydro.waves.second_order import bound_waves, transfer

CAMPAIGN = "jaxhydro/campaigns/volturnus-s-decays"
TIMES = np.arange(0.0, 4.0, 1.0)

CONVENTIONS = [field.name for field in dataclasses.fields(Conventions)]


@pytest.fixture(scope="module")
def model():
    return jh.load_model("volturnus-s")


@pytest.fixture(scope="module")
def waves(model):
    return jh.spectrum_components(lambda w: jh.jonswap(w, 3.0, 9.0), 120.0, model.environment, low=0.05, cutoff=0.2, seed=1)


@pytest.mark.parametrize(
    ("name", "wrong", "right"),
    [
        ("wetting", "Mean", "mean"),
        ("wetting", "instantanous", "instantaneous"),
        ("diffraction", "maccamy-fuchs", "maccamy_fuchs"),
        ("diffraction", "ramps", "ramp"),
        ("directions", "erth", "earth"),
        ("waves_at", "displacd", "displaced"),
        ("waves_at", "Mean", "mean"),
    ],
)
def test_a_convention_that_there_is_none_of_is_refused(model, name, wrong, right):
    with pytest.raises(ValueError, match=f"{name}: expected .* found '{wrong}'. Did you mean '{right}'?") as caught:
        model.with_conventions(**{name: wrong})
    assert isinstance(caught.value, UnknownName)
    assert getattr(model.with_conventions(**{name: right}).conventions, name) == right


@pytest.mark.parametrize("name", CONVENTIONS)
@pytest.mark.parametrize("wrong", ["", None, 1, 0, "True", 2.0, ["mean"], ("mean",), object(), {}])
def test_what_is_no_word_is_refused(model, name, wrong):
    with pytest.raises(UnknownName, match=f"{name}: expected"):
        Conventions(**{name: wrong})


def test_every_convention_of_the_model_is_checked(model):
    """All its static fields but the remarks, and every value that there is; an unknown convention is refused by its name."""
    static = {field.name for field in dataclasses.fields(model) if field.metadata.get("static")}
    assert static == {"conventions", "remarks"}
    for name in CONVENTIONS:
        assert getattr(Conventions(), name) == allowed_values(name)[0]
        for value in allowed_values(name):
            assert getattr(model.with_conventions(**{name: value}).conventions, name) == value
    with pytest.raises(UnknownName, match="wetting"):
        Conventions("Mean")
    with pytest.raises(UnknownName, match=r"no convention 'weting'; .* Did you mean 'wetting'\?"):
        model.with_conventions(weting="mean")


def test_seas_refuse_what_they_do_not_know(model, waves):
    plane = PlaneWaves.free(waves, model.environment)
    for make in (
        lambda **how: jh.IrregularSea(waves, model.environment, **how),
        lambda **how: jh.WaveSea(plane, model.environment, **how),
        lambda **how: Options(**how),
    ):
        with pytest.raises(ValueError, match=r"stretching: expected .* found 'vertcal'. Did you mean 'vertical'\?"):
            make(stretching="vertcal")
        for stretching in get_args(Stretching):
            assert make(stretching=stretching).stretching == stretching
    for make in (lambda **how: jh.IrregularSea(waves, model.environment, **how), lambda **how: Options(**how)):
        for how, pattern in (
            ({"order": 3}, "order: expected 1 or 2, found 3"),
            ({"order": True}, "order"),
            ({"order": "2"}, "order"),
            ({"acting": "everywher"}, "Did you mean 'everywhere'"),
            ({"kinds": ("sums",)}, "Did you mean 'sum'"),
            ({"kinds": "sum"}, "kinds"),
        ):
            with pytest.raises(UnknownName, match=pattern):
                make(**how)
        assert make(order=np.int64(2)).order == 2
    with pytest.raises(UnknownName, match="Did you mean 'ramp'"):
        Options(diffraction="rampe")


@pytest.mark.slow
def test_waves_refuse_what_they_do_not_know(model, waves):
    """In every function, not only where a sea is made."""
    environment, sea = model.environment, jh.IrregularSea(waves, model.environment)
    spectrum, band = (lambda w: jh.jonswap(w, 3.0, 9.0)), {"low": 0.05, "cutoff": 0.2}
    record = np.sin(np.arange(0.0, 60.0, 0.5))
    for call, pattern in (
        (lambda: jh.spectrum_components(spectrum, 120.0, environment, seed=1, amplitudes="raleigh", **band), "mean 'rayleigh'"),
        (lambda: separated_record(np.arange(0.0, 60.0, 0.5), record, environment, kinds=("sums",), **band), "mean 'sum'"),
        (lambda: separated_record(np.arange(0.0, 60.0, 0.5), record, environment, order=3, **band), "order: expected 1 or 2"),
        (lambda: bound_waves(waves, environment, ("sums",)), "Did you mean 'sum'"),
        (lambda: elevation_spectrum(waves, environment, jnp.zeros(2), ("sums",)), "Did you mean 'sum'"),
        (lambda: transfer(None, None, environment, "sums"), "Did you mean 'sum'"),
        (lambda: sea.gauge(TIMES, order=3), "order: expected 1, 2 or None, found 3"),
        (lambda: to_omega(1.0, "periods"), "by: .* Did you mean 'period'"),
        (lambda: with_elements(jh.load_platform("volturnus-s"), "colum", 2), "no group of members 'colum'.*mean 'column'"),
        (lambda: with_exponents(model.loads, {("column.Cd_T", "peak_period"): 0.0}, (1, 1)), "mean 'column.Cd_t"),
        (lambda: exponent_label("column.Cd_t", "peak_perod"), "over: .* Did you mean 'peak_period'"),
        (lambda: load_campaign(CAMPAIGN).record("surge-01x"), "no test 'surge-01x'; there are: "),
    ):
        with pytest.raises(UnknownName, match=pattern):
            call()


def test_integrators_are_known_by_name(model):
    for call in (
        lambda: jh.simulate(model, TIMES, method="tsit"),
        lambda: jh.free_decay(model, {"surge": 1.0}, TIMES, method="tsit"),
        lambda: default_step(model, "tsit"),
        lambda: memory_step(model, "tsit"),
        lambda: clock("tsit", 0.0, 1.0, 4),
    ):
        with pytest.raises(UnknownName, match=r"method: expected .* found 'tsit'. Did you mean 'tsit5'\?"):
            call()
    with pytest.raises(UnknownName, match=r"adjoint: .* found 'revers'. Did you mean 'reverse'\?"):
        jh.simulate(model, TIMES, adjoint="revers")
    for method in get_args(Method):
        assert np.isfinite(default_step(model, method))


def convergence_of_pich():
    return jh.convergence("volturnus-s", jh.StillWater(), TIMES, elements=(1, 2), dofs=("pich",), peak_period=9.0)


def test_motions_are_known_by_name(model):
    modes, still = jh.natural_modes(model), jh.simulate(model, TIMES, step=1.0)
    for call in (
        lambda: modes.of("pich"),
        lambda: still["pich"],
        lambda: jh.free_decay(model, {"pich": 0.1}, TIMES),
        lambda: jh.simulate(model, TIMES, position={"pich": 0.1}),
        lambda: jh.simulate(model, TIMES, rate={"pich": 0.1}),
        lambda: stable_modes(model, ["pich"]),
        convergence_of_pich,
    ):
        with pytest.raises(KeyError, match=r"no degree of freedom 'pich'; .*surge.* Did you mean 'pitch'\?"):
            call()
    with pytest.raises(ValueError, match="no degree of freedom 3"):
        modes.of(3)


def test_labels_are_known_by_name(model):
    for call in (lambda: model.about("column.Cd_T"), lambda: model.with_values({"column.Cd_T": 1.0})):
        with pytest.raises(KeyError, match=r"no parameter 'column.Cd_T'; there are: .* Did you mean 'column.Cd_t'\?"):
            call()
    assert str(unknown("parameter", "x", [])) == "no parameter 'x'; there are: none"


@pytest.mark.parametrize("label", ["column.Cd_t", "column.Ca_t", "pontoon.Cd_z", "linear_damping.B11"])
@pytest.mark.parametrize("value", [-1.2, np.nan, np.inf, -1e-6, jnp.asarray(-1.0), [1.0, -1.0], "1,2", None])
def test_values_that_cannot_be_are_refused(model, label, value):
    with pytest.raises(ValueError, match=f"{label}: expected a (finite )?number"):
        model.with_values({label: value})


def test_values_that_can_be_are_taken(model):
    """Zero, and what is beyond the range that a fit looks in: a plate's drag."""
    for label in ("column.Cd_t", "column.Ca_t", "linear_damping.B11"):
        for value in (0, 0.0, 31.0, 1e9, np.float32(2.0), jnp.asarray(3.0)):
            assert float(model.with_values({label: value}).values[label]) == float(value)


@pytest.mark.parametrize("name", LOADS)
def test_a_sign_is_asked_for_where_physics_has_one_alone(name):
    """A parameter whose range goes below zero may be negative, as far as one likes; others are sizes."""
    free, size = Parameter("N", "a force", -1.0, 1.0), Parameter("s", "a time", 0.005, 1.0)
    free.check("x", -1e9)
    size.check("x", 1e9)
    with pytest.raises(ValueError, match=r"x: expected a finite number of 0 or more \(s: a time\), found -1"):
        size.check("x", -1.0)
    for bad in (np.nan, np.inf, -np.inf):
        with pytest.raises(ValueError, match="x: expected a finite number"):
            free.check("x", bad)


def test_traced_values_pass(model):
    """As in a gradient that looks at both sides, under jit and vmap."""

    @eqx.filter_jit
    def drag(value):
        return model.with_values({"column.Cd_t": value}).values["column.Cd_t"]

    assert float(drag(jnp.asarray(-1.2))) == -1.2
    assert float(jax.grad(lambda x: drag(x) ** 2)(jnp.asarray(-1.0))) == -2.0
    assert jax.vmap(drag)(jnp.array([-1.0, jnp.nan]))[0] == -1.0
    assert float(model.at_values({"column.Cd_t": -1e-18}).values["column.Cd_t"]) == -1e-18


def test_fits_do_not_check_what_they_try(model, monkeypatch):
    """The optimiser's way to a model goes past the checks, jitted or not."""
    campaign = load_campaign(CAMPAIGN)
    space = space_of(campaign, labels_of(campaign, model, ["surge"], None), model)
    monkeypatch.setattr(Parameter, "check", None)
    space.model(model, space.start)


def test_calibrations_know_their_objectives():
    campaign = load_campaign(CAMPAIGN)
    with pytest.raises(UnknownName, match=r"objective: .* found 'band'. Did you mean 'bands'\?"):
        calibrate_in_waves(campaign, objective="band")
    with pytest.raises(UnknownName, match=r"over: .* Did you mean 'peak_period'"):
        calibrate_in_waves(campaign, over=("peak_perod",))
    with pytest.raises(UnknownName, match=r"drag: .* Did you mean 'high_pass'"):
        calibrate_in_waves(campaign, drag="highpass")
    with pytest.raises(UnknownName, match="objective"):
        calibrate_jointly(campaign, objective="band")
    with pytest.raises(UnknownName, match=r"loss: .* Did you mean 'cauchy'"):
        calibrate_jointly(campaign, loss="cauchi")
    with pytest.raises(UnknownName, match=r"kinds: .* Did you mean 'decays'"):
        calibrate_jointly(campaign, kinds=("decay",))


def test_a_message_is_plain_text():
    """Not in quotes, as KeyError's are."""
    error = unknown("motion", "pich", ["pitch", "roll"])
    assert str(error) == "no motion 'pich'; there are: pitch, roll. Did you mean 'pitch'?"
    assert isinstance(error, KeyError) and isinstance(error, ValueError)
    assert nearest("PITCH", ["pitch"]) == "pitch" and nearest("x", ["pitch"]) == ""
    check(method=("a", ("a", None)), other=(None, ("a", None)))


def test_a_search_of_another_name_is_refused(tmp_path):
    with pytest.raises(InputError, match="expected multistart, found 'ga'"):
        calibrate_command.run(load_campaign(CAMPAIGN), tmp_path, method="ga")
