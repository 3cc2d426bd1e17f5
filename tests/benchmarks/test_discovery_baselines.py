"""Baselines of the discovery benchmark, on forces that are known."""

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from benchmarks.discovery import make_campaigns
from benchmarks.discovery.cases import EFFECTS, Case
from benchmarks.discovery_baselines import __main__ as baselines
from benchmarks.discovery_baselines.law_answer import answer_of_laws, held_out_error
from benchmarks.discovery_baselines.reconstructed_forces import ForcedTest, Reconstruction, reconstructed
from benchmarks.discovery_baselines.terms import EFFECT_OF, effect_of, hysteretic
from benchmarks.evidence.common import DEMO
from calibration.discovery.latent_force.recover_force import windows
from calibration.discovery.latent_force.recovered_force import RecoveredForce, ResampledTest, filtered

pytestmark = pytest.mark.slow

MASS, STIFFNESS, DAMPING = 3e7, 6e4, 8e4  # kg, N/m, N s/m: a period of 140 s
FRICTION, STEP = 5e3, 0.5  # N, s


def decay(use: str, amplitude: float, friction: float) -> ForcedTest:
    """A surge decay with friction that the model does not have; its force is recovered as `recover_force` does."""
    time = np.arange(0.0, 1400.0, STEP)

    def motion(force: float) -> tuple[np.ndarray, np.ndarray]:
        def rate(t, y):
            return y[1], (-force * np.tanh(y[1] / 0.01) - DAMPING * y[1] - STIFFNESS * y[0]) / MASS

        return solve_ivp(rate, (0.0, time[-1]), (amplitude, 0.0), t_eval=time, rtol=1e-8, max_step=0.5).y

    (x, v), (x0, v0) = motion(friction), motion(0.0)
    test = ResampledTest(f"surge-{amplitude:g}", use, "decay", time, {"surge": x}, {"surge": x0}, {"surge": 0.01}, None)
    first, second, inside = windows(x - x0 + 1e-6 * np.cos(2 * np.pi * time / 140.0))
    omega = 2 * np.pi * np.fft.rfftfreq(len(time), STEP)
    impedance = STIFFNESS - omega**2 * MASS + 1j * omega * DAMPING
    gain = 0.5 + 0.5 * np.cos(np.pi * np.clip(omega / (2 * np.pi / 140.0) / 6 - 0.5, 0.0, 1.0))
    raw = np.fft.irfft(impedance * np.fft.rfft((x - x0) * first), len(time))
    force, acceleration, peak = filtered(raw * second, gain), np.gradient(v, STEP), 100.0 if friction else 0.0
    recovered = RecoveredForce(test, "surge", force, x, v, acceleration, (x0, v0), gain, second, inside, 10.0, peak)
    relative = {"surge": max(float(np.std(x - x0) / np.std(x)), 0.01)}
    return ForcedTest({"surge": recovered}, *(np.array([[value]]) for value in (MASS, DAMPING, STIFFNESS)), relative)


def made(friction: float) -> Reconstruction:
    """Three decays, the largest held out."""
    uses = (("fit", 4.0), ("fit", 8.0), ("holdout", 12.0))
    return Reconstruction([decay(use, amplitude, friction) for use, amplitude in uses], 0.0)


@pytest.fixture(scope="module")
def with_friction() -> Reconstruction:
    return made(FRICTION)


def test_a_force_moves_as_the_equation_of_motion_says():
    """A harmonic force, to the exact amplitude and phase."""
    test = decay("fit", 4.0, FRICTION)
    time = test.test.time
    omega = 2 * np.pi * 7 / (len(time) * STEP)
    response = test.motion_under({"surge": 1e5 * np.cos(omega * time)})["surge"]
    exact = 1e5 / (STIFFNESS - omega**2 * MASS + 1j * omega * DAMPING) * np.exp(1j * omega * time)
    assert np.abs(response - exact.real).max() < 1e-9 * np.abs(exact).max()


@pytest.mark.parametrize(("method", "package"), [("sindy", "pysindy"), ("grey-box", "sklearn")])
def test_friction_is_named(with_friction: Reconstruction, method: str, package: str):
    """By both methods, and the error of the decay that was not fitted falls."""
    pytest.importorskip(package)
    answer = baselines.answered(with_friction, baselines.law_of_method(method))
    first = answer.effects[0]
    assert answer.verdict == "found" and (first.effect, first.motion) == ("coulomb_friction", "surge")
    assert first.probability > 0.5
    assert answer.held_out_error.final < 0.8 * answer.held_out_error.baseline
    if method == "grey-box":  # a function of velocity is any damping
        assert "amplitude_dependent_drag" in first.indistinguishable_from


def test_nothing_is_named_where_no_force_is_seen():
    reconstruction = made(0.0)
    assert reconstruction.motions() == []
    answer = answer_of_laws(reconstruction, [])
    assert answer.verdict == "nothing_missing" and not answer.effects
    assert (
        answer.held_out_error.final
        == answer.held_out_error.baseline
        == held_out_error(reconstruction, [])
        == pytest.approx(0.01)
    )


def test_what_no_law_helps_is_unexplained(with_friction: Reconstruction):
    assert answer_of_laws(with_friction, []).verdict == "unexplained"


def test_the_hysteretic_term_is_that_of_bouc_and_wen():
    """One way, z = 1 - exp(-x / limit); the force stays when the motion stops."""
    z = hysteretic(np.repeat([0.2, 0.0], 500), 0.01, 0.5)
    assert z[499] == pytest.approx(1 - np.exp(-0.2 * 4.99 / 0.5), abs=2e-3) and z[-1] == pytest.approx(z[499], abs=2e-3)


def test_forces_of_a_campaign_are_reconstructed(tmp_path: Path):
    """Of the embedded decays: the fit's own errors without a force, smaller ones with the force; kept for another method."""
    file = tmp_path / "forces" / "demo.pickle"
    first = reconstructed(DEMO, file)
    assert [len(first.of_use(use)) for use in ("fit", "holdout")] == [9, 0]
    for test in first.tests:
        assert test.errors_with({}) == pytest.approx(test.relative, rel=1e-12)
        assert np.linalg.eigvalsh((test.mass + test.mass.T) / 2).min() > 0 and (np.diag(test.damping) > 0).all()
        mended = test.errors_with({name: force.force for name, force in test.forces.items()})
        assert all(mended[name] <= error for name, error in test.relative.items())
    second = reconstructed(tmp_path / "not read", file)
    assert second.minutes == first.minutes and second.motions() == first.motions()


def test_terms_stand_for_effects_of_the_benchmark():
    """By motion where they differ."""
    names = {
        effect for effects in EFFECT_OF.values() for effect in ([effects] if isinstance(effects, str) else effects.values())
    }
    assert names - {""} <= set(EFFECTS)
    assert effect_of("x^3", "surge") == "mooring_nonlinearity" and effect_of("x^3", "heave") == "nonlinear_hydrostatics"
    assert effect_of("v of pitch", "surge") == "coupled_damping" and effect_of("v", "heave") == ""


def test_campaigns_are_answered(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, with_friction: Reconstruction, capsys):
    """The command writes a file of answers that can be scored; a folder without campaigns is an error."""
    pytest.importorskip("pysindy")
    monkeypatch.setattr(baselines, "reconstructed", lambda folder, file: with_friction)
    folder, name = tmp_path / "campaigns", Case.of("coulomb_friction-2-1").public_name
    (folder / name).mkdir(parents=True)
    make_campaigns.write_index(folder)
    baselines.main(["sindy", str(folder)])
    saved = json.loads((tmp_path / "campaigns-answers" / "sindy.json").read_text())
    assert saved["method"].startswith("ensemble SINDy, pysindy ")
    assert saved["campaigns"][name]["effects"][0]["effect"] == "coulomb_friction"
    with pytest.raises(SystemExit) as stopped:
        baselines.main(["sindy", str(tmp_path / "none")])
    assert stopped.value.code == 2 and "benchmark.json" in capsys.readouterr().err
