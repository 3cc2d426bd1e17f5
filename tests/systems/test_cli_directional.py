"""`jaxhydro simulate` in seas of several headings: an answer in words for every bad input, and what it writes."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from test_cli import cache, run  # noqa: F401

SHORT = ("--duration", 60, "--dt", 0.5, "--transient", 0, "--no-figures")


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("--sea", "hs=2 tp=14 headin=30"), "found 'headin=30'. Did you mean"),
        (("--sea", "tp=14"), "hs expected, as --sea"),
        (("--sea", "hs=2 tp=x"), "a number after tp= expected, found 'x'"),
        (("--sea", "hs=2 tp=9 spreading=-1"), "spreading: a number from 0 to 10000 expected, found -1"),
        (("--sea", "hs=2 tp=9", "--hs", 2, "--tp", 9), "--sea says what the sea is: not both"),
        (("--sea", "hs=2 tp=9", "--heading", 20), "the sea has its own: heading= of --sea"),
        (("--hs", 2, "--tp", 9, "--spreading", -3), "a number from 0 to 10000 expected, found -3"),
        (("--spreading", 3), "a sea expected with it"),
        (("--hs", 2, "--tp", 9, "--x-bearing", 3), "a spectrum expected with it, --sea-file FILE"),
        (("--hs", 2, "--tp", 9, "--sea-time", "2019-02-06T00:40"), "a spectrum expected with it, --sea-file FILE"),
        (("--sea-file", "none.csv", "--sea-time", "noon"), "a time as 2019-02-06T00:40 expected, found 'noon'"),
        (("--sea-file", "none.csv"), "expected a CSV, NetCDF, NDBC or SWAN file, found no such file"),
        (("--wave", "none.csv", "--spreading", 4), "a record of one gauge, which does not tell directions"),
        (("--hs", 2, "--tp", 9, "--spreading", 4, "--order", 2), "100 components at most"),
    ],
)
def test_bad_input_has_one_clear_message(tmp_path: Path, words: tuple, expected: str) -> None:
    message = run("simulate", "oc3-hywind", *words, "--out", tmp_path / "out", status=2)
    assert expected in message, message
    assert not (tmp_path / "out" / "motion.csv").exists()


def test_a_file_without_directions_is_told(tmp_path: Path) -> None:
    (tmp_path / "flat.csv").write_text("freq,efth\n0.1,1\n0.2,1\n", encoding="utf-8")
    message = run("simulate", "oc3-hywind", "--sea-file", tmp_path / "flat.csv", "--out", tmp_path / "out", status=2)
    assert "expected a column dir, beside freq and efth, found freq, efth" in message, message


def test_a_buoy_s_file_of_several_times(tmp_path: Path) -> None:
    """NDBC's text: the times are told; without directions --x-bearing says nothing."""
    rows = "2019 02 06 00 40 1.0 2.0 0.5\n2019 02 06 01 40 1.0 3.0 0.5\n"
    (tmp_path / "buoy.txt").write_text("#YY MM DD hh mm .08 .10 .12\n" + rows, encoding="utf-8")
    words = ("simulate", "oc3-hywind", "--sea-file", tmp_path / "buoy.txt", "--out", tmp_path / "out")
    message = run(*words, status=2)
    assert "expected one spectrum, found 2, from 2019-02-06T00:40 to 2019-02-06T01:40. --sea-time says which" in message, (
        message
    )
    message = run(*words, "--sea-time", "2019-02-06T00:40", "--x-bearing", 20, status=2)
    assert "the file has no directions: --heading says where the waves travel to" in message, message
    assert not (tmp_path / "out" / "motion.csv").exists()


@pytest.mark.slow
def test_two_systems_move_a_platform(tmp_path: Path) -> None:
    """Sway too; what was asked for is in the file."""
    systems = ("--sea", "hs=2 tp=14 heading=30", "--sea", "hs=1.5 tp=7 heading=-40 spreading=8")
    run("simulate", "oc3-hywind", *systems, *SHORT, "--out", tmp_path)
    with xr.open_dataset(tmp_path / "simulated.nc") as data:
        assert data.attrs["significant_wave_height"] == pytest.approx(2.5) and data.attrs["order"] == 1
        assert -40 < data.attrs["mean_heading"] < 30 and data.attrs["directional_width"] > 10
        assert float(np.std(data.simulated.sel(channel="sway"))) > 1e-3
