"""Evidence: results apart from the text that is made of them."""

import json
from pathlib import Path

import numpy as np
import pytest

from benchmarks import validate
from benchmarks.evidence import common, hulls, hulls_text, measured_runs
from benchmarks.evidence.common import Absent, Section, cached, keep
from calibration import result as calibration_result


@pytest.fixture(autouse=True)
def folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache and a docs folder of its own."""
    monkeypatch.setattr(common, "CACHE", tmp_path / "cache")
    monkeypatch.setattr(common, "EVIDENCE", tmp_path / "evidence")
    monkeypatch.setattr(common, "stale", [])
    return tmp_path


def not_run() -> None:
    raise AssertionError("a run")


def test_results_are_kept_for_the_text(folders: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In docs/evidence, by name and with the hash of their sources; a text is made of them without a run."""
    assert cached("a", "sources", "one", lambda: {"x": 1.5}) == {"x": 1.5}
    assert json.loads((folders / "evidence" / "a.json").read_text()) == {"one": {"result": {"x": 1.5}, "sources": "sources"}}
    keep("a", "sources", "two", [1])
    monkeypatch.setattr(common, "text_only", True)
    assert cached("a", "of today", "one", not_run) == {"x": 1.5} and cached("a", "of today", "two") == [1]
    assert common.stale == []
    with pytest.raises(Absent, match=r"no result 'three' .*--only a` runs it"):
        cached("a", "of today", "three", not_run)


def test_the_order_within_a_result_stays(folders: Path) -> None:
    """It is that of the rows of tables."""
    keep("a", "sources", "two", {"surge": 1, "heave": 2})
    keep("a", "sources", "one", {"b": 1, "a": 2})
    results = common.evidence("a")
    assert list(results) == ["one", "two"] and list(results["one"]["result"]) == ["b", "a"]


def test_data_is_required_of_a_run_only(folders: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A text of kept results is made where the data of the run is not."""
    common.require(folders, "not raised")
    with pytest.raises(Absent, match="no records"):
        common.require(folders / "records", "no records")
    monkeypatch.setattr(common, "text_only", True)
    common.require(folders / "records", "no records")


def test_motions_of_a_decay_are_kept_for_its_figures() -> None:
    """As JSON, from which the test of the calibration is made again."""
    time = np.linspace(0.0, 1.0, 5)
    series = calibration_result.Series("roll", np.sin(time), np.cos(time), 0.1, 0.01, True)
    test = calibration_result.TestFit("roll-1", "fit", "decay", "roll", time, (series,), {"roll": 2 * time}, "roll.csv")
    restored = measured_runs.test_of(json.loads(json.dumps(measured_runs.motions_of(test))))
    assert (restored.id, restored.use, restored.kind, restored.degree_of_freedom) == ("roll-1", "fit", "decay", "roll")
    assert restored.main.rmse == series.rmse and restored.main.noise == series.noise and restored.main.scored
    assert np.array_equal(restored.time, time) and np.array_equal(restored.start["roll"], 2 * time)


def test_results_of_a_clone_are_enough(folders: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a cache; results of the cache alone are taken too, and told as of earlier sources."""
    keep("a", "sources", "one", 1)
    (folders / "cache" / "a" / "sources" / "one.json").unlink()
    monkeypatch.setattr(common, "MAX_EVIDENCE", 10)
    keep("b", "sources", "one", "large" * 10)
    assert not (folders / "evidence" / "b.json").exists()
    monkeypatch.setattr(common, "text_only", True)
    assert cached("a", "of today", "one") == 1 and common.stale == []
    assert cached("b", "of today", "one") == "large" * 10 and common.stale == ["b"]


def test_a_section_without_results_stays(folders: Path, monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    """The page keeps it, and the command names it; another section is made again."""
    page = folders / "validation.md"
    page.write_text("<!-- seeds -->\n## Former\n\n<!-- hulls -->\n## Former hulls\n")
    monkeypatch.setattr(validate, "PAGE", page)
    monkeypatch.setattr(validate, "ROOT", folders)
    monkeypatch.setattr(common, "text_only", False)  # what --text sets is taken back
    monkeypatch.setattr("benchmarks.evidence.hulls.run", lambda figures: Section("New", "words", (), ()))
    monkeypatch.setattr("sys.argv", ["validate", "--text", "--only", "seeds", "hulls"])
    validate.main()
    output, text = capsys.readouterr().out, page.read_text()
    assert "skipped: no result 'seed-1'" in output and "the page keeps what it had" in output
    assert "## Former\n" in text and "## New" in text and "Former hulls" not in text


def test_the_text_of_hulls_is_made_of_results() -> None:
    """As on the page, of the results that are kept."""
    evidence = json.loads((Path(common.ROOT) / "docs" / "evidence" / "hulls.json").read_text())
    results = {name: entry["result"] for name, entry in evidence.items()}
    panels = json.loads(hulls.POTENTIAL.read_text("utf-8"))
    text = hulls_text.words(results, results["variants"], panels)
    page = " ".join((Path(common.ROOT) / "docs" / "validation.md").read_text().split())
    assert " ".join(validate.wrapped(text.strip()).split()) in page
