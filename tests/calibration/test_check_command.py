"""`jaxhydro check`: what a campaign holds, its natural periods beside the model's, and what to look at first."""

import math
from importlib import resources
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from test_cli import small_campaign
from typer.testing import CliRunner

from calibration.campaign.load_campaign import load_campaign
from calibration.report.check_tables import PeriodComparison, compare_periods, doubts, periods, verdict
from jaxhydro.cli import app as cli
from jaxhydro.dynamics.statics import natural_modes
from jaxhydro.errors import InputError
from jaxhydro.hull.member import Member
from jaxhydro.plots.hull_drawing import hull_figure, outline
from jaxhydro.plots.style import style

RUNNER = CliRunner()
DEMO = Path(str(resources.files("jaxhydro") / "campaigns" / "volturnus-s-decays"))


@pytest.fixture(scope="module")
def demo():
    return load_campaign(DEMO)


def test_periods_are_those_of_the_records(demo):
    by_motion = {comparison.motion: comparison for comparison in compare_periods(demo.records, natural_modes(demo.model))}
    assert {name: comparison.tests for name, comparison in by_motion.items()} == {"surge": 3, "heave": 3, "pitch": 3}
    # the records were made with periods of 133, 18.8 and 26.4 s
    np.testing.assert_allclose([by_motion[name].measured for name in ("surge", "heave", "pitch")], [133, 18.8, 26.4], rtol=0.02)
    assert all(abs(comparison.difference) < 0.05 for comparison in by_motion.values())


def test_a_sound_campaign_is_said_to_be_sound(demo):
    compared = compare_periods(demo.records, natural_modes(demo.model))
    assert verdict(demo, list(doubts(demo, compared))) == "9 tests read: nothing looks wrong."
    assert verdict(demo, ["this", "that"]) == "9 tests read. Look at this first: this; that."


def test_a_period_far_off_is_named(demo):
    sentences = list(doubts(demo, [PeriodComparison("pitch", 3, 26.4, 37.0), PeriodComparison("heave", 3, 18.8, 18.1)]))
    assert len(sentences) == 1 and sentences[0].startswith("pitch: the model's natural period is 37.0 s, measured 26.4 s")
    assert "no natural period" in next(doubts(demo, [PeriodComparison("sway", 1, 130.0, math.nan)]))


def test_command_draws_the_hull_and_every_record(tmp_path):
    out, campaign = tmp_path / "check", small_campaign(tmp_path / "few", ("surge-1", "heave-1"))
    result = RUNNER.invoke(cli.app, ["check", str(campaign), "--out", str(out)], env={"COLUMNS": "160"})
    assert result.exit_code == 0, result.output
    assert "surge from 3.01 m" in result.output and "nothing looks wrong" in result.output
    assert {path.name for path in out.iterdir()} == {"hull.png", "record-surge-1.png", "record-heave-1.png"}
    with Image.open(out / "hull.png") as image:
        assert min(image.size) > 500


def test_command_says_that_periods_are_off(tmp_path):
    folder = small_campaign(tmp_path / "wrong", ("surge-1",))
    text = (folder / "platform.yaml").read_text()
    assert text.count("stiffness: 45000.0") == 3
    (folder / "platform.yaml").write_text(text.replace("stiffness: 45000.0", "stiffness: 20000.0"))
    result = RUNNER.invoke(cli.app, ["check", str(folder)], env={"COLUMNS": "160"})
    assert result.exit_code == 0, result.output
    assert "surge: the model's natural period is" in " ".join(result.output.split())


@pytest.mark.slow
def test_a_platform_out_of_balance_or_not_one_s_own_is_named(tmp_path):
    folder = small_campaign(tmp_path / "new")
    text = (folder / "platform.yaml").read_text()
    assert "mass: 20054283" in text
    (folder / "platform.yaml").write_text(text.replace("mass: 20054283", "mass: 20554283"))
    heavy = " ".join(doubts(load_campaign(folder), []))
    assert "m too low, draught 20" in heavy
    (folder / "platform.yaml").write_bytes((DEMO.parents[1] / "platforms" / "volturnus-s.yaml").read_bytes())
    warned = [str(finding) for finding in load_campaign(folder).findings]
    assert any(message.startswith("platform.yaml: still the built-in platform volturnus-s: put your") for message in warned)


@pytest.mark.parametrize("command", ["check", "calibrate", "diagnose"])
def test_an_unstable_platform_is_refused(tmp_path, command):
    folder = small_campaign(tmp_path / "top-heavy")
    text = (folder / "platform.yaml").read_text()
    assert "centre_of_mass: [0.0, 0.0, -2.4]" in text
    (folder / "platform.yaml").write_text(text.replace("[0.0, 0.0, -2.4]", "[0.0, 0.0, 40.0]"))
    result = RUNNER.invoke(cli.app, [command, str(folder), "--out", str(tmp_path / "out")], env={"COLUMNS": "160"})
    output = " ".join(result.output.split())
    assert result.exit_code == 2 and "the platform is unstable in roll and pitch" in output, output
    assert not (tmp_path / "out").exists()


def test_restoring_that_a_ship_leaves_out_is_named(tmp_path):
    small_campaign(tmp_path / "ship")
    (tmp_path / "ship" / "platform.yaml").write_text(
        "{name: ship, water: {density: 1000.0, depth: 3.0}, members: [], mooring: {kind: none}, hydrostatics: {C44: 1e9},"
        "rigid_body: {mass: 2e7, centre_of_mass: [0, 0, 1.0], inertia: {Ixx: 1e10, Iyy: 1e10, Izz: 1e10}}}"
    )
    with pytest.raises(InputError, match=r"unstable in pitch.*`hydrostatics` states what restores: C55 is left out"):
        load_campaign(tmp_path / "ship")


def test_a_motion_without_a_natural_period_has_no_difference():
    _, rows = periods([PeriodComparison("sway", 1, 130.0, math.nan)])
    assert rows == [("sway", "1", "130", "–", "–")]


def test_command_refuses_what_cannot_be_read(tmp_path):
    result = RUNNER.invoke(cli.app, ["check", str(tmp_path), "--out", str(tmp_path / "out")])
    assert result.exit_code == 2 and not (tmp_path / "out").exists()


def test_command_refuses_to_free_what_the_platform_does_not_have(tmp_path):
    """As `calibrate` does, which comes next."""
    folder = small_campaign(tmp_path / "campaign")
    text = (folder / "campaign.yaml").read_text()
    assert "free: [pontoon.Ca_z" in text
    (folder / "campaign.yaml").write_text(text.replace("free: [pontoon.Ca_z", "free: [pontoon.Ca_x"))
    result = RUNNER.invoke(cli.app, ["check", str(folder), "--out", str(tmp_path / "out")], env={"COLUMNS": "160"})
    output = " ".join(result.output.split())
    assert result.exit_code == 2 and "calibrate.free: expected a parameter of this platform" in output, output
    assert not (tmp_path / "out").exists()


def test_outline_has_the_member_s_size():
    box = Member(
        "box", "hull", False, np.array([-10.0, 0, -3]), np.array([10.0, 0, -3]), np.array([0.0, 1]), np.array([[4.0, 6]] * 2)
    )
    points = outline(box).reshape(-1, 3)
    np.testing.assert_allclose(np.ptp(points, axis=0), [20, 4, 6], atol=1e-12)
    pole = Member(
        "pole", "hull", True, np.array([0.0, 0, -120]), np.array([0.0, 0, 10]), np.array([0.0, 1]), np.full((2, 2), 9.0)
    )
    with style():
        assert hull_figure([pole], "a spar").get_figheight() < 7  # a slender hull does not make an endless page
