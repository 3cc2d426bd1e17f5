"""Public hulls: the page follows from the raw results, and sources that are absent are named."""

import json
from pathlib import Path

import numpy as np
import pytest

from benchmarks.public_hulls import RAW, TEXT, main, missing, with_edits
from benchmarks.public_hulls_cases import CASES, Published
from benchmarks.public_hulls_motions import INTERVAL, in_band
from benchmarks.public_hulls_motions_text import motion_reasons
from benchmarks.public_hulls_text import compared, text

STATICS = {"mass": 1010.0, "volume": 2.0, "tensions": [90.0, 110.0], "pull": 50.0, "periods": {"heave": 20.0, "pitch": 31.0}}
DECAYS = {dof: {"period": period, "release": 1.0, "half_cycles": 9} for dof, period in (("heave", 20.0), ("pitch", 32.0))}
DECAYS["surge"] = {"period": None, "release": 5.0, "half_cycles": 0}
SEA = {key: {"surge": 1.0, "heave": heave, "pitch": 1.0} for key, heave in (("simulated", 1.1), ("linear", 1.0))}
STATICS_AND_MOTIONS = {"statics": STATICS, "motions": {"decays": DECAYS, "sea": SEA}}


def test_the_page_is_made_from_the_raw_results() -> None:
    results = json.loads(RAW.read_text("utf-8"))
    assert len(results) >= 10 and TEXT.read_text("utf-8") == text(results)


def test_every_hull_has_decays_and_every_deviation_a_reason() -> None:
    results = json.loads(RAW.read_text("utf-8"))
    assert all("motions" in found and "fault" not in found for found in results.values())
    assert "not explained yet.\n" not in TEXT.read_text("utf-8")
    lines = motion_reasons([("hull", {"heave sea": "drag."}, STATICS_AND_MOTIONS)])
    assert list(lines) == ["- hull: heave sea +10.0 %: drag.", "- hull: pitch decay +3.2 %: not explained yet."][::-1]


def test_deviations_in_a_band() -> None:
    """A sine of 10 s has its standard deviation; a drift of 200 s is left out."""
    times = np.arange(0.0, 2700.0, INTERVAL)
    motion = np.sqrt(2) * np.sin(2 * np.pi * times / 10)[:, None] + 5 * np.sin(2 * np.pi * times / 200)[:, None] * np.ones(6)
    assert in_band(motion) == pytest.approx(np.ones(6), rel=1e-3)


def test_deviations_and_rounding() -> None:
    """A period of 30 s that is published as 0.033 Hz is known to 1.5 %."""
    published = Published("a report", {"heave": 20.2, "pitch": 30.0, "yaw": 80.0}, 1000.0, tension=100.0, rounding=1.5e-3)
    by_quantity = {comparison.quantity: comparison for comparison in compared(STATICS, published)}
    assert by_quantity["mass"].deviation == pytest.approx(0.01) and by_quantity["mass"].within
    assert by_quantity["line tension"].deviation == pytest.approx(0.0)
    assert by_quantity["pitch period"].rounding == pytest.approx(0.045) and by_quantity["pitch period"].within
    assert "displaced volume" not in by_quantity and not by_quantity["yaw period"].within


def test_values_of_a_deck_are_changed_in_a_copy(tmp_path: Path) -> None:
    deck = tmp_path / "source"
    deck.mkdir()
    (deck / "main.fst").write_text("---\ntitle\n   1   CompMooring  - switch\n", encoding="utf-8")
    copy = with_edits(deck / "main.fst", {"main.fst": {"CompMooring": "3", "ExctnMod": "0"}}, tmp_path)
    lines = copy.read_text("utf-8").splitlines()
    assert lines[2] == "3   CompMooring  - switch" and lines[-1].split()[:2] == ["0", "ExctnMod"]
    assert "   1   CompMooring" in (deck / "main.fst").read_text("utf-8")


def test_absent_sources_are_named(tmp_path: Path) -> None:
    assert missing(tmp_path, CASES["iea-15"]) == CASES["iea-15"].source
    with pytest.raises(SystemExit, match=r"nowhere: expected a folder, found none"):
        main([str(tmp_path / "nowhere")])
