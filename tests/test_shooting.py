"""Multiple shooting: blocks of a made record, their elimination, coefficients found back where whole motions lead astray."""

import json

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

import jaxhydro as jh
from calibration import calibrate_in_waves, load_campaign
from calibration.identifiability import memory
from calibration.joint import calibrate_jointly
from calibration.parameters import parameter_space
from calibration.residuals import Unknowns
from calibration.sea_residuals import pose_in_waves
from calibration.seas import Options, seas_of, with_diffraction
from calibration.shooting import shoot
from calibration.shooting_fit import ShootingFit, objective
from calibration.stretches import stretches, walk
from jaxhydro.integrate import clock
from jaxhydro.platform import build
from jaxhydro.problems import InputError

OPTIONS = Options(order=1, diffraction="none", cutoff=0.2)
LENGTH, STEP = 1000.0, 0.5  # s
SPAR = {
    "name": "a spar",
    "water": {"density": 1025.0, "depth": 200.0, "gravity": 9.81},
    "rigid_body": {"mass": 2.415e6, "centre_of_mass": [0, 0, -20.0], "inertia": {"Ixx": 4e10, "Iyy": 4e10, "Izz": 3e8}},
    "members": [{"name": "column", "group": "column", "shape": "circ", "d": 10.0, "rA": [0, 0, -30], "rB": [0, 0, 15]}],
    "coefficients": {"column": {"Ca_t": 1.0, "Ca_z": 0.5, "Cd_t": 0.1, "Cd_z": 2.0}},
    "added_mass": {"A11": 3.0e6},
    "linear_damping": {"B11": 3e4, "B33": 1e5, "B55": 1e8},
    "mooring": {
        "kind": "stiffness_matrix",
        "stiffness": {"C11": 8.5e4, "C22": 8.5e4, "C44": 4e9, "C55": 4e9, "C66": 1e8},
    },
}
LABELS = ("added_mass.A11", "linear_damping.B11")
TRUE = {"added_mass.A11": 3.0e6, "linear_damping.B11": 3e4}
START = {"added_mass.A11": 5.53e6, "linear_damping.B11": 6e4}  # a natural period 15 % too long, 69.4 s


def document() -> dict:
    test = {"id": "sea", "kind": "irregular", "file": "sea.csv", "transient": 100.0, "peak_period": 9.0}
    return {"name": "drift", "platform": "platform.yaml", "zero": {"window": [0.0, 10.0]}, "tests": [test],
            "channels": {"time": {"column": "t", "unit": "s"}, "surge": {"column": "surge", "unit": "m"}},
            "wave_channel": {"column": "w", "unit": "m", "position": [0.0, 0.0]}}  # fmt: skip


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    """Surge of this package's own spar, hardly damped, most of it slow, in a sea that comes and goes."""
    folder = tmp_path_factory.mktemp("drift")
    (folder / "platform.yaml").write_text(json.dumps(SPAR))
    (folder / "campaign.yaml").write_text(json.dumps(document()))
    environment = jh.Environment(1025.0, 200.0)
    waves = jh.spectrum_components(lambda w: jh.jonswap(w, 5.0, 9.0, 3.3), LENGTH, environment, low=0.05, cutoff=0.18, seed=2)
    time = np.arange(0.0, LENGTH, STEP)
    wave = jh.IrregularSea(waves, environment).gauge(time) * np.clip(np.minimum(time - 20, LENGTH - time) / 30, 0, 1)

    def write(surge) -> None:
        lines = (f"{t:.1f},{w:.9g},{x:.9g}" for t, w, x in zip(time, wave, surge))
        (folder / "sea.csv").write_text("\n".join(["t,w,surge", *lines]) + "\n")

    write(np.sin(time))
    first = load_campaign(folder)
    model = with_diffraction(build(first.platform), OPTIONS)
    ((run, sea),) = seas_of(first, model.environment, OPTIONS)
    ((_, found, _),) = walk(model, run, stretches(run, run.records, model, OPTIONS.low, OPTIONS.cutoff), sea.sea, 0.25)
    write(np.asarray(found.response.position)[:, 0])
    return load_campaign(folder)


@pytest.fixture(scope="module")
def seas(campaign):
    return seas_of(campaign, build(campaign.platform).environment, OPTIONS)


def fit_of(campaign, seas, values) -> ShootingFit:
    declared = with_diffraction(build(campaign.platform), OPTIONS).with_values(values)
    space = parameter_space(declared, LABELS)

    def pose(model):
        return pose_in_waves(model, seas, space, OPTIONS, from_rest=True, scale=1.0, step=0.25, objective="blocks")

    return ShootingFit(pose, declared, lambda *_: None)


def true_states(fit: ShootingFit) -> jnp.ndarray:
    """Coordinates of the initial states of the continuous run."""
    (blocks,) = fit.problem.blocks
    rate = jax.vmap(fit.problem.model.position_rate)(blocks.state.position, blocks.state.velocity)[:, :1]
    there = jnp.stack([blocks.state.position[:, :1] + fit.problem.constant, rate], axis=1)
    return ((there - blocks.smooth) / blocks.loose)[..., 0]


def test_blocks_of_the_truth_are_the_record(campaign, seas) -> None:
    """True coefficients and states leave nothing, and blocks that join, to what the first steps of a block (RK4) differ from
    those of a run (AB4); the record's own position and rate are nearly these states."""
    fit = fit_of(campaign, seas, TRUE)
    (blocks,) = fit.problem.blocks
    measured = np.asarray(fit.problem.sea.runs[0].pieces[0].measured)
    present = np.asarray(blocks.factor[:, 0] > 0)
    assert_allclose(np.concatenate([m[p] for m, p in zip(np.asarray(blocks.measured[:, 0]), present)]), measured)
    assert len(present) == 5 and np.ptp(present.sum(axis=1)) <= 1  # 900 s of 60.4 s
    own = true_states(fit)
    assert np.abs(own).max() < 0.7 and np.median(np.abs(own)) < 0.1
    fit.unknowns = Unknowns(fit.unknowns.shared, own)
    error, inside = fit.left()
    assert inside and error < 1e-3 and fit.jumps["surge"] < 2e-3
    assert_allclose(fit.groups[0], np.asarray(shoot(fit.problem, fit.unknowns).residual[:, 0])[present])


def test_the_elimination_is_the_full_problem(campaign, seas) -> None:
    """The step, and the parameters' covariance, against the dense Jacobian of all residuals by all unknowns, by differences."""
    fit = fit_of(campaign, seas, START)
    start = fit.problem.begin()
    shared = start.shared + jnp.array([-0.3, 0.2, 0.1])
    at = Unknowns(shared, start.own + 0.2 * np.random.default_rng(1).normal(size=start.own.shape))
    weight, ridge = jnp.asarray(fit.weight()), jnp.asarray(fit.ridge())
    args = (fit.problem, weight, start.shared, ridge)

    def unflat(z) -> Unknowns:
        return Unknowns(z[:3], z[3:].reshape(at.own.shape))

    def whole(z) -> np.ndarray:
        residual, own = shoot(fit.problem, unflat(z)).residual, unflat(z).own * jnp.sqrt(weight[:, -1:])
        return np.concatenate([residual.ravel(), own.ravel(), ridge * (z[:3] - start.shared)])

    def condensed_rows(z) -> jnp.ndarray:
        (rows, priors), _ = objective(unflat(z), args)
        return jnp.concatenate([rows.ravel(), priors])

    here = jnp.concatenate([at.shared, at.own.ravel()])
    matrix = np.stack([(whole(here + d) - whole(here - d)) / 2e-5 for d in 1e-5 * np.eye(len(here))], axis=1)
    dense = np.linalg.lstsq(matrix, -whole(here), rcond=None)[0]
    found = np.linalg.lstsq(jax.jacfwd(condensed_rows)(here), -condensed_rows(here), rcond=None)[0]
    assert len(dense) == 2 + 1 + at.own.size
    assert_allclose(found, dense, rtol=1e-5, atol=1e-6)
    fit.unknowns, fit.products = at, np.asarray(objective(at, args)[1])
    fit.left()
    deviation = fit.identifiability()[0].deviation()
    priors = np.concatenate([np.asarray(ridge) ** 2, np.repeat(np.asarray(weight)[:, -1], 2)])  # what they add to the matrix
    data = matrix.T @ matrix - np.diag(priors)
    width = np.concatenate([fit.width, np.ones(len(dense) - 2)])
    (group,) = fit.groups
    count, inverse = len(group) / memory(group), np.linalg.inv(matrix.T @ matrix)
    variance = np.mean(group**2) * count / (count - np.trace(inverse @ data)) * memory(group)
    covariance = inverse @ (variance * data + np.diag(width**2 * priors**2)) @ inverse
    assert_allclose(deviation, np.sqrt(np.diag(covariance))[:2], rtol=1e-5)


def test_a_sea_from_a_later_step(seas) -> None:
    """The same as prepared for a later clock; interpolated in the middle of the first steps."""
    ((_, sea),) = seas
    points = np.array([[0.0, 0.0], [0.0, 0.0], [-30.0, 15.0]])
    period = float(sea.sea.components.period)
    step = period / 4000
    assert step == pytest.approx(0.25)
    whole = sea.sea.prepared(points, None, clock("ab4", 0.0, step, 800))
    later = sea.sea.prepared(points, None, clock("ab4", 300 * step, step, 100))
    moved = whole.from_step(jnp.asarray(300), 100)
    size = float(jnp.abs(later.series).max())
    for steps in (0.0, 0.5, 1.5, 2.5, 3.0, 57.0):
        time = later.start + steps * step
        assert_allclose(moved.rows(time), later.rows(time), atol=1e-6 * size)
        assert_allclose(moved.drift(time), later.drift(time), rtol=1e-5)  # by cubics, one-sided at a clock's start


def test_coefficients_are_found_where_whole_motions_lead_astray(campaign, seas) -> None:
    """From a natural period that is 15 % too long: fitted sample by sample, it stays out of phase."""
    how = {"free": LABELS, "start": START, "options": OPTIONS, "made": seas}
    found = calibrate_in_waves(campaign, objective="blocks", **how)
    assert found.converged
    for label, true in TRUE.items():
        assert found.parameters[label].value == pytest.approx(true, rel=1e-3), label
        assert found.parameters[label].identifiable
    (test,) = found.tests
    series = test.series[0]
    assert np.std(series.simulated - series.measured) < 0.01 * np.std(series.measured)
    (said,) = [note for note in found.notes if "blocks that start anew" in note]
    assert "in surge" in said
    astray = calibrate_in_waves(campaign, objective="motion", **how)
    assert abs(astray.parameters["added_mass.A11"].value / TRUE["added_mass.A11"] - 1) > 0.3
    assert astray.history[-1] > 0.9  # of the motion


def test_with_tests_of_all_kinds_there_are_no_blocks(campaign) -> None:
    with pytest.raises(InputError, match="--tests waves beside blocks"):
        calibrate_jointly(campaign, objective="blocks")
