"""Multiple shooting: blocks of a made record, their elimination, coefficients found back where whole motions lead astray."""

import json

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

import jaxhydro as jh
from calibration import calibrate_in_waves, load_campaign
from calibration.fitting.block_part import BlockPart
from calibration.fitting.fit import Fit
from calibration.fitting.joint_fit import calibrate_jointly
from calibration.fitting.normal_equations import LeastSquares, normal_equations
from calibration.identifiability.standard_deviations import correlated_samples
from calibration.parameters.space import parameter_space
from calibration.residuals.abstract_residual import Unknowns
from calibration.residuals.run_seas import seas_of, with_diffraction
from calibration.residuals.run_segments import run_segments, simulate_segments
from calibration.residuals.seas import set_up_waves
from calibration.residuals.shooting import simulate_blocks
from calibration.residuals.wave_options import Options
from jaxhydro.dynamics.integrate import clock
from jaxhydro.errors import InputError
from jaxhydro.platform.build import build

pytestmark = pytest.mark.slow

OPTIONS = Options(order=1, diffraction="none", cutoff=0.2)
LENGTH, STEP = 1000.0, 0.5  # s
DOFS = ("surge", "heave")
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
    return {
        "name": "drift",
        "platform": "platform.yaml",
        "zero": {"window": [0.0, 10.0]},
        "tests": [test],
        "channels": {"time": {"column": "t", "unit": "s"}, **{dof: {"column": dof, "unit": "m"} for dof in DOFS}},
        "wave_channel": {"column": "w", "unit": "m", "position": [0.0, 0.0]},
    }


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    """Surge, hardly damped and mostly slow, and heave of this package's own spar in a sea that comes and goes."""
    folder = tmp_path_factory.mktemp("drift")
    (folder / "platform.yaml").write_text(json.dumps(SPAR))
    (folder / "campaign.yaml").write_text(json.dumps(document()))
    environment = jh.Environment(1025.0, 200.0)
    waves = jh.spectrum_components(lambda w: jh.jonswap(w, 5.0, 9.0, 3.3), LENGTH, environment, low=0.05, cutoff=0.18, seed=2)
    time = np.arange(0.0, LENGTH, STEP)
    wave = jh.IrregularSea(waves, environment).gauge(time) * np.clip(np.minimum(time - 20, LENGTH - time) / 30, 0, 1)

    def write(surge, heave) -> None:
        lines = (f"{t:.1f},{w:.9g},{x:.9g},{z:.9g}" for t, w, x, z in zip(time, wave, surge, heave))
        (folder / "sea.csv").write_text("\n".join(["t,w,surge,heave", *lines]) + "\n")

    write(np.sin(time), np.cos(time))
    first = load_campaign(folder)
    model = with_diffraction(build(first.platform), OPTIONS)
    ((run, sea),) = seas_of(first, model.environment, OPTIONS)
    ((_, segment, _),) = simulate_segments(
        model, run, run_segments(run, run.records, model, OPTIONS.low, OPTIONS.cutoff), sea.sea, 0.25
    )
    write(*np.asarray(segment.response.position)[:, [0, 2]].T)
    return load_campaign(folder)


@pytest.fixture(scope="module")
def seas(campaign):
    return seas_of(campaign, build(campaign.platform).environment, OPTIONS)


def fit_of(campaign, seas, values) -> BlockPart:
    declared = with_diffraction(build(campaign.platform), OPTIONS).with_values(values)
    space = parameter_space(declared, LABELS)

    def pose(model):
        return set_up_waves(model, seas, space, OPTIONS, from_rest=True, scale=1.0, step=0.25, objective="blocks")

    return BlockPart(pose, declared)


def true_states(fit: BlockPart) -> jnp.ndarray:
    """Coordinates of the initial states of the continuous run."""
    (blocks,) = fit.problem.blocks
    dofs = jnp.array(fit.problem.dofs)
    rate = jax.vmap(fit.problem.model.position_rate)(blocks.state.position, blocks.state.velocity)[:, dofs]
    position = (blocks.state.position - fit.problem.sea.rest)[:, dofs] + fit.problem.constant
    return ((jnp.stack([position, rate], axis=1) - blocks.smooth) / blocks.loose).reshape(len(rate), -1)


def test_blocks_of_the_truth_are_the_record(campaign, seas) -> None:
    """True coefficients and states leave nothing, and blocks that join, to what the first steps of a block (RK4) differ from
    those of a run (AB4); the record's own position and rate are nearly these states."""
    fit = fit_of(campaign, seas, TRUE)
    (blocks,) = fit.problem.blocks
    present = np.asarray(blocks.factor > 0)
    for i, piece in enumerate(fit.problem.sea.runs[0].pieces):
        assert_allclose(np.asarray(blocks.measured)[:, i][present[:, i]], piece.measured)
    assert len(present) == 5 and np.ptp(present.sum(axis=2)) <= 1  # 900 s of 60.4 s
    own = true_states(fit)
    assert np.abs(own).max() < 0.7 and np.median(np.abs(own)) < 0.1
    unknowns = Unknowns(fit.problem.begin().shared, own)
    error = np.sqrt(fit.estimate(unknowns).variance.max())
    assert not fit.outgrown(unknowns) and error < 1e-3 and max(fit.jumps.values()) < 2e-3
    assert list(fit.jumps) == list(DOFS)
    for i, group in enumerate(fit.groups):
        assert_allclose(group, np.asarray(simulate_blocks(fit.problem, unknowns).residual)[:, i][present[:, i]])


def test_the_elimination_is_the_full_problem(campaign, seas) -> None:
    """The step, and the parameters' covariance, against the dense Jacobian of all residuals by all unknowns, by differences."""
    fit = fit_of(campaign, seas, START)
    start = fit.problem.begin()
    shared = start.shared + jnp.array([-0.3, 0.2, 0.1, -0.2])
    at = Unknowns(shared, start.own + 0.2 * np.random.default_rng(1).normal(size=start.own.shape))
    whole_fit = Fit([fit], at)
    fit.renew(at)
    weight, ridge = jnp.asarray(fit.weight), jnp.asarray(whole_fit.ridge)
    args = LeastSquares((fit.problem,), (weight,), start.shared, ridge)

    def unflat(z) -> Unknowns:
        return Unknowns(z[:4], z[4:].reshape(at.own.shape))

    def whole(z) -> np.ndarray:
        residual, own = simulate_blocks(fit.problem, unflat(z)).residual, unflat(z).own * jnp.sqrt(weight[:, -1:])
        residual = residual * jnp.sqrt(weight[:, :-1, None])
        return np.concatenate([residual.ravel(), own.ravel(), ridge * (z[:4] - start.shared)])

    unknowns = jnp.concatenate([at.shared, at.own.ravel()])
    matrix = np.stack([(whole(unknowns + d) - whole(unknowns - d)) / 2e-5 for d in 1e-5 * np.eye(len(unknowns))], axis=1)
    dense = np.linalg.lstsq(matrix, -whole(unknowns), rcond=None)[0]
    info, (products,) = jax.jit(normal_equations)(at, args)
    step = info.hessian.solve(info.grad)
    sparse = -np.concatenate([step.shared, step.own.ravel()])
    assert len(dense) == 2 + 2 + at.own.size
    assert_allclose(sparse, dense, rtol=1e-5, atol=1e-6)
    fit.products = np.asarray(products)
    deviation = whole_fit.uncertainty("blocks")[0].deviation()
    priors = np.concatenate([np.asarray(ridge) ** 2, np.repeat(np.asarray(weight)[:, -1], 4)])  # what they add to the matrix
    width = np.concatenate([whole_fit.width, np.ones(len(dense) - 4)])
    rows = matrix[: simulate_blocks(fit.problem, at).residual.size].reshape(len(at.own), 2, -1, len(dense))
    parts = [np.einsum("btk,btl->kl", rows[:, i], rows[:, i]) for i in range(2)]
    inverse = np.linalg.inv(matrix.T @ matrix)
    count = sum(len(group) / correlated_samples(group) for group in fit.groups)
    factor = count / (count - np.trace(inverse @ sum(parts)))
    scale = float(weight[0, 0])  # of the rows' squares
    scatter = sum(
        factor * scale * np.mean(group**2) * correlated_samples(group) * part for group, part in zip(fit.groups, parts)
    )
    covariance = inverse @ (scatter + np.diag(width**2 * priors**2)) @ inverse
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


def test_coefficients_are_found_where_whole_motions_lead_astray(campaign, tmp_path) -> None:
    """Surge alone, from a natural period that is 15 % too long: fitted sample by sample, it stays out of phase."""
    alone = document()
    del alone["channels"]["heave"]
    (tmp_path / "campaign.yaml").write_text(json.dumps(alone))
    for name in ("platform.yaml", "sea.csv"):
        (tmp_path / name).write_text((campaign.folder / name).read_text())
    campaign = load_campaign(tmp_path)
    how = {"free": LABELS, "start": START, "options": OPTIONS}
    result = calibrate_in_waves(campaign, objective="blocks", **how)
    assert result.converged
    for label, true in TRUE.items():
        assert result.parameters[label].value == pytest.approx(true, rel=1e-3), label
        assert result.parameters[label].identifiable
    series = result.tests[0].series[0]
    assert np.std(series.simulated - series.measured) < 0.01 * np.std(series.measured)
    (note,) = [note for note in result.notes if "blocks that start anew" in note]
    assert "in surge" in note
    astray = calibrate_in_waves(campaign, objective="motion", **how)
    assert abs(astray.parameters["added_mass.A11"].value / TRUE["added_mass.A11"] - 1) > 0.3
    series = astray.tests[0].series[0]
    assert np.std(series.simulated - series.measured) > 0.9 * np.std(series.measured)


def test_with_tests_of_all_kinds_there_are_no_blocks(campaign) -> None:
    with pytest.raises(InputError, match="--tests waves beside blocks"):
        calibrate_jointly(campaign, objective="blocks")
