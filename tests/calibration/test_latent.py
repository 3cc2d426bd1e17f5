"""The latent force: torques known in closed form found back from decays made by SciPy, laws named, and none in noise."""

import json
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import jsonschema
import numpy as np
import pytest
from fake_diagnosis import fake_diagnosis
from numpy.testing import assert_allclose
from ruamel.yaml import YAML
from scipy.integrate import solve_ivp
from scipy.signal import hilbert
from test_discovery import NOISE, PLATFORM

from calibration.discovery.campaign_study import highest_frequency
from calibration.discovery.latent_force.describe_force import described
from calibration.discovery.latent_force.force_law import RegressionBlock, best_terms, law_of
from calibration.discovery.latent_force.force_words import law_in_words
from calibration.discovery.latent_force.recover_force import forces_of, latent_forces, latent_of
from calibration.discovery.latent_force.recovered_force import RecoveredForce, ResampledTest
from calibration.discovery.latent_force.term_library import LAGGED_TERMS, STILL_WATER_TERMS
from calibration.discovery.reported_forces import Law, LawTerm
from calibration.report.write_report import write_report
from calibration.result import Series, TestFit
from calibration.results.diagnosis_file import read_diagnosis
from calibration.results.write_diagnosis import write_diagnosis
from jaxhydro.dynamics.simulate import free_decay
from jaxhydro.platform.build import load_model
from jaxhydro.waves.sea import StillWater

TIME = np.arange(0.0, 60.0, 0.05)
RELEASES = ((0.10, "fit"), (0.30, "fit"), (0.22, "holdout"))  # rad
SCHEMA = Path(__file__).resolve().parents[2] / "calibration" / "outputs.schema.json"


def cubic(x, v):
    return -500.0 * x**3


def friction(x, v):
    return -0.3 * np.tanh(v / 2e-3)


def drag(x, v):
    return -2.0 * np.abs(v) * v


def repeating(x, v):
    return -4.0 * np.sin(10 * x)


def nothing(x, v):
    return 0.0 * x


@cache
def rolled(torque, amplitude: float) -> np.ndarray:
    """Roll and its rate of a body with a torque (N m) beside what the platform file has."""

    def rate(_, y):
        return [y[1], (-822.0 * np.sin(y[0]) - 2.4 * y[1] + torque(*y)) / (115.7 + 23.0)]

    return solve_ivp(rate, (0, 60), [amplitude, 0.0], t_eval=TIME, rtol=1e-9, atol=1e-11).y


@pytest.fixture(scope="module")
def model(tmp_path_factory):
    """A rolling body that lacks nothing but what the tests add; its damping may be wrong, as a fit would leave it."""
    folder = tmp_path_factory.mktemp("platform")

    @cache
    def made(damping=2.4):
        with (folder / "platform.yaml").open("w") as file:
            YAML().dump({**PLATFORM, "added_mass": {"A44": 23.0}, "linear_damping": {"B44": damping}}, file)
        return load_model(folder / "platform.yaml")

    return made


def decays(model, torque, seed=0, releases=RELEASES) -> list[tuple[ResampledTest, np.ndarray]]:
    """Decays with a torque (N m) that the model does not have, and the torque along them."""
    tests_and_torques = []
    for i, (amplitude, use) in enumerate(releases):
        roll, speed = rolled(torque, amplitude)
        measured = roll + np.random.default_rng(10 * seed + i).normal(0, NOISE, TIME.size)
        simulated = np.asarray(free_decay(model, {"roll": amplitude}, TIME).position[:, 3])
        test = ResampledTest(
            f"roll-{i}", use, "decay", TIME, {"roll": measured}, {"roll": simulated}, {"roll": NOISE}, StillWater()
        )
        tests_and_torques.append((test, torque(roll, speed)))
    return tests_and_torques


@pytest.mark.slow
@pytest.mark.parametrize(
    ("torque", "least"),  # `least`: correlation with the torque, of which noise hides what dry friction does fast
    [(cubic, 0.93), (friction, 0.88), (repeating, 0.99)],
)
def test_the_force_is_found_back(model, torque, least):
    """Inside the record it is the torque that SciPy had, as far as it can be seen: 0.998 correlated, to 0.6 % of its size."""
    for test, true in decays(model(), torque):
        recovered = forces_of(model(), test, np.zeros(6), highest_frequency(model()))["roll"]
        inside = recovered.inside
        assert recovered.visible and inside.stop - inside.start > 0.85 * len(TIME)
        assert np.corrcoef(recovered.force[inside], true[inside])[0, 1] > least
        seen = recovered.through_filter(true)[inside]
        assert np.corrcoef(recovered.force[inside], seen)[0, 1] > 0.995
        assert_allclose(np.std(recovered.force[inside]), np.std(seen), rtol=0.02)
        assert np.std(recovered.force[inside] - seen) < 3 * recovered.noise + 0.02 * np.std(seen)


@pytest.mark.parametrize(
    ("torque", "damping", "expected", "power"),
    [
        (cubic, 2.4, {"x^3": -500.0}, 3.0),
        (friction, 2.4, {"tanh(v/v0)": -0.3}, 0.0),
        (friction, 3.0, {"tanh(v/v0)": -0.3, "v": 0.6}, None),  # a fit has hidden some of it in the damping
        (drag, 2.4, {"|v| v": -2.0}, 2.0),
    ],
    ids=["cubic", "friction", "friction-hidden", "drag"],
)
def test_the_law_is_named(model, torque, damping, expected, power):
    """Its terms, coefficients, the share of the held-out decay that it explains, and how the force grows."""
    tests = [test for test, _ in decays(model(damping), torque)]
    (force,) = latent_forces(model(damping), tests, ["roll"], False)
    terms = {term.name: term.coefficient for term in force.law.terms}
    assert set(terms) == set(expected)
    for name, value in expected.items():
        assert_allclose(terms[name], value, rtol=0.15)
    assert force.law.share > 0.9 and force.law.checked == "held-out tests"
    assert (force.motion, force.unit) == ("roll", "N m")
    if power is not None:
        assert_allclose(force.growth["amplitude"], power, atol=0.2)
        assert f"{next(iter(expected))} explains" in force.words
    assert_allclose(sum(force.shares["decay"].values()), 1.0)
    follows = force.coherence["decay"]
    along, across = ("position", "velocity") if torque is cubic else ("velocity", "position")
    assert follows[along].correlation < (-0.8 if damping == 2.4 else -0.5)
    assert np.cos(follows[along].phase) < -0.95 and abs(follows[across].correlation) < 0.1
    assert_allclose(follows[across].phase, np.pi / 2 if torque is cubic else -np.pi / 2, atol=0.1)


def test_a_law_is_said_in_seconds_and_units():
    """Not in omegas: the time constant of a lag, the speed at which friction turns."""
    lag, turns = LAGGED_TERMS[1], [kind.name for kind in STILL_WATER_TERMS].index("tanh(v/v0)")
    terms = tuple(LawTerm(STILL_WATER_TERMS[i].name, -2.0, "N m", i) for i in (lag, turns))
    sentence = law_in_words(Law(terms, 0.8, 0.9, "held-out tests", v0=0.02, pace=0.5), "N m")
    assert "v lagged by a time constant of 2.0 s" in sentence and sentence.endswith("v0 = 0.020 rad/s")
    sentence = law_in_words(Law(terms[1:], 0.8, 0.9, "held-out tests", v0=0.02), "N")
    assert "lagged" not in sentence and sentence.endswith("v0 = 0.020 m/s")


def test_blocks_left_out_in_turn(model):
    """Where no test is held out."""
    tests = [test for test, _ in decays(model(), cubic, releases=[(0.15, "fit"), (0.3, "fit")])]
    law = latent_forces(model(), tests, ["roll"], False)[0].law
    assert law.checked == "blocks left out in turn" and law.share > 0.9
    assert [term.name for term in law.terms] == ["x^3"] and law.terms[0].unit == "N m/rad3"


@pytest.mark.parametrize("seed", range(4))
def test_nothing_is_named_in_noise(model, seed):
    """A model that lacks nothing: no force."""
    tests = [test for test, _ in decays(model(), nothing, seed)]
    assert latent_forces(model(), tests, ["roll"], False) == ()


def sea(height: float, seed: int, use: str, law) -> RecoveredForce:
    """A force in waves of a spectrum about 0.1 Hz, on a body that drifts about on its own, with noise of a tenth of it."""
    rng, step, n = np.random.default_rng(seed), 0.5, 7200
    frequency = np.fft.rfftfreq(n, step)

    def random(peak: float, width: float) -> np.ndarray:
        lines = rng.standard_normal((2, len(frequency))) * np.exp(-0.5 * ((frequency - peak) / width) ** 2)
        values = np.fft.irfft(lines[0] + 1j * lines[1], n)
        return values / values.std()

    wave, position = 0.25 * height * random(0.1, 0.012), 3.0 * random(0.01, 0.003)
    force = law(wave)
    force = force + 0.1 * np.std(force) * random(0.05, 0.05)
    velocity, time = np.gradient(position, step), step * np.arange(n)
    test = ResampledTest(
        f"sea-{seed}", use, "irregular", time, {"surge": position}, {"surge": 0 * position}, {}, StillWater(), wave
    )
    gain = np.ones(len(frequency))
    return RecoveredForce(
        test,
        "surge",
        force,
        position,
        velocity,
        np.gradient(velocity, step),
        (position, velocity),
        gain,
        np.ones(n),
        slice(100, n - 100),
        0.01 * float(np.std(force)),
        1e3,
    )


def test_slow_drift_goes_with_the_squared_envelope():
    """A force like the envelope's square, Hs^2, is said to be so; not to go with the elevation."""
    forces = [
        sea(height, i, use, lambda wave: 4e4 * np.abs(hilbert(wave)) ** 2)
        for i, (height, use) in enumerate([(3.0, "fit"), (7.0, "fit"), (5.0, "holdout")])
    ]
    description = described("surge", forces, law_of("surge", forces))
    follows = description.coherence["waves"]
    assert follows["squared_envelope"].coherence > 0.9 and abs(follows["squared_envelope"].phase) < 0.05
    assert follows["elevation"].coherence < 0.3 and follows["velocity"].coherence < 0.3
    assert description.shares["waves"]["wave_frequency"] < 0.05
    assert_allclose(description.growth["significant_height.low_frequency"], 2.0, atol=0.2)
    assert [(term.name, term.unit) for term in description.law.terms] == [("eta^2 slow", "N/m2")]
    assert_allclose(description.law.terms[0].coefficient, 4e4, rtol=0.05)
    assert description.law.share > 0.9 and "coherent with the squared wave envelope" in description.words


@pytest.mark.parametrize("share", [0.0, 0.12], ids=["nothing", "little"])
def test_what_follows_next_to_nothing_has_no_law(share):
    """A force that has to do with neither motion nor wave, or of which the wave is an eighth."""
    rng, uses = np.random.default_rng(7), ("fit", "fit", "holdout")

    def law(wave):
        return 1e5 * ((1 - share) ** 0.5 * rng.standard_normal(len(wave)) + share**0.5 * wave / np.std(wave))

    forces = [sea(5.0, i, use, law) for i, use in enumerate(uses)]
    description = described("surge", forces, law_of("surge", forces))
    assert description.law.terms == () and "no law" in description.words
    assert_allclose(description.law.share, share, atol=0.04)
    assert all(follows.coherence < 0.3 for follows in description.coherence["waves"].values())


def test_terms_that_all_but_cancel_are_no_law():
    """Two terms that differ by a thousandth follow anything that is like their difference."""
    first, second = np.random.default_rng(0).standard_normal((2, 500))
    terms = np.column_stack([first, first + 1e-3 * second, 0.3 * second])
    part = RegressionBlock(second, terms, terms, 1.0)
    assert best_terms(part.products(), 2)[0] != (0, 1)
    chosen, coefficients = best_terms(part.products(), 1)
    assert chosen == (2,)
    assert_allclose(coefficients, 1 / 0.3, rtol=1e-6)
    assert best_terms(RegressionBlock(second, terms[:, :2], terms[:, :2], 1.0).products(), 2)[0] == ()


@pytest.mark.slow
def test_what_is_written(model, tmp_path):
    """From a calibration's tests, uneven clocks among them, to the document, the page and a figure."""
    made = decays(model(), cubic)
    jitter = np.random.default_rng(1).uniform(-0.005, 0.005, len(TIME))
    tests = tuple(
        TestFit(
            test.id,
            test.use,
            "decay",
            "roll",
            TIME + jitter,
            tuple(
                Series(
                    "roll",
                    *(np.interp(TIME + jitter, TIME, row["roll"]) for row in (test.measured, test.simulated)),
                    0.0,
                    NOISE,
                    True,
                )
                for _ in "1"
            ),
            {},
            "roll.csv",
        )
        for test, _ in made
    )
    campaign = SimpleNamespace(manifest=SimpleNamespace(zero=None), records=[SimpleNamespace(id=test.id) for test in tests])
    fits = SimpleNamespace(campaign=campaign, study=SimpleNamespace(seas=()), setup=SimpleNamespace(motions=("roll",)))
    latent = latent_of(fits, SimpleNamespace(model=model(), tests=tests))
    assert_allclose({term.name: term.coefficient for term in latent[0].law.terms}["x^3"], -500.0, rtol=0.15)
    folder = write_diagnosis(replace(fake_diagnosis(), verdict="unexplained", effects=(), latent=latent), tmp_path)
    read = json.loads((folder / "diagnosis.json").read_text())
    jsonschema.validate(read, json.loads(SCHEMA.read_text()))
    (force,) = read["missing"]["unexplained"]["forces"]
    assert force["degree_of_freedom"] == "roll" and force["law"]["terms"][0]["unit"] == "N m/rad3"
    assert force["law"]["share"] == latent[0].law.share and force["rms"]["decay"] == latent[0].rms["decay"]
    assert read_diagnosis(folder).missing.unexplained.forces[0].words == latent[0].words
    assert any(figure["file"] == "figures/latent-force.png" for figure in read["figures"])
    text = write_report(folder).read_text()
    assert "the model lacks a moment of" in text and text.count("that would have to act on the model") >= 2
