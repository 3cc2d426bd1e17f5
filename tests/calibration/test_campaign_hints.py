"""Units, scales and signs that all records of a campaign tell: nothing where nothing is wrong, and every way to be wrong."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from calibration import load_campaign
from calibration.campaign.load_campaign import Campaign
from calibration.campaign.motion_hints import motion_hints
from calibration.campaign.record_plausibility import CampaignFinding, check_plausible

TURN, SCALE = 180 / math.pi, 50.0
ANGLES = ("roll", "pitch", "yaw")


@pytest.fixture(scope="module")
def campaign() -> Campaign:
    return load_campaign("jaxhydro/campaigns/volturnus-s-decays")


def broken(campaign: Campaign, scale: float = 1.0, time: float = 1.0, **factors: float) -> list[str]:
    """What is told of the campaign with its times, lengths, angles or single channels multiplied."""

    def factor(name: str) -> float:
        return factors.get(name, factors.get("angle" if name in ANGLES else "length", 1.0))

    records = [
        replace(r, time=r.time * time, values={name: values * factor(name) for name, values in r.values.items()})
        for r in campaign.records
    ]
    findings = check_plausible(records, campaign.model, campaign.manifest.zero is not None, scale)
    return [f"{finding.channel}: {finding.message}" for finding in findings if isinstance(finding, CampaignFinding)]


def test_nothing_is_told_of_a_sound_campaign(campaign) -> None:
    assert broken(campaign) == [] == broken(campaign, scale=SCALE)
    assert not [finding for finding in campaign.findings if isinstance(finding, CampaignFinding)]


@pytest.mark.parametrize("off", [0.6, 0.8, 1.25, 1.7])
def test_a_model_that_is_off_is_no_mistake(campaign, off) -> None:
    """Periods and couplings that the model misses are what a calibration is for."""
    assert broken(campaign, time=off) == [] == broken(campaign, surge=off) == broken(campaign, angle=off)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"angle": TURN}, "pitch: all releases in angle are as if 57.3 times too large. Are degrees and radians mixed up"),
        ({"angle": 1 / TURN}, "pitch: all releases in angle are as if 57.3 times too small. Are degrees and radians mixed up"),
        ({"length": 1e3}, "surge: all releases in displacement are as if 1000 times too large. Are millimetres and metres"),
        ({"length": 1e-3}, "surge: all releases in displacement are as if 1000 times too small. Are millimetres and metres"),
        ({"heave": 1e3}, "heave: all releases in heave are as if 1000"),
        ({"heave": 1e-3}, "heave: all releases in heave are as if 1000 times too small. Are millimetres and metres"),
        ({"surge": 1e3}, "surge: all releases in surge are as if 1000 times too large. Are millimetres and metres"),
        ({"time": 1e3}, "1.04e+03 times the model's: `channels.time.unit`: milliseconds and seconds mixed up?"),
        ({"time": 1 / 60}, "1/57.7 of the model's: `channels.time.unit`: minutes and seconds mixed up?"),
        ({"length": 1 / SCALE, "time": SCALE**-0.5}, "as those of a model at 1:46.2 would be. Is `scale` left out?"),
        ({"time": SCALE**-0.5}, "as those of a model at 1:46.2 would be. Is `scale` left out?"),
        ({"scale": SCALE, "length": SCALE, "time": SCALE**0.5}, "If records and platform file are at one scale, `scale` is 1"),
        ({"scale": SCALE, "time": SCALE**0.5}, "If records and platform file are at one scale, `scale` is 1"),
        ({"scale": SCALE, "time": SCALE**-0.5}, "off by the square root of `scale`, 7.07. Were times scaled down before?"),
        ({"scale": SCALE, "time": SCALE}, "longer by `scale`. Times go with its square root"),
        ({"scale": 1 / SCALE, "length": SCALE**-2, "time": 1 / SCALE}, "is `scale` turned round (1:50 is `scale: 50`)?"),
        ({"scale": SCALE, "length": 1 / SCALE}, "or lengths not at the scale that `scale` states?"),
        ({"scale": SCALE, "length": SCALE}, "lengths at the model's and at full scale (`scale`) mixed up"),
        ({"pitch": -1}, "with the other sign. Is an axis reversed (`channels.surge.sign` or `channels.pitch.sign`)"),
        ({"surge": -1}, "with the other sign. Is an axis reversed (`channels.surge.sign` or `channels.pitch.sign`)"),
        ({"surge": -1, "pitch": -1}, ""),  # an axis that points the other way: nobody can tell
    ],
)
def test_every_way_to_be_wrong_is_told_once(campaign, changes, words) -> None:
    hints = broken(campaign, **changes)
    if not words:
        assert hints == []
        return
    (hint,) = hints
    assert words in hint


def test_a_campaign_that_is_refused_says_why_first(tmp_path) -> None:
    import shutil

    from jaxhydro.errors import InputError

    folder = tmp_path / "campaign"
    shutil.copytree("jaxhydro/campaigns/volturnus-s-decays", folder)
    text = (folder / "campaign.yaml").read_text()
    assert "unit: deg" in text
    (folder / "campaign.yaml").write_text(text.replace("unit: deg", "unit: rad"))
    with pytest.raises(InputError) as error:
        load_campaign(folder)
    assert "all releases in angle are as if 57.3 times too large" in error.value.problems[0].found


def waves(change: Callable[[str, np.ndarray], np.ndarray], late: float = 0.0) -> list[str]:
    """What is told of two tests in waves that are followed well."""
    time = np.arange(0.0, 600.0, 0.5)
    tests = []
    for period in (9.0, 12.0):
        sizes = {"surge": 1.0, "heave": 0.4, "pitch": 0.02}
        phase = {"surge": 1.5, "heave": 0.0, "pitch": -1.5}
        exact = {name: size * np.cos(2 * np.pi * time / period + phase[name]) for name, size in sizes.items()}
        shown = {name: size * np.cos(2 * np.pi * (time - late) / period + phase[name]) for name, size in sizes.items()}
        tests.append({name: (change(name, shown[name]), 1.1 * exact[name]) for name in sizes})
    return list(motion_hints(tests))


def test_motions_in_waves_tell_units_and_signs() -> None:
    assert waves(lambda name, x: x) == [] == waves(lambda name, x: 1.5 * x)
    assert waves(lambda name, x: -x, late=2.5) == []  # what is out of phase says nothing
    (hint,) = waves(lambda name, x: -x if name == "pitch" else x)
    assert hint == "of the other sign than simulated in all tests in waves: pitch. An axis reversed (`channels.pitch.sign`)?"
    (hint,) = waves(lambda name, x: -x)
    assert "(`wave_channel.sign` or its `position`)" in hint
    (hint,) = waves(lambda name, x: TURN * x if name == "pitch" else x, late=2.5)  # a size says it, whatever the phase
    assert hint.startswith("pitch is 57.3 times too large") and "(`channels.pitch.unit`)" in hint
    (hint,) = waves(lambda name, x: x / 1000 if name == "heave" else x)
    assert hint.startswith("heave is 1000 times too small") and "(`channels.heave.unit`)" in hint
