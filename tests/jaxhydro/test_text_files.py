"""Text files and workbooks as loggers and spreadsheets write them: read where there is one reading, else refused by row."""

import datetime
import gzip
import json
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from scipy.io import savemat

from calibration.campaign.load_campaign import load_campaign
from calibration.campaign.manifest import read_manifest
from calibration.campaign.records import load_records
from jaxhydro.errors import InputError
from jaxhydro.interop.data_files import read_table

CASES = Path(__file__).resolve().parents[3] / "shared" / "cases"
COUNT = 60
NUMBERS = np.c_[0.5 * np.arange(COUNT), 0.3 * np.arange(COUNT) + 1, -0.01 * np.arange(COUNT)]
DELIMITERS = {",": "a.csv", ";": "a.csv", "\t": "a.txt", "  ": "a.txt"}


def rows(delimiter, numbers=NUMBERS):
    return [delimiter.join(f"{value:.2f}" for value in row) for row in numbers]


def read(folder, lines, name="a.txt"):
    (folder / name).write_text("\n".join(lines) + "\n")
    return read_table(folder / name)


def refused(folder, lines, name="a.txt"):
    with pytest.raises(InputError) as caught:
        read(folder, lines, name)
    assert str(folder / name) in str(caught.value)
    return str(caught.value)


# --------------------------------------------------------------------------------------------------- header and footer


@pytest.mark.parametrize("delimiter", DELIMITERS, ids=["comma", "semicolon", "tab", "spaces"])
@pytest.mark.parametrize(
    ("top", "names"),
    [
        (["Time[s] Surge[m] Pitch[deg]"], ["Time[s]", "Surge[m]", "Pitch[deg]"]),
        (["Time,Surge,Pitch"], ["Time", "Surge", "Pitch"]),
        (["Time;Surge;Pitch"], ["Time", "Surge", "Pitch"]),
        (["Time s\tSurge m\tPitch deg"], ["Time s", "Surge m", "Pitch deg"]),
        (["Time (s) Surge (m) Pitch (deg)"], ["Time (s)", "Surge (m)", "Pitch (deg)"]),
        (["Time in s   Surge in m   Pitch in deg"], ["Time in s", "Surge in m", "Pitch in deg"]),
        (['"Time in s" "Surge in m" "Pitch in deg"'], ["Time in s", "Surge in m", "Pitch in deg"]),
        (["Time Surge Pitch", "(s) (m) (deg)"], ["Time", "Surge", "Pitch"]),
        (["Time Surge Pitch", "s m deg"], ["Time", "Surge", "Pitch"]),
        (["Time Surge Pitch", "---- ----- -----"], ["Time", "Surge", "Pitch"]),
        (["Run 12, decay in surge, 2019-03-01", "", "Time[s] Surge[m] Pitch[deg]"], ["Time[s]", "Surge[m]", "Pitch[deg]"]),
        (["# Time Surge Pitch"], ["Time", "Surge", "Pitch"]),
        (["% Time, Surge, Pitch", "% s, m, deg"], ["Time", "Surge", "Pitch"]),
    ],
)
def test_a_header_of_another_delimiter(tmp_path, delimiter, top, names):
    frame = read(tmp_path, top + rows(delimiter))
    assert list(frame.columns) == names
    np.testing.assert_allclose(frame.to_numpy(), NUMBERS, atol=5e-3)


@pytest.mark.parametrize("delimiter", DELIMITERS, ids=["comma", "semicolon", "tab", "spaces"])
@pytest.mark.parametrize(
    "bottom",
    [
        ["End of file"],
        ["End of the measurement"],
        ["Test stopped, rope slack"],
        ["", "Operator: J. Doe", "File closed"],
        ["# 60 samples"],
        ["Samples: 60"],
    ],
)
def test_sentences_after_the_last_row(tmp_path, delimiter, bottom):
    frame = read(tmp_path, ["Time", *rows(delimiter), *bottom][1:])
    np.testing.assert_allclose(frame.to_numpy(), NUMBERS, atol=5e-3)


@pytest.mark.parametrize(
    ("top", "expected"),
    [
        (["Time Surge"], "header: expected 3 names, one for each column, found 2: Time, Surge"),
        (["Time Surge Pitch Roll"], "header: expected 3 names, one for each column, found 4: Time, Surge, Pitch, Roll"),
    ],
)
def test_a_header_that_does_not_fit(tmp_path, top, expected):
    assert expected in refused(tmp_path, top + rows("  "))


def test_decimal_commas_between_commas_are_guessed(tmp_path):
    message = refused(tmp_path, ["Time,Surge", "0,0,1,5", "0,1,1,4", "0,2,1,3"])
    assert "expected 4 names, one for each column, found 2: Time, Surge. If numbers have decimal commas" in message


@pytest.mark.parametrize("delimiter", DELIMITERS, ids=["comma", "semicolon", "tab", "spaces"])
@pytest.mark.parametrize("at", [0, 1, COUNT // 2, COUNT - 1])
@pytest.mark.parametrize(
    "damage",
    [
        "1.00",
        "oops",
        "1.0x{d}2.00{d}3.00",
        "1.00{d}2.00",
        "1.00{d}2.00{d}3.00{d}4.00",
        "1.00{d}*{d}3.00",
    ],
)
def test_no_damaged_row_is_passed_over(tmp_path, delimiter, at, damage):
    """Wherever it is. A word alone in the last row is no row."""
    lines = rows(delimiter)
    lines[at] = damage.format(d=delimiter)
    if damage == "oops" and at in (0, COUNT - 1):
        assert len(read(tmp_path, ["Time Surge Pitch", *lines])) == COUNT - 1
    else:
        assert f"row {at + 2}" in refused(tmp_path, ["Time Surge Pitch", *lines])


def test_numbers_as_fortran_and_typesetters_write_them(tmp_path):
    frame = read(tmp_path, ["t x", *(f"{i}.0 \u22120.{i + 10}D+01" for i in range(30))])
    np.testing.assert_allclose(frame["x"], [-(0.1 + 0.01 * i) * 10 for i in range(30)])


# --------------------------------------------------------------------------------------------------------------- times


def stamps(form, step=0.5, start=datetime.datetime(2024, 1, 31, 10, 22, 33)):
    moments = [start + datetime.timedelta(seconds=step * i) for i in range(COUNT)]
    return [form.format(m, tenth=m.microsecond // 100000, half=m.strftime("%I:%M:%S.%f %p")) for m in moments]


@pytest.mark.parametrize(
    ("times", "first"),
    [
        (stamps("{0:%Y-%m-%dT%H:%M:%S}.{tenth}"), 0),
        (stamps("{0:%Y-%m-%d %H:%M:%S.%f}"), 0),
        (stamps("{0:%Y-%m-%dT%H:%M:%S.%f}Z"), 0),
        (stamps("{0:%Y-%m-%dT%H:%M:%S.%f}+01:00"), 0),
        (stamps("{0:%Y/%m/%d %H:%M:%S.%f}"), 0),
        (stamps("{0:%Y%m%dT%H:%M:%S.%f}"), 0),
        (stamps("{0:%d.%m.%Y %H:%M:%S.%f}", start=datetime.datetime(2024, 1, 31, 23, 59, 50)), 0),
        (stamps("{0:%Y-%m-%dT%H:%M:%S.%f}", start=datetime.datetime(2024, 2, 28, 23, 59, 50)), 0),
        (stamps("{0:%d/%m/%Y %H:%M:%S.%f}"), 0),
        (stamps("{0:%m/%d/%Y} {half}"), 0),
        (stamps("{0:%H:%M:%S}.{tenth}"), 37353),
        (stamps("{0:%H:%M:%S.%f}", start=datetime.datetime(2024, 1, 1, 23, 59, 50)), 86390),
        ([f"{100 + i // 3600}:{i // 60 % 60:02d}:{i % 60:02d}.5" for i in range(COUNT)], 360000.5),
        ([f"{i // 120:02d}:{i / 2 % 60:04.1f}" for i in range(COUNT)], 0),
    ],
)
def test_times_become_seconds(tmp_path, times, first):
    frame = read(tmp_path, ["t,x", *(f"{time},{i}" for i, time in enumerate(times))], "a.csv")
    step = 1.0 if first == 360000.5 else 0.5
    np.testing.assert_allclose(frame["t"], first + step * np.arange(COUNT), atol=1e-6)
    assert frame.attrs["times"] == ["t"]


@pytest.mark.parametrize("header", [["date time x"], ["t x"], []])
def test_a_date_and_a_time_of_day_between_spaces(tmp_path, header):
    frame = read(tmp_path, header + [f"{time} {i}" for i, time in enumerate(stamps("{0:%Y-%m-%d %H:%M:%S.%f}"))])
    time = frame.iloc[:, -2].to_numpy(float)
    assert time[-1] - time[0] == pytest.approx(0.5 * (COUNT - 1)) and frame.iloc[-1, -1] == COUNT - 1


@pytest.mark.parametrize(
    ("times", "expected"),
    [
        (stamps("{0:%d/%m/%Y %H:%M:%S}", start=datetime.datetime(2024, 1, 31, 23, 59, 50)), "in the order year-month-day"),
        ([f"10:{i:02d}" for i in range(COUNT)], "hours, minutes and seconds"),
        (
            [*stamps("{0:%H:%M:%S}")[:-1], "10:23:75"],
            f"row {COUNT + 1}, column t: expected a time such as 2024-01-31T10:22:33.5",
        ),
        ([*stamps("{0:%Y-%m-%dT%H:%M:%S}")[:-1], "2024-13-45T10:22:33"], f"row {COUNT + 1}, column t: expected a date"),
        ([*stamps("{0:%Y-%m-%dT%H:%M:%S}")[:-1], "10:22:33"], "column t: expected a date, as the other rows have"),
        (
            [*stamps("{0:%Y-%m-%dT%H:%M:%S}")[:-1], "2024-01-31T25:22:33"],
            f"row {COUNT + 1}, column t: expected an hour of the day",
        ),
    ],
)
def test_times_that_may_mean_something_else(tmp_path, times, expected):
    assert expected in refused(tmp_path, ["t,x", *(f"{time},{i}" for i, time in enumerate(times))], "a.csv")


def campaign(folder, name, unit="s"):
    channels = {"time": {"column": "t", "unit": unit}, "surge": {"column": "x", "unit": "m"}}
    test = {"id": "d", "kind": "decay", "degree_of_freedom": "surge", "file": name, "window": [5, 29]}
    manifest = {"name": "d", "platform": "volturnus-s", "channels": channels, "tests": [test]}
    (folder / "campaign.yaml").write_text(json.dumps(manifest))
    return load_records(*read_manifest(folder))


def test_a_campaign_of_time_stamps(tmp_path):
    """Windows count from the first row."""
    decay = np.cos(np.arange(COUNT) / 4)
    lines = [f"{t},{x}" for t, x in zip(stamps("{0:%Y-%m-%dT%H:%M:%S.%f}"), decay)]
    (tmp_path / "d.Elev").write_text("\n".join(["t,x", *lines]))
    (record,) = campaign(tmp_path, "d.Elev")
    np.testing.assert_allclose(record.time, 0.5 * np.arange(10, 59), atol=1e-6)
    with pytest.raises(InputError, match="unit: s, since such times are read as seconds, found times in column 't'"):
        campaign(tmp_path, "d.Elev", "ms")


# -------------------------------------------------------------------------------------------------------------- endings


@pytest.mark.parametrize("name", ["a.Elev", "a.asc", "a.prn", "run7", "a.1", "a.Elev.gz", "a.tab", "a.out", "a.Bin"])
def test_text_of_any_ending(tmp_path, name):
    content = "\n".join(["Time Surge Pitch", *rows(" ")]).encode()
    (tmp_path / name).write_bytes(gzip.compress(content) if name.endswith(".gz") else content)
    np.testing.assert_allclose(read_table(tmp_path / name).to_numpy(), NUMBERS, atol=5e-3)


@pytest.mark.parametrize("name", ["a.csv", "a.dat", "run7", "a.bin"])
def test_the_content_goes_before_the_ending(tmp_path, name):
    t, x = NUMBERS[:, 0], NUMBERS[:, 1]
    for engine in ("scipy", "h5netcdf"):
        xr.Dataset({"x": ("t", x)}, {"t": t}).to_netcdf(tmp_path / name, engine=engine)
        np.testing.assert_allclose(read_table(tmp_path / name)[["t", "x"]].to_numpy(), NUMBERS[:, :2])
    savemat(tmp_path / "b.mat", {"t": t, "x": x})
    (tmp_path / name).write_bytes((tmp_path / "b.mat").read_bytes())
    np.testing.assert_allclose(read_table(tmp_path / name)[["t", "x"]].to_numpy(), NUMBERS[:, :2])


def test_hdf5_that_is_no_netcdf(tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["t"], file["x"] = NUMBERS[:, 0], NUMBERS[:, 1]
    np.testing.assert_allclose(read_table(tmp_path / "a.h5")[["t", "x"]].to_numpy(), NUMBERS[:, :2])


def test_netcdf_times_with_a_date_are_seconds_from_the_first(tmp_path):
    moments = np.datetime64("2024-01-31T10:22:33", "ns") + (NUMBERS[:, 0] * 1e9).astype("timedelta64[ns]")
    xr.Dataset({"x": ("t", NUMBERS[:, 1])}, {"t": moments}).to_netcdf(tmp_path / "a.nc")
    frame = read_table(tmp_path / "a.nc")
    np.testing.assert_allclose(frame["t"], NUMBERS[:, 0])
    assert frame.attrs["times"] == ["t"]


# ----------------------------------------------------------------------------------------------------------- workbooks


def workbook(path, *sheets):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.remove(book.active)
    for i, lines in enumerate(sheets):
        sheet = book.create_sheet(f"sheet {i}")
        for line in lines:
            sheet.append(line)
    book.save(path)
    return path


HEADER = [["Run 3"], ["Operator", "J. Doe"], [], ["Time", "Surge", "Pitch"], ["s", "m", "deg"]]


def test_a_workbook(tmp_path):
    frame = read_table(workbook(tmp_path / "a.xlsx", [["Notes"], ["the rope slipped"]], HEADER + NUMBERS.tolist()))
    assert list(frame.columns) == ["Time", "Surge", "Pitch"] and frame.attrs["units"]["Pitch"] == "deg"
    np.testing.assert_allclose(frame.to_numpy(), NUMBERS, rtol=1e-14)


def test_moments_in_a_workbook(tmp_path):
    start = datetime.datetime(2024, 1, 31, 10, 22, 33)
    moments = [start + datetime.timedelta(seconds=0.5 * i) for i in range(COUNT)]
    for cells in (moments, [moment.time() for moment in moments]):
        frame = read_table(workbook(tmp_path / "a.xlsx", [["t", "x"], *([cell, i] for i, cell in enumerate(cells))]))
        np.testing.assert_allclose(frame["t"] - frame["t"][0], NUMBERS[:, 0], atol=1e-3)


def test_workbooks_that_are_refused(tmp_path):
    numbers = [["t", "x"], *([i, 2 * i] for i in range(30))]
    with pytest.raises(InputError, match="expected one sheet with numbers, found sheet 0, sheet 1"):
        read_table(workbook(tmp_path / "a.xlsx", numbers, numbers))
    with pytest.raises(InputError, match="expected one sheet with numbers, found none in sheet 0"):
        read_table(workbook(tmp_path / "a.xlsx", [["nothing"]]))
    with pytest.raises(InputError, match="row 12, column x: expected a number, found 'slack'"):
        read_table(workbook(tmp_path / "a.xlsx", [*numbers[:11], [10, "slack"], *numbers[12:]]))
    (tmp_path / "a.xlsx").write_bytes(b"PK\x03\x04 and rubbish")
    with pytest.raises(InputError, match="an Excel workbook"):
        read_table(tmp_path / "a.xlsx")


def test_a_workbook_without_its_library_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    (tmp_path / "a.xlsx").write_bytes(b"PK\x03\x04")
    with pytest.raises(InputError, match=r'pip install "jaxhydro\[excel\]", or save the sheet as CSV'):
        read_table(tmp_path / "a.xlsx")


@pytest.mark.slow
@pytest.mark.skipif(not CASES.is_dir(), reason=f"{CASES} is not on this machine")
def test_the_case_of_spaces_and_tabs_loads_as_it_does_with_tabs():
    assert load_campaign(CASES / "header-spaces-data-tabs").findings == ()
