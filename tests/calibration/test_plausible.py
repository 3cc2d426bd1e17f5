"""Records of another size or pace than the platform's are told before anything is fitted to them."""

import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from ruamel.yaml import YAML

from calibration.campaign.load_campaign import load_campaign
from calibration.campaign.record_plausibility import check_plausible
from jaxhydro.errors import InputError
from jaxhydro.interop.data_files import read_table

DEMO = Path(__file__).parents[2] / "jaxhydro" / "campaigns" / "volturnus-s-decays"


def stated(folder: Path, **channels: dict) -> Path:
    """The demo campaign, its channels (or `noise`) stated otherwise."""
    shutil.copytree(DEMO, folder)
    yaml = YAML()
    manifest = yaml.load(folder / "campaign.yaml")
    manifest["noise"].update(channels.pop("noise", {}))
    for name, change in channels.items():
        manifest["channels"][name].update(change)
    yaml.dump(manifest, folder / "campaign.yaml")
    return folder


def with_motion(folder: Path, column: int, change: Callable[[np.ndarray], np.ndarray]) -> Path:
    """The demo campaign, a column of its files (1: surge, 2: heave) recorded otherwise."""
    stated(folder)
    for path in folder.glob("*.csv"):
        header, rows = path.read_text().splitlines()[0], np.loadtxt(path, delimiter=",", skiprows=1)
        rows[:, column] = change(rows[:, column])
        np.savetxt(path, rows, "%.5f", ",", header=header, comments="")
    return folder


@pytest.mark.slow
def test_a_platform_that_does_not_float_is_told_with_its_file(tmp_path):
    """A mass in tonnes: where it says so, before anything is simulated."""
    folder = stated(tmp_path / "campaign")
    text = (folder / "platform.yaml").read_text()
    mass = re.search(r"mass: (\S+?)[,\s}]", text)
    assert mass is not None
    (folder / "platform.yaml").write_text(text.replace(f"mass: {mass[1]}", f"mass: {float(mass[1]) / 1e3}", 1))
    with pytest.raises(InputError, match=r"platform\.yaml: expected a platform that floats at rest, found no static"):
        load_campaign(folder)


def test_a_surge_that_no_mooring_allows_is_an_error(tmp_path):
    """Centimetres read as metres: more than six times the platform's radius of gyration."""
    folder = with_motion(tmp_path / "campaign", 1, lambda surge: 100 * surge)
    with pytest.raises(InputError, match=r"surge-3, channel surge: expected a motion .* radius of gyration"):
        load_campaign(folder)


def test_a_sound_campaign_has_nothing_odd():
    assert load_campaign(DEMO).findings == ()


@pytest.mark.parametrize(
    ("channels", "where", "pattern"),
    [
        ({"time": {"unit": "ms"}}, "surge-1.csv, test surge-1, channel surge", r"a period of 0\.1\d+ s .* model's is 1\d\d s"),
        ({"time": {"unit": "min"}}, "heave-1.csv, test heave-1, channel heave", r"a period of 1\.\d+e\+03 s"),
        ({"pitch": {"unit": "rad"}}, "pitch-3.csv, test pitch-3, channel pitch", "an angle of 3\\d\\d deg"),
        ({"heave": {"column": "surge_m"}}, "surge-1.csv, channel heave of test surge-1", "that of channel surge, 'surge_m'"),
    ],
)
def test_a_wrong_unit_is_an_error(tmp_path, channels, where, pattern):
    with pytest.raises(InputError) as error:
        load_campaign(stated(tmp_path / "campaign", **channels))
    faults = {problem.where: problem.found for problem in error.value.problems}
    assert re.search(pattern, faults[where])


def test_a_motion_in_millimetres_is_an_error(tmp_path):
    folder = with_motion(tmp_path / "campaign", 2, lambda heave: 1000 * heave)
    with pytest.raises(InputError, match=r"heave-1, channel heave: expected a motion .*, found a motion of"):
        load_campaign(folder)


def test_what_is_odd_is_a_warning(tmp_path):
    small = load_campaign(stated(tmp_path / "small", heave={"unit": "mm"}))
    still_findings = [finding for finding in small.findings if "moves by 0.00" in finding.message]
    assert {(finding.test, finding.severity) for finding in still_findings} == {(f"heave-{i}", "warning") for i in (1, 2, 3)}
    units = [finding for finding in small.findings if finding not in still_findings]
    together = (
        "all releases in heave are as if 1000 times too small. Are millimetres and metres mixed up (`channels.heave.unit`)?"
    )
    assert {finding.message for finding in units} == {"the file states m for column 'heave_m', and the manifest mm", together}
    noisy = load_campaign(stated(tmp_path / "noisy", noise={"surge": 3.0}))
    assert ["noise is stated as 3 m" in finding.message for finding in noisy.findings] == 3 * [True]


def test_a_sensor_with_a_zero_of_its_own_is_a_warning(tmp_path):
    folder = with_motion(tmp_path / "campaign", 2, lambda heave: heave + 2.5)
    (finding,) = load_campaign(folder).findings
    assert finding.channel == "heave" and finding.message.startswith(
        "decays end 2.5 m from the equilibrium of the platform file"
    )


ROWS = "\n".join(f"{0.1 * i:.2f},{0.3 * i:.2f},{-0.01 * i:.3f}" for i in range(30)) + "\n"


@pytest.mark.parametrize(
    "top",
    [
        "time,surge,pitch\n",
        "time,surge,pitch\ns,m,deg\n",
        "Catman export\nDate 2024-01-02,10:22\n\ntime,surge,pitch\n",
        "Run 3\nrate,50\n1.0\ntime,surge,pitch\ns,m,deg\n",
        "Run 3,,\ntime,surge,pitch\n",
        "# a comment\nA basin\ntime,surge,pitch\n",
    ],
)
def test_what_a_logger_wrote_above_the_header_is_left_out(tmp_path, top):
    path = tmp_path / "run.csv"
    path.write_text(top + ROWS)
    table = read_table(path)
    assert list(table.columns) == ["time", "surge", "pitch"] and table.shape == (30, 3)
    assert table["surge"].iloc[-1] == 8.7


@pytest.mark.parametrize(("factor", "severity"), [(1.0, None), (8.0, "warning"), (1000.0, "error")])
def test_waves_that_cannot_stand_are_told(factor, severity):
    time = np.arange(0.0, 600.0, 0.5)
    campaign = load_campaign(DEMO)
    record = replace(
        campaign.record("surge-1"),
        kind="regular",
        degree_of_freedom=None,
        time=time,
        values={},
        wave=factor * 2.0 * np.sin(2 * np.pi * time / 10),  # 4 m high, 156 m long: 1/39
    )
    findings = check_plausible([record], campaign.model, zeroed=False)
    assert [finding.severity for finding in findings] == ([severity] if severity else [])


SHIP = """
name: Ship, model at 1:50
water: {density: 1000.0, depth: 3.0}
rigid_body: {mass: 800.0, centre_of_mass: [0, 0, -0.03], inertia: {Ixx: 90.0, Iyy: 1200.0, Izz: 1200.0}}
members: []
added_mass: {A44: 15.0}
linear_damping: {B44: 2.0}
hydrostatics: {RESTORING}
mooring: {kind: none}
"""


@pytest.mark.parametrize(
    ("restoring", "expected"),
    [
        ("C44: 650.0", ["heave: C33, or take heave", "pitch: C55, or take pitch"]),
        ("C44: 650.0, C33: 30000.0, C55: 40000.0", []),
        ("C33: 30000.0, C55: 40000.0", ["roll: C44"]),
    ],
)
def test_a_measured_motion_that_nothing_restores_is_told(tmp_path, restoring, expected):
    """A fit of the roll of a ship would pitch it to lengthen its period."""
    time = np.arange(0, 40, 0.1)
    roll = np.radians(8) * np.exp(-0.02 * time) * np.cos(2 * np.pi * time / 2.5)
    small = np.random.default_rng(0).normal(0, 1e-4, (2, len(time)))
    np.savetxt(
        tmp_path / "roll.csv", np.stack([time, roll, *small], axis=1), delimiter=",", header="t,phi,z,theta", comments=""
    )
    (tmp_path / "platform.yaml").write_text(SHIP.replace("RESTORING", restoring))
    (tmp_path / "campaign.yaml").write_text(
        "name: ship\nplatform: platform.yaml\nscale: 1\n"
        "channels: {time: {column: t, unit: s}, roll: {column: phi, unit: rad}, heave: {column: z, unit: m}, "
        "pitch: {column: theta, unit: rad}}\n"
        "tests: [{id: roll, kind: decay, degree_of_freedom: roll, file: roll.csv, use: fit}]\n"
    )
    warned = [
        f"{finding.channel}: {finding.message.partition('hydrostatics.')[2].partition(' out')[0]}"
        for finding in load_campaign(tmp_path).findings
        if "nothing restores" in finding.message
    ]
    assert warned == expected
