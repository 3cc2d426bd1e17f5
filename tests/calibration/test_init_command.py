"""`jaxhydro init`: columns, units and kinds that are guessed, the campaign that is written, and what is refused."""

import re
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from fake_calibration import DEMO
from scipy.io import savemat
from test_cli import run

from calibration.campaign.load_campaign import Campaign, load_campaign
from calibration.campaign.manifest import read_manifest
from calibration.commands.init_command import init_campaign
from calibration.discovery.study_set_up import set_up_study
from calibration.new_campaign.column_names import channel_of, motion_in
from calibration.new_campaign.draft_text import yaml_scalar
from calibration.residuals.measured_seas import Options
from jaxhydro.errors import InputError

MEASURED = Path("/work/shared/measured")


def record(name: str) -> pd.DataFrame:
    return pd.read_csv(DEMO / f"{name}.csv")


def campaign(folder: Path, *files: Path, platform: str = "volturnus-s", scale: float | None = None) -> Campaign:
    """Made from files, then read as `jaxhydro calibrate` reads it."""
    init_campaign(folder, platform, scale, files)
    return load_campaign(folder)


def sea(regular: bool) -> pd.DataFrame:
    """A made-up test in waves; motions follow the elevation."""
    time = np.arange(0.0, 1200.0, 0.5)
    frequency = np.array([0.1]) if regular else np.linspace(0.06, 0.16, 60)
    phase = np.random.default_rng(1).uniform(0, 2 * np.pi, len(frequency))
    wave = np.cos(2 * np.pi * frequency * time[:, None] + phase).sum(axis=1)
    return pd.DataFrame({"time_s": time, "surge_m": 0.5 * wave, "heave_m": 0.4 * wave, "pitch_deg": wave, "wave_m": wave})


def test_text_among_numbers_says_what_to_do(tmp_path):
    table = record("surge-1")
    table["operator"] = 1.0
    table = table.astype(object)
    table.loc[3, "operator"] = "tea"
    table.to_csv(tmp_path / "one.csv", index=False)
    assert campaign(tmp_path / "a", tmp_path / "one.csv").records[0].degree_of_freedom == "surge"
    table.loc[5, "surge_m"] = "lost"
    table.to_csv(tmp_path / "two.csv", index=False)
    with pytest.raises(InputError, match=r"row 7, column surge_m: expected a number, found 'lost'. Leave the cell empty"):
        campaign(tmp_path / "b", tmp_path / "two.csv")
    assert not (tmp_path / "b").exists()


@pytest.mark.slow
def test_still_water_before_a_push_is_zero(tmp_path):
    """A platform that rests off zero for 30 s, and is then pushed: its readings at rest are still water."""
    time = np.arange(0.0, 150.0, 0.1)
    moved = np.maximum(time - 30.0, 0.0)
    table = pd.DataFrame(
        {"t": time, "x": 7.0 + 0.01 * np.sin(time), "phi": 2.0 - 8 * np.exp(-0.01 * moved) * np.sin(0.6 * moved)}
    )
    table.to_csv(tmp_path / "roll.csv", index=False)
    made = campaign(tmp_path / "made", tmp_path / "roll.csv", platform="ship-section")
    window = made.manifest.zero.window
    assert window[0] == 0 and 20 < window[1] < 30
    record = made.records[0]
    assert abs(np.mean(record.values["surge"])) < 0.02 and abs(np.mean(record.values["roll"])) < np.radians(0.5)
    record_of_demo = tmp_path / "surge.csv"
    shutil.copyfile(DEMO / "surge-1.csv", record_of_demo)  # let go away from rest
    assert campaign(tmp_path / "other", record_of_demo).manifest.zero is None


@pytest.mark.slow
def test_a_ship_that_nothing_holds_up_can_be_diagnosed(tmp_path):
    """Its weight is not varied: with more of it there would be no equilibrium."""
    time = np.arange(0.0, 30.0, 0.05)
    pd.DataFrame({"t": time, "phi_deg": 8 * np.exp(-0.02 * time) * np.cos(2.5 * time)}).to_csv(tmp_path / "a.csv", index=False)
    ship = tmp_path / "ship.yaml"
    ship.write_text(
        "{name: ship, water: {density: 1000.0, depth: 3.0}, members: [], mooring: {kind: none}, hydrostatics: {C44: 822.0},"
        "rigid_body: {mass: 994.0, centre_of_mass: [0, 0, -0.03], inertia: {Ixx: 115.7, Iyy: 1376, Izz: 1376}},"
        "added_mass: {A44: 16.0}, linear_damping: {B44: 5.0}}"
    )
    made = campaign(tmp_path / "made", tmp_path / "a.csv", platform=str(ship))
    labels = set_up_study(made, Options()).study.space.labels
    assert "mass_properties.inertia_roll" in labels and "mass_properties.mass" not in labels


def test_coefficients_of_the_platform_are_the_examples(tmp_path):
    init_campaign(tmp_path / "made", "volturnus-s", None, [])
    text = (tmp_path / "made" / "campaign.yaml").read_text()
    written = "\n".join(line.removeprefix("# ") for line in text[text.index("# calibrate:") :].splitlines())
    (tmp_path / "made" / "campaign.yaml").write_text(text[: text.index("# calibrate:")] + written)
    for dof in ("surge", "heave", "pitch"):
        shutil.copyfile(DEMO / f"{dof}-1.csv", tmp_path / "made" / f"{dof}-1.csv")
    fit = read_manifest(tmp_path / "made")[0].calibrate
    assert set(fit.bounds) == set(fit.priors) == {"column.Ca_t"} and fit.free and fit.fixed


def test_an_embedded_campaign_is_found_by_its_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert len(load_campaign("volturnus-s-decays").records) == 9
    with pytest.raises(InputError, match="no such folder"):
        load_campaign("volturnus-s-decay")
    (tmp_path / "volturnus-s-decays").mkdir()
    with pytest.raises(InputError, match=r"a folder without campaign\.yaml"):  # one's own comes first
        load_campaign("volturnus-s-decays")


# --- names of columns


@pytest.mark.parametrize(
    ("column", "channel"),
    [
        ("PtfmSurge", "surge"),
        ("Surge (m)", "surge"),
        ("heave_mm", "heave"),
        ("ptfmPitch_deg", "pitch"),
        ("Roll Angle [rad]", "roll"),
        ("x", "surge"),
        ("phi", "roll"),
        ("θ", "pitch"),
        ("6DoF.X [mm]", "surge"),
        ("rotz", None),
        ("t", "time"),
        ("Time_s", "time"),
        ("Zeit [s]", "time"),
        ("Wave1Elev", "wave"),
        ("eta", "wave"),
        ("wave_elevation", "wave"),
        ("BldPitch1", None),
        ("Surge velocity", None),
        ("surge (m/s)", None),
        ("NacYaw", None),
        ("thrust", None),
        ("", None),
        ("3", None),
    ],
)
def test_channel_of_a_name(column: str, channel: str | None) -> None:
    match = channel_of(column)
    assert (match and match[0]) == channel


def test_motion_in_the_name_of_a_file() -> None:
    assert motion_in("Pitch-decay_02") == "pitch"
    assert motion_in("surge_pitch") is None and motion_in("run7") is None


@pytest.mark.parametrize(
    ("value", "text"), [("surge_m", "surge_m"), ("y", '"y"'), ("21337", '"21337"'), ("a: b", '"a: b"'), (3, "3")]
)
def test_names_are_written_as_yaml(value: str | int, text: str) -> None:
    assert yaml_scalar(value) == text


# --- campaigns that can be read


def test_the_example_is_read_once_its_records_are_there(tmp_path: Path) -> None:
    folder = tmp_path / "new"
    text = run("init", folder, "--scale", "1:70")
    assert "is ready for your records" in text and f"jaxhydro check {folder}" in text
    with pytest.raises(InputError, match=re.escape("no such file: 'surge-1.csv'")):
        load_campaign(folder)
    for name in ("surge-1.csv", "heave-1.csv", "pitch-1.csv"):
        shutil.copy(DEMO / name, folder)
    manifest, _ = read_manifest(folder)
    assert manifest.scale == 70
    path = folder / "campaign.yaml"
    path.write_text(path.read_text().replace("scale: 70 ", "scale: 1 "))
    assert [record.degree_of_freedom for record in load_campaign(folder).used("fit")] == ["surge", "heave", "pitch"]


def test_every_key_of_the_examples_comments_is_one(tmp_path: Path) -> None:
    """What is commented out can be used as it stands."""
    folder = tmp_path / "new"
    init_campaign(folder, "volturnus-s", None, ())
    for name in ("surge-1", "heave-1", "pitch-1", "sea-1", "wave-1"):
        shutil.copy(DEMO / "surge-1.csv", folder / f"{name}.csv")
    path = folder / "campaign.yaml"
    text = re.sub(
        r"^#( *(?:noise|zero|tracked_point|wave_channel|calibrate|free|fixed|- \{id).*)$", r"\1", path.read_text(), flags=re.M
    )
    text = re.sub(r"^ (?=\w)", "", text, flags=re.M)
    path.write_text(text)
    manifest, _ = read_manifest(folder)
    assert manifest.noise and manifest.zero and manifest.tracked_point and manifest.wave_channel
    assert [test.kind for test in manifest.tests][3:] == ["irregular", "regular"] and manifest.calibrate.fixed


def test_repeats_of_a_motion(tmp_path: Path) -> None:
    """Released motions are seen in the records, whatever their files are called; the last of each is held out."""
    names = [f"{dof}-{i}" for dof in ("heave", "pitch", "surge") for i in (1, 2, 3)]
    files = [tmp_path / f"run{i}.csv" for i in range(9)]
    for name, file in zip(names, files):
        shutil.copy(DEMO / f"{name}.csv", file)
    made = campaign(tmp_path / "new", *files)
    assert [record.degree_of_freedom for record in made.records] == [name.split("-")[0] for name in names]
    assert [record.use for record in made.records] == 3 * ["fit", "fit", "holdout"]
    assert (tmp_path / "new" / "platform.yaml").read_text().startswith("# UMaine VolturnUS-S")


def test_files_written_in_many_ways(tmp_path: Path) -> None:
    """Decimal commas, mm and rad, spaces with a row of units, MATLAB: released motions and sizes come out alike."""
    surge, pitch, heave = record("surge-2"), record("pitch-2"), record("heave-2")
    angles = np.deg2rad(surge.pitch_deg)
    german = {
        "Zeit [s]": surge.time_s,
        "Surge [mm]": 1000 * surge.surge_m,
        "Heave [mm]": 1000 * surge.heave_m,
        "Pitch [rad]": angles,
    }
    files = [tmp_path / name for name in ("a1.csv", "b1.txt", "c1.mat")]
    pd.DataFrame(german).to_csv(files[0], sep=";", decimal=",", index=False)
    rows = "\n".join(" ".join(map(str, row)) for row in pitch.to_numpy())
    files[1].write_text(f"Logger 3\nTime PtfmSurge PtfmHeave PtfmPitch\n(s) (m) (m) (deg)\n{rows}\n")
    columns = zip(("t", "x", "z", "theta"), ("time_s", "surge_m", "heave_m", "pitch_deg"))
    savemat(files[2], {short: heave[name].to_numpy() for short, name in columns})
    made = campaign(tmp_path / "new", *files)
    assert [record.degree_of_freedom for record in made.records] == ["surge", "pitch", "heave"]
    expected = (surge.surge_m, np.deg2rad(pitch.pitch_deg), heave.heave_m)
    for decay, values in zip(made.records, expected):
        np.testing.assert_allclose(decay.values[str(decay.degree_of_freedom)], values, atol=1e-9)
    text = (tmp_path / "new" / "campaign.yaml").read_text()
    assert 'column: "Surge [mm]", unit: mm' in text and "CHECK: by its name; no unit in the files" not in text
    assert "column: theta, unit: deg" in text


def test_waves_and_still_water(tmp_path: Path) -> None:
    """A wave column makes a test in waves, unless it shows still water."""
    still = record("surge-1").assign(eta=0.002 * np.random.default_rng(0).standard_normal(4001))
    files = [tmp_path / name for name in ("a.csv", "b.csv", "c.csv")]
    for file, table in zip(files, (sea(True), sea(False), still)):
        table.to_csv(file, index=False)
    made = campaign(tmp_path / "new", *files)
    assert [(test.kind, test.degree_of_freedom) for test in made.manifest.tests] == [
        ("regular", None),
        ("irregular", None),
        ("decay", "surge"),
    ]
    assert made.manifest.wave_channel is not None and made.manifest.wave_channel.column == "wave_m"
    assert [record.wave is not None for record in made.records] == [True, True, False]


def test_a_record_that_is_no_decay_is_not_used(tmp_path: Path) -> None:
    file = tmp_path / "heave.csv"
    sea(False).drop(columns="wave_m").to_csv(file, index=False)
    draft = init_campaign(tmp_path / "new", "volturnus-s", None, [file])
    assert [(test.guess.kind, test.use) for test in draft.tests] == [("static", "ignore")]


def test_columns_that_are_named_twice_are_numbered(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    file.write_text(record("heave-1").to_csv(index=False).replace("surge_m,heave_m", "heave_m,heave_m", 1))
    draft = init_campaign(tmp_path / "new", "volturnus-s", None, [file])
    assert draft.columns["heave"].column == 1 and draft.columns["heave"].others == ("heave_m",)


def test_measured_roll_decay(tmp_path: Path) -> None:
    """Columns x, y, z, phi, theta, psi without units; the heading is near a full turn."""
    folder = MEASURED / "kvlcc2"
    if not folder.is_dir():
        pytest.skip("the measured KVLCC2 records are not on this machine")
    made = campaign(tmp_path / "new", folder / "21337.csv", platform=str(folder / "platform.yaml"))
    (record,) = made.records
    assert (record.kind, record.degree_of_freedom, record.use) == ("decay", "roll", "fit")
    assert made.manifest.channels["roll"].unit == "rad" and "yaw" not in made.manifest.channels
    assert made.platform.name.startswith("KVLCC2")


# --- the command


def test_what_is_printed(tmp_path: Path) -> None:
    file = tmp_path / "run.csv"
    record("heave-1").rename(columns={"pitch_deg": "pitch"}).to_csv(file, index=False)
    text = run("init", tmp_path / "new", file)
    assert "1 of 1 file can be used as guessed" in text and "pitch: pitch, deg?" in text and "heave: heave_m;" in text
    assert f"jaxhydro check {tmp_path / 'new'}" in text


def test_files_of_a_platform_are_copied_with_it(tmp_path: Path) -> None:
    source = tmp_path / "own"
    source.mkdir()
    text = (DEMO / "platform.yaml").read_text() + "\nradiation: {file: wamit/hull.1}\n"
    (source / "hull.yaml").write_text(text)
    assert "a file in" in run("init", tmp_path / "new", "--platform", source / "hull.yaml", status=2)
    (source / "wamit").mkdir()
    (source / "wamit" / "hull.1").write_text("0")
    run("init", tmp_path / "new", "--platform", source / "hull.yaml")
    assert (tmp_path / "new" / "wamit" / "hull.1").read_text() == "0"
    assert (tmp_path / "new" / "platform.yaml").read_text() == text
    assert not [path.name for path in tmp_path.iterdir() if path.name.startswith(".")]


def test_what_is_refused_leaves_nothing(tmp_path: Path) -> None:
    good, torn, bare = (tmp_path / name for name in ("good.csv", "torn.csv", "bare.csv"))
    shutil.copy(DEMO / "heave-1.csv", good)
    torn.write_text("time_s,heave_m\n0,1\n1,x\n2,3\n")
    bare.write_text("0,1\n1,2\n2,3\n")
    (tmp_path / "other").mkdir()
    shutil.copy(good, tmp_path / "other")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "notes.txt").write_text("mine")
    for words, expected in (
        (["full"], "expected a folder that is new or empty, found a folder that is not empty"),
        (["good.csv"], "which is a file"),
        (["new", "torn.csv"], "torn.csv: row 3, column heave_m: expected a number, found 'x'"),
        (["new", "none.csv"], "none.csv: file: expected a file that can be read"),
        (["new", "bare.csv"], "expected a column of a motion"),
        (["new", "good.csv", "other/good.csv"], "expected files of different names"),
        (["new", "--platform", "volturn"], "Did you mean 'volturnus-s'"),
        (["new", "--scale", "0"], "full-scale length over model length"),
        (["new", "--scale", "70:1"], "70 or 1:70 expected; found 70:1"),
    ):
        paths = [str(tmp_path / word) if word.endswith(".csv") or word in ("full", "new") else word for word in words]
        assert expected in run("init", *paths, status=2)
    assert not (tmp_path / "new").exists() and [path.name for path in (tmp_path / "full").iterdir()] == ["notes.txt"]


def test_an_empty_folder_is_filled(tmp_path: Path) -> None:
    run("init", tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["campaign.yaml", "platform.yaml"]


def test_a_decay_with_a_gap_is_used_beside_it(tmp_path: Path) -> None:
    """A hold, a release, and a gap: the gap would hide where the free motion begins."""
    time = np.arange(0.0, 200.0, 0.1)
    moved = np.maximum(time - 60.0, 0.0)
    table = pd.DataFrame({"time_s": time, "heave_m": 2 * np.exp(-0.02 * moved) * np.cos(0.6 * moved)})
    table[(time < 63.0) | (time > 69.0)].to_csv(tmp_path / "run.csv", index=False)
    (made,) = campaign(tmp_path / "made", tmp_path / "run.csv", platform="ship-section").records
    assert (made.kind, made.degree_of_freedom, made.use) == ("decay", "heave", "fit") and made.time[0] > 69.0
    assert "dies out in the longest part without a gap" in (tmp_path / "made" / "campaign.yaml").read_text()
