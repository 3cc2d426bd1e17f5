"""Evidence: results apart from the text that is made of them."""

import json
from pathlib import Path

import pytest

from benchmarks import validate
from benchmarks.evidence import common, hulls
from benchmarks.evidence.common import Absent, Section, cached, keep


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
    said, text = capsys.readouterr().out, page.read_text()
    assert "skipped: no result 'seed-1'" in said and "the page keeps what it had" in said
    assert "## Former\n" in text and "## New" in text and "Former hulls" not in text


def test_the_text_of_hulls_is_made_of_results() -> None:
    """As on the page, of the results that are kept."""
    known = json.loads((Path(common.ROOT) / "docs" / "evidence" / "hulls.json").read_text())
    results = {name: one["result"] for name, one in known.items()}
    panels = json.loads(hulls.POTENTIAL.read_text("utf-8"))
    found = hulls.text(results, results["variants"], panels)
    page = " ".join((Path(common.ROOT) / "docs" / "validation.md").read_text().split())
    assert " ".join(validate.wrapped(found.text.strip()).split()) in page
