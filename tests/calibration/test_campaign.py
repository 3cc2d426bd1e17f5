"""Campaign folders: manifests, readers, records, checks; whatever is wrong is an InputError and nothing else."""

import copy
import gzip
import io
import json
import struct
from functools import cache
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.io import savemat

from calibration.campaign.checks import check_records
from calibration.campaign.load_campaign import load_campaign
from calibration.campaign.manifest import read_manifest
from calibration.campaign.records import load_records
from calibration.campaign.series import read_series
from calibration.campaign.signals import noise_level
from jaxhydro.errors import InputError
from jaxhydro.interop.data_files import read_table

SHARED = Path(__file__).resolve().parents[3] / "shared"
MEASURED = ("measured/focal-c4", "measured/focal-c2", "measured/kvlcc2")
MADE = ("campaigns/nothing-missing", "campaigns/with-umbilical")
PLATFORM = """
name: a box
water: {density: 1000.0, depth: 5.0}
rigid_body: {mass: 994.0, centre_of_mass: [0.0, 0.0, -0.03], inertia: {Ixx: 115.7, Iyy: 1376.0, Izz: 1376.0}}
members: []
added_mass: {A44: 20.0}
linear_damping: {B44: 2.0}
hydrostatics: {C44: 822.0}
mooring: {kind: none}
"""
T = np.arange(400) * 0.1
SURGE = 3 * np.exp(-0.02 * T) * np.cos(2 * np.pi * T / 6)
PITCH = 2 * np.exp(-0.03 * T) * np.sin(2 * np.pi * T / 5)
RNG = np.random.default_rng(7)
NOISE = RNG.normal(size=(4, 4000))


@cache
def shared(name):
    """A campaign of ../shared, read once."""
    if not (SHARED / name).is_dir():
        pytest.skip(f"{SHARED / name} is not on this machine")
    return load_campaign(SHARED / name)


def manifest(**changes):
    return {
        "name": "made",
        "platform": "platform.yaml",
        "channels": {
            "time": {"column": "t", "unit": "s"},
            "surge": {"column": "x", "unit": "m"},
            "pitch": {"column": "p", "unit": "deg"},
        },
        "tests": [{"id": "d-1", "kind": "decay", "degree_of_freedom": "surge", "file": "d.csv"}],
        **changes,
    }


def table(t=T, x=SURGE, p=PITCH, header="t,x,p", **columns_beside):
    columns = [t, x, p, *columns_beside.values()]
    names = [header, *columns_beside]
    return "\n".join([",".join(names), *(",".join(f"{value:.5f}" for value in row) for row in zip(*columns))]) + "\n"


def write(folder, document=None, files=None, platform=PLATFORM):
    (folder / "platform.yaml").write_text(platform)
    (folder / "campaign.yaml").write_text(json.dumps(document or manifest()))
    for name, content in ({"d.csv": table()} | (files or {})).items():
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    return folder


def records(folder):
    return {record.id: record for record in load_records(*read_manifest(folder))}


def messages(folder):
    return [f"{finding.severity}: {finding}" for finding in check_records(*read_manifest(folder))]


def failure(function, *arguments):
    with pytest.raises(InputError) as caught:
        function(*arguments)
    assert caught.value.problems and all(problem.expected and problem.found for problem in caught.value.problems)
    return str(caught.value)


# ------------------------------------------------------------------------------------------------------ real ones


@pytest.mark.parametrize("name", MEASURED + MADE)
def test_shared_campaigns_load_without_errors(name):
    campaign = shared(name)
    assert len(campaign.records) == len(campaign.manifest.tests)
    assert all(np.all(np.diff(record.time) > 0) for record in campaign.records)
    assert not [finding for finding in campaign.findings if finding.severity == "error"]
    assert len(campaign.findings) <= (6 if name in MEASURED else 0)
    for record in campaign.records:
        assert set(record.noise) == set(record.values) | ({"wave"} if record.wave is not None else set())
        assert all(0 < record.noise[name] < 1.05 * np.std(values) for name, values in record.values.items())


def test_focal_c4_is_zeroed_by_its_rest_and_its_clock_is_noticed():
    campaign = shared("measured/focal-c4")
    assert abs(campaign.record("rest").values["heave"].mean()) < 1e-12
    assert campaign.record("offset-3").values["surge"].mean() == pytest.approx(22.4, abs=0.1)
    assert campaign.record("surge-release").time[0] == pytest.approx(1891.3, abs=0.1)
    assert any("times are written to 0.01 s" in str(finding) for finding in campaign.findings)
    assert [record.id for record in campaign.used("fit")] == ["surge-release"]


def test_focal_c2_has_three_windows_of_one_file_and_its_wave():
    first, second, third = shared("measured/focal-c2").records
    assert second.time[0] - first.time[-1] < 1 and third.time[0] - second.time[-1] < 1 and third.time[0] > 7134
    assert [4 * r.wave.std() for r in (first, second, third)] == pytest.approx([2.7, 5.9, 7.8], abs=0.1)
    assert abs(first.values["heave"].mean()) < 0.1  # the raw record sits at -20 m


def test_estimated_noise_is_what_was_put_into_the_made_campaigns():
    for record in shared(MADE[0]).records:
        assert record.noise["surge"] == 0.01 and record.noise["pitch"] == pytest.approx(np.deg2rad(0.01))
        for channel in ("surge", "heave", "pitch"):
            assert noise_level(record.time, record.values[channel]) == pytest.approx(record.noise[channel], rel=0.12)


# -------------------------------------------------------------------------------------------------------- readers


def text(separator, decimal=".", top=("t", "x", "p"), units=None, ending=""):
    rows = [separator.join(top)] + ([separator.join(units)] if units else [])
    rows += [separator.join(f"{v:.5f}".replace(".", decimal) for v in row) + ending for row in zip(T, SURGE, PITCH)]
    return "\n".join(rows)


@pytest.mark.parametrize(
    ("name", "content"),
    {
        "comma.csv": text(","),
        "trailing.csv": text(",", ending=","),
        "semicolon.csv": text(";", ","),
        "points.csv": text(";"),
        "tabs.tsv": text("\t"),
        "decimal.dat": text("\t", ","),
        "spaces.txt": text("   "),
        "units.txt": text("  ", units=("(s)", "(m)", "(deg)")),
        "units.csv": text(",", units=("s", "m", "deg")),
        "comments.txt": "# a run\n\n" + text(" "),
        "savetxt.txt": text(" ").replace("t x p", "# t x p"),
        "bom.csv": "\ufeff" + text(",").replace("\n", "\r\n"),
        "spaces.dat": text(" ", ","),
        "quoted.csv": text(",", top=('"t"', '"x"', '"p"')),
        "zipped.csv.gz": gzip.compress(text(",").encode()),
        "utf16.csv": text(",").encode("utf-16"),
        "note.csv": text(",", top=("t", "x", "p", "note"), ending=",ok"),
    }.items(),
)
def test_delimited_text(tmp_path, name, content):
    (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    frame = read_table(tmp_path / name)
    assert list(frame.columns)[:3] == ["t", "x", "p"]
    np.testing.assert_allclose(frame[["t", "x", "p"]].to_numpy(), np.c_[T, SURGE, PITCH], atol=6e-6)


def test_text_without_a_header_has_numbered_columns_and_a_manifest_may_count(tmp_path):
    document = manifest(
        channels={
            "time": {"column": 0, "unit": "s"},
            "surge": {"column": 1, "unit": "m"},
            "pitch": {"column": "2", "unit": "deg"},
        }
    )
    folder = write(tmp_path, document, {"d.csv": table().partition("\n")[2]})
    np.testing.assert_allclose(records(folder)["d-1"].values["surge"], SURGE, atol=6e-6)


def test_missing_cells_are_nan(tmp_path):
    (tmp_path / "a.csv").write_text("t,x\n0,1\n1,\n2,NaN\n3,4\n")
    assert np.isnan(read_table(tmp_path / "a.csv")["x"]).tolist() == [False, True, True, False]


@pytest.mark.parametrize(
    "content",
    [
        {"t": T, "x": SURGE, "p": PITCH, "rate": 10.0, "place": [1.0, 2.0, 3.0], "who": "us"},
        {"t": T[:, None], "x": SURGE[:, None], "p": PITCH[:, None]},
        {"run": {"t": T, "x": SURGE, "p": PITCH, "who": "us"}},
        {"data": np.c_[T, SURGE, PITCH], "names": np.array(["t", "x", "p"], dtype=object)},
        {"run": {"data": np.c_[T, SURGE, PITCH].T, "names": np.array(["t", "x", "p"], dtype=object)}},
    ],
)
def test_matlab(tmp_path, content):
    savemat(tmp_path / "a.mat", content)
    np.testing.assert_allclose(read_table(tmp_path / "a.mat")[["t", "x", "p"]].to_numpy(), np.c_[T, SURGE, PITCH])


def test_matlab_73(tmp_path):
    with h5py.File(tmp_path / "a.mat", "w") as file:
        group = file.create_group("run")
        for name, values in {"t": T, "x": SURGE, "p": PITCH}.items():
            group[name] = values[None, :]
        group["who"] = np.array([[117], [115]], dtype=np.uint16)
        group["who"].attrs["MATLAB_class"] = b"char"
    np.testing.assert_allclose(read_table(tmp_path / "a.mat")[["t", "x", "p"]].to_numpy(), np.c_[T, SURGE, PITCH])


@pytest.mark.parametrize("engine", ["h5netcdf", "scipy"])
def test_netcdf(tmp_path, engine):
    data = xr.Dataset({"x": ("t", SURGE), "p": ("t", PITCH), "draught": 20.0, "place": ("axis", [0.0, 1.0])}, {"t": T})
    data.to_netcdf(tmp_path / "a.nc", engine=engine)
    frame = read_table(tmp_path / "a.nc")
    assert set(frame.columns) == {"t", "x", "p"}
    np.testing.assert_allclose(frame[["t", "x", "p"]].to_numpy(), np.c_[T, SURGE, PITCH])


OUT = (
    "\nPredictions were generated on 01-Jan-2026\n\nlinked with modules\n\nDescription from the input file\n\n"
    + text("\t", top=("Time", "PtfmSurge", "PtfmPitch"), units=("(s)", "(m)", "(deg)"))
    + "\n"
)


def outb(kind, names=("Time", "PtfmSurge", "PtfmPitch"), units=("(s)", "(m)", "(deg)")):
    """OpenFAST's binary format, as FAST_output_reader.load_binary_output takes it."""
    data = np.c_[SURGE, PITCH]
    width = 16 if kind == 4 else 10
    slope = np.array([1e4, 1.1e4], "f4")
    head = struct.pack("<h", kind) + (struct.pack("<h", width) if kind == 4 else b"") + struct.pack("<2i", 2, len(T))
    head += struct.pack("<2d", 100.0, 0.0) if kind == 1 else struct.pack("<2d", T[0], T[1] - T[0])
    head += b"" if kind == 3 else slope.tobytes() + np.zeros(2, "f4").tobytes()
    head += struct.pack("<i", 4) + b"made" + b"".join(word.ljust(width).encode() for word in (*names, *units))
    clock = np.round(T * 100).astype("<i4").tobytes() if kind == 1 else b""
    return head + clock + (data.astype("<f8") if kind == 3 else np.round(data * slope).astype("<i2")).tobytes()


@pytest.mark.parametrize(("name", "content"), [("a.out", OUT.encode()), *((f"{k}.outb", outb(k)) for k in range(1, 5))])
def test_openfast(tmp_path, name, content):
    pytest.importorskip("openfast_io")
    (tmp_path / name).write_bytes(content)
    frame = read_table(tmp_path / name)
    assert list(frame.columns) == ["Time", "PtfmSurge", "PtfmPitch"]
    np.testing.assert_allclose(frame.to_numpy(), np.c_[T, SURGE, PITCH], atol=1e-4)


def test_openfast_without_its_library_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "openfast_io.FAST_output_reader", None)
    (tmp_path / "a.outb").write_bytes(outb(2))
    assert 'pip install "jaxhydro[openfast]"' in failure(read_table, tmp_path / "a.outb")


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.csv", b"", "empty file"),
        ("a.csv", b"# only\n# comments\n", "comments only"),
        ("a.csv", b"t,x\n", "a header only"),
        ("a.csv", b"t,x\n0,1\n1,2,3\n2,3\n", "row 3: expected 2 columns, found 3"),
        ("a.csv", b"t,x\n0,1\n1,2\n2\n", "row 4: expected 2 columns, found 1 columns. a line cut short"),
        ("a.csv", b"t,x\n0,1\n\n1,two\n2,3\n", "row 4, column x: expected a number, found 'two'"),
        ("a.csv", b"a,b\nthe quick brown fox,jumped\nover the lazy dog,again\n", "only text, in a, b"),
        ("a.csv", b"t,x,y\n0,1\n1,2\n2,3\n", "expected 2 names, one for each column, found 3: t, x, y"),
        ("a.csv", bytes(range(256)) * 20, "binary content"),
        ("a.csv", b't,x\n0,"1\n1,2\n2,3"\n3,4\n', "row"),
        ("a.csv.gz", b"not gzip", "a whole gzip file"),
        ("a.csv.gz", gzip.compress(text(",").encode())[:-50], "a whole gzip file"),
        ("a.mat", b"MATLAB 5.0 MAT-file" + bytes(range(256)), "a MATLAB .mat file"),
        ("a.mat", b"", "a MATLAB .mat file"),
        ("a.mat", b"MATLAB 7.3 MAT-file".ljust(600), "a MATLAB 7.3 file"),
        ("a.nc", b"rubbish" * 50, "a NetCDF file"),
        ("a.nc", b"\x89HDF\r\n\x1a\n" + b"rubbish" * 50, "a NetCDF file"),
        ("a.out", b"rubbish\n" * 50, "a row of units"),
        ("a.out", OUT.replace("\t", " 1e", 5).encode(), "row"),
        ("a.out", OUT.replace("0.30000\t", "0.30000\tx").encode(), "row 13, column PtfmSurge: expected a number, found 'x"),
        ("a.outb", b"\x02\x00" + b"\xff" * 40, "OpenFAST binary output"),
        ("a.outb", outb(2)[:-100], "OpenFAST binary output"),
        ("a.outb", b"", "OpenFAST binary output"),
        ("a.yaml", b"t,x\n0,1\n", "a data file: text (.csv, .txt, .dat, ...), .mat, .nc, .xlsx, .out or .outb"),
        ("a.xls", b"t,x\n0,1\n", "Save it as .xlsx or CSV"),
        ("a", b"t,x\n", "a header only"),
    ],
)
def test_broken_files(tmp_path, name, content, words):
    (tmp_path / name).write_bytes(content)
    message = failure(read_table, tmp_path / name)
    assert words in message and str(tmp_path / name) in message


@pytest.mark.parametrize(
    ("good", "bad"),
    [
        (b"\x09\0\0\0\x80\x0c", b"\xa1\0\0\0\x80\x0c"),  # an unknown type
        (b"\x06\0\0\0\x08\0\0\0\x06\0", b"\x06\0\0\0\x08\0\0\0\x06\x08"),
        (b"\x01\0\0\0\x90\x01\0\0", b"\x01\0\0\0\x90\x01\0\xff"),
    ],
)
def test_a_damaged_matlab_file_does_not_crash_scipy(tmp_path, good, bad):
    assert good in matlab()
    (tmp_path / "a.mat").write_bytes(matlab().replace(good, bad, 1))
    assert "damaged, or cut short" in failure(read_table, tmp_path / "a.mat")


def test_text_in_a_column_that_nobody_uses_is_no_mistake(tmp_path):
    rows = [f"{t:.1f},{x:.4f},{p:.4f},{'fault' if i == 7 else 1.5}" for i, (t, x, p) in enumerate(zip(T, SURGE, PITCH))]
    document = manifest()
    text = "\n".join(["t,x,p,force", *rows])
    folder = write(tmp_path, document, {document["tests"][0]["file"]: text})
    np.testing.assert_allclose(records(folder)["d-1"].values["surge"], SURGE, atol=1e-4)
    rows[7] = rows[7].replace(",", ",off", 1)
    (folder / document["tests"][0]["file"]).write_text("\n".join(["t,x,p,force", *rows]))
    message = failure(records, folder)
    assert "d.csv, row 9, column x: expected a number, found 'off" in message and "force" not in message


def test_files_that_are_not_there(tmp_path):
    (tmp_path / "folder.csv").mkdir()
    names = ("none.csv", "none.mat", "none.nc", "none.out", "none.outb", "folder.csv", "x\0.csv", "y" * 400 + ".csv")
    for name in names:
        assert "expected a file that can be read" in failure(read_table, tmp_path / name)


def test_vectors_of_unequal_length(tmp_path):
    savemat(tmp_path / "a.mat", {"t": T, "x": SURGE, "p": PITCH[:-1]})
    assert "variable p: expected 400 values, as the longest has, found 399" in failure(read_table, tmp_path / "a.mat")


# -------------------------------------------------------------------------------------------------------- records


def test_froude_scaling_units_and_signs(tmp_path):
    document = manifest(
        scale=49.0,
        noise={"surge": 2.0},
        wave_channel={"column": "w", "unit": "cm", "position": [-2.0, 0.5]},
        channels={
            "time": {"column": "t", "unit": "ms"},
            "surge": {"column": "x", "unit": "mm", "sign": -1},
            "pitch": {"column": "p", "unit": "deg", "sign": -1},
        },
    )
    document["tests"] = [
        {"id": "sea", "kind": "regular", "file": "d.csv", "window": [10.0, 30.0], "transient": 5.0, "wave_height": 0.06}
    ]
    wave = 3 * np.cos(2 * np.pi * T / 3)
    folder = write(tmp_path, document, {"d.csv": table(w=wave)})
    record = records(folder)["sea"]
    at = (T > 9.99) & (T < 30.01)
    np.testing.assert_allclose(record.time, T[at] * 1e-3 * 7, atol=1e-7)
    np.testing.assert_allclose(record.values["surge"], -49e-3 * SURGE[at], atol=49e-3 * 1e-5)
    np.testing.assert_allclose(record.values["pitch"], -np.deg2rad(PITCH[at]), atol=1e-6)
    np.testing.assert_allclose(record.wave, 0.49 * wave[at], atol=1e-5)
    assert record.wave_position == (-98.0, 24.5) and record.transient == pytest.approx(0.035)
    assert record.noise["surge"] == pytest.approx(0.098) and not record.noise_declared
    assert not [message for message in messages(folder) if "wave_height" in message]
    document["tests"][0]["wave_height"] = 2.9  # at full scale: not what the contract says
    assert (
        "wave_height is stated as 2.9 m, and recorded as 0.06"
        in messages(write(tmp_path, document, {"d.csv": table(w=wave)}))[0]
    )


def test_a_sea_of_few_waves_is_told(tmp_path):
    """Of those after the transient, which are what is compared."""
    document = manifest(wave_channel={"column": "w", "unit": "m", "position": [0.0, 0.0]})
    sea = {"id": "sea", "kind": "irregular", "file": "d.csv", "window": [0.0, 39.0], "transient": 9.0}
    document["tests"] = [sea]
    content = {"d.csv": table(w=np.cos(2 * np.pi * T / 2) + 0.2 * np.cos(2 * np.pi * T / 2.5))}
    few_waves = [message for message in messages(write(tmp_path, document, content)) if "too few" in message]
    assert len(few_waves) == 1 and "only 30 s after the transient, 15" in few_waves[0]
    sea["transient"] = 0.0
    content["d.csv"] = table(w=np.cos(2 * np.pi * T / 1.2) + 0.2 * np.cos(2 * np.pi * T / 1.5))
    assert not any("too few" in message for message in messages(write(tmp_path, document, content)))


def test_zero_by_a_window_of_the_same_file(tmp_path):
    quiet = T < 8
    values = [np.where(quiet, 0.0, column) + offset for column, offset in ((SURGE, 5.0), (PITCH, -3.0))]
    document = manifest(zero={"window": [0.0, 7.9]})
    document["tests"][0]["window"] = [8.0, 39.0]
    record = records(write(tmp_path, document, {"d.csv": table(T, *values)}))["d-1"]
    np.testing.assert_allclose(record.values["surge"], SURGE[(T > 7.99) & (T < 39.01)], atol=1e-5)
    np.testing.assert_allclose(record.values["pitch"], np.deg2rad(PITCH[(T > 7.99) & (T < 39.01)]), atol=1e-6)


def test_zero_by_a_test_in_its_own_units(tmp_path):
    document = manifest(scale=4.0, zero={"test": "rest"}, wave_channel={"column": "w", "unit": "m", "position": [0, 0]})
    document["tests"] += [
        {
            "id": "rest",
            "kind": "static",
            "file": "r.csv",
            "use": "ignore",
            "window": [0, 20],
            "channels": {"surge": {"column": "x_mm", "unit": "mm", "sign": -1}},
        },
        {"id": "sea", "kind": "regular", "file": "s.csv"},
    ]
    still = table(T, -500 + NOISE[0, :400], 0.5 + 0.01 * NOISE[1, :400], "t,x_mm,p", w=0.2 + 0.001 * NOISE[2, :400])
    wave = np.cos(2 * np.pi * T / 3)
    folder = write(tmp_path, document, {"r.csv": still, "d.csv": table(x=SURGE + 0.5), "s.csv": table(w=wave + 0.2)})
    read = records(folder)
    np.testing.assert_allclose(read["d-1"].values["surge"], 4 * SURGE, atol=2e-3)
    np.testing.assert_allclose(read["sea"].wave, 4 * wave, atol=1e-3)
    assert abs(read["rest"].values["surge"].mean()) < 1e-12 and read["d-1"].wave is None
    assert read["rest"].values["surge"].std() == pytest.approx(4e-3, rel=0.2)


def test_a_frozen_motion_is_left_out(tmp_path):
    """Of a test that moves, where another motion does: a model would be fitted to a sensor that was off."""
    assert set(records(write(tmp_path))["d-1"].values) == {"surge", "pitch"}
    assert set(records(write(tmp_path, files={"d.csv": spoilt(p={(0, 400): 1.5})}))["d-1"].values) == {"surge"}
    document = manifest()
    document["tests"].append({"id": "rest", "kind": "static", "file": "r.csv"})
    still = {"r.csv": table(T, 0 * T, 0.5 + 0.01 * NOISE[1, :400])}
    assert set(records(write(tmp_path, document, still))["rest"].values) == {"surge", "pitch"}


def test_declared_noise_is_used_and_the_rest_is_estimated(tmp_path):
    t = np.arange(2000) * 0.05
    slow = 3 * np.exp(-0.01 * t) * np.cos(2 * np.pi * t / 7)
    folder = write(tmp_path, manifest(noise={"pitch": 0.5}), {"d.csv": table(t, slow + 0.02 * NOISE[0, :2000], 0.1 * slow)})
    record = records(folder)["d-1"]
    assert record.noise == {"surge": pytest.approx(0.02, rel=0.15), "pitch": pytest.approx(np.deg2rad(0.5))}
    assert not record.noise_declared
    assert records(write(tmp_path, manifest(noise={"pitch": 0.5, "surge": 0.1})))["d-1"].noise_declared


@pytest.mark.parametrize("seed", range(6))
def test_noise_level_of_white_noise_on_a_slow_decay(seed):
    rng = np.random.default_rng(seed)
    t = np.arange(1500) * 0.1
    slow = 5 * np.exp(-0.01 * t) * np.cos(2 * np.pi * t / 8)
    noise = 0.01 * rng.normal(size=len(t))
    assert noise_level(t, slow + noise) == pytest.approx(0.01, rel=0.15)
    jittered = t + 0.02 * rng.uniform(-1, 1, len(t))  # truly uneven, and recorded so
    at_jittered = 5 * np.exp(-0.01 * jittered) * np.cos(2 * np.pi * jittered / 8)
    assert noise_level(jittered, at_jittered + noise) == pytest.approx(0.01, rel=0.15)
    assert noise_level(np.round(t * 1.003, 1), slow + noise) == pytest.approx(0.01, rel=0.15)  # even, times rounded
    spiked = slow + noise
    spiked[::97] += 3.0
    assert noise_level(t, spiked) == pytest.approx(0.01, rel=0.25)
    assert noise_level(t, np.round(slow, 1)) >= 0.99 * 0.1 / 12**0.5


def test_one_column_for_one_test_and_none_for_another(tmp_path):
    document = manifest()
    document["tests"] += [{"id": "no-pitch", "kind": "static", "file": "n.csv", "channels": {"pitch": None}}]
    rows = "\n".join(f"{t:.1f},{n:.4f}" for t, n in zip(T, NOISE[0]))
    read = records(write(tmp_path, document, {"n.csv": "t,x\n" + rows}))
    assert set(read["no-pitch"].values) == {"surge"} and set(read["d-1"].values) == {"surge", "pitch"}


def test_a_numeric_id_is_a_name_and_each_file_is_read_once(tmp_path, monkeypatch):
    from jaxhydro.interop import data_files as module

    document = manifest()
    document["tests"] = [
        {**document["tests"][0], "id": 21337, "window": [0, 20]},
        {**document["tests"][0], "id": "b", "window": [20, 40], "repeat_of": 21337},
    ]
    folder = write(tmp_path, document)
    count = []
    monkeypatch.setattr(module, "read_table", lambda path, **how: count.append(path) or read_table(path, **how))
    series = read_series(*read_manifest(folder))
    assert [entry.test.id for entry in series] == ["21337", "b"] and len(count) == 1


# --------------------------------------------------------------------------------------------------------- checks


def spoilt(**changes):
    """A decay of which some samples are replaced: name -> {slice: value}."""
    columns = {"t": T.copy(), "x": SURGE.copy(), "p": PITCH.copy()}
    for name, places in changes.items():
        for index, value in places.items():
            columns[name][slice(*index)] = value
    return table(**columns)


@pytest.mark.parametrize(
    ("csv", "words"),
    [
        (spoilt(t={(200, 400): T[200:] + 4.0}), "channel time: a gap of 4.1 s after 19.9 s"),
        (
            spoilt(t={(100, 101): T[99]}),
            "channel time: 1 times that repeat, the first 9.9 s in row 102: these rows are dropped",
        ),
        (
            spoilt(x={(50, 53): np.nan}),
            "surge: 3 values missing or infinite, the first near 5 s, row 52: these rows are dropped",
        ),
        (spoilt(x={(50, 53): np.inf}), "channel surge: 3 values missing or infinite"),
        (spoilt(x={(50, 53): 1e30}), "channel surge: 3 values missing or infinite"),
        (
            spoilt(x={(50, 53): -9999}),
            "surge: 3 values missing, as -9999 seems to say, the first near 5 s, row 52: these rows are dropped",
        ),
        (spoilt(t={(50, 52): np.nan}), "channel time: 2 values missing or infinite, the first near 4.9 s, row 52"),
        (spoilt(x={(100, 140): SURGE[100]}), "channel surge: frozen from 10 s to 13.9 s, 40 samples"),
        (table(x=np.clip(SURGE, -9, 2.2)), "channel surge: clipped: "),
        (table(x=np.clip(SURGE, -2.2, 9)), "at its lowest value, -2.2"),
        (spoilt(x={(77, 78): 4.0}), "channel surge: a spike at 7.7 s, 4 between"),
        (table(x=SURGE + 0.05 * T), "channel surge: its mean drifts by"),
        (spoilt(p={(0, 400): 1.5}), "channel pitch: one value throughout, 1.5: left out"),
        (table(*(column[:60] for column in (T, SURGE, PITCH))), "channel surge: only 1.2 cycles"),
        (table(*(column[::5] for column in (T, SURGE, PITCH))), "channel surge: only 11.9 samples per cycle"),
        (table(t=np.round(T * 0.837, 2)), "channel time: times are written to 0.01 s, where steps are 0.0837"),
    ],
)
def test_warnings(tmp_path, csv, words):
    campaign = load_campaign(write(tmp_path, files={"d.csv": csv}))
    warnings = [str(finding) for finding in campaign.findings]
    assert any(words in message for message in warnings), warnings
    record = campaign.records[0]
    assert np.all(np.diff(record.time) > 0) and all(np.all(np.isfinite(values)) for values in record.values.values())


def test_what_is_held_out_is_not_fitted_too(tmp_path):
    """The same samples for both: said; another part of the file is another record."""
    decay = {"kind": "decay", "degree_of_freedom": "surge", "file": "d.csv"}
    for window, expected in ([0, 20], True), ([20, 40], False):
        tests = [{"id": "a", "window": [0, 20], **decay}, {"id": "b", "use": "holdout", "window": window, **decay}]
        warnings = messages(write(tmp_path, manifest(tests=tests)))
        assert any("held out, and the fitted test a has samples of it" in message for message in warnings) == expected


@pytest.mark.parametrize(
    "csv",
    [
        table(),
        table(x=np.round(SURGE, 1)),  # coarse, and not clipped
        table(x=np.round(SURGE * np.exp(-0.2 * T), 3)),  # comes to rest
        table(x=SURGE + 0.05 * NOISE[0, :400], p=np.round(0.01 * NOISE[1, :400], 2)),
        table(t=T + 0.03 * NOISE[2, :400].clip(-1, 1)),
    ],
)
def test_no_false_alarm(tmp_path, csv):
    assert messages(write(tmp_path, files={"d.csv": csv})) == []


def test_a_gap_is_no_spike(tmp_path):
    """A signal goes on elsewhere after one: that is said once."""
    warnings = messages(write(tmp_path, files={"d.csv": spoilt(x={(50, 64): np.nan})}))
    assert len(warnings) == 2 and "14 values missing" in warnings[1] and "a gap of" in warnings[0]


def change(document, path, value):
    """A copy with the value at a path replaced; ... takes it out."""
    document = copy.deepcopy(document)
    at = document
    for key in path[:-1]:
        at = at[key]
    if value is ...:
        del at[path[-1]]
    else:
        at[path[-1]] = value
    return document


WORDS = {
    "unit": "channels.surge.unit: expected a unit of length: m, cm, mm, ft, found 'inch'",
    "kind": "tests[0].kind: expected one of decay, regular, irregular, static, forced, found 'decai'",
    "window": "expected a window in the file's range, 0 s to 39.9 s, found a window from 0 s to 100 s",
    "left": "expected a transient that leaves 20 samples or more, found 39 s of a record of 39.9 s, which leaves 10",
    "repeat": "tests[1].repeat_of: expected the id of another test: d-2",
}
D2 = {"id": "d-2", "kind": "decay", "degree_of_freedom": "pitch", "file": "d.csv"}


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        (("name",), ..., "name: expected"),
        (("tests",), [], "tests: expected one test at least"),
        (("tests",), ..., "tests: expected"),
        (("test",), [], "'test'. Did you mean 'tests'?"),
        (("scale",), 0, "scale: expected a number > 0"),
        (("scale",), "70", "scale: expected a number"),
        (("density_ratio",), -1.0, "density_ratio"),
        (("channels", "time"), ..., "channels: expected the channel time"),
        (("channels", "surge"), "x", "channels.surge: expected"),
        (("channels",), {"time": {"column": "t", "unit": "s"}}, "a motion beside time"),
        (("channels", "Heave"), {"column": "p", "unit": "m"}, "found 'Heave'. Did you mean 'heave'?"),
        (("channels", "wave"), {"column": "x", "unit": "m"}, "wave_channel"),
        (("channels", "surge", "unit"), "inch", WORDS["unit"]),
        (("channels", "surge", "unit"), "deg", "a unit of length"),
        (("channels", "pitch", "unit"), "m", "a unit of angle: rad, mrad, deg"),
        (("channels", "surge", "sign"), 2, "channels.surge.sign: expected one of 1, -1, found 2"),
        (("channels", "surge", "column"), -1, "channels.surge.column"),
        (("channels", "surge", "column"), 1.5, "a column's name, or its number"),
        (("channels", "surge", "column"), "xx", "channel surge of test d-1: expected a column 'xx', found t, x, p"),
        (("channels", "surge", "column"), 7, "a column 7"),
        (("channels", "surge", "colum"), "x", "Did you mean 'column'?"),
        (("noise",), {"heave": 0.1}, "noise: expected a declared channel: pitch, surge, found 'heave'"),
        (("noise",), {"surge": -0.1}, "noise.surge: expected a number > 0"),
        (("zero",), {"test": "d1"}, "zero.test: expected the id of a test: d-1, found 'd1'. Did you mean 'd-1'?"),
        (("zero",), {}, "either a window or a test"),
        (("zero",), {"window": [0, 1], "test": "d-1"}, "either a window or a test, found both"),
        (("zero",), {"window": [5, 1]}, "zero.window: expected two numbers, the first less than the second"),
        (("zero",), {"window": [-9, -5]}, "in zero.window, found 0 in [-9.0, -5.0], of a file from 0 s to 39.9 s"),
        (("tests", 0, "kind"), "decai", WORDS["kind"]),
        (("tests", 0, "use"), "fitt", "Did you mean 'fit'?"),
        (("tests", 0, "degree_of_freedom"), ..., "tests[0].degree_of_freedom: expected the motion that was released"),
        (("tests", 0, "degree_of_freedom"), "heave", "a motion that has a channel: surge, pitch, found 'heave'"),
        (("tests", 0, "kind"), "irregular", "expected a wave_channel"),
        (("tests", 0, "file"), "e.csv", "tests[0].file: expected a file in"),
        (("tests", 0, "file"), "d\0.csv", "tests[0].file: expected a file in"),
        (("tests", 0, "file"), "", "tests[0].file"),
        (("tests", 0, "file"), "campaign.yaml", "expected a data file"),
        (("tests", 0, "id"), "a/b", "tests[0].id: expected a name that can be a file's"),
        (("tests", 0, "id"), "..", "a name that can be a file's"),
        (("tests", 0, "window"), [3, 1], "tests[0].window: expected two numbers, the first less"),
        (("tests", 0, "window"), [3], "tests[0].window: expected a list of 2 numbers, found [3]"),
        (("tests", 0, "window"), [0, float("inf")], "tests[0].window"),
        (("tests", 0, "window"), [0, 100], WORDS["window"]),
        (("tests", 0, "window"), [1, 2], "expected 20 samples or more in the window, found 11 samples"),
        (("tests", 0, "transient"), 39.0, WORDS["left"]),
        (("tests", 0, "transient"), -1, "tests[0].transient"),
        (("tests", 0, "repeat_of"), "d-1", "tests[0].repeat_of: expected the id of another test"),
        (("tests", 0, "channels"), {"heave": {"unit": "m"}}, "tests[0].channels: expected a declared channel"),
        (("tests", 0, "channels"), {"surge": {"unit": "deg"}}, "tests[0].channels.surge.unit: expected a unit of length"),
        (("tests", 0, "channels"), {"time": None}, "tests[0].channels.time: expected a column"),
        (("tests", 0, "channels"), {"surge": None, "pitch": None}, "one motion at least"),
        (("tests",), [D2, D2], "tests[1].id: expected an id that no other test has, found 'd-2'"),
        (("tests",), [D2, {**D2, "id": "D-2"}], "Upper and lower case are alike"),
        (("tests",), [D2, {**D2, "id": "d-3", "repeat_of": "d-4"}], WORDS["repeat"]),
        (("platform",), "platfrom.yaml", "platform: expected a file in"),
        (("platform",), "no-such-platform", "no-such-platform"),
        (("wave_channel",), {"column": "w", "unit": "deg"}, "wave_channel.unit: expected a unit of length"),
        (("calibrate",), {"bounds": {"column.Ca_t": [2, 1]}}, "calibrate.bounds.column.Ca_t: expected two numbers"),
        (("calibrate",), {"priors": {"column.Ca_t": {"value": 1.0, "standard_deviation": 0}}}, "standard_deviation"),
        (("calibrate",), {"free": "column.*"}, "calibrate.free: expected a list"),
    ],
)
def test_broken_manifests(tmp_path, path, value, words):
    message = failure(load_campaign, write(tmp_path, change(manifest(), path, value)))
    assert words in message and "campaign.yaml" in message, message


def test_a_misspelt_channel_is_one_mistake(tmp_path):
    """Not also a motion that is missing in every test."""
    document = manifest()
    document["channels"] = {"time": document["channels"]["time"], "sruge": document["channels"]["surge"]}
    message = failure(load_campaign, write(tmp_path, document))
    assert "channels.sruge" in message and "Did you mean 'surge'?" in message and "tests[0]" not in message


def test_all_missing_files_are_told_at_once(tmp_path):
    document = manifest(platform="p.yaml")
    document["tests"] = [{**D2, "id": str(i), "file": f"{i}.csv"} for i in range(3)]
    message = failure(load_campaign, write(tmp_path, document))
    assert all(word in message for word in ("'0.csv'", "'1.csv'", "'2.csv'", "platform: expected a file"))


def test_platform_and_data_mistakes_are_told_together(tmp_path):
    folder = write(tmp_path, files={"d.csv": "t,x,p\n0,0\n"}, platform=PLATFORM.replace("mass: 994.0", "mass: -1"))
    message = failure(load_campaign, folder)
    assert "platform.yaml: rigid_body.mass" in message and "d.csv, header" in message


def test_a_campaign_that_is_not_there_or_not_yaml(tmp_path):
    assert "campaign.yaml" in failure(load_campaign, tmp_path)
    assert "no such folder" in failure(load_campaign, tmp_path / "nowhere")
    (tmp_path / "campaign.yaml").write_text("a: [1, 2\nb: }")
    assert "line 2" in failure(load_campaign, tmp_path)
    (tmp_path / "campaign.yaml").write_text("- 1\n")
    assert "a mapping" in failure(load_campaign, tmp_path)


@pytest.mark.parametrize(
    ("csv", "words"),
    [
        (spoilt(t={(200, 400): T[200:] - 4.0}), "expected times that increase, found a step back from 19.9 s to 16 s"),
        (
            spoilt(t={(100, 140): T[99]}),
            "interpolated in the file, found 40 times",
        ),
        (spoilt(x={(50, 90): np.nan}), "interpolated in the file, found 40 values"),
        (spoilt(t={(0, 400): np.nan}), "channel time: expected times, found none"),
        (spoilt(x={(0, 400): 2.0}), "channel surge: expected a signal that moves, found one value throughout, 2"),
        (table(*(column[::10] for column in (T, SURGE, PITCH))), "expected 8 samples per cycle or more, found 5.9 samples"),
        (table(*(column[:12] for column in (T, SURGE, PITCH))), "expected 20 samples or more in the window, found 12"),
        (table().replace("\n3.00000,", "\n3.00000,oops"), "d.csv, row 32, column x: expected a number, found 'oops"),
        (table(header="t,x,x"), "expected one column 'x', found 2 of that name"),
        (table(header="t,X,p"), "expected a column 'x', found t, X, p. Did you mean 'X'?"),
        (
            "t,x,p\n" + "\n".join(f"{i},high,{i}" for i in range(60)),
            "numbers in column 'x', found text such as 'high' in row 2",
        ),
        ("t,x,p\n" + "\n".join(f"{i},12:00:{i:02d},{i}" for i in range(60)), "numbers, found times in column 'x', stated in m"),
    ],
)
def test_broken_records(tmp_path, csv, words):
    message = failure(load_campaign, write(tmp_path, files={"d.csv": csv}))
    assert words in message and "d.csv" in message, message


def test_waves_that_are_not_in_the_file_and_zero_tests_without_a_channel(tmp_path):
    document = manifest(wave_channel={"column": "w", "unit": "m"})
    document["tests"][0] |= {"kind": "irregular"}
    assert "channel wave of test d-1: expected a column 'w'" in failure(load_campaign, write(tmp_path, document))
    wave = np.cos(2 * np.pi * T / 1.8)
    warnings = messages(write(tmp_path, document, {"d.csv": table(w=wave)}))
    assert "the waves have begun before the record" in warnings[0] and "wave_channel has no position" in warnings[1]
    document = manifest(zero={"test": "d-2"})
    document["tests"].append({**D2, "channels": {"surge": None}})
    assert "expected a channel that the zero test has too" in failure(load_campaign, write(tmp_path, document))


def test_a_faulty_test_marked_ignore_is_left_out(tmp_path):
    document = manifest()
    document["tests"].append({**D2, "file": "bad.csv", "use": "ignore"})
    folder = write(tmp_path, document, {"bad.csv": spoilt(t={(200, 400): T[200:] - 4.0})})
    campaign = load_campaign(folder)
    assert [record.id for record in campaign.records] == ["d-1"]
    assert [finding.message for finding in campaign.findings if finding.test == "d-2"] == [
        "left out: a step back from 19.9 s to 16 s in row 202 of the file"
    ]
    assert "d-2" in failure(
        load_campaign,
        write(tmp_path, {**document, "zero": {"test": "d-2"}}, {"bad.csv": spoilt(t={(200, 400): T[200:] - 4.0})}),
    )


# ----------------------------------------------------------------------------------------------------------- fuzz

FULL = manifest(
    scale=2.0,
    density_ratio=1.025,
    noise={"surge": 0.1},
    zero={"window": [0, 5]},
    calibrate={"free": ["*"], "bounds": {"a": [0, 1]}, "priors": {"b": {"value": 1.0, "standard_deviation": 0.1}}},
    wave_channel={"column": "w", "unit": "m", "position": [1.0, 0.0]},
)
FULL["tests"] = [
    {**FULL["tests"][0], "window": [0, 20], "transient": 1.0, "channels": {"surge": {"sign": -1}}},
    {"id": "s", "kind": "regular", "file": "d.csv", "use": "holdout", "wave_height": 2.0, "period": 3.0},
]
SHORT = "\n".join(table(w=np.cos(2 * np.pi * T / 3)).split("\n")[:202])


def paths(document, prefix=()):
    nested = isinstance(document, dict | list)
    for key, value in document.items() if isinstance(document, dict) else enumerate(document) if nested else ():
        yield (*prefix, key)
        yield from paths(value, (*prefix, key))


odd = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(max_size=8),
    st.just([]),
    st.just({}),
    st.sampled_from(
        [
            "surge",
            "time",
            "d.csv",
            "d-1",
            "s",
            "deg",
            1e308,
            -1e308,
            1e-320,
            10**400,
            [0, 1],
            [1e308, 1.7e308],
            {"a": 1},
            [[]],
            "\0",
            "../..",
            "platform.yaml",
            "volturnus-s",
        ]
    ),
)


@pytest.mark.slow
@settings(max_examples=120, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
@given(st.lists(st.tuples(st.sampled_from(list(paths(FULL))), st.just(...) | odd), min_size=1, max_size=3))
def test_a_mutated_manifest_is_refused_or_read(tmp_path_factory, changes):
    document = FULL
    for path, value in changes:
        try:
            document = change(document, path, value)
        except (KeyError, IndexError, TypeError):
            continue
    folder = write(tmp_path_factory.mktemp("fuzz"), document, {"d.csv": SHORT})
    try:
        load_campaign(folder)
    except InputError as error:
        assert error.problems and str(error)


def matlab():
    file = io.BytesIO()
    savemat(file, {"run": {"t": T, "x": SURGE}, "p": PITCH})
    return file.getvalue()


BASES = {
    ".csv": SHORT.encode(),
    ".txt": text(" ").encode(),
    ".csv.gz": gzip.compress(SHORT.encode()),
    ".mat": matlab(),
    ".nc": bytes(xr.Dataset({"x": ("t", SURGE)}, {"t": T}).to_netcdf(engine="scipy")),
    ".out": OUT.encode(),
    ".outb": outb(2),
}
words = st.sampled_from([b"nan", b"1e999", b"-1e300", b"\n", b"\n\n", *(bytes([c]) for c in b',;"\t#0.-\x00')])
cuts = st.lists(
    st.tuples(st.floats(0, 1) | st.floats(0, 0.05), st.integers(0, 40), st.binary(max_size=6) | words), min_size=1, max_size=4
)


@pytest.mark.slow
@settings(max_examples=200, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
@given(cuts, st.just(".csv") | st.sampled_from(list(BASES)))
def test_a_mutated_file_is_refused_or_read(tmp_path_factory, cuts, ending):
    content = BASES[ending]
    for index, length, put in cuts:
        start = int(index * len(content))
        content = content[:start] + put + content[start + length :]
    path = tmp_path_factory.mktemp("fuzz") / f"d{ending}"
    path.write_bytes(content)
    try:
        read_table(path)
        if ending == ".csv":
            load_campaign(write(path.parent, FULL, {"d.csv": content}))
    except InputError as error:
        assert error.problems and str(error)
