"""What OpenFAST itself asks of an exported deck, by the text of the deck. Runs: tests/systems/test_openfast_runs.py."""

from pathlib import Path

import numpy as np
import pytest
from test_openfast_export import BUILT_IN, SAME, RoundTrip, round_trip, said

from jaxhydro.dynamics.statics import linearised
from jaxhydro.interop.conversion import Treatment
from jaxhydro.platform.build import build
from jaxhydro.platform.schema import load_platform


@pytest.fixture(scope="module")
def trips(tmp_path_factory: pytest.TempPathFactory) -> dict[str, RoundTrip]:
    folder = tmp_path_factory.mktemp("decks")
    return {name: round_trip(load_platform(name), folder / name) for name in BUILT_IN}


def keyed(text: str, key: str) -> float:
    """Number of a key of a file's text."""
    return next(float(line.split()[0]) for line in text.splitlines() if line.split()[1:2] == [key])


@pytest.mark.parametrize("name", BUILT_IN)
def test_hydrodyn_gets_both_limits_of_the_added_mass(trips: dict[str, RoundTrip], name: str) -> None:
    """OpenFAST stops without rows of zero and of infinite frequency: WAMIT_Init of v5.0.0."""
    rows = [line.split() for line in trips[name].deck.texts["potential.1"].splitlines()]
    limits = {period: {tuple(words[1:3]) for words in rows if words[0] == period} for period in ("-1.0", "0.0")}
    assert len(limits["-1.0"]) == 36 and limits["-1.0"] == limits["0.0"]
    assert all(len(words) == (4 if float(words[0]) <= 0.0 else 5) for words in rows)


def test_decks_have_the_tables_and_grids_that_openfast_asks_for(trips: dict[str, RoundTrip]) -> None:
    """Outputs of blade nodes, without which ElastoDyn warns; 5 m between points of SeaState, which interpolates linearly."""
    texts = trips["volturnus-s"].deck.texts
    assert keyed(texts["elastodyn.dat"], "BldNd_BladesOut") == 0
    sea = texts["seastate.dat"]
    assert 2 * keyed(sea, "X_HalfWidth") / (keyed(sea, "NX") - 1) <= 5.0
    assert "NY as NX" in said(trips["volturnus-s"].deck, "sea", Treatment.APPROXIMATED)
    assert keyed(texts["main.fst"], "DT") == 0.025


def test_a_stiff_pile_on_the_bed_gets_a_short_step_and_stays_above_the_grid(tmp_path: Path) -> None:
    """OpenFAST diverges with 0.025 s at a natural period of 0.073 s, and warns of points below the bed."""
    trip = round_trip(load_platform("oc3-monopile"), tmp_path / "deck")
    assert keyed(trip.deck.texts["main.fst"], "DT") == 0.0025
    assert trip.after.members[0].rA[2] == pytest.approx(-19.999, abs=1e-12)
    assert trip.after.mooring.matrix() == pytest.approx(trip.before.mooring.matrix(), rel=SAME)


def test_the_added_mass_of_a_barge_is_in_the_table(trips: dict[str, RoundTrip]) -> None:
    """Nodes of its members come out of the water and go under: with their own added mass OpenFAST does not converge."""
    trip = trips["iti-barge"]
    added = [
        np.asarray(linearised(model, np.zeros(6))[0]) - np.asarray(model.body.mass_matrix())
        for model in map(build, (trip.before, trip.after))
    ]
    assert np.diag(added[1]) == pytest.approx(np.diag(added[0]), rel=1e-8)
    assert "PER = 0" in said(trip.deck, "Ca_t, Ca_z", Treatment.APPROXIMATED)
    assert "table of excitation" in said(trip.deck, "coefficients", Treatment.LEFT_OUT)
