"""Campaigns with two wave gauges: incident and reflected waves drive the tests, which are compared and not fitted."""

import json
import math

import numpy as np
import pytest
from fake_sweep import PLATFORM
from test_seas import GAUGE, SCALE, STEP, document, write

from calibration.campaign.load_campaign import load_campaign
from calibration.campaign.runs import runs
from calibration.fitting.sea_fit import calibrate_in_waves
from calibration.residuals.measured_seas import compare
from calibration.residuals.run_seas import seas_of
from calibration.residuals.wave_options import Options
from jaxhydro.errors import InputError

SECOND = (-85.0, 20.0)  # m, full scale
DEPTH, OFFSET = 100.0, 0.31  # m; of the first gauge at the scale of the files
TIMES = STEP * np.arange(800)
TESTS = [document()["tests"][0], {"id": "sea", "kind": "irregular", "file": "sea.csv", "transient": 5}]
OPTIONS = Options(order=1, low=0.05, cutoff=0.2)


def elevation(x: float, reflection: float) -> np.ndarray:
    """Incident and reflected waves at full scale (m): harmonics of 400 s, in plain NumPy."""
    omega = 2 * math.pi * np.arange(34, 48, 2) / 400.0
    k = omega**2 / 9.80665
    for _ in range(100):
        k = omega**2 / (9.80665 * np.tanh(k * DEPTH))
    phase, angle = np.arange(7.0) ** 2, np.outer(TIMES, omega)
    return 0.4 * (np.cos(angle - k * x + phase) + reflection * np.cos(angle + k * x - 2 * phase)).sum(axis=1)


def campaign(folder, reflection=0.2, **changes):
    """A campaign at 1:50 whose sea was measured by two gauges; `w2` is in mm."""
    second = {"column": "w2", "unit": "mm", "position": [x / SCALE for x in SECOND]}
    stated = {"records": {"order": 1}, "tests": TESTS, "second_wave_channel": second} | changes
    write(folder, text=PLATFORM, **{key: value for key, value in stated.items() if value is not None})
    first, later = (elevation(x, reflection) / SCALE for x in (GAUGE[0], SECOND[0]))
    motions = 0.01 * np.cos(np.outer(TIMES, [0.6, 0.7, 0.8]))
    table = np.column_stack([TIMES / SCALE**0.5, first + OFFSET, 1000 * later, motions])
    np.savetxt(folder / "sea.csv", table, delimiter=",", header="t,w,w2,x,z,p", comments="", fmt="%.8f")
    return folder


def test_both_gauges_are_read_at_full_scale(tmp_path) -> None:
    loaded = load_campaign(campaign(tmp_path))
    (run,) = runs(loaded)
    assert run.second is not None and run.second.position == pytest.approx(SECOND) and run.position == pytest.approx(GAUGE)
    np.testing.assert_allclose(run.second.wave, elevation(SECOND[0], 0.2), atol=1e-5)
    np.testing.assert_allclose(run.wave - run.wave.mean(), elevation(GAUGE[0], 0.2), atol=1e-2)
    assert "second_wave" not in loaded.record("sea").values and "second_wave" not in loaded.record("sea").noise


def test_incident_and_reflected_waves_of_a_run(tmp_path) -> None:
    loaded = load_campaign(campaign(tmp_path))
    ((_, made),) = seas_of(loaded, loaded.model.environment, OPTIONS, several_headings=True)
    energy = 0.5 * np.asarray(made.sea.components.amplitude).reshape(2, -1) ** 2
    height = 4 * math.sqrt(7 * 0.4**2 / 2)
    assert 4 * np.sqrt(energy.sum(axis=1)) == pytest.approx((height, 0.2 * height), rel=0.02)
    third = made.sea.gauge(TIMES + runs(loaded)[0].time[0], (0.0, 0.0))
    assert np.std(third - elevation(0.0, 0.2)) < 0.02 * np.std(third)
    (note,) = [note for note in made.notes if "two gauges find incident waves" in note]
    assert "The reflection coefficient is 0.2." in note


def test_a_fit_and_second_order_are_refused(tmp_path) -> None:
    loaded = load_campaign(campaign(tmp_path))
    with pytest.raises(InputError, match=r"compared, not fitted, found sea.*take one gauge: `channels: \{second_wave: null\}`"):
        calibrate_in_waves(loaded)
    with pytest.raises(InputError, match="order: expected 1 in a sea of several headings, found 2"):
        seas_of(loaded, loaded.model.environment, Options(order=2), several_headings=True)
    tests = [TESTS[0], {**TESTS[1], "channels": {"second_wave": None}}]
    (run,) = runs(load_campaign(campaign(tmp_path, tests=tests, records=None)))
    assert run.second is None and not run.several_headings


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"records": None}, r"tests\[1\]: expected records: \{order: 1\} with two wave gauges, found order: 2"),
        (
            {"second_wave_channel": {"column": "w2", "unit": "mm"}},
            r"second_wave_channel\.position: expected the position of each",
        ),
        (
            {"wave_channel": {"column": "w", "unit": "m"}},
            r"wave_channel\.position: expected the position of each of two gauges",
        ),
        ({"wave_channel": None}, "wave_channel: expected a first gauge, beside second_wave_channel, found none"),
        ({"second_wave_channel": {"column": "w3", "unit": "m", "position": [0, 0]}}, "expected a column 'w3'"),
        ({"second_wave_channel": {"column": "w2", "unit": "deg", "position": [0, 0]}}, "expected a unit of length"),
        ({"second_wave_channel": {"column": "w2", "unit": "mm", "position": [-2.0, 0.4]}}, "gauges apart along the waves"),
    ],
)
def test_what_does_not_suit_two_gauges_is_told(changes, words, tmp_path) -> None:
    manifest = campaign(tmp_path, **changes) / "campaign.yaml"
    if "wave_channel" in changes and changes["wave_channel"] is None:  # `document` states one
        stated = json.loads(manifest.read_text())
        manifest.write_text(json.dumps({key: value for key, value in stated.items() if key != "wave_channel"}))
    with pytest.raises(InputError, match=words):
        loaded = load_campaign(tmp_path)
        seas_of(loaded, loaded.model.environment, OPTIONS, several_headings=True)


@pytest.mark.slow
def test_without_reflection_motions_are_those_of_one_gauge(tmp_path) -> None:
    """Both are of first order; the sea of two headings is summed directly, that of one is not."""
    simulated = []
    for name, changes in (("two", {}), ("one", {"second_wave_channel": None})):
        (tmp_path / name).mkdir()
        loaded = load_campaign(campaign(tmp_path / name, reflection=0.0, **changes))
        (test,) = compare(loaded, loaded.model, OPTIONS).tests
        simulated.append({series.channel: series.simulated for series in test.fit.series})
    two, one = simulated
    for channel in ("surge", "heave"):
        assert np.abs(two[channel] - one[channel]).max() < 2e-3 * np.std(one[channel]), channel
