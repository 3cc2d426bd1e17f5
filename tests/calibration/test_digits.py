"""Records of few digits, or interpolated: what is smooth has no spikes and is not clipped; what is spoilt still is told."""

import json

import numpy as np
import pytest

from calibration.campaign.checks import check_records
from calibration.campaign.digits import local_resolution, straight_piece
from calibration.campaign.manifest import read_manifest
from calibration.campaign.signals import spikes

T = np.arange(0.0, 100.0, 0.05)
SMOOTH = 3.4 * np.exp(-0.01 * T) * np.cos(2 * np.pi * T / 9.2 + 0.1)
NOISE = np.random.default_rng(3).normal(size=len(T))


def written(values, form):
    return np.array([float(form % value) for value in values])


def coarse(stride, values=SMOOTH):
    """Straight lines between every so many samples, as video tracking that is resampled."""
    return np.interp(T, T[::stride], values[::stride])


def told(folder, values, form="%.17g"):
    """What is said of a surge decay of these values."""
    rows = "\n".join(f"{t:.2f},{form % x}" for t, x in zip(T, values))
    (folder / "d.csv").write_text(f"t,x\n{rows}\n")
    channels = {"time": {"column": "t", "unit": "s"}, "surge": {"column": "x", "unit": "m"}}
    test = {"id": "d", "kind": "decay", "degree_of_freedom": "surge", "file": "d.csv"}
    manifest = {"name": "d", "platform": "volturnus-s", "channels": channels, "tests": [test]}
    (folder / "campaign.yaml").write_text(json.dumps(manifest))
    return [finding.message for finding in check_records(*read_manifest(folder))]


@pytest.mark.parametrize("form", ["%.3g", "%.4g", "%.5g", "%.3e", "%.2f", "%.4f", "%.17g"])
@pytest.mark.parametrize("values", [SMOOTH, 1000 * SMOOTH, SMOOTH + 0.01 * NOISE], ids=["metres", "millimetres", "noisy"])
def test_few_digits_are_no_fault(tmp_path, values, form):
    assert told(tmp_path, values, form) == []


@pytest.mark.parametrize("form", ["%.4g", "%.17g"])
@pytest.mark.parametrize(
    "values",
    [
        coarse(2),
        coarse(5),
        coarse(10),
        coarse(10, SMOOTH + 0.01 * NOISE),
        coarse(10, written(SMOOTH, "%.4g")),
        np.interp(T, np.arange(0, 101, 0.3337), np.interp(np.arange(0, 101, 0.3337), T, SMOOTH)),
        SMOOTH[np.arange(len(T)) // 10 * 10],
        SMOOTH.astype(np.float32).astype(float),
        np.rint(SMOOTH / 0.0033) * 0.0033,
    ],
    ids=["by 2", "by 5", "by 10", "noisy by 10", "rounded by 10", "odd rate", "held by 10", "float32", "counts"],
)
def test_interpolation_is_no_fault(tmp_path, values, form):
    assert told(tmp_path, values, form) == []


@pytest.mark.parametrize("form", ["%.4g", "%.17g"])
@pytest.mark.parametrize("values", [SMOOTH, coarse(10), SMOOTH + 0.01 * NOISE], ids=["smooth", "by 10", "noisy"])
def test_a_spike_and_a_clipped_channel_are_told(tmp_path, values, form):
    spoilt = values.copy()
    spoilt[777] += 0.5
    assert [f"a spike at {T[777]:g} s" in message for message in told(tmp_path, spoilt, form)] == [True]
    assert [
        "clipped" in message and "highest value, 2.5" in message for message in told(tmp_path, np.minimum(values, 2.5), form)
    ] == [True]


def test_the_grain_of_a_sensor_is_no_spike():
    """A still sensor whose reading flickers by one grain, written with digits beyond it; a real spike beside it is found."""
    random = np.random.default_rng(3)
    grain = 0.0873
    values = np.round(grain * (random.random(1400) < 0.1) + 1e-6 * random.normal(size=1400), 5)
    step = np.full(1400, 1e-5)
    assert spikes(values, step).size == 0
    values[700] += 12 * grain
    assert spikes(values, step).tolist() == [700]


def test_the_step_of_the_last_digit_is_that_at_the_value():
    values = np.array([0.1234, 0.5671, 0.9999, 1.0, 1.002, 2.345, 12.34, 0.0123, -0.0456, -1.111, 0.0])
    expected = [1e-4, 1e-4, 1e-4, 1e-3, 1e-3, 1e-3, 1e-2, 1e-4, 1e-4, 1e-3, 1e-4]
    assert local_resolution(values) == pytest.approx(expected, rel=1e-9)
    single = np.random.default_rng(1).uniform(0, 4, 4000).astype(np.float32).astype(float)
    assert set(local_resolution(single)[single > 2]) == {2.0**-22}
    assert straight_piece(coarse(10), local_resolution(coarse(10))) == pytest.approx(10, rel=0.1)
    assert straight_piece(SMOOTH, local_resolution(SMOOTH)) == 1
