"""Diagnosis: frequency bands, and rolling bodies made by SciPy with an effect in them, or none."""

from time import monotonic
from types import SimpleNamespace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from ruamel.yaml import YAML
from scipy.integrate import solve_ivp

import jaxhydro as jh
from calibration import calibrate
from calibration.campaign.load_campaign import load_campaign
from calibration.discovery import checkpoint, mass_properties_check
from calibration.discovery.acceptance import Verdict
from calibration.discovery.diagnose import diagnose
from calibration.discovery.doubts import abandoned_decays
from calibration.discovery.effects.candidates import Candidate, with_effects
from calibration.discovery.effects.catalogue import catalogue
from calibration.discovery.effects.catalogue_builder import noticeable_scales
from calibration.discovery.fit_state import ResidualSummary
from calibration.discovery.frequency_bands import FourierRows, cut_into_bands
from calibration.discovery.linearisations import Point, Prior
from calibration.discovery.mass_properties_check import with_mass_properties
from calibration.discovery.refusal import Refusal, RefusalKind
from calibration.discovery.reported_effects import IMPLAUSIBLE_SIZE
from calibration.discovery.search import Search, SearchRecord
from calibration.discovery.study_set_up import set_up_study
from calibration.residuals.wave_options import Options
from calibration.results.refusal_sentences import describe_refusal
from jaxhydro.dynamics.statics import equilibrium, linearised
from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError
from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.parameters import parameter

PLATFORM = {
    "name": "a rolling body",
    "water": {"density": 1000.0, "depth": 5.0, "gravity": 9.81},
    "rigid_body": {"mass": 994.0, "centre_of_mass": [0.0, 0.0, 0.0], "inertia": {"Ixx": 115.7, "Iyy": 1376.0, "Izz": 1376.0}},
    "members": [],
    "added_mass": {"A44": 20.0},
    "linear_damping": {"B44": 3.0},
    "hydrostatics": {"C44": 822.0},
    "mooring": {"kind": "none"},
}
NOISE = 2e-4  # rad


def release(amplitude: float, torque, seed: int, swinging=None) -> tuple[np.ndarray, np.ndarray]:
    """Roll of a body released at rest, with a torque (N m) of angle and rate beside what the platform file has; and noise.
    `swinging` in it: inertia, period and damping ratio of what is on a spring."""
    time = np.arange(0.0, 60.0, 0.05)
    inertia, period, ratio = swinging or (1.0, 1.0, 0.0)
    own = 2 * np.pi / period

    def rate(_, y):
        roll, speed, apart, moved = y
        pull = own**2 * apart + 2 * ratio * own * (moved - speed) if swinging else 0.0
        turn = -822.0 * np.sin(roll) - 2.4 * speed + torque(roll, speed) + inertia * pull
        return [speed, turn / (115.7 + 23.0), moved - speed, -pull]

    solution = solve_ivp(rate, (0, 60), [amplitude, 0.0, 0.0, 0.0], t_eval=time, rtol=1e-9, atol=1e-11)
    return time, solution.y[0] + np.random.default_rng(seed).normal(0, NOISE, time.size)


def campaign_of(folder, torque, swinging=None):
    """Three decays of one body: two to fit, one held out."""
    tests = []
    for i, (amplitude, use) in enumerate([(0.10, "fit"), (0.30, "fit"), (0.22, "holdout")]):
        time, roll = release(amplitude, torque, i, swinging)
        columns = np.column_stack([time, roll])
        np.savetxt(folder / f"roll-{i}.csv", columns, "%.6f", ",", header="time_s,roll_rad", comments="")
        tests.append({"id": f"roll-{i}", "kind": "decay", "degree_of_freedom": "roll", "file": f"roll-{i}.csv", "use": use})
    manifest = {
        "name": "made by SciPy",
        "platform": "platform.yaml",
        "scale": 1.0,
        "channels": {"time": {"column": "time_s", "unit": "s"}, "roll": {"column": "roll_rad", "unit": "rad"}},
        "noise": {"roll": NOISE},
        "tests": tests,
    }
    for name, data in (("campaign.yaml", manifest), ("platform.yaml", PLATFORM)):
        with (folder / name).open("w") as file:
            YAML().dump(data, file)
    return load_campaign(folder)


def test_bands_are_a_partition_of_the_lines():
    """Every Fourier line up to the highest frequency is in one band; degrees of freedom are the record's, not the zeros'."""
    cut = cut_into_bands(100.0, 0.1, 1500, 9, 1.0)
    frequency = np.fft.rfftfreq(1500, 0.1)
    assert_allclose(cut.member.sum(axis=0), 1.0)
    assert cut.member.shape[1] == (frequency <= 1.0).sum()
    assert_allclose(2 * cut.lines[1:].sum() + 1, 2 * 100.0 * 1.0, rtol=0.02)


def test_rows_hold_the_sum_of_squares():
    """Parseval: products over rows are those over samples, series by series."""
    rng = np.random.default_rng(0)
    values = rng.normal(size=(2, 401, 3))  # an odd number has no line at half the sampling rate
    cut = cut_into_bands(40.1, 0.1, 401, 12, 6.0)  # all frequencies
    rows = FourierRows.of([cut, cut], 401)
    all_rows = rows(values)
    for i, samples in enumerate(values):
        series_rows = all_rows[rows.series == i]
        assert_allclose(series_rows.T @ series_rows, samples.T @ samples, rtol=1e-10, atol=1e-10)
    assert_allclose(rows(values[..., 0]), all_rows[:, 0])


def test_a_series_without_rows_keeps_its_place():
    """A motion that a record lacks has no lines, and is counted all the same: what comes after it stays where it was."""
    cut = cut_into_bands(40.1, 0.1, 401, 12, 6.0)
    nothing = cut._replace(member=np.zeros_like(cut.member))
    rows = FourierRows.of([cut, nothing], 401)
    assert rows.members == 2
    assert set(rows.series) == {0}


@pytest.mark.slow
def test_an_effect_of_the_platform_file_is_no_candidate(tmp_path):
    """What is declared is fitted, not looked for."""
    campaign = campaign_of(tmp_path, lambda x, v: 0.0)
    names = {candidate.name for candidate in set_up_study(campaign, Options()).candidates}
    assert {"coulomb_friction (roll)", "nonlinear_hydrostatics (roll)", "quadratic_damping (roll)"} <= names
    assert not any("surge" in name for name in names)


def test_a_term_that_is_declared_zero_is_a_candidate(tmp_path):
    """And one that is declared and fitted is none: a unit of its direction is a unit of its logarithm."""
    campaign = campaign_of(tmp_path, lambda x, v: 0.0)
    setup = set_up_study(campaign, Options())
    assert "linear_damping (roll)" not in {candidate.name for candidate in setup.candidates}
    assert (np.abs(setup.study.directions[setup.study.index(setup.base)]).max(axis=1) == 1.0).all()
    for change in ({"linear_damping": {"B44": 0.0}}, {"linear_damping": {}}):
        with (tmp_path / "platform.yaml").open("w") as file:
            YAML().dump(PLATFORM | change, file)
        names = {candidate.name for candidate in set_up_study(load_campaign(tmp_path), Options()).candidates}
        assert {"linear_damping (roll)", "stiffness (roll)"} <= names


def found_in(campaign, **how):
    return diagnose(campaign.model, campaign, **how)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("torque", "expected", "error_ratio"),  # `error_ratio`: share of the held-out decay's error
    [
        (lambda x, v: 0.0, None, 1.0),
        (lambda x, v: -500.0 * x**3, "nonlinear_hydrostatics", 0.05),
        (lambda x, v: -0.3 * np.tanh(v / 2e-3), "coulomb_friction", 0.3),
    ],
    ids=["nothing", "hydrostatics", "friction"],
)
def test_what_a_rolling_body_lacks(tmp_path, torque, expected, error_ratio):
    """The effect is named, the held-out decay comes down, and its band holds it; where there is none, none is named."""
    diagnosis = found_in(campaign_of(tmp_path, torque))
    predicted = [prediction for prediction in diagnosis.predictions if prediction.test == "roll-2"]
    assert len(predicted) == len(diagnosis.predictions) == 1
    assert predicted[0].model_error >= NOISE
    if expected is None:
        assert diagnosis.verdict == "nothing_missing"
        assert not diagnosis.effects
        assert abs(predicted[0].inside - 0.95) < 3 * np.sqrt(0.95 * 0.05 / 1200)
        return
    assert predicted[0].inside > 0.93
    assert diagnosis.verdict == "found"
    assert expected in {diagnosis.effects[0].effect, *(name.split(" ")[0] for name in diagnosis.effects[0].indistinguishable)}
    held = [series for series in diagnosis.anatomy_after if series.use == "holdout"]
    before = [series for series in diagnosis.anatomy_before if series.use == "holdout"]
    assert held[0].rms < error_ratio * before[0].rms


@pytest.mark.slow
def test_linear_damping_that_is_declared_zero_is_found(tmp_path):
    """With its size: 2.4 N m s/rad of linear damping, by which the body loses its motion."""
    campaign_of(tmp_path, lambda x, v: 0.0)
    with (tmp_path / "platform.yaml").open("w") as file:
        YAML().dump(PLATFORM | {"linear_damping": {"B44": 0.0}}, file)
    diagnosis = found_in(load_campaign(tmp_path))
    assert [effect.effect for effect in diagnosis.effects] == ["linear_damping"]
    assert diagnosis.effects[0].evidence.probability > 0.9
    assert diagnosis.effects[0].parameters["linear_damping.B44"].value == pytest.approx(2.4, rel=0.05)


@pytest.mark.slow
def test_a_size_beyond_what_is_plausible_is_not_named(tmp_path):
    """Something acts like the law, which cannot be so large where the campaign says what is plausible."""
    campaign_of(tmp_path, lambda x, v: -500.0 * x**3)
    manifest = tmp_path / "campaign.yaml"
    manifest.write_text(manifest.read_text() + "plausible:\n  nonlinear_hydrostatics: 0.2 %\n")
    diagnosis = found_in(load_campaign(tmp_path))
    hydrostatics = [effect for effect in diagnosis.effects if effect.effect == "nonlinear_hydrostatics"]
    assert all(effect.in_doubt == IMPLAUSIBLE_SIZE for effect in hydrostatics)
    assert all(
        size.lower <= effect.parameters[k].value <= size.upper
        for effect in hydrostatics
        for k, size in effect.plausible.items()
    )


# a body that rolls in 2.58 s: off its period, near it, where it makes two modes of one, and heavy enough for that further off
@pytest.mark.slow
@pytest.mark.parametrize(("inertia", "period"), [(0.4, 2.35), (0.42, 2.7), (2.8, 3.1)], ids=["off", "near", "heavy"])
def test_what_swings_in_a_rolling_body(tmp_path, inertia, period):
    """Named, with its period, which no coarse search would meet: a resonance is some hundredths of it wide."""
    diagnosis = found_in(campaign_of(tmp_path, lambda roll, speed: 0.0, (inertia, period, 0.02)))
    assert [effect.effect for effect in diagnosis.effects] == ["hidden_oscillator"]
    by_name = {label.split(".")[-1]: parameter for label, parameter in diagnosis.effects[0].parameters.items()}
    for name, true in {"mass": inertia, "period": period, "damping_ratio": 0.02}.items():
        assert by_name[name].value == pytest.approx(true, rel=0.01, abs=4 * by_name[name].standard_deviation), name
    assert by_name["period"].standard_deviation < 0.01
    # a small body's centre is known as well, for its size, as a large one's
    assert by_name["mass"].standard_deviation < 0.1 * inertia


@pytest.mark.slow
def test_blocks_left_out_in_turn_where_no_test_is_held_out(tmp_path, monkeypatch):
    """A coefficient that two blocks give follows the third one, too. And a search that was killed goes on from the effect that
    it had let in, of the same campaign alone."""
    campaign_of(tmp_path, lambda x, v: -500.0 * x**3)
    manifest = tmp_path / "campaign.yaml"
    manifest.write_text(manifest.read_text().replace("holdout", "fit"))
    campaign, path, seen = load_campaign(tmp_path), tmp_path / "under-way", []

    def killed(progress):
        if progress.stage.startswith("round 2"):
            raise RuntimeError("killed")

    with pytest.raises(RuntimeError, match="killed"):
        found_in(campaign, progress=killed, checkpoint=path)
    begun = monotonic()
    diagnosis = found_in(campaign, progress=lambda progress: seen.append(progress.stage), checkpoint=path)
    assert diagnosis.seconds > monotonic() - begun  # with what the first run took
    assert not any(stage.startswith(("fitting the baseline", "round 1")) for stage in seen)
    assert [effect.effect for effect in diagnosis.effects] == ["nonlinear_hydrostatics"]
    assert 0.9 < diagnosis.effects[0].evidence.holdout_gain < 1.0
    nothing = SimpleNamespace()
    monkeypatch.setattr(checkpoint, "fingerprint", lambda search: "of another campaign")
    assert checkpoint.load_checkpoint(path, nothing) == []
    path.write_bytes(path.read_bytes()[:1000])
    assert checkpoint.load_checkpoint(path, nothing) == []
    assert checkpoint.load_checkpoint(tmp_path / "none", nothing) == []


class Sine(AbstractLoad):
    """A torque in roll of one's own: -k sin(10 x)."""

    strength: jax.Array = parameter("N m", "strength of a torque that repeats")
    label_prefix = "repeating"

    def act(self, now, memory):
        torque = -self.strength * jnp.sin(10 * now.position[3])
        return Action(force=jnp.zeros(6).at[3].set(torque))


@pytest.mark.slow
def test_a_law_of_ones_own_takes_part(tmp_path):
    """What no candidate of the catalogue follows as well is found by one's own, and the model has it afterwards."""
    own = Candidate(
        "repeating",
        "roll",
        ("repeating.strength",),
        load=Sine(),
        sizes={"repeating.strength": 1.0},
    )
    diagnosis = found_in(campaign_of(tmp_path, lambda x, v: -4.0 * np.sin(10 * x)), candidates=[own])
    assert diagnosis.effects[0].effect == "repeating"
    assert_allclose(float(diagnosis.augmented.model.values["repeating.strength"]), 4.0, rtol=0.05)
    assert diagnosis.augmented.objective("holdout") < 0.1 * diagnosis.baseline.objective("holdout")


class Runaway(AbstractLoad):
    """Roll torque from a memory that grows without end: silent at its neutral value, and nothing can be said of its slopes."""

    strength: jax.Array = parameter("N m s/rad", "strength of a torque that runs away")

    def rest(self):
        return jnp.zeros(())

    def act(self, now, memory):
        force = jnp.zeros(6).at[3].set(self.strength * memory)
        return Action(force=force, memory_rate=6.0 * memory + now.earth_velocity()[3])


@pytest.mark.slow
def test_a_law_whose_slopes_overflow_is_passed_over(tmp_path):
    """The others are scored as ever, whatever one of them does off its neutral value."""
    own = Candidate(
        "runaway",
        "roll",
        ("runaway.strength",),
        load=Runaway(),
        sizes={"runaway.strength": 1.0},
    )
    diagnosis = found_in(campaign_of(tmp_path, lambda x, v: -500.0 * x**3), candidates=[own])
    assert [effect.effect for effect in diagnosis.effects] == ["nonlinear_hydrostatics"]
    assert "improbable" in next(
        describe_refusal(rejected.reason) for rejected in diagnosis.rejected if rejected.effect == "runaway"
    )


@pytest.mark.slow
def test_a_model_of_ones_own_is_calibrated(tmp_path):
    """With a load that no platform file has, freed by its label like any other."""
    campaign = campaign_of(tmp_path, lambda x, v: -4.0 * np.sin(10 * x))
    own = campaign.with_model(campaign.model.with_effect(Sine(3.0)))
    result = calibrate(own, free=["added_mass.A44", "linear_damping.B44", "repeating.strength"])
    assert_allclose(result.parameters["repeating.strength"].value, 4.0, rtol=0.05)
    with pytest.raises(InputError, match=r"repeating\.strength"):
        calibrate(campaign, free=["repeating.strength"])


@pytest.mark.parametrize(
    ("inertia", "deviation", "reported"), [(2.6, 0.17, True), (1.6, 0.17, False), (2.6, 0.9, False), (2.1, 0.17, False)]
)
def test_what_was_weighed_wrongly_is_told(monkeypatch, inertia, deviation, reported):
    """Where it is beyond two of the deviations by which laboratories are wrong, clearly: an error that every fit may make up
    for shows in none. Named as what it is, whatever the other rules say of an effect that takes no error away."""
    mass = Candidate("mass_properties", None, ("mass", "mass_properties.inertia_pitch"))
    nearly, free = (Prior(np.zeros(2), np.full(2, width)) for width in (1.0, 30.0))

    def away(study, point, prior):
        z = point.x / prior.width
        return z * (1 + (z / 3) ** 2), 0

    def state(x, chosen=()):
        linearisation = SimpleNamespace(point=Point(np.array(x), None), active=(0, 1))
        return SimpleNamespace(linearisation=linearisation, chosen=chosen, likelihood=np.zeros(1))

    monkeypatch.setattr(mass_properties_check, "deviations_of", lambda *_: np.array([0.1, deviation]))
    monkeypatch.setattr(mass_properties_check, "prior_residuals", away)
    after = state([0.1, inertia], (mass,))
    fits = SimpleNamespace(
        setup=SimpleNamespace(candidates=[mass], prior=nearly),
        count=500.0,
        study=SimpleNamespace(used=np.array([True]), index=lambda _: [0, 1], steps=lambda x: x),
        refit_from=lambda *_: after,
        prior=lambda chosen: free if chosen else nearly,
        likelihood_gain=lambda *_: 0.0,
        assess=lambda *_, **__: Verdict(-20.0, 0.0, True, 0.0, 0.0, 0.0, Refusal(RefusalKind.NEGLIGIBLE)),
    )
    record = SearchRecord()
    concluded = with_mass_properties(Search(fits, record), state([0.1, 0.9 * inertia]))
    assert (concluded is after) == reported == ("mass_properties" in record.accepted)
    if reported:
        evidence = record.accepted["mass_properties"].verdict
        assert evidence.refused is None and np.isnan(evidence.bic)  # which is of errors
        assert record.notes[0].startswith("inertia pitch is further from the platform file's values")


def test_a_decay_that_the_seas_take_away_is_said():
    """Of fitted decays, in their own motion; not where little is left, nor where it was no better alone."""
    series = [
        SimpleNamespace(test=test, kind=kind, channel="surge", spread=2.0)
        for test, kind in (("a", "decay"), ("b", "decay"), ("c", "decay"), ("d", "irregular"), ("e", "decay"), ("f", "decay"))
    ]
    used, main = np.array([True, True, True, True, False, True]), np.array([True, True, True, True, True, False])
    study = SimpleNamespace(series=series, used=used, main=main)
    alone, now = (
        ResidualSummary(np.zeros((6, 1)), np.array(error)[:, None], np.zeros(6))
        for error in ([0.1, 0.1, 0.6, 0.1, 0.1, 0.1], [1.5, 0.19, 1.5, 1.5, 1.5, 1.5])
    )
    (note,) = abandoned_decays(study, alone, now)
    assert "the decay a is given up: 75 % of its motion is left, 5 % where decays are fitted alone" in note


def test_every_candidate_can_be_put_into_a_model_of_the_platform():
    """By its labels alone, as a file of a diagnosis has them; amplitudes silent."""
    model = jh.load_model("volturnus-s")
    mass, stiffness = (np.asarray(m) for m in linearised(model, equilibrium(model)))
    scales = noticeable_scales(mass, stiffness, dict.fromkeys(DOFS, 0.1))
    candidates, free, units = catalogue(model, scales, True, 1.0)
    assert {"wave_excitation", "wave_drift", "umbilical", "amplitude_dependent_drag"} <= {
        candidate.effect for candidate in candidates
    }
    for candidate in candidates:
        changed = with_effects(model, candidate.labels)
        assert set(candidate.labels) <= set(changed.values), candidate.name
        added = [label for label in candidate.amplitudes if label not in model.values]  # other terms are declared
        assert [float(changed.values[label]) for label in added] == [free[label].start for label in added]
        assert all(units[label] > 0 for label in candidate.amplitudes)


def test_no_beach_is_within_half_a_wavelength_of_the_platform():
    """A shorter delay of reflected waves only gives slopes: a fit with it would shift phases, as a clock or the gauge does."""
    model = jh.load_model("volturnus-s")
    mass, stiffness = (np.asarray(m) for m in linearised(model, equilibrium(model)))
    scales = noticeable_scales(mass, stiffness, dict.fromkeys(DOFS, 0.1))
    candidates, _, _ = catalogue(model, scales, True, 1.0, peak_period=12.0)
    (reflection,) = [candidate for candidate in candidates if candidate.effect == "wave_reflection"]
    delay = "wave_reflection.delay"
    assert reflection.shape_limits[delay][0] == 24.0
    assert [reflection.is_plausible_at({delay: value}) for value in (0.0, 23.9, 24.1, 90.0)] == [False, False, True, True]
    assert all(candidate.is_plausible_at({}) for candidate in candidates)
