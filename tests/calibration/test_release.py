"""Decays that are held, pushed or caught, seas that begin late or die down: what is used of them, and what is told."""

import json
from pathlib import Path

import numpy as np
import pytest

from calibration.campaign.checks import check_records
from calibration.campaign.load_campaign import load_campaign
from calibration.campaign.manifest import read_manifest
from calibration.campaign.records import load_records
from calibration.campaign.release import free_motion

SHARED = Path(__file__).resolve().parents[3] / "shared"
PERIOD, STEP, RATIO = 9.2, 0.1, 0.03
W = 2 * np.pi / PERIOD
RNG = np.random.default_rng(5)


def swing(duration, position=1.0, speed=0.0):
    """A free decay from a position and speed."""
    t = np.arange(0, duration, STEP)
    wd = W * (1 - RATIO**2) ** 0.5
    return np.exp(-RATIO * W * t) * (position * np.cos(wd * t) + (speed + RATIO * W * position) / wd * np.sin(wd * t))


def held(duration, level=1.0):
    return np.full(round(duration / STEP), level)


DECAY = swing(90)
AT_END = DECAY[400]
PULL = 0.5 - 0.5 * np.cos(np.linspace(0, np.pi, 300))


def motion(*parts, noise=0.002):
    """Parts of a motion one after the other, 3 m about -0.4 m, the other way up."""
    x = -3 * np.concatenate(parts) - 0.4
    return STEP * np.arange(len(x)), x + 3 * noise * RNG.normal(size=len(x))


@pytest.mark.parametrize("noise", [0.0, 0.002, 0.02])
@pytest.mark.parametrize("hold", [0.15, 0.3, 0.43, 1.0, 3.3, 30.0])
def test_a_decay_begins_at_its_release(hold, noise):
    t, x = motion(held(hold * PERIOD), DECAY, noise=noise)
    free = free_motion(t, x)
    released = round(hold * PERIOD / STEP) * STEP
    assert free.start == "release" and free.end == "record" and free.last == len(t)
    assert free.held_until == pytest.approx(released, abs=0.03 * PERIOD) and free.level == pytest.approx(-3.4, abs=0.1)
    assert -STEP < t[free.first] - released < 0.06 * PERIOD


@pytest.mark.parametrize(
    ("before", "start", "first"),
    [
        ((held(20, 0.0), PULL, held(15)), "release", 65.0),
        ((held(20, 0.0), PULL), "release", 50.0),
        ((held(15, 1.02), held(2, 1.01), held(9)), "release", 26.0),
    ],
)
def test_the_last_stillness_counts(before, start, first):
    t, x = motion(*before, DECAY)
    free = free_motion(t, x)
    assert free.start == start and free.end == "record"
    assert t[free.first] == pytest.approx(first, abs=0.06 * PERIOD)


def test_a_push_from_rest_is_left_out():
    t, x = motion(held(20, 0.0), swing(90, 0.0, W))
    free = free_motion(t, x)
    assert free.start == "push" and free.held_until == pytest.approx(20, abs=0.1 * PERIOD)
    assert 20 < t[free.first] < 20 + 0.35 * PERIOD


@pytest.mark.parametrize(
    ("after", "end", "last"),
    [
        (held(40, AT_END), "catch", 40.0),
        (swing(80, AT_END, -2 * W), "push", 40.0),
        (swing(80, 2.0, 0.0), "push", 40.0),
    ],
)
def test_a_decay_ends_where_it_is_disturbed(after, end, last):
    t, x = motion(DECAY[:400], after)
    free = free_motion(t, x)
    assert (free.first, free.start, free.end) == (0, "record", end)
    assert last - 0.8 * PERIOD < t[free.last - 1] < last + 0.1 * PERIOD


def test_a_second_push_after_rest_is_left_out():
    t, x = motion(held(10), swing(300), swing(80, 0.0, W))
    free = free_motion(t, x)
    assert free.start == "release" and free.end == "push" and 300 < t[free.last - 1] < 311


FREE = {
    "noisy": motion(DECAY, noise=0.03),
    "in motion": motion(DECAY[30:]),
    "to rest": motion(swing(300)),
    "strongly damped": motion(np.exp(-0.15 * W * STEP * np.arange(900)) * np.cos(W * STEP * np.arange(900))),
    "with a slow motion": motion(DECAY + 0.2 * np.cos(W / 4 * STEP * np.arange(900) + 1)),
    "with a fast motion": motion(DECAY + 0.1 * np.cos(3.3 * W * STEP * np.arange(900) + 1)),
    "with a gap": tuple(np.delete(samples, np.s_[200:240]) for samples in motion(DECAY)),
}


@pytest.mark.parametrize("name", FREE)
def test_a_free_decay_is_taken_whole(name):
    time, values = FREE[name]
    free = free_motion(time, values)
    assert (free.first, free.last, free.start, free.end) == (0, len(time), "record", "record")


def campaign(folder, time, motions, wave=None, **test):
    """A folder of one test, its findings and its record."""
    columns = {"t": time, "x": motions, **({} if wave is None else {"w": wave})}
    rows = "\n".join(",".join(f"{value:.6f}" for value in row) for row in zip(*columns.values()))
    (folder / "d.csv").write_text(f"{','.join(columns)}\n{rows}\n")
    channels = {"time": {"column": "t", "unit": "s"}, "surge": {"column": "x", "unit": "m"}}
    kind = {"kind": "decay", "degree_of_freedom": "surge"} if "kind" not in test else {}
    manifest = {"name": "d", "platform": "volturnus-s", "channels": channels, "tests": []}
    manifest["tests"] = [{"id": "d", "file": "d.csv"} | kind | test]
    if wave is not None:
        manifest["wave_channel"] = {"column": "w", "unit": "m", "position": [0, 0]}
    (folder / "campaign.yaml").write_text(json.dumps(manifest))
    read = read_manifest(folder)
    return [finding.message for finding in check_records(*read)], load_records(*read)[0]


def test_what_was_left_out_is_told_once_with_its_time(tmp_path):
    warnings, record = campaign(tmp_path, *motion(held(10), DECAY[:400], held(40, AT_END)))
    assert len(warnings) == 2
    assert (
        warnings[0].startswith("stands still at -3.4")
        and "until 10" in warnings[0]
        and "a `window` that begins later" in warnings[0]
    )
    assert warnings[1].startswith("is held again after 49.") and "`window` overrides this" in warnings[1]
    assert 10 <= record.time[0] < 10.6 and 48.5 < record.time[-1] < 50.2


def test_a_window_is_respected_and_a_hold_in_it_is_found(tmp_path):
    parts = motion(held(10), DECAY[:400], held(40, AT_END))
    warnings, record = campaign(tmp_path, *parts, window=[5, 80])
    assert "until 10" in warnings[0] and "`window` includes this" in warnings[1]
    assert 10 <= record.time[0] < 10.6 and record.time[-1] == pytest.approx(80)
    warnings, record = campaign(tmp_path, *parts, window=[12, 48])
    assert warnings == [] and record.time[0] == pytest.approx(12)


def test_waves_in_a_decay_are_told(tmp_path):
    t, x = motion(DECAY)
    wave = 0.05 * np.cos(2 * np.pi * t / 2.3) + 0.0005 * RNG.normal(size=len(t))
    warnings, _ = campaign(tmp_path, t, x, wave)
    assert len(warnings) == 1 and warnings[0].startswith("waves of 2.29")
    assert "0.1 m high, where a decay should be in still water" in warnings[0]
    assert campaign(tmp_path, t, x, 0.01 * DECAY + 0.0005 * RNG.normal(size=len(t)))[0] == []  # its own
    warnings, _ = campaign(tmp_path, t, x * np.exp(-t / 15) + 0.3 * np.sin(2 * np.pi * t / 2.3))
    assert [message[:40] for message in warnings] == ["its last third oscillates by 0.3 m in 2."]


def sea(first, last, duration=400.0, period=4.0):
    """Regular waves of which a record has more or less."""
    t = np.arange(0, duration, 0.2)
    height = np.clip((t - first) / 8, 0, 1) * np.clip((last - t) / 8, 0, 1)
    return t, height * np.cos(2 * np.pi * t / period) + 0.001 * RNG.normal(size=len(t))


@pytest.mark.parametrize(
    ("bounds", "transient", "words"),
    [
        ((-20, 500), 0.0, ["the waves have begun before the record"]),
        ((-20, 500), 40.0, []),
        ((0, 500), 10.0, []),
        ((20, 500), 60.0, []),
        ((100, 500), 20.0, ["the waves begin at 1"]),
        ((0, 300), 20.0, ["the waves die down after 2"]),
        ((0, 300), 300.0, []),
    ],
)
def test_seas_that_begin_late_or_die_down(tmp_path, bounds, transient, words):
    t, wave = sea(*bounds)
    messages, _ = campaign(tmp_path, t, 0.5 * wave + 0.01 * RNG.normal(size=len(t)), wave, kind="regular", transient=transient)
    messages = [message for message in messages if "drifts" not in message]
    assert len(messages) == len(words) and all(message.startswith(word) for message, word in zip(messages, words))


@pytest.mark.parametrize(("first", "last", "frozen"), [(0, 18, False), (100, 130, True), (0, 130, True)])
def test_what_is_still_before_the_waves_is_not_frozen(tmp_path, first, last, frozen):
    t, wave = sea(20, 500)
    x = 0.5 * wave + 0.01 * RNG.normal(size=len(t))
    x[(t >= first) & (t <= last)] = 0.0
    messages, _ = campaign(tmp_path, t, x, wave, kind="regular", transient=60.0)
    assert any("frozen" in message for message in messages) == frozen


@pytest.mark.skipif(not (SHARED / "cases").is_dir(), reason=f"{SHARED / 'cases'} is not on this machine")
@pytest.mark.parametrize(("name", "until"), [("campaign.yaml", 1.0), ("campaign-30s.yaml", 30.0)])
def test_the_case_of_a_hold_before_the_release(name, until):
    campaign = load_campaign(SHARED / "cases" / "hold-before-release" / name)
    (record,), (finding,) = campaign.records, campaign.findings
    assert finding.time == pytest.approx(until, abs=0.02) and 0 <= record.time[0] - until < 0.1
    assert f"roll: stands still at 12 deg until {until:g}" in str(finding)
