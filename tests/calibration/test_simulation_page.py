"""Pages of simulations: of a sea, of regular waves, of a free decay, and of a campaign's tests in waves."""

import base64
import json
import re
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from fake_calibration import small
from fake_simulation import PERIOD, comparison, hull, motion, written_comparison, written_sea, written_waves
from test_outputs import Page, follows

from calibration.formatting import number
from calibration.report.interactive import MotionView, motion_view, packed, plotly_script, thinned
from calibration.report.recorded_motion import read_motion
from calibration.report.write_report import write_report
from calibration.results.write_calibration import write_calibration
from jaxhydro.cli.simulation_files import write_motion
from jaxhydro.errors import InputError
from jaxhydro.hull.outline import element_outlines

MAX_BYTES = 6e6


def text_of(folder: Path) -> str:
    """Text of a folder's page, in one line."""
    written = write_report(folder)
    assert written.stat().st_size < MAX_BYTES
    parts = Page(re.sub(r"</(th|td|p|h2|li)>", r" \g<0>", written.read_text(encoding="utf-8")))
    return " ".join(parts.text.split())


def in_order(text: str, *passages: str) -> None:
    """Assert that words follow each other in a text."""
    at = 0
    for words in passages:
        position = text.find(words, at)
        assert position >= 0, words
        at = position


def test_the_page_of_a_sea_begins_with_the_largest_motions(tmp_path: Path) -> None:
    folder = written_sea(tmp_path / "sea", figures=True)
    statistics = json.loads((folder / "statistics.json").read_text())["statistics"]
    text = text_of(folder)
    in_order(
        text,
        "Simulation by jaxhydro 0.1.0",
        f"In a sea of Hs 3.10 m, Tp 8.96 s the platform moves up to {number(statistics['surge']['maximum'], 3)} m in surge",
        "deg in pitch (standard deviations",
        "from 100 to 399.5 s. No motion in sway, roll and yaw.",
        "Energy in bands",
        "0.06-0.15",
        "Spectra of the wave",
        "What was simulated",
        "Significant wave height 3.1 m",
        "Left out at the start 100 s",
        "Calibration fit/calibration.json",
    )


def test_the_page_of_regular_waves_has_the_response(tmp_path: Path) -> None:
    """Amplitudes are those of the formulas; slow motion beside the waves is not in them."""
    text = text_of(written_waves(tmp_path / "waves"))
    in_order(
        text, "In regular waves of 3.00 m, 10.0 s the amplitudes are 0.4", "0.300 m in heave and 0.200 deg in pitch", "0.20 m"
    )
    in_order(text, "Response", "heave", "0.300", "0.200", "Statistics", "Wave period 10 s")


def test_the_page_of_a_free_decay_tells_the_release(tmp_path: Path) -> None:
    moved = motion()._replace(wave=None)
    write_motion(
        moved, tmp_path / "d", "buoy", "jaxhydro 0.1.0", figures=False, inputs={"release_surge": 5.0, "calibration": None}
    )
    text = text_of(tmp_path / "d")
    in_order(text, "In still water the platform moves up to", "Released in surge at 5.000 m from rest")
    assert "Energy in bands" not in text and "Response" not in text


def test_the_page_of_a_campaign_tells_how_each_test_is_followed(tmp_path: Path) -> None:
    """Small motions do not count in the sentence."""
    text = text_of(written_comparison(tmp_path / "c"))
    in_order(
        text,
        "Simulation of tests in waves by jaxhydro 0.1.0",
        "1 test in regular waves followed to 12-16 %. 1 held-out test in irregular waves: low-frequency energy off by 11 % and "
        "wave-frequency energy off by 8.0 %.",
        "Values of the calibration of basin. Not used, since the campaign has its own: mooring.stiffness.",
        "not determined by its records",
        "Agreement by motion",
        "surge (m)",
        "low, 0.005-0.025 Hz",
        "amplitude",
        "irregular",
        "w.csv: something to be known",
        "Records seas.csv and w.csv",
        "order 2",
    )
    follows(comparison(), "ComparisonFile")


def test_what_is_no_simulation_is_told(tmp_path: Path) -> None:
    folder = written_sea(tmp_path / "sea")
    (folder / "simulated.nc").write_bytes(b"no data set")
    with pytest.raises(InputError, match=r"simulated\.nc"):
        write_report(folder)


def test_a_new_simulation_takes_the_report_away(tmp_path: Path) -> None:
    folder = written_sea(tmp_path / "o")
    write_report(folder)
    written_waves(folder)
    assert sorted(path.name for path in folder.iterdir()) == ["motion.csv", "simulated.nc"]


def test_the_page_escapes_what_comes_from_files(tmp_path: Path) -> None:
    evil = '</script><script>alert("1")</script>&amp;'
    content = comparison(campaign=evil, platform=evil, warnings=[evil])
    for key in ("error", "tests"):
        content[key][evil] = content[key].pop("sea-1")
    page = Page(write_report(written_comparison(tmp_path / "c", **content)).read_text(encoding="utf-8"))
    assert page.tags.count("script") in (0, 3) and page.text.count(evil) >= 8


# --- the interactive part


def test_series_end_with_the_test_and_the_stretch_is_about_the_highest_crest(tmp_path: Path) -> None:
    page = read_motion(written_comparison(tmp_path / "c"))
    assert page is not None and [test.name for test in page.tests] == ["sea-1", "wave-1"]
    first, last = page.tests
    assert first.time[-1] == 399.5 and list(first.series) == ["wave", "surge", "heave", "pitch"]
    assert np.isnan(last.series["surge"]["measured"][-100:]).all()
    stretch = first.stretch()
    assert stretch.times[-1] - stretch.times[0] == pytest.approx(10 * PERIOD, rel=0.05) and len(stretch.times) > 60
    assert set(stretch.poses) == {"measured", "simulated"} and stretch.poses["measured"].shape == (len(stretch.times), 6)
    np.testing.assert_allclose(stretch.poses["measured"][:, 2], 0.3 * np.cos(2 * np.pi * stretch.times / PERIOD), atol=0.01)


def test_offsets_that_were_taken_off_are_told(tmp_path: Path) -> None:
    fitted = small()
    first = fitted.tests[0]
    moved = replace(first, series=tuple(replace(series, offset=0.25 * (series.channel == "surge")) for series in first.series))
    write_calibration(replace(fitted, tests=(moved, *fitted.tests[1:])), tmp_path, figures=False)
    page = read_motion(tmp_path)
    assert page is not None and page.offsets["surge"] == pytest.approx(0.25)
    view = motion_view(tmp_path)
    assert isinstance(view, str) or "taken off the measured series: up to 0.25 m in surge" in " ".join(view.notes)


def test_a_folder_without_series_has_no_interactive_part(tmp_path: Path) -> None:
    assert motion_view(tmp_path) is None
    (tmp_path / "simulated.nc").write_bytes(b"damaged")
    assert motion_view(tmp_path) is None


def test_without_plotly_the_page_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plotly_script.cache_clear()
    monkeypatch.setitem(sys.modules, "plotly.offline", None)
    folder = written_sea(tmp_path / "o", figures=True)
    page = Page(write_report(folder).read_text(encoding="utf-8"))
    assert "need plotly, which is not installed here" in page.text and "script" not in page.tags and "img" in page.tags
    plotly_script.cache_clear()


def test_the_data_of_the_page_give_back_the_motion(tmp_path: Path) -> None:
    pytest.importorskip("plotly", reason="plotly.js is a part of it")
    view = motion_view(written_sea(tmp_path / "o"))
    assert isinstance(view, MotionView) and view.hull and view.tests == [""]
    content: dict[str, Any] = json.loads(str(view.data))
    test = content["tests"][0]
    assert [panel["name"] for panel in test["panels"]] == ["wave", "surge", "heave", "pitch"]  # what is still is left out
    surge = test["panels"][1]["traces"][0]
    values = surge["offset"] + surge["scale"] * np.frombuffer(base64.b64decode(surge["data"]), "<i2")
    np.testing.assert_allclose(values, motion().values[:, 0], atol=1e-4)
    points = np.frombuffer(base64.b64decode(content["hull"]["points"]), "<f4").reshape(-1, 3)
    corners = np.frombuffer(base64.b64decode(content["hull"]["triangles"]), "<u2")
    assert corners.max() == len(points) - 1 and len(corners) % 3 == 0
    np.testing.assert_allclose([points.min(axis=0), points.max(axis=0)], [[-4, -4, -20], [24, 4, 10]], atol=0.01)


def test_thinned_series_keep_their_extremes() -> None:
    values = np.sin(np.arange(1000) / 7.0)
    values[[123, 456]] = 5.0, -5.0
    values[700:760] = np.nan
    few = thinned(values, 10)
    assert len(few) == 100 and np.nanmax(few) == 5 and np.nanmin(few) == -5 and np.isnan(few[70:76]).all()
    assert thinned(values, 1) is values
    packed_series = packed(np.array([1.0, 1.0, np.nan]))
    whole = np.frombuffer(base64.b64decode(packed_series["data"]), "<i2")
    assert whole[2] == -32768 and packed_series["offset"] + packed_series["scale"] * whole[0] == pytest.approx(1.0)


def test_outlines_are_those_of_the_members() -> None:
    """End sections of a cylinder have its diameters, those of a box its sides; elements meet."""
    outlines = element_outlines(hull())
    column = outlines[outlines[..., 0].max(axis=(1, 2)) < 4.1]
    low, high = column[np.argmin(column[..., 2].min(axis=(1, 2))), 0], column[np.argmax(column[..., 2].max(axis=(1, 2))), 1]
    np.testing.assert_allclose(np.hypot(low[:, 0], low[:, 1]), 4.0)
    np.testing.assert_allclose(low[:, 2], -20.0)
    np.testing.assert_allclose(np.hypot(high[:, 0], high[:, 1]), 3.0)
    np.testing.assert_allclose(high[:, 2], 10.0)
    box = outlines[outlines[..., 0].max(axis=(1, 2)) > 4.1]
    assert (np.ptp(box[..., 1]), np.ptp(box[..., 2])) == pytest.approx((6.0, 3.0))


def test_the_hull_is_in_the_series_of_a_simulation(tmp_path: Path) -> None:
    with xr.open_dataset(written_sea(tmp_path / "o") / "simulated.nc") as data:
        np.testing.assert_allclose(data["hull"].values, element_outlines(hull()))
        assert data["hull"].units == "m" and data.attrs["calibration"] == "fit/calibration.json"
