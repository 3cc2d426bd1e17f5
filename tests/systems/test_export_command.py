"""`jaxhydro export`: what it writes, and what it refuses."""

import json
from pathlib import Path

from test_cli import run


def test_it_writes_a_deck_and_a_page(tmp_path: Path) -> None:
    text = run("export", "oc3-hywind", "--out", tmp_path / "deck", "--format", "openfast")
    page = (tmp_path / "deck" / "export.md").read_text(encoding="utf-8")
    names = {path.name for path in (tmp_path / "deck").iterdir()}
    assert {"main.fst", "elastodyn.dat", "hydrodyn.dat", "seastate.dat", "export.md", "potential.hst"} <= names
    assert "left out" in text and "## Approximated" in page and "## Left out" in page and "OC3-Hywind spar" in page
    message = run("export", "oc3-hywind", "--out", tmp_path / "deck", status=2)
    assert "a folder that is new or empty" in message


def test_it_writes_a_raft_design(tmp_path: Path) -> None:
    text = run("export", "oc3-hywind", "--out", tmp_path / "raft", "--format", "raft")
    page = (tmp_path / "raft" / "export.md").read_text(encoding="utf-8")
    assert {path.name for path in (tmp_path / "raft").iterdir()} == {"design.yaml", "export.md"}
    assert "as a RAFT design" in page and "raft.Model" in text and "openfast" not in text


def test_lines_alone_need_catenaries(tmp_path: Path) -> None:
    text = run("export", "oc3-hywind", "--out", tmp_path / "lines", "--format", "moordyn", status=2)
    assert "lines of `kind: catenary`" in text and not (tmp_path / "lines").exists()


def test_other_formats_and_broken_calibrations_write_nothing(tmp_path: Path) -> None:
    assert "openfast" in run("export", "oc3-hywind", "--out", tmp_path / "deck", "--format", "orcaflex", status=2)
    (tmp_path / "calibration.json").write_text(json.dumps({"nothing": 1}), encoding="utf-8")
    run("export", "oc3-hywind", "--out", tmp_path / "deck", "--calibration", tmp_path / "calibration.json", status=2)
    assert not (tmp_path / "deck").exists()
