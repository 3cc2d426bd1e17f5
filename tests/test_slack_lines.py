"""Lines that are longer than the way to their anchors: no mooring, and a warning before anything runs."""

import copy
import warnings
from typing import Any

import pytest
import yaml
from typer.testing import CliRunner

from jaxhydro.cli import app
from jaxhydro.platform import build
from jaxhydro.platform_schema import Platform
from jaxhydro.problems import PlatformWarning, validate

ANCHORS = ([60, 0, -100], [-30, 52, -100], [-30, -52, -100])
FAIRLEADS = ([5, 0, -5], [-2.5, 4.33, -5], [-2.5, -4.33, -5])
DATA: dict[str, Any] = {
    "name": "shallow",
    "water": {"density": 1025.0, "depth": 100},
    "rigid_body": {
        "mass": 483019.87, "centre_of_mass": [0, 0, -4.2], "inertia": {"Ixx": 1.0e7, "Iyy": 1.0e7, "Izz": 5.0e6},
    },
    "members": [{"name": "m", "shape": "circ", "d": 10.0, "rA": [0, 0, -6], "rB": [0, 0, 6]}],
    "coefficients": {"m": {"Ca_t": 1.0, "Ca_z": 0.6, "Cd_t": 1.0, "Cd_z": 1.0}},
}  # fmt: skip


def platform(*lengths: float) -> dict[str, Any]:
    ends = zip(ANCHORS, FAIRLEADS, lengths)
    lines = [{"anchor": a, "fairlead": f, "axial_stiffness": 5e6, "unstretched_length": n} for a, f, n in ends]
    return copy.deepcopy(DATA) | {"mooring": {"kind": "linear_springs", "lines": lines}}


def told(data: dict[str, Any]) -> list[str]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        build(validate(Platform, data, "shallow"))
    return [str(one.message) for one in caught if issubclass(one.category, PlatformWarning)]


def test_lines_that_hang_through_are_told() -> None:
    """By number, distance and length, with what to use instead; one warning for all."""
    (message,) = told(platform(115.0, 115.0, 115.0))
    assert "every line is slack" in message and "nothing holds the platform" in message
    assert "line 1: 109.8 m to its anchor, 115 m unstretched" in message and "line 3:" in message
    assert "weightless springs" in message and "stiffness_matrix" in message and "preload" in message
    (message,) = told(platform(115.0, 105.0, 105.0))
    assert "one line is slack" in message and "line 2" not in message
    (message,) = told(platform(115.0, 115.0, 105.0))
    assert "2 of 3 lines are slack" in message


@pytest.mark.parametrize("length", [100.0, 109.0])
def test_lines_that_pull_are_not(length: float) -> None:
    assert not told(platform(length, length - 1, length - 1))


def test_a_pretension_of_zero_is_no_slack_line() -> None:
    data = platform()
    line = {"anchor": [60.1, 0.3, -100], "fairlead": [5, 0, -5], "stiffness": 4e4, "pretension": 0.0}
    data["mooring"] = {"kind": "linear_springs", "lines": [line]}
    assert not told(data)


def test_the_command_line_says_it_before_it_runs(tmp_path) -> None:
    file = tmp_path / "platform.yaml"
    file.write_text(yaml.safe_dump(platform(115.0, 115.0, 115.0)), encoding="utf-8")
    found = CliRunner().invoke(
        app, ["simulate", str(file), "--release", "surge=5", "--duration", "20", "--out", str(tmp_path / "o")]
    )
    assert found.exit_code == 0
    assert found.stderr.count("every line is slack") == 1
    assert found.stderr.startswith("jaxhydro: warning: shallow: mooring.lines")
