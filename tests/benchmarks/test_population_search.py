"""Population searches: the coefficients of a simulated decay from a far start; seeds, budgets, stops."""

import math

import numpy as np
import pytest
from test_calibration import SHIP, SHIP_TRUE, model_of
from test_search import ENOUGH, check_history, far_campaign, true_objective

import jaxhydro as jh
from benchmarks.population_search import CMAES, POPULATIONS, DifferentialEvolution, Genetic, PopulationSearch
from calibration.campaign.load_campaign import Campaign
from calibration.fitting.progress import Progress
from calibration.global_search.run_search import Found, SearchInterrupted, run, set_up_search
from calibration.global_search.task import Budget, Task

pytestmark = pytest.mark.slow

# one size of batch, CMA-ES's apart: less to compile
CHOSEN: dict[str, PopulationSearch] = {
    method.name: method for method in (CMAES(), Genetic(population=33), DifferentialEvolution(population=11))
}


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Campaign:
    return far_campaign(tmp_path_factory.mktemp("ship"))


def search(campaign: Campaign, name: str, seed: int, budget: Budget = Budget(), progress=lambda _: None) -> Found:
    return run(Task(*set_up_search(campaign), None, budget, progress), CHOSEN[name], seed)


@pytest.fixture(scope="module")
def searches(campaign: Campaign) -> dict[str, Found]:
    """Every method once."""
    return {name: search(campaign, name, 1, ENOUGH) for name in CHOSEN}


@pytest.mark.parametrize("name", CHOSEN)
def test_every_method_finds_the_coefficients(name: str, searches: dict[str, Found], campaign: Campaign) -> None:
    result = searches[name]
    assert (
        result.method == name and result.ended == "reached" and true_objective(campaign) < result.objective <= ENOUGH.objective
    )
    assert set(result.values) == set(SHIP_TRUE)
    period = [jh.natural_modes(model_of(SHIP, values)).of("roll") for values in (result.values, SHIP_TRUE)]
    assert period[0] == pytest.approx(period[1], rel=2e-3)
    assert result.values["quadratic_damping.B44"] == pytest.approx(SHIP_TRUE["quadratic_damping.B44"], rel=0.2)
    check_history(result)


@pytest.mark.parametrize("name", CHOSEN)
def test_the_same_seed_gives_the_same_search_and_leaves_others_chance_alone(name: str, campaign: Campaign) -> None:
    def state() -> np.ndarray:
        return np.random.get_state()[1].copy()  # noqa: NPY002

    budget, before = Budget(math.inf, 400.0), state()
    first, same, other_seed = (search(campaign, name, seed, budget) for seed in (7, 7, 8))
    assert first.values == same.values and first.objective == same.objective and first.simulations == same.simulations
    assert first.values != other_seed.values and first.ended == "budget" and 400 <= first.simulations < 400 + 36
    np.testing.assert_array_equal(state(), before)


def test_ctrl_c_gives_what_was_reached(campaign: Campaign) -> None:
    reports: list[Progress] = []

    def stop(p: Progress) -> None:
        reports.append(p)
        if sum(math.isfinite(p.objective) for p in reports) == 2:
            raise KeyboardInterrupt

    for name in CHOSEN:
        reports.clear()
        with pytest.raises(SearchInterrupted) as caught:
            search(campaign, name, 1, progress=stop)
        partial = caught.value.partial
        assert partial is not None and partial.ended == "interrupted" and set(partial.values) == set(SHIP_TRUE)


def test_batches_are_even(campaign: Campaign) -> None:
    assert {name: method().batch_size(11) for name, method in POPULATIONS.items()} == {"cma-es": 11, "ga": 33, "de": 33}
    with pytest.raises(ValueError, match="two coefficients or more, found 1"):
        CMAES().batch_size(1)
