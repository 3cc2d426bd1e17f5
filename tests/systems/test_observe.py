"""What sensors record of a motion: one definition in calibrations, simulated campaigns and diagnoses."""

import json
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from fake_diagnosis import fake_diagnosis
from numpy.testing import assert_allclose
from test_diagnosis_in_waves import PLATFORM, excited, write_table

import jaxhydro as jh
from calibration import load_campaign
from calibration.commands.simulate_campaign_command import simulate_campaign
from calibration.discovery.diagnosis_fits import test_fits_at as fitted_tests
from calibration.discovery.effects.candidates import with_effects
from calibration.discovery.linearisations import Point
from calibration.discovery.study_set_up import set_up_study
from calibration.parameters.space import parameter_space
from calibration.residuals.abstract_residual import Unknowns
from calibration.residuals.measured_seas import compare
from calibration.residuals.run_seas import seas_of, with_diffraction
from calibration.residuals.seas import residuals_and_reach, set_up_waves
from calibration.residuals.shooting import set_up_blocks, simulate_blocks
from calibration.residuals.static import set_up_offsets
from calibration.residuals.wave_options import Options
from calibration.result import Calibration, Estimate
from calibration.results.applied_calibration import apply_calibration
from calibration.results.write_diagnosis import write_diagnosis
from jaxhydro.dynamics.integrate import Grid
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.observe import motion_behind, observe, reading_at
from jaxhydro.dynamics.statics import held_at
from jaxhydro.environment import DOFS
from jaxhydro.rotations import rotation
from jaxhydro.sensors import SensorLag, SensorReference

OPTIONS = Options(order=1, diffraction="none", cutoff=0.2)
CHANNELS = {"surge": "m", "heave": "m", "pitch": "rad"}
DURATION, STEP = 240.0, 0.5  # s
GROUPS = 4  # of effects that are simulated together
POINT, LAG = (4.0, -15.0), 0.7  # m, s
NOISE = {"surge": 1e-3, "heave": 1e-3, "pitch": 1e-5}


def with_sensors(model: Model, point: tuple[float, float] = POINT, lag: float = LAG) -> Model:
    """The model with a tracked point off the reference point and motions that are recorded late."""
    model = model.with_effect(SensorReference()).with_effect(SensorLag())
    return model.with_values({"sensor_reference.x": point[0], "sensor_reference.z": point[1], "sensor_lag.delay": lag})


@pytest.fixture(scope="module")
def body(tmp_path_factory: pytest.TempPathFactory) -> Model:
    folder = tmp_path_factory.mktemp("body")
    (folder / "platform.yaml").write_text(PLATFORM)
    write_table(folder, excited)
    return jh.load_model(folder / "platform.yaml")


@pytest.fixture(scope="module")
def motion() -> Grid:
    """A motion whose value at any time is known: sines, on a fine grid."""
    step, omega = 0.05, np.array([0.3, 0.5, 0.7, 0.4, 0.6, 0.8])
    size = np.array([3.0, 1.0, 2.0, 0.1, 0.2, 0.3])
    phase = omega * step * np.arange(2001)[:, None]
    rows = (size * np.sin(phase), size * omega * np.cos(phase), -size * omega**2 * np.sin(phase))
    return Grid(jnp.zeros(()), jnp.asarray(step), jnp.asarray(2000), *map(jnp.asarray, rows))


@pytest.mark.slow
def test_readings_of_a_point_and_of_a_late_clock(body: Model, motion: Grid) -> None:
    """Against the displacement of the point by rotation matrices, and the motion a lag earlier; counted from the origin."""
    sensed, times = with_sensors(body), jnp.arange(5.0, 90.0, 0.37)
    arm = np.array([POINT[0], 0.0, POINT[1]])
    origin = jnp.array([0.4, 0.0, -0.2, 0.0, 0.05, 0.0])

    def tracked(q: np.ndarray) -> np.ndarray:
        return np.concatenate([q[:3] + np.asarray(rotation(jnp.asarray(q[3:]))) @ arm, q[3:]])

    for in_waves, late in ((True, LAG), (False, 0.0)):
        delayed = np.asarray(motion.at(times - late)[0])
        expected = np.stack([tracked(q) - tracked(np.asarray(origin)) for q in delayed])
        assert_allclose(observe(sensed, motion, times, origin, in_waves=in_waves), expected, atol=1e-12)
    assert_allclose(observe(body, motion, times, in_waves=True), motion.at(times)[0], atol=0)


def test_the_motion_behind_a_reading(body: Model) -> None:
    """Position and rate come back from what a tracked point shows of them, at large angles too."""
    sensed = with_sensors(body)
    rng = np.random.default_rng(2)
    for _ in range(5):
        position, rate = (jnp.asarray(rng.normal(size=6)) for _ in range(2))
        reading, reading_rate = jax.jvp(lambda q: reading_at(sensed, q), (position,), (rate,))
        behind = motion_behind(sensed, reading, reading_rate)
        assert_allclose(behind[0], position, atol=1e-12)
        assert_allclose(behind[1], rate, atol=1e-12)


def manifest(tests: list[dict]) -> dict:
    channels = {name: {"column": name, "unit": unit} for name, unit in CHANNELS.items()}
    return {
        "name": "a tracked buoy",
        "platform": "platform.yaml",
        "scale": 1.0,
        "noise": NOISE,
        "tests": tests,
        "channels": {"time": {"column": "t", "unit": "s"}} | channels,
        "wave_channel": {"column": "wave", "unit": "m", "position": [0.0, 0.0]},
    }


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two seas of a buoy, one held out, recorded late and at another point than the reference point."""
    folder = tmp_path_factory.mktemp("tracked")
    (folder / "platform.yaml").write_text(PLATFORM)
    write_table(folder, excited)
    model = with_diffraction(jh.load_model(folder / "platform.yaml"), OPTIONS)
    model, times, tests = with_sensors(model), np.arange(0.0, DURATION, STEP), []
    for seed, use in enumerate(("fit", "holdout")):
        band = {"low": 0.05, "cutoff": 0.2, "seed": seed}
        waves = jh.spectrum_components(lambda w: jh.jonswap(w, 2.0, 9.0), DURATION, model.environment, **band)
        sea = jh.IrregularSea(waves, model.environment, 1)
        late = times > LAG
        moved = jh.simulate(model, np.concatenate([[0.0], times[late] - LAG]), sea, step=0.1)
        first = np.zeros((len(times) - late.sum() - 1, 6))  # at rest before the clock of the motions begins
        readings = np.concatenate([first, np.asarray(reading_at(model, moved.position))])
        columns = np.column_stack([times, sea.gauge(times), *(readings[:, DOFS.index(name)] for name in CHANNELS)])
        np.savetxt(folder / f"sea-{seed}.csv", columns, "%.9f", ",", header="t,wave," + ",".join(CHANNELS), comments="")
        stated = {"peak_period": 9.0} if use == "fit" else {}  # where none is stated, both measure it
        about = {"id": f"sea-{seed}", "kind": "irregular", "file": f"sea-{seed}.csv", "use": use, "transient": 40.0}
        tests.append(about | stated)
    (folder / "campaign.yaml").write_text(json.dumps(manifest(tests)))
    return folder


@pytest.mark.slow
def test_a_campaign_is_compared_with_what_sensors_read(folder: Path) -> None:
    """With the sensors as they were the record is followed, without either effect it is not; a calibration's residuals, by
    motions and by blocks, are those of the comparison."""
    campaign = load_campaign(folder)
    declared = with_diffraction(campaign.model, OPTIONS)
    true = with_sensors(declared)
    seas = seas_of(campaign, declared.environment, OPTIONS)

    def errors(model: Model) -> np.ndarray:
        tests = compare(campaign, model, OPTIONS, made=seas).tests
        return np.array([series.relative for test in tests for series in test.fit.series])

    assert errors(true).max() < 0.01
    assert errors(with_sensors(declared, lag=0.0)).min() > 0.1
    assert errors(with_sensors(declared, point=(0.0, 0.0)))[0] > 0.1  # of surge, by the point's depth and pitch
    space = parameter_space(true, ["linear_damping.B33"])
    how = {"from_rest": False, "scale": 1.0, "step": 0.1}
    problem = set_up_waves(true, seas, space, OPTIONS, objective="motion", **how)
    groups, inside = residuals_and_reach(problem, space.start)
    assert inside and len(groups) == 3
    assert max(float(jnp.linalg.norm(group)) for group in groups) < 0.01
    blocks = set_up_blocks(set_up_waves(true, seas, space, OPTIONS, objective="blocks", **how), 15.0)
    (cut,) = blocks.blocks
    rates = jax.vmap(true.position_rate)(cut.state.position, cut.state.velocity)
    shown = [jax.jvp(lambda q: reading_at(true, q), (q,), (v,)) for q, v in zip(cut.state.position, rates)]
    dofs = jnp.array(blocks.dofs)
    position = jnp.stack([q[dofs] for q, _ in shown]) + blocks.constant
    rate = jnp.stack([v[dofs] for _, v in shown])
    own = ((jnp.stack([position, rate], axis=1) - cut.smooth) / cut.loose).reshape(len(rate), -1)
    assert jnp.abs(own).max() < 1.0  # the record has nearly these states, where it is read a lag later
    shared = jnp.concatenate([space.start, jnp.zeros(blocks.observations)])
    residual = simulate_blocks(blocks, Unknowns(shared, own)).residual
    assert np.sqrt(float((residual**2).sum()) / blocks.observations) < 0.01


@pytest.mark.slow
def test_a_static_test_is_held_where_the_tracked_point_says(body: Model) -> None:
    """Surge of the point is that measured; the other readings are the point's, too."""
    sensed = with_sensors(body)
    truth = np.asarray(held_at(body, 0, jnp.asarray(3.0)))
    reading = np.asarray(reading_at(sensed, jnp.asarray(truth)))
    record = SimpleNamespace(degree_of_freedom="surge", values={name: reading[[DOFS.index(name)]] for name in CHANNELS})
    offsets = set_up_offsets(sensed, [record], parameter_space(sensed, ["linear_damping.B33"]), from_rest=False)
    assert_allclose(eqx.filter_jit(lambda residual: residual.readings(residual.space.start))(offsets)[0], reading, atol=1e-9)


@pytest.mark.slow
def test_a_simulation_has_the_errors_of_its_diagnosis(folder: Path, tmp_path: Path) -> None:
    """For every kind of effect: errors in diagnosis.json, by the diagnosis's own path, and in comparison.json of
    `simulate --calibration`, which reads the effect back from the file."""
    campaign = load_campaign(folder)
    setup = set_up_study(campaign, OPTIONS)
    study, started = setup.study, np.asarray(setup.study.space.start)
    fits = SimpleNamespace(study=study, setup=setup)
    kinds = {candidate.effect: candidate for candidate in reversed(setup.candidates)}
    assert {
        "sensor_reference",
        "sensor_lag",
        "wave_gauge_position",
        "wave_reflection",
        "current",
        "hidden_oscillator",
        "computed_excitation",
        "wave_drift",
        "hysteresis",
        "amplitude_dependent_drag",
    } <= set(kinds)

    def calibration(point: Point, model: Model, labels: tuple[str, ...]) -> Calibration:
        values = {label: float(model.values[label]) for label in labels}
        parameters = {k: Estimate(k, v, 0.0, "-", "of the test", 0.0, False, True) for k, v in values.items()}
        tests = tuple(fitted_tests(campaign, fits, point))
        return Calibration(campaign.manifest.name, model, parameters, tests, True, 1, 1.0, (), (), campaign.platform.name, None)

    null = Point(started, np.zeros((0, 0)))
    damping = ("linear_damping.B33",)
    before = calibration(null, setup.baseline, damping)

    def moved(effects: Sequence[str], size: float, far: float) -> Point:
        """A point where effects have some size, and their shapes are some steps off."""
        parts = [(size, label) for effect in effects for label in kinds[effect].amplitudes]
        parts += [(far, label) for effect in effects for label in kinds[effect].shapes]
        rows = [step * study.directions[study.names.index(label)] for step, label in parts]
        return Point(started + sum(rows, np.zeros_like(started)), null.own)

    step_of, still = {}, set()
    for effect in kinds:
        # hysteresis that yields at a small displacement is too fast for the time step: with another shape, then
        places = (moved([effect], *by) for by in (((4.0, 4.0),) if effect == "hysteresis" else ((4.0, 0.0), (1.0, 0.0))))
        point = next(at for at in places if all(np.isfinite(row).all() for row in study.motions(at)))
        step_of[effect] = point.x - started
        after = fitted_tests(campaign, fits, point)
        pairs = [pair for test, first in zip(after, before.tests) for pair in zip(test.series, first.series)]
        if not any(abs(series.relative / first_series.relative - 1) > 0.01 for series, first_series in pairs):
            still.add(effect)
    # drag hardly matters for this buoy in a sea of 2 m
    assert still <= {"amplitude_dependent_drag", "current"}
    for i in range(GROUPS):  # programs of many models take long to compile
        group = list(kinds)[i::GROUPS]
        point = Point(started + 0.5 * sum(step_of[effect] for effect in group), null.own)
        values = {
            label: study.value(label, point.x) for effect in group for label in (*kinds[effect].labels, *kinds[effect].choices)
        }
        model = with_effects(setup.baseline, values).with_values(values)
        after = calibration(point, model, (*damping, *values))
        diagnosis = fake_diagnosis(
            baseline=before, augmented=after, seas=OPTIONS, campaign=campaign.manifest.name, predictions=()
        )
        write_diagnosis(diagnosis, tmp_path / str(i), figures=False)
        diagnosed = json.loads((tmp_path / str(i) / "diagnosis.json").read_text())["augmented"]["error"]
        used = apply_calibration(tmp_path / str(i) / "diagnosis.json", campaign.model, campaign.platform.name)
        assert set(values) <= set(used.values)
        assert simulate_campaign(folder, tmp_path / "out", calibration=tmp_path / str(i) / "diagnosis.json")
        simulated = json.loads((tmp_path / "out" / "comparison.json").read_text())["error"]
        for id, errors in simulated.items():
            for name in CHANNELS:
                assert errors[name]["rmse"] == pytest.approx(diagnosed[id][name]["rmse"], rel=2e-3), (group, id, name)
                assert errors[name]["relative"] == pytest.approx(diagnosed[id][name]["relative"], rel=2e-3), (group, id, name)
            for name, bands in errors["bands"].items():
                for band, error in bands.items():
                    assert error == pytest.approx(diagnosed[id]["bands"][name][band], rel=2e-3, abs=2e-3), (
                        group,
                        id,
                        name,
                        band,
                    )
