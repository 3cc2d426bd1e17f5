"""`jaxhydro simulate` with the records of two wave gauges: motions, what is printed and what is refused."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from fake_calibration import DEMO
from test_cli import cache, run  # noqa: F401

PLATFORM = DEMO / "platform.yaml"
TIMES = 0.5 * np.arange(600)
ONE = ("--wave", "tank.csv", "--wave-column", "near", "--wave-position", -100, 0)
SECOND = ("--second-wave-column", "far", "--second-wave-position", -80, 0)
SIZE = ("--dt", 0.5, "--cutoff", 0.2, "--no-figures")


def elevation(x: float, reflection: float) -> np.ndarray:
    """Waves of 12 harmonics of 300 s in deep enough water, and a part of them that comes back."""
    omega = 2 * np.pi * np.arange(26, 38) / 300.0
    k, phase = omega**2 / 9.80665, np.arange(12.0) ** 2
    angle = np.outer(TIMES, omega)
    return 0.3 * (np.cos(angle - k * x + phase) + reflection * np.cos(angle + k * x - phase)).sum(axis=1)


@pytest.fixture
def tank(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    table = {"time_s": TIMES, "near": elevation(-100.0, 0.0), "far": elevation(-80.0, 0.0)}
    table |= {
        "near_r": elevation(-100.0, 0.2),
        "far_r": elevation(-80.0, 0.2),
        "mm": 1000 * elevation(-80.0, 0.0),
        "dead": 0 * TIMES,
    }
    pd.DataFrame(table).to_csv(tmp_path / "tank.csv", index=False)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_without_reflection_the_motion_is_that_of_one_gauge(tank) -> None:
    run("simulate", PLATFORM, *ONE, *SIZE, "--order", 1, "--out", "one")
    text = run("simulate", PLATFORM, *ONE, *SECOND, *SIZE, "--out", "two")
    one, two = (pd.read_csv(tank / name / "motion.csv") for name in ("one", "two"))
    for column in ("surge_m", "heave_m", "pitch_deg", "wave_m"):
        assert np.abs(one[column] - two[column]).max() < 1e-4 * one[column].std(), column
    for words in ("Incident significant wave height", "Reflected significant wave height", "first order is the default"):
        assert words in text, words


def test_reflected_waves_are_told(tank) -> None:
    columns = ("--wave-column", "near_r", "--second-wave-column", "far_r")
    positions = ("--wave-position", -100, 0, "--second-wave-position", -80, 0)
    run("simulate", PLATFORM, "--wave", "tank.csv", *columns, *positions, *SIZE, "--out", "o")
    sea = json.loads((tank / "o" / "statistics.json").read_text())["sea"]
    height = 4 * np.sqrt(12 * 0.3**2 / 2)
    assert sea["incident_significant_wave_height"] == pytest.approx(height, rel=0.01)
    assert sea["reflected_significant_wave_height"] == pytest.approx(0.2 * height, rel=0.02)
    assert sea["reflection_coefficient"] == pytest.approx(0.2, rel=0.02)
    assert sea["second_wave_column"] == "far_r" and sea["second_wave_position"] == [-80.0, 0.0] and sea["order"] == 1
    assert sea["share_outside_separated_band"] < 1e-6 and 0.05 < sea["separated_band"][0] < sea["separated_band"][1] < 0.2


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (SECOND[:2], "--second-wave-position: expected with --second-wave-column"),
        (SECOND[2:], "--second-wave-column: expected with --second-wave-position"),
        (("--second-wave-column", "near", *SECOND[2:]), "another column than that of --wave-column expected, found near"),
        (("--second-wave-column", "fat", *SECOND[2:]), "tank.csv: expected a column 'fat'"),
        (("--second-wave-column", "mm", *SECOND[2:]), "column mm: expected waves less than 1/7 as high as long"),
        (("--second-wave-column", "dead", *SECOND[2:]), "tank.csv: column dead: expected an elevation that changes, found 0 m"),
        ((*SECOND[:2], "--second-wave-position", -120, 0), "expected positions for which incident waves are higher"),
        ((*SECOND[:2], "--second-wave-position", "nan", 0), "--second-wave-position: a finite number expected"),
        ((*SECOND[:2], "--second-wave-position", -100, 9), "expected two gauges apart along the waves, found 0 m"),
        ((*SECOND[:2], "--second-wave-position", 20, 0), "120 m between them, for 0.0177 to 0.0765 Hz, with 0% of the energy"),
        ((*SECOND, "--order", 2), "--order: expected 1 with two wave gauges, found 2 (at second order a sea of several"),
    ],
)
def test_bad_second_gauges_are_told(options, words, tank) -> None:
    assert words in run("simulate", PLATFORM, *ONE, *options, "--out", "o", status=2)
    assert not Path("o").exists()


def test_a_second_gauge_needs_a_record(tank) -> None:
    text = run("simulate", PLATFORM, "--hs", 3, "--tp", 9, *SECOND, "--out", "o", status=2)
    assert "--second-wave-column: a record expected with it, --wave FILE" in text
