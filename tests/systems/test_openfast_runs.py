"""Exported decks in OpenFAST itself, where its executable is on the PATH."""

import shutil
from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest

import jaxhydro as jh
from benchmarks.openfast_decks import SMALL_GRID
from benchmarks.openfast_decks_export import written
from benchmarks.openfast_decks_run import TEXT_OUTPUT, edit, initial, run

OPENFAST = shutil.which("openfast")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(OPENFAST is None, reason="no executable `openfast` (OpenFAST 5) is on the PATH"),
]


@pytest.mark.parametrize("name", jh.builtin_platforms())
def test_openfast_runs_the_deck_of_every_platform_without_a_warning(name: str, tmp_path: Path) -> None:
    written(jh.load_platform(name), tmp_path / "deck")
    edit(tmp_path / "deck", {"main.fst": {"TMax": 5.0, "OutFileFmt": 1}})
    result = run(str(OPENFAST), tmp_path / "deck")
    assert result.status == 0 and result.messages == ()


@pytest.mark.parametrize("dof, offset, limit", [("surge", 5.0, 2e-4), ("heave", 2.0, 2e-4), ("pitch", 0.05, 2e-3)])
def test_decays_are_those_of_openfast(dof: str, offset: float, limit: float, tmp_path: Path) -> None:
    platform = jh.load_platform("oc3-hywind")
    model = jh.build(platform)
    start = np.asarray(jh.equilibrium(model)).copy()
    start[jh.DOFS.index(dof)] += offset
    deck = tmp_path / "deck"
    written(platform, deck)
    edit(deck, {"main.fst": TEXT_OUTPUT | {"TMax": 100.0, "DT": 0.05}, "seastate.dat": SMALL_GRID})
    edit(deck, initial(start))
    result = run(str(OPENFAST), deck)
    assert result.status == 0
    simulated = np.asarray(jh.simulate(model, result.times, position=jnp.asarray(start))[dof])
    assert np.abs(simulated - result.motion[jh.DOFS.index(dof)]).max() < limit * offset
