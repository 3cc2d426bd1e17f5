"""Multi-start search: the coefficients of a simulated decay from a far start; seeds, budgets, stops, bad input."""

import dataclasses
import json
import math
from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest
from test_calibration import SHIP, SHIP_TRUE, model_of, roll_decay, write
from test_cli import cache, run  # noqa: F401

import jaxhydro as jh
from calibration import load_campaign
from calibration.campaign.load_campaign import Campaign
from calibration.fitting.decay_fit import fit_of_decays, run_fit
from calibration.fitting.progress import Progress
from calibration.global_search.multistart import MultiStart
from calibration.global_search.objective import coordinates, ranges
from calibration.global_search.run_search import DEFAULT_FACTOR, Found, SearchInterrupted, search, set_up_search
from calibration.global_search.task import FAILED_OBJECTIVE, Budget, Task, even_batch
from calibration.residuals.decays import first_guess
from jaxhydro.errors import InputError

NOISE, OFFSET = 2e-4, 3e-3  # rad
STARTS = 33  # one batch
ENOUGH = Budget(seconds=60.0, simulations=3000.0, objective=0.005)  # the noise alone is 0.002
LABELS = list(SHIP_TRUE)


def far_campaign(folder: Path, **options) -> Campaign:
    """A noisy roll decay of a body without members, its sensor off by OFFSET."""
    time, roll = roll_decay(12.0, 30.0)
    noisy = roll + OFFSET + NOISE * np.random.default_rng(3).standard_normal(len(time))
    tests = {"roll": ({"kind": "decay", "degree_of_freedom": "roll", "use": "fit"}, time, {"roll": noisy})}
    # the declared values are far from the truth, and not in the middle of what is searched
    document = SHIP | {"added_mass": {"A44": 60.0}, "linear_damping": {"B44": 12.0}, "quadratic_damping": {"B44": 5.0}}
    return load_campaign(write(folder, document, tests, noise={"roll": NOISE}, **options))


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Campaign:
    return far_campaign(tmp_path_factory.mktemp("ship"))


def true_objective(campaign: Campaign) -> float:
    """J of the true coefficients, releases fitted."""
    problem, records = set_up_search(campaign)
    x = jnp.array([p.transform.inverse(SHIP_TRUE[p.label]) for p in problem.space.free])
    fit = fit_of_decays(problem, records, x)
    run_fit(fit)
    return fit.decays.objective()


@pytest.mark.slow
def test_a_search_finds_the_coefficients(campaign: Campaign) -> None:
    best = search(campaign, starts=STARTS, seed=1, budget=ENOUGH)
    assert best.method == "multistart" and best.ended == "reached"
    assert true_objective(campaign) < best.objective <= ENOUGH.objective
    assert set(best.values) == set(SHIP_TRUE)
    period = [jh.natural_modes(model_of(SHIP, values)).of("roll") for values in (best.values, SHIP_TRUE)]
    assert period[0] == pytest.approx(period[1], rel=2e-3)
    assert best.values["quadratic_damping.B44"] == pytest.approx(SHIP_TRUE["quadratic_damping.B44"], rel=0.2)
    check_history(best)


def check_history(best: Found) -> None:
    """It falls, and ends where the search did."""
    history = best.history
    assert (np.diff(history.objective) <= 0).all() and history.objective[-1] == best.objective
    assert (np.diff(history.simulations) >= 0).all() and history.simulations[-1] == best.simulations
    assert (np.diff(history.seconds) >= 0).all() and history.seconds[-1] == best.seconds
    assert history.until(best.objective) == (history.simulations[-2], history.seconds[-2])
    assert history.until(0.5 * best.objective) is None


@pytest.mark.slow
def test_the_same_seed_gives_the_same_search_and_leaves_others_chance_alone(campaign: Campaign) -> None:
    def state() -> np.ndarray:
        return np.random.get_state()[1].copy()  # noqa: NPY002

    budget, before = Budget(math.inf, 400.0), state()
    first, same, other_seed = (search(campaign, starts=STARTS, seed=seed, budget=budget) for seed in (7, 7, 8))
    assert first.values == same.values and first.objective == same.objective and first.simulations == same.simulations
    assert first.values != other_seed.values and first.ended == "budget" and 400 <= first.simulations < 400 + 36
    np.testing.assert_array_equal(state(), before)


@pytest.mark.slow
def test_a_budget_of_seconds_ends_a_search(campaign: Campaign) -> None:
    best = search(campaign, starts=STARTS, finalists=STARTS, seed=2, budget=Budget(1.0))
    assert best.ended == "budget" and 1.0 <= best.seconds < 2.0


@pytest.mark.slow
def test_multi_start_settles_where_the_truth_is(campaign: Campaign) -> None:
    reports: list[Progress] = []
    best = search(campaign, starts=STARTS, finalists=1, seed=3, progress=reports.append)
    assert best.ended == "settled" and best.objective == pytest.approx(true_objective(campaign), rel=1e-3)
    assert reports[-1].stage == "start 1 of 1: noise level" and reports[-1].objective == best.objective
    model = jh.build(campaign.platform).with_values(best.values)  # what `calibrate(start=...)` begins from
    assert jh.natural_modes(model).of("roll") == pytest.approx(jh.natural_modes(model_of(SHIP, SHIP_TRUE)).of("roll"), rel=1e-3)


@pytest.mark.slow
def test_ctrl_c_gives_what_was_reached(campaign: Campaign) -> None:
    reports: list[Progress] = []

    def stop(p: Progress) -> None:
        reports.append(p)
        if sum(math.isfinite(p.objective) for p in reports) == 2:
            raise KeyboardInterrupt

    with pytest.raises(SearchInterrupted) as caught:
        search(campaign, starts=STARTS, seed=1, progress=stop)
    partial = caught.value.partial
    assert partial is not None and partial.ended == "interrupted" and math.isfinite(partial.objective)
    assert set(partial.values) == set(SHIP_TRUE)
    assert all(p.stage and 0 <= p.fraction <= 1 for p in reports)


def test_ctrl_c_before_anything_is_reached(campaign: Campaign) -> None:
    def stop(_: Progress) -> None:
        raise KeyboardInterrupt

    with pytest.raises(SearchInterrupted) as caught:
        search(campaign, starts=STARTS, progress=stop)
    assert caught.value.partial is None


def test_j_is_the_contracts_and_free_of_offsets(campaign: Campaign) -> None:
    problem, records = set_up_search(campaign)
    x = jnp.array([p.transform.inverse(SHIP_TRUE[p.label]) for p in problem.space.free])
    fit = fit_of_decays(problem, records, x)
    run_fit(fit)
    at = np.asarray(fit.unknowns.shared)[None]
    task = Task(problem, records, fit.unknowns.own, Budget())
    # its prior keeps the fit's offset from the mean residual by next to nothing
    assert task.simulate(at)[0] == pytest.approx(fit.decays.objective(), rel=1e-6)
    moved = fit.unknowns.own.at[0, 2].add(1.0)
    assert Task(problem, records, moved, Budget()).simulate(at)[0] == pytest.approx(fit.decays.objective(), rel=1e-6)


@pytest.mark.slow
def test_the_command_calibrates_from_end_to_end(campaign: Campaign, tmp_path: Path) -> None:
    """Between the bounds of the searches: the program is theirs."""
    bounds = {label: list(ends) for label, ends in ranges(jh.build(campaign.platform), LABELS, {}, DEFAULT_FACTOR, "x").items()}
    bounded = far_campaign(tmp_path / "ship", calibrate={"bounds": bounds})
    assert "converged after" in run("calibrate", bounded.folder, "--no-figures", "--out", tmp_path / "o")
    read = json.loads((tmp_path / "o" / "calibration.json").read_text())["baseline"]
    assert set(read["parameters"]) == set(SHIP_TRUE) and read["converged"]
    error = read["error"]["roll"]["roll"]
    assert error["relative"] < 0.1 < error["before"]["relative"]
    assert read["parameters"]["added_mass.A44"]["value"] == pytest.approx(SHIP_TRUE["added_mass.A44"], rel=0.01)


def test_a_simulation_without_a_number_counts_as_a_bad_one(campaign: Campaign) -> None:
    problem, records = set_up_search(campaign)
    task = Task(problem, records, first_guess(records, problem.data), Budget())
    task.batch = 7
    x = np.array(problem.space.start)
    values = task.simulate(np.array([x, x * np.nan] * 5))  # two batches, the second one padded
    assert (values[1::2] == FAILED_OBJECTIVE).all() and (values[::2] == values[0]).all() and values[0] < FAILED_OBJECTIVE
    assert task.best == values[0] and task.simulations == 10
    bad = Task(problem, records, first_guess(records, problem.data) * np.nan, Budget())
    assert bad.simulate(x[None])[0] == FAILED_OBJECTIVE and math.isinf(bad.best)


def test_descents_that_are_lost_are_given_up(campaign: Campaign) -> None:
    """A release that is no number makes every descent's simulations none: the search ends without an answer, and says so."""
    record = dataclasses.replace(campaign.records[0], values={"roll": campaign.records[0].values["roll"] * np.nan})
    with pytest.raises(ValueError, match="expected enough for one simulation"):
        search(dataclasses.replace(campaign, records=(record,)), starts=STARTS, finalists=2)


def test_points_of_the_cube_are_shares_of_logarithmic_ranges(campaign: Campaign) -> None:
    problem, _ = set_up_search(campaign, factor=10.0)
    for share in (0.0, 0.25, 0.5, 1.0):
        values = problem.space.values(jnp.asarray(coordinates(problem.space, np.full((1, 3), share))[0]))
        for label, value in values.items():
            declared = float(problem.model.values[label])
            assert float(value) == pytest.approx(declared * 100 ** (share - 0.5), rel=1e-4)


def test_ranges_keep_to_what_is_given_and_what_is_physical(campaign: Campaign) -> None:
    model = jh.build(campaign.platform)
    given = {"added_mass.A44": (20.0, 40.0)}
    assert ranges(model, LABELS, given, 10.0, "x") == given | {
        "linear_damping.B44": pytest.approx((1.2, 120.0)),
        "quadratic_damping.B44": pytest.approx((0.5, 50.0)),
    }
    with pytest.raises(InputError, match="expected bounds to search between") as caught:
        ranges(model.with_values({"linear_damping.B44": 0.0}), LABELS, given, 10.0, "x")
    assert [p.where for p in caught.value.problems] == ["calibrate.bounds.linear_damping.B44"]


def test_batches_are_even() -> None:
    assert [even_batch(n) for n in (1, 11, 36, 45, 64, 99, 165)] == [1, 11, 36, 23, 32, 33, 33]
    assert MultiStart().batch_size(11) == 32


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"starts": 0}, "starts: expected a number above 0, found 0"),
        ({"finalists": -1}, "finalists: expected a number above 0, found -1"),
        ({"seed": -1}, "seed: expected a whole number from 0, found -1"),
        ({"seed": 1.5}, "seed: expected a whole number from 0, found 1.5"),
        ({"budget": Budget(0.0)}, "budget: expected seconds and simulations above 0, found 0.0"),
        ({"budget": Budget(math.nan)}, "budget: expected seconds and simulations above 0, found nan"),
        ({"factor": 1.0}, "factor: expected a number above 1, found 1.0"),
    ],
)
def test_bad_options_are_told(options: dict, words: str, campaign: Campaign) -> None:
    with pytest.raises(ValueError) as caught:
        search(campaign, **options)
    assert words in str(caught.value)


def test_nothing_to_search_is_told(campaign: Campaign) -> None:
    bare = {key: value for key, value in SHIP.items() if key not in ("added_mass", "linear_damping", "quadratic_damping")}
    for changed, words in (
        ({"records": ()}, "at least one decay test marked"),
        ({"platform": jh.Platform.model_validate(bare)}, "at least one free parameter"),
    ):
        with pytest.raises(InputError) as caught:
            search(dataclasses.replace(campaign, **changed))
        assert words in str(caught.value)
