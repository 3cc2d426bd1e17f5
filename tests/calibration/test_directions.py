"""What records tell together: linear models whose answers are known by hand, and decays of a real platform."""

import math
from dataclasses import replace
from types import SimpleNamespace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from ruamel.yaml import YAML

import jaxhydro as jh
from calibration.campaign.manifest_sections import Test
from calibration.campaign.records import Record
from calibration.fitting.decay_fit import fit_of_decays, run_fit, set_up_decays
from calibration.fitting.decay_part import series_of
from calibration.fitting.fit_conclusion import identifiability_of
from calibration.identifiability.findings import MAX_REPORTED_DIRECTIONS, Identifiability, identifiability
from calibration.identifiability.information import IDENTIFIABLE_DEVIATION, collinearity, shared_information, varimax
from calibration.identifiability.standard_deviations import sandwich_covariance
from calibration.identifiability.statements import Parameters
from calibration.parameters.families import parameter_family
from calibration.parameters.space import VAGUE_DEVIATION, parameter_space
from calibration.uncertainty.further_tests import decay_information, effective_noise, expected_information, rank_tests
from jaxhydro.dynamics.statics import linearised

pytestmark = pytest.mark.slow

PLATFORM = jh.__path__[0] + "/campaigns/volturnus-s-decays/platform.yaml"
NOISE, LENGTH = 0.01, 300.0  # m, s


def stated(labels: str, value=None, unit=None) -> Parameters:
    """Parameters of names, logarithmic in their coordinates."""
    names = tuple(labels.split())
    value = np.ones(len(names)) if value is None else np.asarray(value, float)
    families = tuple(parameter_family(name, ()) for name in names)
    return Parameters(names, value, value.copy(), ("-",) * len(names) if unit is None else unit, families)


def judged(parameters: Parameters, information: np.ndarray, width: float = VAGUE_DEVIATION, **options) -> Identifiability:
    """The statement on a linear problem with a prior of one width."""
    return identifiability(parameters, information, np.linalg.inv(information + np.eye(len(information)) / width**2), **options)


# linear problems


def sum_of_two(a: float = 0.8, b: float = 0.36, sigma: float = 0.05, n: int = 40):
    """y = a v1 + b v2 + c v3 t measured n times, v1 = 1.2 and v2 = 0.51 only as a sum: information, the sum's deviation."""
    value, t = np.array([1.2, 0.51, 3.0]), np.linspace(-1, 1, n)
    slope = np.stack([a * np.ones(n), b * np.ones(n), t], axis=1) * value
    return stated("column.Ca_t pontoon.Ca_t linear_damping.B11", value), slope.T @ slope / sigma**2, sigma / math.sqrt(n) / a


def test_two_that_enter_as_a_sum_have_its_weights_and_its_deviation() -> None:
    parameters, information, deviation = sum_of_two()
    findings = judged(parameters, information, source="1 surge decay")
    assert (
        len(findings.weak) == 1 and np.isinf(findings.spectrum[-1]) and (findings.spectrum[:2] < IDENTIFIABLE_DEVIATION).all()
    )
    weak = findings.weak[0]
    assert set(weak.movement) == {"column.Ca_t", "pontoon.Ca_t"}
    changes = np.array(list(weak.movement.values()))
    assert 0.8 * 1.2 * changes[0] + 0.36 * 0.51 * changes[1] == pytest.approx(0.0, abs=1e-9)
    assert np.abs(changes).max() == pytest.approx(0.1) and changes[0] > 0
    combination = weak.known
    assert combination is not None and not combination.product and combination.unit == "-"
    assert combination.weights == pytest.approx({"column.Ca_t": 1.0, "pontoon.Ca_t": 0.36 / 0.8})
    assert combination.value == pytest.approx(1.2 + 0.36 / 0.8 * 0.51)
    assert combination.standard_deviation == pytest.approx(deviation, rel=1e-6)
    sentences = " | ".join(findings.sentences())
    assert "1 surge decay cannot tell column.Ca_t from pontoon.Ca_t" in sentences
    assert "1.00 column.Ca_t + 0.450 pontoon.Ca_t = 1.4295 ± 0.0099 is known" in sentences


def test_the_deviation_of_a_combination_counts_what_else_is_unknown() -> None:
    """A sum whose level is confounded with a third parameter's: least squares on all three says how well it is known."""
    n, sigma = 30, 0.05
    slope = np.stack([np.ones(n), 0.5 * np.ones(n), np.linspace(0.5, 1.0, n)], axis=1)
    findings = judged(stated("a.Ca_t b.Ca_t c.Cd_t"), slope.T @ slope / sigma**2)
    regressors = np.stack([slope[:, 0], slope[:, 2]], axis=1)
    expected = sigma * math.sqrt(np.linalg.inv(regressors.T @ regressors)[0, 0])
    assert findings.weak[0].known is not None
    assert findings.weak[0].known.standard_deviation == pytest.approx(expected, rel=1e-6)


def test_in_different_units_a_product_is_known() -> None:
    value = np.array([2.0, 4e5])
    row = np.array([[1.0, 0.4]])
    findings = judged(stated("column.Cd_t linear_damping.B11", value, ("-", "N s/m")), row.T @ row / 0.03**2)
    combination = findings.weak[0].known
    assert combination is not None and combination.product and combination.standard_deviation == pytest.approx(0.03)
    assert combination.weights == pytest.approx({"column.Cd_t": 1.0, "linear_damping.B11": 0.4})
    assert combination.value == pytest.approx(2.0 * 4e5**0.4)
    assert "The product column.Cd_t^1.00 linear_damping.B11^0.40 is known to 3 %" in findings.weak[0].sentence("these records")


def test_two_open_directions_of_three_are_told_with_their_one_sum() -> None:
    row = np.array([[1.0, 0.7, 0.4]])
    findings = judged(stated("a.Cd_t b.Cd_t c.Cd_t"), row.T @ row / 0.02**2)
    assert len(findings.weak) == 2
    for weak in findings.weak:
        assert weak.known is not None
        assert weak.known.weights == pytest.approx({"a.Cd_t": 1.0, "b.Cd_t": 0.7, "c.Cd_t": 0.4})
        assert weak.known.standard_deviation == pytest.approx(0.02)
    assert len({fix.label for fix in findings.fixes}) == 2
    # what is known is said once, and of what is fixed nothing more
    assert " | ".join(findings.sentences()).count("Their weighted sum a.Cd_t") <= 1
    assert findings.fixes[0].label not in findings.fixes[1].after and len(findings.fixes[1].after) == 1


def test_many_unknown_directions_are_told_briefly() -> None:
    labels = [f"{x}.Cd_t" for x in "abcdefgh"]
    row = np.array([[1.0, *[0.5] * 6, 1e-4]])
    findings = judged(stated(" ".join(labels)), row.T @ row / 0.02**2 + np.diag([0.0] * 7 + [900.0]))
    sentences = findings.sentences()
    assert len(findings.weak) == 6 and sum(" cannot tell " in x for x in sentences) == MAX_REPORTED_DIRECTIONS
    assert sum("act alike (collinearity index without bound" in x for x in sentences) == 1
    assert any(x.startswith("2 further combinations of ") and x.endswith("are not known to 25 % either") for x in sentences)
    assert not any("0.00" in x or " -0 " in x for x in sentences)


def test_unknown_directions_are_told_one_pair_at_a_time() -> None:
    """Two sums known: the null space has any basis, and that of the two pairs is the one to be told."""
    rows = np.array([[1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 1.0]])
    findings = judged(stated("a.Ca_t b.Ca_t a.Cd_t b.Cd_t"), rows.T @ rows / 0.02**2)
    assert sorted(sorted(weak.movement) for weak in findings.weak) == [["a.Ca_t", "b.Ca_t"], ["a.Cd_t", "b.Cd_t"]]
    mixed = np.array([[1.0, 1.0], [1.0, -1.0], [0.0, 0.0]]) / math.sqrt(2)
    np.testing.assert_allclose(np.sort(np.abs(varimax(mixed)), axis=None), [0, 0, 0, 0, 1, 1], atol=1e-6)


def test_an_untouched_parameter_is_said_so() -> None:
    information = np.diag([400.0, 0.0, 900.0])
    findings = judged(stated("column.Ca_t column.Cd_z pontoon.Cd_t"), information)
    assert findings.untouched == ("column.Cd_z",) and not findings.weak
    assert "no record responds to column.Cd_z: fix it, or add tests that move it" in findings.sentences()
    sentences = replace(findings, untouched=("a", "b"), at_bound=("c", "d")).sentences()
    assert "no record responds to a and b: fix them, or add tests that move them" in sentences
    assert "c and d stand at a bound and are taken as fixed there" in sentences
    assert findings.spectrum == pytest.approx([1 / 30, 1 / 20, np.inf])


def test_a_parameter_at_its_bound_is_taken_as_fixed() -> None:
    parameters, information, _ = sum_of_two()
    findings = judged(parameters, information, at_bound=("pontoon.Ca_t",))
    assert not findings.weak and findings.untouched == ()
    assert "pontoon.Ca_t stands at a bound and is taken as fixed there" in findings.sentences()


def test_the_prior_is_not_counted() -> None:
    parameters, information, _ = sum_of_two()
    tight, vague = judged(parameters, information, width=0.01), judged(parameters, information)
    np.testing.assert_array_equal(tight.spectrum, vague.spectrum)
    assert tight.weak == vague.weak and len(tight.weak) == 1
    # while the posterior has it
    assert np.sqrt(tight.covariance[1, 1]) < 0.011 and np.sqrt(vague.covariance[1, 1]) > 1


def test_what_to_fix_is_what_helps_the_others_most() -> None:
    covariance = np.array([[1.0, 0.98, 0.0], [0.98, 1.02, 0.0], [0.0, 0.0, 0.01]])
    findings = judged(stated("a.Ca_t b.Ca_t c.Ca_t"), np.linalg.inv(covariance))
    assert len(findings.weak) == 1
    c, brute = findings.covariance, []
    for j in range(3):  # conditional covariance, by inverting what is left
        remaining = np.delete(np.delete(np.linalg.inv(c), j, 0), j, 1)
        brute.append(np.delete(np.diag(c), j).sum() - np.trace(np.linalg.inv(remaining)))
    fix = findings.fixes[0]
    assert fix.label == findings.parameters.labels[int(np.argmax(brute))]
    assert fix.reduction == pytest.approx(max(brute))
    i = findings.parameters.labels.index(fix.label)
    left_free = 1 - i
    assert fix.share == pytest.approx(max(brute) / np.delete(np.diag(c), i).sum())
    assert fix.after == pytest.approx({"ab"[left_free] + ".Ca_t": math.sqrt(c[left_free, left_free] - c[0, 1] ** 2 / c[i, i])})


def regression(records: int = 3, n: int = 60, shared: int = 3, own: int = 2):
    """Slopes (record, channel, sample, unknown) of two channels, and products with residuals of some size."""
    random = np.random.default_rng(7)
    slope = random.standard_normal((records, 2, n, shared + own)) * np.array([1.0, 0.3, 20.0, 2.0, 0.05])
    full = np.concatenate([slope, random.standard_normal((records, 2, n, 1))], axis=-1)
    return slope, np.einsum("rctk,rctl->rckl", full, full)


def brute_force(slope: np.ndarray, variance: np.ndarray, shared: int) -> np.ndarray:
    """Inverse of the shared block of the inverse of the whole J^T J / sigma^2."""
    records, _, n, k = slope.shape
    whole = np.zeros((records, 2 * n, shared + records * (k - shared)))
    for i in range(records):
        rows = (slope[i] / np.sqrt(variance[i])[:, None, None]).reshape(2 * n, k)
        whole[i, :, :shared] = rows[:, :shared]
        whole[i, :, shared + i * (k - shared) : shared + (i + 1) * (k - shared)] = rows[:, shared:]
    flat = whole.reshape(-1, whole.shape[-1])
    return np.linalg.inv(np.linalg.inv(flat.T @ flat)[:shared, :shared])


def test_own_unknowns_are_eliminated_as_by_inverting_everything() -> None:
    slope, products = regression()
    variance = np.array([[0.1, 0.4], [0.2, 0.3], [0.7, 0.1]])
    actual = shared_information(products, 1 / variance, variance, np.ones((3, 2)), 3)
    np.testing.assert_allclose(actual, brute_force(slope, variance, 3), rtol=1e-9)
    # weighed otherwise, with samples that count as fewer: the inverse of the sandwich that the fit reports
    weight, inflation = np.array([[1.0, 2.0], [3.0, 1.0], [1.0, 1.0]]), np.array([[1.0, 4.0], [2.0, 1.0], [9.0, 1.0]])
    expected = shared_information(products, weight, variance, inflation, 3)
    covariance = sandwich_covariance(products, weight, variance, inflation, np.full(3, 1e-9), np.ones(3)).covariance[:3, :3]
    np.testing.assert_allclose(expected, np.linalg.inv(covariance), rtol=1e-7)


def test_the_spectrum_is_that_of_the_projected_jacobian() -> None:
    slope, products = regression(records=1)
    sigma = 0.3
    information = shared_information(products, np.ones((1, 2)), np.full((1, 2), sigma**2), np.ones((1, 2)), 3)
    rows = slope[0].reshape(-1, 5) / sigma
    q = np.linalg.qr(rows[:, 3:])[0]
    projected = rows[:, :3] - q @ (q.T @ rows[:, :3])
    findings = judged(stated("a.Ca_t b.Ca_t c.Ca_t"), information)
    np.testing.assert_allclose(findings.spectrum, 1 / np.linalg.svd(projected, compute_uv=False), rtol=1e-9)


def test_the_collinearity_index_is_its_definition() -> None:
    random = np.random.default_rng(2)
    slope = random.standard_normal((50, 4)) * np.array([1.0, 30.0, 1e-2, 1.0])
    slope[:, 1] = 30 * slope[:, 0] + random.standard_normal(50)
    findings = judged(stated("a.Ca_t b.Ca_t c.Ca_t d.Cd_t"), 1e6 * slope.T @ slope)
    groups = {group.labels: group.gamma for group in findings.collinear}
    # three pairs and one triple of inertia; drag has no partner
    assert len(groups) == 4 and all("d.Cd_t" not in labels for labels in groups)
    index = {"a.Ca_t": 0, "b.Ca_t": 1, "c.Ca_t": 2}
    for labels, gamma in groups.items():
        columns = slope[:, [index[label] for label in labels]]
        unit = columns / np.linalg.norm(columns, axis=0)
        assert gamma == pytest.approx(1 / np.linalg.svd(unit, compute_uv=False)[-1], rel=1e-8)
    assert groups["a.Ca_t", "b.Ca_t"] > 10
    assert any("a.Ca_t and b.Ca_t act alike" in x for x in findings.sentences())
    assert collinearity(np.diag([1e-9, 1e9])) == pytest.approx(1.0)
    assert math.isinf(collinearity(np.ones((2, 2))))


def test_the_same_test_again_halves_the_variances() -> None:
    information = np.array([[400.0, 100.0], [100.0, 900.0]])
    findings = judged(stated("a.Ca_t b.Cd_t"), information, width=1e6)
    gain = expected_information(findings, information, "again")
    np.testing.assert_allclose(gain.after**2, gain.before**2 / 2, rtol=1e-6)
    assert gain.gain == pytest.approx(0.5 * 2 * math.log(2), rel=1e-6)


def test_the_test_that_tells_two_apart_is_ranked_first_and_leaves_nothing_weak() -> None:
    parameters, information, _ = sum_of_two()
    findings = judged(parameters, information)
    row = np.array([[1.0, -1.0, 0.0]])
    difference = row.T @ row / 0.1**2
    ranked = rank_tests(findings, {"nothing": np.zeros((3, 3)), "the same": information, "another": difference})
    assert [candidate.name for candidate in ranked] == ["another", "the same", "nothing"]
    assert not ranked[0].weak and len(ranked[1].weak) == len(ranked[2].weak) == 1
    assert ranked[2].gain == 0 and "nothing much better known" in ranked[2].sentence()
    posterior = np.linalg.inv(np.linalg.inv(findings.covariance) + difference)
    np.testing.assert_allclose(ranked[0].after, np.sqrt(np.diag(posterior)), rtol=1e-8)
    determinants = np.linalg.slogdet(findings.covariance)[1] - np.linalg.slogdet(posterior)[1]
    assert ranked[0].gain == pytest.approx(0.5 * determinants, rel=1e-8)


# one surge decay of a semi-submersible


@pytest.fixture(scope="module")
def surge():
    """A fit to one noisy surge decay: the fit, its tests, what is said of it, and the fitted model."""
    true = {"column.Ca_t": 1.3, "pontoon.Ca_t": 0.6, "linear_damping.B11": 8e4}
    with open(PLATFORM) as file:
        declared = jh.build(jh.Platform.model_validate(YAML(typ="safe").load(file)))
    model = declared.with_values(true)
    time = np.arange(0.0, LENGTH, 3.3)
    motion = np.asarray(jh.free_decay(model, {"surge": 6.0}, time)["surge"]) - float(jh.equilibrium(model)[0])
    motion = motion + NOISE * np.random.default_rng(4).standard_normal(len(time))
    test = Test.model_validate({"id": "surge-1", "kind": "decay", "file": "made", "degree_of_freedom": "surge"})
    record = Record(
        "surge-1", "decay", "fit", "surge", time, {"surge": motion}, None, None, {"surge": NOISE}, True, 0.0, test, "made"
    )
    space = parameter_space(declared, [*true, "column.Cd_z"])
    at_rest = SimpleNamespace(manifest=SimpleNamespace(zero=True))
    problem = set_up_decays(declared, at_rest, [record], space)
    fit = fit_of_decays(problem, [record], space.start)
    run_fit(fit)
    tests = series_of(problem, [record], fit.unknowns)
    return fit, tests, identifiability_of(fit), space.model(declared, fit.unknowns.shared)


def test_a_surge_decay_knows_the_added_mass_of_the_hull_and_not_whose_it_is(surge) -> None:
    _, _, findings, model = surge
    weak = next(weak for weak in findings.weak if "column.Ca_t" in weak.movement)
    assert set(weak.movement) == {"column.Ca_t", "pontoon.Ca_t"} and weak.known is not None
    sentences = " | ".join(findings.sentences())
    assert "1 surge decay cannot tell column.Ca_t from pontoon.Ca_t" in sentences
    assert "no record responds to column.Cd_z" in sentences
    # the weights are what either coefficient adds to the mass in surge
    position = jh.equilibrium(model)

    @jax.jit
    @jax.grad
    def added(values: dict) -> jnp.ndarray:
        return linearised(model.with_values(values), position)[0][0, 0]

    per = added({label: model.values[label] for label in weak.movement})
    ratio = float(per["pontoon.Ca_t"] / per["column.Ca_t"])
    assert weak.known.weights == pytest.approx({"column.Ca_t": 1.0, "pontoon.Ca_t": ratio}, rel=0.02)
    # and the true sum is where it should be
    truth = weak.known.weights["column.Ca_t"] * 1.3 + weak.known.weights["pontoon.Ca_t"] * 0.6
    assert abs(weak.known.value - truth) < 4 * weak.known.standard_deviation < 0.1 * truth


def test_the_information_of_a_made_decay_is_that_of_the_fitted_one(surge) -> None:
    fit, tests, findings, model = surge
    noise = effective_noise(fit, tests)
    assert noise["surge"] == pytest.approx(NOISE, rel=0.5)
    period = jh.natural_modes(model).of("surge")
    predicted = decay_information(model, fit.decays.problem.space, "surge", 6.0, noise, cycles=LENGTH / period, interval=3.3)
    first, second = np.sqrt(np.diag(findings.information)), np.sqrt(np.diag(predicted))
    np.testing.assert_allclose(second[:3], first[:3], rtol=0.03)


def test_a_pitch_decay_is_worth_more_than_another_surge_decay(surge) -> None:
    fit, tests, findings, model = surge
    noise = effective_noise(fit, tests) | {"pitch": math.radians(0.01)}
    made = {
        "another surge decay": decay_information(
            model, fit.decays.problem.space, "surge", 6.0, {"surge": noise["surge"]}, cycles=LENGTH / 128, interval=3.3
        ),
        "a pitch decay": decay_information(
            model, fit.decays.problem.space, "pitch", math.radians(5.0), {"pitch": noise["pitch"]}
        ),
    }
    first, second = rank_tests(findings, made)
    assert first.name == "a pitch decay" and first.gain > second.gain + 1
    index = findings.parameters.labels.index("pontoon.Ca_t")
    assert first.after[index] < IDENTIFIABLE_DEVIATION < second.after[index]
    assert "pontoon.Ca_t from" in first.sentence() and "0 weak directions left" in first.sentence()


def test_a_candidate_that_measures_nothing_of_its_motion_is_refused(surge) -> None:
    fit, _, _, model = surge
    with pytest.raises(ValueError, match="the motion released, found pitch"):
        decay_information(model, fit.decays.problem.space, "surge", 6.0, {"pitch": 1e-4})
