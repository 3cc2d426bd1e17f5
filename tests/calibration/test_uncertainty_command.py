"""The uncertainty command: what it finds is what Python finds, and what does not fit together is told."""

import json
from pathlib import Path

import numpy as np
import pytest
from fake_calibration import fake_calibration
from test_cli import cache, run, small_campaign  # noqa: F401
from test_uncertainty import FREE, campaign_of

from calibration import calibrate, load_campaign
from calibration.formatting import interval, to_width
from calibration.results.write_calibration import write_calibration
from calibration.uncertainty.bootstrap import bootstrap_blocks, bootstrap_repeats
from calibration.uncertainty.likelihood import Likelihood
from calibration.uncertainty.likelihood_of_fit import likelihood
from calibration.uncertainty.profile import profile


@pytest.fixture(scope="module")
def ship(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path, Likelihood]:
    """A campaign's folder, that of its calibration, and its likelihood."""
    folder, results = tmp_path_factory.mktemp("ship"), tmp_path_factory.mktemp("results") / "results"
    campaign = campaign_of(folder)
    result = calibrate(campaign)
    write_calibration(result, results, figures=False)
    return campaign.folder, results, likelihood(campaign, result)


@pytest.fixture(scope="module")
def written(ship: tuple[Path, Path, Likelihood], tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    folder, results, _ = ship
    out = tmp_path_factory.mktemp("out") / "uncertainty"
    how = ("--calibration", results, "--profile", "added_mass.*", "--bootstrap", 40, "--seed", 3)
    return out, run("uncertainty", folder, *how, "--out", out)


@pytest.mark.slow
def test_what_is_written_is_what_python_finds(ship: tuple[Path, Path, Likelihood], written: tuple[Path, str]) -> None:
    (_, _, likely), (out, output) = ship, written
    content = json.loads((out / "uncertainty.json").read_text())
    assert set(content["parameters"]) == set(FREE) and content["level"] == 0.95 and content["converged"] is True
    draws = {"blocks": bootstrap_blocks(likely, 40, seed=3), "repeats": bootstrap_repeats(likely, 40, seed=3)}
    for label, intervals in content["parameters"].items():
        low, high = likely.interval(label)
        near = 0.01 * (high - low)  # the refit begins elsewhere
        np.testing.assert_allclose(intervals["laplace"], (low, high), atol=near)
        np.testing.assert_allclose(intervals["white"], likely.interval(label, white=True), atol=near)
        assert intervals["white_too_small_by"] == pytest.approx(likely.excess()[label], rel=0.01)
        np.testing.assert_allclose(intervals["blocks"], draws["blocks"].interval(label), atol=5 * near)
        np.testing.assert_allclose(intervals["repeats"], draws["repeats"].interval(label, kind="normal"), atol=5 * near)
        assert f"{label} {to_width(intervals['value'], high - low)}" in output
    along = profile(likely, "added_mass.A44")
    np.testing.assert_allclose(content["parameters"]["added_mass.A44"]["profile"], along.interval, rtol=1e-4)
    assert list(content["profiles"]) == ["added_mass.A44"] and content["nuts"] is None
    assert content["bootstrap"]["repeats"]["groups"] == {"roll-1": ["roll-1", "roll-3"], "roll-2": ["roll-2"]}
    assert {Path(figure["file"]).name for figure in content["figures"]} == {
        "profile-added_mass.A44.png",
        "draws-blocks.png",
        "draws-repeats.png",
    }
    assert all((out / figure["file"]).stat().st_size > 5000 for figure in content["figures"])
    assert any("roll-2 without repeats" in note for note in content["notes"])
    assert "makes a page of them" in output


@pytest.fixture(scope="module")
def fake(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A campaign's folder, and that of results without a fit."""
    folder = small_campaign(tmp_path_factory.mktemp("fake") / "campaign")
    made = fake_calibration(folder, {"pontoon.Ca_z": 1.87, "pontoon.Cd_z": 4.9})
    return folder, write_calibration(made, folder.parent / "results", figures=False)


def told_of(folder: Path, saved: dict, tmp_path: Path, *words: object) -> str:
    """What the command says of a calibration.json that it refuses."""
    path, out = tmp_path / "calibration.json", tmp_path / "out"
    path.write_text(json.dumps(saved))
    text = run("uncertainty", folder, "--calibration", path, *words, "--out", out, status=2)
    assert not out.exists()
    return text


def test_what_does_not_fit_together_is_told(fake: tuple[Path, Path], tmp_path: Path) -> None:
    folder, results = fake
    saved = json.loads((results / "calibration.json").read_text())

    def said(*words: object, **changed: object) -> str:
        return told_of(folder, saved | changed, tmp_path, *words)

    assert "'pontoon.Ca_y'" in said("--profile", "pontoon.Ca_y") and "pontoon.Ca_z" in said("--profile", "pontoon.Ca_y")
    assert "For 95 % say 0.95" in said("--level", 95)
    assert "40 resamplings or more" in said("--bootstrap", 10)
    assert "It is another campaign's calibration" in said(campaign="another")
    assert "Calibrate this platform first" in said(platform="another")
    tests = {id: test | {"kind": "irregular"} for id, test in saved["tests"].items()}
    assert "a calibration to free decays alone" in said(tests=tests)
    assert "calibrate again" in said(tests={"heave-9": saved["tests"]["heave-1"]})
    assert "a finished calibration" in said(baseline=saved["baseline"] | {"converged": False})
    foreign = {**saved["baseline"]["parameters"], "pontoon.Ca_y": saved["baseline"]["parameters"]["pontoon.Ca_z"]}
    assert "pontoon.Ca_y" in said(baseline=saved["baseline"] | {"parameters": foreign})
    arguments = ("--calibration", tmp_path / "none.json", "--out", tmp_path / "o")
    assert "no such file" in run("uncertainty", folder, *arguments, status=2)


@pytest.mark.slow
def test_values_that_a_fit_does_not_end_at_are_told(ship: tuple[Path, Path, Likelihood], tmp_path: Path) -> None:
    folder, results, _ = ship
    saved = json.loads((results / "calibration.json").read_text())
    saved["baseline"]["parameters"]["added_mass.A44"]["value"] *= 1.1
    assert "where a fit to this campaign's decays ends" in told_of(folder, saved, tmp_path)


def test_results_do_not_stand_beside_others(fake: tuple[Path, Path]) -> None:
    folder, results = fake
    before = sorted(results.iterdir())
    text = run("uncertainty", folder, "--calibration", results, "--out", results, status=2)
    assert "--out" in text and "the results of a calibration" in text
    assert sorted(results.iterdir()) == before
    assert load_campaign(folder).folder == folder


@pytest.mark.parametrize(
    "ends, words",
    [
        ((1.4949, 1.5351), "1.495 to 1.535"),
        ((0.2, None), "at least 0.200"),
        ((None, 3.0), "at most 3.00"),
        ((None, None), "not bounded"),
    ],
)
def test_intervals_in_words(ends: tuple[float | None, float | None], words: str) -> None:
    assert interval(*ends) == words
