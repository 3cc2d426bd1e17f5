"""Calibration to decays, waves, offsets and periods together: each residual against another way, coefficients found back."""

import json
from dataclasses import replace

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_sea_laws import HULL, OPTIONS, STEP, rows

import jaxhydro as jh
from calibration import load_campaign
from calibration.fitting.joint_fit import calibrate_jointly
from calibration.parameters.space import parameter_space
from calibration.residuals.abstract_residual import cauchy_residual, parameters_only
from calibration.residuals.run_seas import seas_of, with_diffraction
from calibration.residuals.run_segments import run_segments, simulate_segments
from calibration.residuals.static import natural_period, set_up_offsets, set_up_periods
from jaxhydro.dynamics.statics import held_at
from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError
from jaxhydro.loads.stiffness import Stiffness
from jaxhydro.platform.build import build

pytestmark = pytest.mark.slow

LABELS = ("column.Ca_t", "column.Cd_t", "pontoon.Ca_z", "pontoon.Cd_z", "linear_damping.B11")
FACTORS = (0.8, 1.5, 1.2, 0.6, 1.6)
NOISE = {"surge": 0.02, "heave": 0.005, "pitch": 2e-4}
SEA, HELD = 500.0, 4.0  # s, m
CHANNELS = ("surge", "heave", "pitch")


def manifest(model: jh.Model) -> dict:
    channels = {name: {"column": name, "unit": "rad" if name == "pitch" else "m"} for name in CHANNELS}
    modes = jh.natural_modes(model)
    periods = {dof: {"value": modes.of(dof), "standard_deviation": 0.01 * modes.of(dof)} for dof in ("surge", "pitch")}
    decays = [{"id": f"{d}-decay", "kind": "decay", "degree_of_freedom": d, "file": f"{d}.csv"} for d in ("surge", "heave")]
    return {
        "name": "all kinds",
        "platform": "platform.yaml",
        "channels": {"time": {"column": "t", "unit": "s"}, **channels},
        "wave_channel": {"column": "w", "unit": "m", "position": [0.0, 0.0]},
        "zero": {"test": "rest"},
        "noise": NOISE,
        "calibrate": {"natural_periods": periods, "free": list(LABELS)},
        "tests": [
            {"id": "rest", "kind": "static", "file": "rest.csv", "use": "ignore"},
            *decays,
            {"id": "held", "kind": "static", "degree_of_freedom": "surge", "file": "held.csv"},
            {"id": "sea", "kind": "irregular", "file": "sea.csv", "transient": 100.0, "peak_period": 10.0},
        ],
    }


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    """Every kind of test on this package's own motions, with noise."""
    folder = tmp_path_factory.mktemp("kinds")
    (folder / "platform.yaml").write_text(HULL.read_text())
    platform = jh.load_platform(folder / "platform.yaml")
    model = with_diffraction(build(platform), OPTIONS)
    equilibrium, rng = np.asarray(jh.equilibrium(model)), np.random.default_rng(5)
    (folder / "campaign.yaml").write_text(json.dumps(manifest(model)))

    def write(name: str, time, positions, wave=None) -> None:
        motion = [
            positions[:, DOFS.index(d)] - equilibrium[DOFS.index(d)] + rng.normal(0, NOISE[d], len(time)) for d in CHANNELS
        ]
        (folder / name).write_text(rows(time, np.stack([np.zeros(len(time)) if wave is None else wave, *motion])))

    for dof, released, duration in (("surge", 6.0, 500.0), ("heave", 2.0, 150.0)):
        time = np.arange(0.0, duration, STEP)
        write(f"{dof}.csv", time, np.asarray(jh.free_decay(model, {dof: released}, time).position))
    time = np.arange(0.0, 60.0, STEP)
    still = np.tile(np.asarray(held_at(model, 0, equilibrium[0] + HELD)), (len(time), 1))
    write("held.csv", time, still)
    write("rest.csv", time, np.tile(equilibrium, (len(time), 1)))
    environment = jh.Environment(1025.0, 200.0)
    band = {"low": 0.05, "cutoff": 0.18, "seed": 2}
    waves = jh.spectrum_components(lambda w: jh.jonswap(w, 5.0, 10.0, 3.3), SEA, environment, **band)
    time = np.arange(0.0, SEA, STEP)
    wave = jh.IrregularSea(waves, environment).gauge(time)
    write("sea.csv", time, np.tile(equilibrium, (len(time), 1)) + np.sin(time)[:, None], wave)
    first = load_campaign(folder)
    ((run, sea),) = seas_of(first, environment, OPTIONS)
    (part,) = run_segments(run, run.records, model, OPTIONS.low, OPTIONS.cutoff)
    write(
        "sea.csv",
        time,
        np.asarray(next(iter(simulate_segments(model, run, (part,), sea.sea, 0.25))).simulation.response.position),
        wave,
    )
    return load_campaign(folder)


@pytest.fixture(scope="module")
def model(campaign):
    return build(campaign.platform)


def test_a_motion_held_by_a_force(model) -> None:
    """The other five forces vanish; a body on a matrix of springs rests where the matrix says."""
    equilibrium = np.asarray(jh.equilibrium(model))
    position = held_at(model, 0, jnp.asarray(equilibrium[0] + HELD))
    force = np.asarray(model.force_at_rest(position))
    assert position[0] == pytest.approx(equilibrium[0] + HELD) and abs(position[4] - equilibrium[4]) > 1e-4
    assert np.abs(force[1:]).max() < 1e-9 * float(model.body.mass) * 9.81 and abs(force[0]) > 1e5
    stiff = {"C11": 1e5, "C15": -2e6, "C51": -2e6, "C55": 3e9, "C33": 4e6, "C22": 1e5, "C44": 3e9, "C66": 1e9}
    body = eqx.tree_at(lambda m: m.loads, model, (Stiffness(stiff),))
    assert float(held_at(body, 0, jnp.asarray(3.0))[4]) == pytest.approx(2e6 * 3 / 3e9, rel=1e-9)
    slope = jax.jacfwd(lambda v: held_at(body, 0, v))(jnp.asarray(3.0))
    assert float(slope[4]) == pytest.approx(2e6 / 3e9, rel=1e-9)


@pytest.mark.parametrize("dof", ["heave", "pitch"])
def test_a_natural_period_and_its_slope(model, dof: str) -> None:
    """`natural_modes`, by another package's eigenvalues; the slope by differences."""
    seconds = jax.jit(lambda: natural_period(model, DOFS.index(dof)))()
    assert float(seconds) == pytest.approx(jh.natural_modes(model).of(dof), rel=1e-9)
    label = "pontoon.Ca_z" if dof == "heave" else "column.Ca_t"
    value = float(model.values[label])

    def period(v):
        return natural_period(model.with_values({label: v}), DOFS.index(dof))

    slope = jax.jit(jax.jacfwd(period))(jnp.asarray(value))
    h = 1e-3 * value
    rough = (
        jh.natural_modes(model.with_values({label: value + h})).of(dof)
        - jh.natural_modes(model.with_values({label: value - h})).of(dof)
    ) / (2 * h)
    assert float(slope) == pytest.approx(rough, rel=1e-4)


def test_residuals_of_offsets_and_periods(campaign, model) -> None:
    """At the truth the noise's, off it what is declared; their Gauss-Newton matrices against differences."""
    space = parameter_space(model, LABELS)
    residuals = eqx.filter_jit(lambda problem, x: problem.residuals(x)[0])
    products = eqx.filter_jit(lambda problem, x: problem.products(parameters_only(x))[0, 0])
    offsets = set_up_offsets(model, [campaign.record("held")], space, from_rest=True)
    assert np.abs(np.asarray(residuals(offsets, space.start))).max() < 1e-3
    assert len(offsets.compared) == 2  # heave and pitch
    periods = set_up_periods(model, campaign.manifest.calibrate.natural_periods, space, campaign.manifest.scale)
    assert_allclose(np.asarray(residuals(periods, space.start)), 0.0, atol=1e-6)
    x = space.start + 0.2
    for source in (offsets, periods):
        r = np.asarray(residuals(source, x))
        slopes = [np.asarray(residuals(source, x + d) - residuals(source, x - d)) / 2e-4 for d in 1e-4 * np.eye(5)]
        full = np.stack([*slopes, r], axis=1)
        expected = full.T @ full
        assert_allclose(np.asarray(products(source, x)), expected, rtol=1e-3, atol=1e-6 * np.abs(expected).max())


def test_cauchy_s_loss() -> None:
    """Squares for small residuals, c^2 ln(1 + (r/c)^2) for all, and a slope that is finite at rest."""
    r = jnp.array([-50.0, -1e-9, 0.0, 1e-4, 0.7, 3.0, 1e5])
    assert_allclose(cauchy_residual(r, jnp.asarray(2.0)) ** 2, 4.0 * np.log1p((np.asarray(r) / 2) ** 2), rtol=1e-9, atol=1e-30)
    slope = jax.vmap(jax.grad(lambda x: cauchy_residual(x, jnp.asarray(2.0))))(r)
    assert np.isfinite(np.asarray(slope)).all() and float(slope[2]) == 1.0 and 0 < float(slope[-1]) < 1e-3
    assert cauchy_residual(r, None) is r


@pytest.fixture(scope="module")
def start(model) -> dict[str, float]:
    return {label: factor * float(model.values[label]) for label, factor in zip(LABELS, FACTORS)}


def found_back(result, model) -> None:
    for label in LABELS:
        estimate, true = result.parameters[label], float(model.values[label])
        assert estimate.identifiable, label
        assert abs(estimate.value - true) < min(3 * estimate.standard_deviation, 0.05 * true) + 0.01 * true, label


def test_coefficients_are_found_back_without_waves(campaign, start, model) -> None:
    """By decays, offsets and periods, within three of their deviations and 5 %; the stages are said, and what was fitted."""
    reports = []
    kinds = ("decays", "offsets", "periods")
    result = calibrate_jointly(campaign, kinds=kinds, start=start, options=OPTIONS, progress=reports.append)
    assert result.converged
    found_back(result, model)
    assert {test.id for test in result.tests} == {"surge-decay", "heave-decay"}
    assert result.identifiability.source == "2 decays, 1 static offset and 2 natural periods"
    stages = {now.stage for now in reports}
    assert any(stage.startswith("first") for stage in stages) and "round 1" in stages
    fractions = [now.fraction for now in reports]
    assert fractions == sorted(fractions)


@pytest.mark.validate
def test_coefficients_are_found_back(campaign, start, model) -> None:
    """By all kinds together; every test is judged."""
    result = calibrate_jointly(campaign, start=start, options=OPTIONS)
    assert result.converged
    found_back(result, model)
    assert {test.id for test in result.tests} == {"surge-decay", "heave-decay", "sea"}
    (sea,) = [test for test in result.tests if test.id == "sea"]
    assert max(abs(band.after) for row in sea.bands.values() for band in row.values()) < 0.1


def test_periods_alone(campaign, start, model) -> None:
    """Two stated periods tell two added masses, and nothing of damping."""
    result = calibrate_jointly(campaign, kinds=("periods",), start=start, options=OPTIONS)
    fitted = jh.natural_modes(result.model)
    for dof in ("surge", "pitch"):
        assert fitted.of(dof) == pytest.approx(jh.natural_modes(model).of(dof), rel=0.01)
    assert not result.parameters["column.Cd_t"].identifiable and result.tests == ()


@pytest.mark.validate
def test_outliers_hardly_count(campaign, start, model) -> None:
    """A decay with a stretch of nonsense in it: squares follow it, Cauchy's loss does not."""
    record = campaign.record("surge-decay")
    values = {k: v.copy() for k, v in record.values.items()}
    values["surge"][200:260] += 3.0
    broken = replace(campaign, records=tuple(replace(r, values=values) if r.id == record.id else r for r in campaign.records))
    options = {"kinds": ("decays",), "free": ("column.Cd_t", "column.Ca_t"), "options": OPTIONS}
    begin = {k: v for k, v in start.items() if k in options["free"]}
    off = {}
    for loss in ("squares", "cauchy"):
        estimates = calibrate_jointly(broken, loss=loss, start=begin, **options).parameters
        off[loss] = max(abs(estimates[label].value / float(model.values[label]) - 1) for label in options["free"])
    assert off["cauchy"] < 0.01 and off["squares"] > 0.03


def test_messages(campaign) -> None:
    with pytest.raises(ValueError, match="found 'seas'"):
        calibrate_jointly(campaign, kinds=("seas",))
    none = replace(campaign, records=())
    with pytest.raises(InputError, match="natural period"):
        calibrate_jointly(none, kinds=("decays", "waves"))
