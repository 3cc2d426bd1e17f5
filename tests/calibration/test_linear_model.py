"""Fits, evidence and selection on linear models whose answers are known."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import dblquad
from scipy.optimize import minimize

from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.search import ListedVariant
from calibration.discovery.selection import bounded_quadratic
from calibration.discovery.selection.bounded_quadratic import bounded_minimum
from calibration.discovery.selection.candidate_passes import is_listed
from calibration.discovery.selection.cross_validation import held_out_gain, left_out_deviances
from calibration.discovery.selection.joint_selection import MAX_EFFECTS, JointSelection
from calibration.discovery.selection.linear_model import SMALL_CHANGE, LinearModel
from calibration.discovery.selection.pooled_products import OwnUnknowns
from calibration.discovery.selection.subsets import Selection, Variant

ROWS, POOLS = 240, 12


def linear_model(columns: int, truth: dict[int, float], seed: int = 1, noise: float = 1.0, own: int = 0) -> LinearModel:
    """A linear model of `columns` random columns, whose residual is -X truth and noise; rows in twelve pools of one floor."""
    random = np.random.default_rng(seed)
    slopes = random.standard_normal((ROWS, columns))
    step = np.zeros(columns)
    step[list(truth)] = list(truth.values())
    residual = -slopes @ step + noise * random.standard_normal(ROWS)
    pool = np.repeat(np.arange(POOLS), ROWS // POOLS)
    decays = []
    if own:
        decay_rows = slice(0, ROWS // 2)
        side = random.standard_normal((ROWS // 2, own))
        residual[decay_rows] -= side @ np.full(own, 2.0)
        decays.append(OwnUnknowns(decay_rows, side, np.full(own, 50.0), np.full(own, 0.5)))
    freedom = np.full(POOLS, float(ROWS // POOLS))
    wide, none, share = np.full(columns, 10.0), np.zeros(columns), np.full(ROWS, POOLS / ROWS)
    low, high = none - 1e3, none + 1e3
    group = np.arange(ROWS)
    return LinearModel(slopes, residual, tuple(decays), pool, share, freedom, none, wide, low, high, none, none == 0, group)


def test_a_fit_is_the_minimum_of_likelihood_and_priors_found_by_another_method() -> None:
    model = linear_model(3, {0: 0.8, 1: -0.5}, noise=3.0, own=2)
    fit = model.fit([0, 1, 2])

    def cost(unknowns: np.ndarray) -> float:
        residual = model.residual + model.slopes @ unknowns[:3]
        residual[model.own[0].rows] += model.own[0].slopes @ unknowns[3:]
        own = (model.own[0].value + unknowns[3:]) / model.own[0].width
        return float(model.deviances(model.levels(residual)).sum() + ((unknowns[:3] / model.width) ** 2).sum() + (own**2).sum())

    best = minimize(cost, np.zeros(5), method="BFGS")
    assert fit.cost == pytest.approx(best.fun, abs=0.02)
    assert fit.step == pytest.approx(best.x[:3], abs=0.02)
    assert fit.own[0] == pytest.approx(best.x[3:], abs=0.02)
    assert cost(np.append(fit.step, fit.own[0])) == pytest.approx(fit.cost, abs=1e-8)


def test_bounds_hold_and_the_other_columns_are_solved_for_again() -> None:
    model = linear_model(2, {0: 2.0, 1: 1.0})
    model.slopes[:, 1] += 0.8 * model.slopes[:, 0]
    free = model.fit([0, 1])
    bounded = replace(model, upper=np.array([free.step[0] - 1.0, 1e3])).fit([0, 1])
    assert bounded.step[0] == pytest.approx(free.step[0] - 1.0) and bounded.at_bound.tolist() == [True, False]
    assert bounded.step[1] > free.step[1] + 0.2  # what it stands for goes to its neighbour


def test_the_evidence_is_the_integral_over_the_columns() -> None:
    model = linear_model(2, {0: 0.1}, noise=1.0)
    model = replace(model, freedom=0.2 * model.freedom)  # wide enough to integrate
    fit = model.fit([0, 1])

    def density(b: float, a: float) -> float:
        step = np.array([a, b])
        cost = model.deviances(model.levels(model.residual + model.slopes @ step)).sum() + ((step / model.width) ** 2).sum()
        return math.exp(-0.5 * (cost - fit.cost)) / (2 * math.pi * model.width.prod())

    total = dblquad(density, -2, 2, -2, 2, epsabs=1e-9)[0]
    assert model.log_evidence(fit) == pytest.approx(math.log(total) - 0.5 * fit.cost, abs=0.15)


def test_a_column_that_is_not_fitted_is_neutral() -> None:
    model = replace(linear_model(2, {0: 1.0}), neutral=np.array([0.0, 0.7]))
    without = model.fit([0])
    assert model.residual_after(without) == pytest.approx(
        model.residual + model.slopes @ np.array([without.step[0], 0.7]), abs=1e-12
    )


def selection(model: LinearModel, variants: list[Variant] | None = None, base: int = 2) -> JointSelection:
    one_per_column = [Variant(f"effect {i}", (i,), math.log(0.03)) for i in range(base, model.slopes.shape[1])]
    return JointSelection(model, range(base), variants or one_per_column, np.arange(POOLS))


def test_the_effects_that_are_there_are_selected_and_no_others() -> None:
    posterior = selection(linear_model(20, {0: 1.0, 5: 0.6, 11: -0.8})).run()
    assert set(posterior.names(posterior.best)) == {"effect 5", "effect 11"}
    probability = posterior.probability()
    assert min(probability["effect 5"], probability["effect 11"]) > 0.95
    assert max(p for name, p in probability.items() if name not in ("effect 5", "effect 11")) < 0.2


@pytest.mark.parametrize("seed", range(4))
def test_nothing_is_selected_where_nothing_is_missing(seed: int) -> None:
    posterior = selection(linear_model(20, {0: 1.0}, seed)).run()
    assert posterior.names(posterior.best) == ()
    assert max(posterior.probability().values(), default=0.0) < 0.5


def test_of_two_that_look_alike_each_has_its_part_of_the_probability() -> None:
    model = linear_model(8, {3: 0.5})
    model.slopes[:, 4] = model.slopes[:, 3] + 0.02 * model.slopes[:, 4]
    probability = selection(model).run().probability()
    assert probability["effect 3"] + probability["effect 4"] > 0.95
    assert min(probability["effect 3"], probability["effect 4"]) > 0.1


def test_a_candidate_is_taken_at_one_of_its_values_only() -> None:
    variants = [Variant("memory", (2,), -3.0), Variant("memory", (3,), -3.0), Variant("friction", (4,), -3.0)]
    posterior = selection(linear_model(5, {2: 0.7, 3: 0.7}), variants).run()
    assert all(len(set(posterior.names(subset))) == len(subset.variants) for subset in posterior.subsets)


def test_effects_at_the_ends_of_their_ranges_are_taken_alone_or_not_at_all() -> None:
    """Two of them explain more than one that is not at an end; alone, what is at an end is still selected."""
    model = linear_model(8, {3: 0.9, 4: 0.9, 5: 0.5})
    narrow = replace(model, lower=np.where(np.isin(np.arange(8), (3, 4)), -0.6, model.lower), upper=np.full(8, 0.6))
    assert set(selection(model).run().best.variants) == {1, 2, 3}
    posterior = selection(narrow).run()
    assert all(len(subset.variants) < 2 for subset in posterior.subsets if subset.at_end)
    assert posterior.names(posterior.best) in {("effect 3",), ("effect 4",), ("effect 5",)}
    once = linear_model(8, {3: 0.9})
    posterior = selection(replace(once, upper=np.full(8, 0.6))).run()
    assert posterior.names(posterior.best) == ("effect 3",) and posterior.best.at_end


@pytest.mark.parametrize("seed", range(5))
def test_a_minimum_at_a_bound_is_at_it_to_the_last_digit(seed: int) -> None:
    random = np.random.default_rng(seed)
    root, width = random.standard_normal((30, 6)), 10.0 ** random.uniform(-3, 3, 6)
    matrix, slope, high = root.T @ root, 100 * random.standard_normal(6), width / 7
    minimum = bounded_minimum(matrix, slope, -high, high)
    assert (np.abs(minimum) == high).sum() >= 3
    at, gradient = np.abs(minimum) == high, matrix @ minimum + slope
    assert (gradient[at] * minimum[at] < 0).all() and np.abs(gradient[~at]).max(initial=0.0) < 1e-6 * np.abs(slope).max()


@pytest.mark.parametrize("seed", range(5))
def test_bounds_exchanged_together_are_those_exchanged_one_by_one(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(seed)
    root = random.standard_normal((40, 20)) * 10.0 ** random.uniform(-3, 3, 20)
    matrix, slope = root.T @ root, 20 * root.T @ random.standard_normal(40)
    high = np.where(random.random(20) < 0.5, np.inf, random.uniform(0.01, 1, 20) / np.sqrt(np.diag(matrix)))
    low = -random.permutation(high)
    together = bounded_minimum(matrix, slope, low, high)
    assert ((together == low) | (together == high)).any()
    monkeypatch.setattr(bounded_quadratic, "active_set", lambda *_: None)
    np.testing.assert_allclose(together, bounded_minimum(matrix, slope, low, high), rtol=1e-7)


def test_an_effect_that_hardly_matters_is_not_selected() -> None:
    """However sure it is; it comes in as soon as what it takes is a large enough part of what the others leave."""
    model = linear_model(8, {3: 6.0, 5: 1.0})

    def some(share: float) -> tuple[str, ...]:
        def matters(before: np.ndarray, after: np.ndarray) -> bool:
            return float((after**2).sum()) < (1 - share) * float((before**2).sum())

        chosen = JointSelection(model, range(2), selection(model).variants, np.arange(POOLS), matters=matters)
        posterior = chosen.run()
        return tuple(sorted(posterior.names(posterior.best)))

    two_effects, free = ("effect 3", "effect 5"), selection(model).run()
    assert tuple(sorted(free.names(free.best))) == two_effects == some(0.3)
    assert some(0.8) == ("effect 3",)


def test_a_set_has_no_more_effects_than_anybody_can_test() -> None:
    """The largest of eleven, each of them sure."""
    posterior = selection(linear_model(16, {i: 1.0 + 0.2 * i for i in range(4, 15)})).run()
    assert set(posterior.best.variants) == {i - 2 for i in range(7, 15)} and len(posterior.best.variants) == MAX_EFFECTS
    assert all(len(subset.variants) <= MAX_EFFECTS for subset in posterior.subsets)


def test_only_the_named_variants_are_selected() -> None:
    model = linear_model(8, {3: 1.0, 5: 1.0})
    chosen = JointSelection(model, range(2), selection(model).variants, np.arange(POOLS), among=[1, 2])
    posterior = chosen.run()
    assert posterior.names(posterior.best) == ("effect 3",) and "effect 5" not in posterior.probability()


def test_a_required_effect_is_in_the_answer_and_keeps_its_probability() -> None:
    """One that does nothing stays improbable; what is there is found beside it. Where it hardly matters it stays, too."""
    model = linear_model(12, {5: 1.0})

    def one(**options: Any) -> Selection:
        return JointSelection(model, range(2), selection(model).variants, np.arange(POOLS), **options).run()

    posterior = one(required=frozenset({"effect 8"}))
    assert set(posterior.names(posterior.best)) == {"effect 5", "effect 8"}
    assert posterior.probability()["effect 5"] > 0.95 and posterior.probability().get("effect 8", 0.0) < 0.5
    at_end = replace(model, upper=np.where(np.arange(12) == 8, 1e-3, 1e3), lower=np.where(np.arange(12) == 8, -1e-3, -1e3))
    posterior = JointSelection(
        at_end, range(2), selection(model).variants, np.arange(POOLS), required=frozenset({"effect 8"})
    ).run()
    assert posterior.names(posterior.best) == ("effect 5",)  # no set of several has one at the end of its range
    many = linear_model(16, {i: 1.0 + 0.2 * i for i in range(4, 12)})
    chosen = JointSelection(many, range(2), selection(many).variants, np.arange(POOLS), required=frozenset({"effect 4"}))
    posterior = chosen.run(range(3, 11))  # as many as may be, without the required one
    assert (
        posterior.best.variants == tuple(range(2, 10))
        and max(len(subset.variants) for subset in posterior.subsets) == MAX_EFFECTS
    )
    posterior = one(required=frozenset({"effect 5"}), matters=lambda before, after: False)
    assert posterior.names(posterior.best) == ("effect 5",)


def test_a_model_that_leaves_more_than_noise_has_fewer_observations() -> None:
    """None at the noise, and as many fewer as the error is larger than the noise; what is not fitted does not count."""
    model = linear_model(3, {})
    model = replace(model, freedom=np.where(np.arange(POOLS) < 2, 0.0, 20.0))
    unit = 1 / np.sqrt(model.levels(np.ones(ROWS)))[model.pool]
    assert model.discrepancy(0.5 * unit) == 1.0
    assert model.discrepancy(3.0 * unit) == pytest.approx(3.0)
    assert model.discrepancy(np.where(model.pool < 7, 4.0, 1.0) * unit) == pytest.approx(2.0)
    assert model.discrepancy(np.where(model.pool < 2, 4.0, 1.0) * unit) == pytest.approx(1.0)


def test_what_no_effect_explains_makes_every_effect_less_sure() -> None:
    """An effect that leaves noise alone is as sure as before, however large the residual is without it."""
    clean, random = linear_model(8, {3: 6.0}), np.random.default_rng(4)
    dirty = replace(clean, residual=clean.residual + 5.0 * random.standard_normal(ROWS))
    first, second = selection(clean), selection(dirty)
    assert first.run().probability()["effect 3"] > 0.99
    assert first.model.freedom.sum() == clean.freedom.sum()
    second.run()
    assert 4.0 < dirty.freedom.sum() / second.model.freedom.sum() < 6.0


def test_what_one_series_alone_shows_is_less_sure_than_what_all_show() -> None:
    everywhere = linear_model(6, {2: 0.6})
    in_pool = everywhere.pool == 3
    noise = everywhere.residual + 0.6 * everywhere.slopes[:, 2]
    slopes = everywhere.slopes * np.where(in_pool[:, None] | (np.arange(6) != 2), 1.0, 0.0)
    once = replace(everywhere, slopes=slopes, residual=noise - 2.5 * slopes[:, 2])
    sure, unsure = (selection(model).run().probability()["effect 2"] for model in (everywhere, once))
    assert sure > 0.9 and 0.4 < unsure < 0.8  # a series is missing from 37 % of the resamplings


def test_a_group_that_is_left_out_is_predicted_by_the_others() -> None:
    """Its own unknowns are fitted to it, the columns to the others: as two fits by hand do."""
    model = linear_model(2, {0: 0.8}, own=2)
    group = np.where(np.arange(POOLS) < POOLS // 2, 0, 1)  # the decay, and the rest
    whole = model.fit([0, 1])
    deviances = left_out_deviances(model, [0, 1], group, whole)
    others_fit = replace(model, freedom=model.freedom * (group == 1)).fit([0, 1])
    residual = model.residual + model.slopes @ others_fit.step
    alone = replace(model, residual=residual, freedom=model.freedom * (group == 0)).fit([])
    assert deviances[0] == pytest.approx(alone.deviance.sum(), abs=SMALL_CHANGE)
    own = model.own[0]
    side = np.linalg.lstsq(own.slopes, -residual[own.rows], rcond=None)[0]
    assert alone.own[0] == pytest.approx(side, abs=0.05)


def test_an_effect_that_is_there_predicts_what_is_left_out_and_another_does_not() -> None:
    model, group = linear_model(4, {2: 0.8}), np.arange(POOLS) // 3
    without = model.fit([0, 1])
    present, absent = (held_out_gain(model, model.fit([0, 1, column]), without, group) for column in (2, 3))
    assert present.shape == (4,) and (present > 0).all()
    assert absent.sum() < 4.0 < present.sum()


def test_products_after_a_fit_are_those_of_its_rows() -> None:
    """With weights of the fit, and the decay's own unknowns eliminated where the fit has moved them."""
    model = replace(linear_model(3, {0: 0.8}, noise=3.0, own=2), neutral=np.array([0.0, 0.4, 0.0]))
    model.own[0].value[:] = 0.3
    fit = model.fit([0])
    residual = model.residual_after(fit)
    assert fit.levels == pytest.approx(model.levels(residual), rel=1e-10)
    weight = (model.freedom / np.maximum(model.levels(residual), 1.0))[model.pool] * model.share
    decay, columns = model.own[0], np.column_stack([model.slopes, residual])
    whole = columns.T @ (weight[:, None] * columns)
    side = weight[decay.rows, None] * decay.slopes
    cross = side.T @ columns[decay.rows]
    cross[:, -1] += (decay.value + fit.own[0]) / decay.width**2
    whole -= cross.T @ np.linalg.solve(side.T @ decay.slopes + np.diag(1 / decay.width**2), cross)
    assert model.products_after(fit) == pytest.approx(whole, rel=1e-8, abs=1e-8)


def test_later_rounds_are_along_the_candidates_that_are_listed() -> None:
    """By the declared values of their shapes that are listed; by all where values were fitted or found, or slopes find more."""
    slow, fast = {"memory.frequency": 0.3}, {"memory.frequency": 0.6}
    memory = Candidate("radiation_memory", "surge", ("memory.strength",), grid=(slow, fast))
    assert is_listed(memory, slow, ListedVariant("radiation_memory (surge)", slow))
    assert not is_listed(memory, fast, ListedVariant("radiation_memory (surge)", slow))
    assert is_listed(memory, fast, ListedVariant("radiation_memory (surge)", {}))
    assert not is_listed(memory, slow, ListedVariant("radiation_memory (heave)", slow))
    oscillator = replace(memory, shape_finder=lambda *_: [])
    assert is_listed(oscillator, fast, ListedVariant("radiation_memory (surge)", slow))
    friction = Candidate("coulomb_friction", "surge", ("friction.force",))
    assert is_listed(friction, {}, ListedVariant("coulomb_friction (surge)", {}))
