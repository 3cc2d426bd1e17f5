"""What holds for the residuals of every kind: shapes, products, and the slope of what a fit minimises."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_joint import LABELS, campaign, model  # noqa: F401  (a fixture: every kind of test)
from test_sea_laws import HULL, OPTIONS

import jaxhydro as jh
from calibration.fitting.decay_fit import set_up_decays
from calibration.fitting.fit import Fit, stacked
from calibration.fitting.normal_equations import LeastSquares, cost_of, normal_equations
from calibration.fitting.sea_part import SeaPart
from calibration.parameters.space import VAGUE_DEVIATION, ParameterSpace, parameter_space
from calibration.residuals.abstract_residual import AbstractGroupedResidual, AbstractResidual, Unknowns, parameters_only
from calibration.residuals.decays import first_guess
from calibration.residuals.run_seas import seas_of, with_diffraction
from calibration.residuals.seas import set_up_waves
from calibration.residuals.shooting import set_up_blocks
from calibration.residuals.static import set_up_offsets, set_up_periods

KINDS = ("decays", "seas", "blocks", "offsets", "periods")
slow = pytest.mark.slow


@pytest.fixture(scope="module")
def residuals(campaign, model) -> dict[str, tuple[AbstractResidual, Unknowns, int]]:  # noqa: F811
    """Residuals by kind, unknowns somewhat off the truth, and the number of shared unknowns that are no parameters."""
    space = parameter_space(model, LABELS)
    x = space.start + 0.1
    records = [record for record in campaign.records if record.kind == "decay"]
    decays = set_up_decays(model, campaign, records, space)
    ends = np.asarray(decays.data.time[:, 0]) + 60.0
    seas = seas_of(campaign, model.environment, OPTIONS)
    how = {"from_rest": True, "scale": 1.0, "step": 0.25}
    afloat = with_diffraction(model, OPTIONS)
    sea = set_up_waves(afloat, seas, space, OPTIONS, objective="both", **how)
    blocks = set_up_blocks(set_up_waves(afloat, seas, space, OPTIONS, objective="blocks", **how), 50.0)
    begin = blocks.begin()
    constants = jnp.append(x, 0.1 * jnp.ones(blocks.observations))
    return {
        "decays": (decays.up_to(ends), Unknowns(x, first_guess(records, decays.data)), 0),
        "seas": (sea, parameters_only(x), 0),
        "blocks": (blocks, Unknowns(constants, begin.own + 0.1), blocks.observations),
        "offsets": (set_up_offsets(model, [campaign.record("held")], space, from_rest=True), parameters_only(x), 0),
        "periods": (set_up_periods(model, campaign.manifest.calibrate.natural_periods, space, 1.0), parameters_only(x), 0),
    }


def test_all_kinds_are_here() -> None:
    """Every final class of residuals of the package has its case."""

    def final(cls: type) -> set[type]:
        return {leaf for sub in cls.__subclasses__() for leaf in final(sub)} or {cls}

    assert {cls.__name__ for cls in final(AbstractResidual) if cls.__module__.startswith("calibration.")} == {
        "DecayProblem",
        "SeaProblem",
        "BlockProblem",
        "OffsetProblem",
        "PeriodProblem",
    }


@slow
@pytest.mark.parametrize("kind", KINDS)
def test_products_are_those_of_residuals_and_slopes(residuals, kind: str) -> None:
    """Symmetric and positive; what a fit minimises falls along them as they say, by differences."""
    problem, at, nuisances = residuals[kind]
    p = len(problem.space.free) + nuisances
    assert len(at.shared) == p and isinstance(problem.model, type(residuals["decays"][0].model))
    solve = eqx.filter_jit(normal_equations)
    shape = eqx.filter_eval_shape(problem.products, at).shape
    weights = (1.0 + jnp.arange(float(np.prod(shape[:2]))).reshape(shape[:2]),)
    fit = LeastSquares((problem,), weights, jnp.zeros(p), jnp.zeros(p))
    info, (products,) = solve(at, fit)
    products = np.asarray(products)
    assert products.shape[-1] == p + at.own.shape[1] + 1 and products.shape[0] == max(len(at.own), 1)
    assert_allclose(products, np.swapaxes(products, -1, -2), rtol=1e-9, atol=1e-12 * np.abs(products).max())
    least = np.linalg.eigvalsh(products)[..., 0]
    assert (least > -1e-9 * np.abs(products).max(axis=(-1, -2))).all()
    assert 2 * float(info.f) == pytest.approx(cost_of((products,), (np.asarray(weights[0]),)), rel=1e-9)
    rng = np.random.default_rng(3)
    move = Unknowns(*(jnp.asarray(rng.normal(size=leaf.shape)) for leaf in at))
    ends = [solve(Unknowns(*(leaf + h * step for leaf, step in zip(at, move))), fit)[0].f for h in (1e-5, -1e-5)]
    slope = sum(float(jnp.vdot(leaf, step)) for leaf, step in zip(info.grad, move))
    assert slope == pytest.approx(float(ends[0] - ends[1]) / 2e-5, rel=1e-4)


@slow
@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind not in ("decays", "blocks")])
def test_groups_have_the_products_of_their_residuals(residuals, kind: str) -> None:
    """One group of products for each group of residuals; with a tail every residual counts less."""
    problem, at, _ = residuals[kind]
    assert isinstance(problem, AbstractGroupedResidual)
    groups = eqx.filter_jit(lambda grouped, x: grouped.residuals(x))(problem, at.shared)
    products = np.asarray(eqx.filter_jit(lambda grouped, z: grouped.products(z))(problem, at))
    assert_allclose(products[0, :, -1, -1], [float(group @ group) for group in groups], rtol=1e-9)
    tail = jnp.array([0.5 * float(jnp.abs(group).max()) + 1e-12 for group in groups])
    tailed = eqx.tree_at(lambda grouped: grouped.tail, problem, tail, is_leaf=lambda leaf: leaf is None)
    less = np.asarray(eqx.filter_jit(lambda grouped, z: grouped.products(z))(tailed, at))
    assert (less[0, :, -1, -1] < products[0, :, -1, -1]).all()


def test_kinds_with_and_without_own_unknowns_are_stacked() -> None:
    """Decays of two records and three channels with 2 + 4 unknowns, bands with 2: what is not there has no weight."""
    rng = np.random.default_rng(2)

    def part(records: int, groups: int, size: int) -> tuple[np.ndarray, ...]:
        return rng.normal(size=(records, groups, size, size)), *rng.uniform(1, 2, size=(3, records, groups))

    decays, bands = part(2, 3, 7), part(1, 1, 3)
    products, weight, variance, inflation = stacked([decays, bands], 2)
    assert products.shape == (3, 3, 7, 7) and weight.shape == variance.shape == inflation.shape == (3, 3)
    assert_allclose(products[:2], decays[0])
    assert_allclose(products[2, 0][np.ix_([0, 1, 6], [0, 1, 6])], bands[0][0, 0])
    assert (weight[2] == [bands[1][0, 0], 0, 0]).all() and (variance[2, 1:] == 1).all() and (inflation[2, 1:] == 1).all()
    assert not products[2, 1:].any() and not products[2, 0, 2:6].any()


class TwoBands(AbstractGroupedResidual):
    """Two bands that are linear in the coordinates of three parameters, and can be met exactly."""

    model: jh.Model
    space: ParameterSpace = eqx.field(static=True)
    tail: jax.Array | None
    in_bands: tuple[bool, ...] = eqx.field(static=True)
    observations: int = eqx.field(static=True)

    def residuals(self, x) -> tuple[jax.Array]:
        return (jnp.array([[1.0, 0.5, -0.2], [0.3, -1.0, 0.4]]) @ x - jnp.array([0.3, 0.1]),)

    def residuals_and_reach(self, x) -> tuple[tuple[jax.Array], jax.Array]:
        return self.residuals(x), jnp.array(True)


def test_bands_that_are_met_exactly_determine_no_more_parameters_than_bands() -> None:
    """The third combination is as uncertain as its prior, however small the error that is left."""
    hull = jh.load_model(str(HULL))
    problem = TwoBands(hull, parameter_space(hull, LABELS[:3]), None, (True,), 2)
    fit = Fit([SeaPart(lambda _: problem, hull, pooled=True)], parameters_only(problem.space.start))
    fit.run_rounds("round {}", 6, 1e-4)
    assert fit.converged and np.abs(problem.residuals(fit.x)[0]).max() < 1e-3
    spread, findings = fit.uncertainty("two bands")
    assert np.sqrt(np.linalg.eigvalsh(spread.covariance)[-1]) == pytest.approx(VAGUE_DEVIATION, rel=0.01)
    assert (findings.spectrum < 0.25).sum() == 2 and len(findings.weak) == 1
