"""Diagnosis in waves: a buoy whose heave is known in closed form, excited as a table says and strips do not."""

import dataclasses
import json
import re
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import MappingProxyType

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

import jaxhydro as jh
from calibration import load_campaign
from calibration.campaign.load_campaign import Campaign
from calibration.campaign.runs import runs
from calibration.commands.simulate_campaign_command import simulate_campaign
from calibration.discovery.baseline_fit import fit_baseline
from calibration.discovery.channel_signs import with_signs_reversed
from calibration.discovery.diagnose import diagnose
from calibration.discovery.diagnosis_conclusion import conclude
from calibration.discovery.effects.phase_shift_start import PHASE_SPACING, phase_shift_start
from calibration.discovery.linearisations import Point
from calibration.discovery.residual_slopes import Frame
from calibration.discovery.sea_slopes import sea_slopes
from calibration.discovery.search import Search
from calibration.discovery.study_set_up import set_up_study
from calibration.report.write_report import write_report
from calibration.residuals.wave_options import options_of
from calibration.results.applied_calibration import apply_calibration
from calibration.results.write_diagnosis import write_diagnosis

RHO, G, DEPTH = 1000.0, 9.81, 200.0
RADIUS, DRAUGHT = 3.0, 10.0
AREA = np.pi * RADIUS**2
MASS, ADDED, DAMPING, TENSION, LENGTH = RHO * AREA * DRAUGHT, 6.0e4, 4.0e4, 1.0e4, 97.0
STEP, DURATION, TRANSIENT, NOISE = 0.5, 600.0, 100.0, 5e-4
HIGHEST = 0.055  # Hz, of differences of frequencies that a program has
TONES = {0.31: 4.0e3, 0.43: 3.0e3}  # rad/s, N: what no candidate has
PLATFORM = f"""
name: a buoy
water: {{density: {RHO}, depth: {DEPTH}, gravity: {G}}}
rigid_body: {{mass: {MASS}, centre_of_mass: [0, 0, -7], inertia: {{Ixx: 4e6, Iyy: 4e6, Izz: 1.3e6}}}}
members:
  - {{name: column, group: column, shape: circ, d: {2 * RADIUS}, rA: [0, 0, {-DRAUGHT}], rB: [0, 0, 5]}}
coefficients: {{column: {{Ca_t: 1.0, Ca_z: 0.0, Cd_t: 1.0, Cd_z: 0.0}}}}
added_mass: {{A33: {ADDED}}}
linear_damping: {{B33: {DAMPING}, B11: 2e4, B22: 2e4, B44: 1e6, B55: 1e6}}
excitation: {{file: buoy.3, use: candidate}}
mooring:
  kind: linear_springs
  lines:
    - {{anchor: [-100, 0, -7], fairlead: [-3, 0, -7], stiffness: 2e4, pretension: {TENSION}}}
    - {{anchor: [50, 86.6025, -7], fairlead: [1.5, 2.59808, -7], stiffness: 2e4, pretension: {TENSION}}}
    - {{anchor: [50, -86.6025, -7], fairlead: [1.5, -2.59808, -7], stiffness: 2e4, pretension: {TENSION}}}
"""


def pressure(omega: np.ndarray) -> np.ndarray:
    """Heave force (N) of the undisturbed pressure under the buoy, of a wave of 1 m: what strips have."""
    return RHO * G * AREA * np.exp(-(omega**2) / G * DRAUGHT) + 0j


def excited(omega: np.ndarray) -> np.ndarray:
    """As the table says: a third less, and late as waves are high or low."""
    return pressure(omega) * (0.5 + 0.25 * omega) * np.exp(-0.6j * omega)


def compliance(omega: np.ndarray) -> np.ndarray:
    """Heave (m) by a force (N)."""
    stiffness = RHO * G * AREA + 3 * TENSION / LENGTH
    return 1 / (stiffness - omega**2 * (MASS + ADDED) + 1j * omega * DAMPING)


def series(amplitude: np.ndarray, omega: np.ndarray) -> np.ndarray:
    return (np.exp(1j * np.outer(np.arange(0.0, DURATION, STEP), omega)) @ amplitude).real


def record(seed: int, force, tones=MappingProxyType({})) -> np.ndarray:
    """Time, wave and heave, both with noise: as steady as waves are that repeat themselves; `tones` act beside them."""
    random = np.random.default_rng(seed)
    period, lines = 2 * DURATION, np.arange(60, 200)
    omega = 2 * np.pi * lines / period
    height = 0.004 * np.exp(-0.5 * ((omega - 0.65) / 0.12) ** 2)
    amplitude = height * (random.normal(size=lines.size) + 1j * random.normal(size=lines.size))
    beside, rate = np.array(list(tones.values())), np.array(list(tones))
    heave = series(amplitude * force(omega) * compliance(omega), omega) + series(beside * compliance(rate), rate)
    noise = random.normal(0, NOISE, (2, heave.size))
    return np.column_stack([np.arange(0.0, DURATION, STEP), series(amplitude, omega) + noise[0], heave + noise[1]])


def write_table(folder: Path, force) -> None:
    """buoy.3: a heave force relative to rho g, as WAMIT writes it."""
    rows = []
    for omega in np.linspace(0.1, 1.6, 61)[::-1]:
        for mode in range(1, 7):
            value = complex(force(np.array([omega]))[0]) / (RHO * G) if mode == 3 else 0j
            rows.append(
                f"{2 * np.pi / omega:.6e} 0.0 {mode} {abs(value):.6e} {np.degrees(np.angle(value)):.6e} "
                f"{value.real:.6e} {value.imag:.6e}"
            )
    (folder / "buoy.3").write_text("\n".join(rows) + "\n")


def campaign_of(folder: Path, force, tones=MappingProxyType({})) -> Campaign:
    """Two seas, one held out; a table of the force that tests of tables are about."""
    (folder / "platform.yaml").write_text(PLATFORM)
    write_table(folder, excited)
    tests = []
    for seed, use in enumerate(("fit", "holdout")):
        columns = record(seed, force, tones)
        np.savetxt(folder / f"sea-{seed}.csv", columns, "%.6f", ",", header="t,wave,heave", comments="")
        tests.append(
            {
                "id": f"sea-{seed}",
                "kind": "irregular",
                "file": f"sea-{seed}.csv",
                "use": use,
                "transient": TRANSIENT,
                "peak_period": 9.7,
            }
        )
    manifest = {
        "name": "a buoy",
        "platform": "platform.yaml",
        "scale": 1.0,
        "channels": {"time": {"column": "t", "unit": "s"}, "heave": {"column": "heave", "unit": "m"}},
        "wave_channel": {"column": "wave", "unit": "m", "position": [0.0, 0.0]},
        "noise": {"heave": NOISE},
        "tests": tests,
    }
    (folder / "campaign.yaml").write_text(json.dumps(manifest))
    return load_campaign(folder)


@pytest.mark.slow
def test_the_force_of_a_table_is_found(tmp_path: Path) -> None:
    """Named first, all of it, within what its deviation and rounding allow; the sea that was held out is followed."""
    campaign = campaign_of(tmp_path, excited)
    diagnosis = diagnose(campaign.model, campaign)
    assert diagnosis.verdict == "found"
    first = diagnosis.effects[0]
    share = first.parameters["computed_excitation.share"]
    assert first.effect == "computed_excitation" and not first.indistinguishable
    assert share.value == pytest.approx(1.0, abs=0.01 + 2 * share.standard_deviation) and share.standard_deviation < 0.02
    assert first.evidence.holdout_gain > 0.95
    before, after = (
        [series for series in anatomy if series.use == "holdout"]
        for anatomy in (diagnosis.anatomy_before, diagnosis.anatomy_after)
    )
    assert after[0].relative < 0.05 < 0.2 < before[0].relative
    write_diagnosis(diagnosis, tmp_path / "out", figures=False)
    used = apply_calibration(tmp_path / "out" / "diagnosis.json", campaign.model, campaign.platform.name)
    assert_allclose(used.model.values["computed_excitation.share"], share.value)


@pytest.mark.validate
def test_a_table_that_says_otherwise_is_left_alone(tmp_path: Path) -> None:
    """Where strips have the force that acts, nothing is missing, whatever the table says."""
    campaign = campaign_of(tmp_path, pressure)
    diagnosis = diagnose(campaign.model, campaign)
    assert diagnosis.verdict == "nothing_missing" and not diagnosis.effects


@pytest.mark.slow
def test_waves_that_come_back_are_found(tmp_path: Path) -> None:
    """When and how much, of waves whose record has incident ones only."""
    share, delay = 0.08, 47.3
    campaign = campaign_of(tmp_path, lambda omega: pressure(omega) * (1 + share * np.exp(-1j * omega * delay)))
    diagnosis = diagnose(campaign.model, campaign)
    assert [effect.effect for effect in diagnosis.effects] == ["wave_reflection"]
    by_name = {label.split(".")[1]: parameter for label, parameter in diagnosis.effects[0].parameters.items()}
    assert by_name["seen"].value == 0
    for name, true in {"coefficient": share, "delay": delay}.items():
        assert by_name[name].value == pytest.approx(true, abs=0.003 + 3 * by_name[name].standard_deviation)
    assert by_name["coefficient"].standard_deviation < 0.01 and by_name["delay"].standard_deviation < 0.2


@pytest.mark.slow
@pytest.mark.parametrize(
    ("label", "turns", "far", "near"),
    [
        ("wave_gauge_position.distance", lambda omega: omega**2 / G, -25.0, 2.0),
        ("sensor_lag.delay", lambda omega: -omega, 2.2, -0.1),
    ],
)
def test_a_shift_is_told_from_afar(tmp_path: Path, label: str, turns, far: float, near: float) -> None:
    """By one look where it is neutral: within a step of what is looked at; nothing where slopes tell of it."""
    starts = []
    for shift in (far, near):
        (folder := tmp_path / f"{shift}").mkdir()
        campaign = campaign_of(folder, lambda omega, shift=shift: pressure(omega) * np.exp(1j * turns(omega) * shift))
        setup = set_up_study(campaign, options_of(campaign))
        (candidate,) = (candidate for candidate in setup.candidates if label in candidate.amplitudes)
        linearisation = setup.study.linearise(
            Point(np.asarray(setup.study.space.start), np.zeros((0, 0))), setup.study.index([label])
        )
        starts.append(phase_shift_start(setup.study, linearisation, label, candidate.phase_per_unit))
    shifted, nothing = starts
    assert shifted.values[label] == pytest.approx(far, abs=PHASE_SPACING / abs(turns(0.65))) and shifted.gain > 500
    assert nothing is None


@pytest.mark.slow
def test_neutral_candidates_change_nothing(tmp_path: Path) -> None:
    """Residual and slopes without their loads are those with them, and points at which one acts take all loads."""
    setup = set_up_study(campaign := campaign_of(tmp_path, pressure), options_of(campaign))
    study, base = setup.study, setup.study.index([*setup.base, *setup.nuisances])
    baseline, start = study.baseline_simulations, Point(np.asarray(study.space.start), np.zeros((0, 0)))
    moved = Point(start.x + study.directions[base[0]], start.own)
    assert baseline is not None and baseline.serves(moved, base)
    fast, (slow,) = study.linearise(moved, base), study.simulations.linearise([(moved, base)], "fit", None)
    assert fast.active == slow.active and fast.point is moved
    assert np.abs(slow.residual).max() > 0 and np.abs(slow.slopes).max() > 0
    for mine, whole in ((fast.residual, slow.residual), (fast.slopes, slow.slopes)):
        np.testing.assert_allclose(mine, whole, rtol=1e-9, atol=1e-9 * np.abs(whole).max())
    np.testing.assert_allclose(study.residual(moved), slow.residual, rtol=1e-9, atol=1e-9 * np.abs(slow.residual).max())
    lag = study.index(["sensor_lag.delay"])
    assert not baseline.serves(start, lag)
    late = Point(start.x + study.directions[lag[0]], start.own)
    assert not baseline.serves(late, base) and not np.allclose(study.residual(late), study.residual(start))


@pytest.mark.validate
def test_a_gauge_that_stood_far_off_is_found(tmp_path: Path) -> None:
    """And nothing beside it, a wave's phase further off than slopes lead; where the campaign says that it can be so far off."""
    campaign_of(tmp_path, lambda omega: pressure(omega) * np.exp(-25j * omega**2 / G))
    manifest = json.loads((tmp_path / "campaign.yaml").read_text()) | {"plausible": {"wave_gauge": "40 m"}}
    (tmp_path / "campaign.yaml").write_text(json.dumps(manifest))
    campaign = load_campaign(tmp_path)
    diagnosis = diagnose(campaign.model, campaign)
    assert [effect.effect for effect in diagnosis.effects] == ["wave_gauge_position"]
    assert diagnosis.effects[0].parameters["wave_gauge_position.distance"].value == pytest.approx(-25.0, abs=0.3)


@pytest.mark.validate
def test_seas_are_as_the_campaign_states(tmp_path: Path) -> None:
    """Bound waves at some differences of frequencies, by their flow at the origin: the model follows such records to
    the noise, and so does a simulation of what a diagnosis has written."""
    (tmp_path / "platform.yaml").write_text(re.sub("excitation: .*\n", "", PLATFORM))
    model = jh.load_model(tmp_path / "platform.yaml")
    times, tests = np.arange(0.0, DURATION, STEP), []
    for seed in (1, 2):
        waves = jh.spectrum_components(
            lambda w: jh.jonswap(w, 3.0, 9.0), DURATION, model.environment, low=0.05, cutoff=0.2, seed=seed
        )
        program = dict(kinds=("difference",), acting="at the origin", highest_difference=HIGHEST)
        sea = jh.IrregularSea(waves, model.environment, 2, **program)
        moved = jh.simulate(model, times, sea)
        columns = np.column_stack([times, sea.gauge(times), moved["surge"], moved["heave"]])
        columns[:, 1:] += np.random.default_rng(seed).normal(0, 1e-3, columns[:, 1:].shape)
        np.savetxt(tmp_path / f"sea-{seed}.csv", columns, "%.6f", ",", header="t,wave,surge,heave", comments="")
        tests.append(
            {
                "id": f"sea-{seed}",
                "kind": "irregular",
                "file": f"sea-{seed}.csv",
                "use": ("fit", "holdout")[seed - 1],
                "transient": TRANSIENT,
                "peak_period": 9.0,
            }
        )
    motions = {dof: {"column": dof, "unit": "m"} for dof in ("surge", "heave")}
    manifest = {
        "name": "a buoy",
        "platform": "platform.yaml",
        "scale": 1.0,
        "noise": dict.fromkeys(motions, 1e-3),
        "tests": tests,
        "channels": {"time": {"column": "t", "unit": "s"}} | motions,
        "wave_channel": {"column": "wave", "unit": "m", "position": [0.0, 0.0]},
        "records": dict(kinds=["difference"], acting="at the origin", highest_difference=HIGHEST),
    }
    (tmp_path / "campaign.yaml").write_text(json.dumps(manifest))
    campaign = load_campaign(tmp_path)
    search = Search.of(campaign, set_up_study(campaign, options_of(campaign)), lambda *_: None)
    state = fit_baseline(search)
    diagnosis = conclude(campaign, search, state, state, (), 1.0)
    write_diagnosis(diagnosis, tmp_path / "found", figures=False)
    assert simulate_campaign(tmp_path, tmp_path / "seas", calibration=tmp_path / "found")
    errors = json.loads((tmp_path / "seas" / "comparison.json").read_text())["error"]
    for test in diagnosis.augmented.tests:
        for series in test.series:
            assert errors[test.id][series.channel]["relative"] == pytest.approx(series.relative, rel=0.02)
            assert series.relative < 0.01  # noise of 1 mm in waves and motions leaves 0.2 % of surge


@pytest.mark.slow
def test_a_wrong_sign_is_found(tmp_path: Path) -> None:
    """Of the motion, or of the waves, which one motion cannot tell; turned round, nothing is missing."""
    campaign = campaign_of(tmp_path, lambda omega: -pressure(omega))
    diagnosis = diagnose(campaign.model, campaign)
    (effect,) = diagnosis.effects
    assert (diagnosis.verdict, effect.effect, effect.degree_of_freedom) == ("found", "sensor_sign", "heave")
    assert effect.indistinguishable == ("sensor_sign (wave)",) and effect.evidence.holdout_gain > 0.99
    assert "sign: -1" in diagnosis.notes[0] and all(series.relative < 0.1 for series in diagnosis.anatomy_after)
    write_diagnosis(diagnosis, tmp_path / "out")
    page = write_report(tmp_path / "out").read_text()
    assert "a wrong sign in heave" in page and "cannot tell it from a wrong sign in wave" in page


@pytest.mark.validate
def test_a_campaign_turned_round(tmp_path: Path) -> None:
    """As if its manifest said so, of a test that has a sign of its own, too."""
    campaign = campaign_of(tmp_path, pressure)
    manifest = json.loads((tmp_path / "campaign.yaml").read_text())
    manifest["tests"][1]["channels"] = {"heave": {"sign": -1}}
    (tmp_path / "campaign.yaml").write_text(json.dumps(manifest))
    original = load_campaign(tmp_path)
    made, twice = (
        with_signs_reversed(original, ["wave", "heave"]),
        with_signs_reversed(with_signs_reversed(original, ["wave", "heave"]), ["wave", "heave"]),
    )
    for was, now, right in zip(campaign.records, made.records, (-1, 1), strict=True):
        assert_allclose(now.values["heave"], right * was.values["heave"])
        assert_allclose(now.wave, -was.wave)
    for was, now in zip(runs(campaign), runs(made), strict=True):
        assert_allclose(now.wave, -was.wave)
    assert twice.manifest == original.manifest


@pytest.mark.validate
def test_a_force_that_nothing_explains_is_shown(tmp_path: Path) -> None:
    """What goes with neither motion nor waves: no name, no law, though the motion follows it; and the force as it acted,
    through the sea that was made ready."""
    campaign = campaign_of(tmp_path, pressure, TONES)
    diagnosis = diagnose(campaign.model, campaign)
    assert diagnosis.verdict == "unexplained" and not diagnosis.effects
    assert re.fullmatch(r"[^(]+ \(of what was tried, [^(]+ came nearest\)", diagnosis.next_test)
    (force,) = diagnosis.latent
    acted = sum(size * np.cos(rate * force.shown.time) for rate, size in TONES.items())
    assert force.motion == "heave" and not force.law.terms
    assert np.corrcoef(force.shown.force, acted)[0, 1] > 0.998
    assert_allclose(np.std(force.shown.force), np.std(acted), rtol=0.02)


@pytest.mark.slow
def test_what_is_held_out_is_not_simulated_to_fit(tmp_path: Path) -> None:
    """Of one run with two tests, the second held out: all that is fitted as of the whole run, and zeros of what is not; the
    same however many directions are looked along at a time, in however many segments."""
    campaign = campaign_of(tmp_path, pressure)
    manifest = json.loads((tmp_path / "campaign.yaml").read_text())
    sea = {"kind": "irregular", "file": "sea-0.csv", "transient": TRANSIENT, "peak_period": 9.7}
    windows = {"fit": [0, 0.4 * DURATION], "holdout": [0.4 * DURATION, DURATION - STEP]}
    manifest["tests"] = [{"id": use, "window": window, "use": use, **sea} for use, window in windows.items()]
    (tmp_path / "campaign.yaml").write_text(json.dumps(manifest))
    setup = set_up_study(campaign := load_campaign(tmp_path), options_of(campaign))
    study = setup.study
    (record,) = study.seas
    assert record.fitted < 0.45 * record.steps
    point = Point(np.asarray(study.space.start), np.zeros((0, 0)))
    whole_run, fitted_part, fitted = study.residual(point, "all"), study.residual(point), study.used[study.row_series]
    assert_allclose(fitted_part[fitted], whole_run[fitted], rtol=0, atol=1e-12)
    assert np.abs(whole_run[~fitted]).max() > 1e-3 and not fitted_part[~fitted].any()
    # slopes by segments on several cores are those of the whole simulation
    count, basis = record.fitted, jnp.asarray(study.directions[::7].T)
    weights, x = jnp.linspace(-1.0, 1.0, basis.shape[1]), jnp.asarray(point.x)
    with ThreadPoolExecutor(2) as pool:
        residual, slopes = sea_slopes(record, Frame(x, basis), count, basis.shape[1], pool)

    def compared(x):
        return record.compared(*record.simulated(x, jnp.asarray(count)), jnp.asarray(count))

    exact, along = jax.jit(lambda x: jax.jvp(compared, (x,), (basis @ weights,)))(x)
    assert_allclose(residual, exact, rtol=0, atol=1e-12)
    assert_allclose(slopes @ weights, along, rtol=0, atol=1e-9 * np.abs(slopes).max())
    active = range(len(study.names) - 3)
    linearisations = [dataclasses.replace(study, width=width).linearise(point, active) for width in (16, study.width)]
    assert_allclose(linearisations[0].residual, fitted_part, rtol=0, atol=1e-12)
    assert not linearisations[0].slopes[~fitted].any() and np.abs(linearisations[0].slopes[fitted]).max() > 1e-3
    assert_allclose(
        linearisations[0].slopes, linearisations[1].slopes, rtol=0, atol=1e-9 * np.abs(linearisations[1].slopes).max()
    )
    # a neutral candidate at another value of its shape changes no slope of the acceleration by the state
    memory = next(candidate for candidate in setup.candidates if candidate.name == "radiation_memory (heave)")
    along, neutral = study.index(memory.amplitudes), {}
    study.linearise_all([(point, along)], keep=neutral)
    for values in memory.grid[1:3]:
        x = np.array(point.x)
        for label, value in values.items():
            x[study.labels.index(label)] = study.space.free[study.labels.index(label)].transform.inverse(value)
        jobs = [(Point(x, point.own), along)]
        quick, whole = study.linearise_neutral(jobs, neutral, along)[0], study.linearise_all(jobs)[0]
        assert_allclose(quick.slopes, whole.slopes, rtol=0, atol=1e-12 * np.abs(whole.slopes).max())
        assert_allclose(quick.residual, fitted_part, rtol=0, atol=1e-12)
