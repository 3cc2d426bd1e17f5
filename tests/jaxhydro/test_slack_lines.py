"""Lines that are longer than the way to their anchors: no mooring, and a warning before anything runs."""

import copy
import math
import warnings
from typing import Any

import pytest
import yaml
from typer.testing import CliRunner

from calibration import load_campaign
from jaxhydro.cli.app import app
from jaxhydro.input_schema import validate
from jaxhydro.platform.build import build, load_model
from jaxhydro.platform.schema import Platform

ANCHORS = ([60, 0, -100], [-30, 52, -100], [-30, -52, -100])
FAIRLEADS = ([5, 0, -5], [-2.5, 4.33, -5], [-2.5, -4.33, -5])
DATA: dict[str, Any] = {
    "name": "shallow",
    "water": {"density": 1025.0, "depth": 100},
    "rigid_body": {
        "mass": 483019.87,
        "centre_of_mass": [0, 0, -4.2],
        "inertia": {"Ixx": 1.0e7, "Iyy": 1.0e7, "Izz": 5.0e6},
    },
    "members": [{"name": "m", "shape": "circ", "d": 10.0, "rA": [0, 0, -6], "rB": [0, 0, 6]}],
    "coefficients": {"m": {"Ca_t": 1.0, "Ca_z": 0.6, "Cd_t": 1.0, "Cd_z": 1.0}},
}


def platform(*lengths: float) -> dict[str, Any]:
    ends = zip(ANCHORS, FAIRLEADS, lengths)
    lines = [{"anchor": a, "fairlead": f, "axial_stiffness": 5e6, "unstretched_length": n} for a, f, n in ends]
    return copy.deepcopy(DATA) | {"mooring": {"kind": "linear_springs", "lines": lines}}


def told(data: dict[str, Any]) -> list[str]:
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # a model says it by its remarks alone
        model = build(validate(Platform, data, "shallow"))
    assert all(remark.warning for remark in model.remarks)
    return [remark.text for remark in model.remarks]


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


@pytest.mark.slow
def test_the_command_line_says_it_before_it_runs(tmp_path) -> None:
    file = tmp_path / "platform.yaml"
    file.write_text(yaml.safe_dump(platform(115.0, 115.0, 115.0)), encoding="utf-8")
    result = CliRunner().invoke(
        app, ["simulate", str(file), "--release", "surge=5", "--duration", "20", "--out", str(tmp_path / "o")]
    )
    assert result.exit_code == 0
    assert result.stderr.count("every line is slack") == 1
    assert result.stderr.startswith("jaxhydro: warning: mooring.lines: every line is slack")


def test_python_is_warned_where_a_file_is_loaded(tmp_path) -> None:
    """At the caller's line, of warnings only; once."""
    file = tmp_path / "platform.yaml"
    file.write_text(yaml.safe_dump(platform(115.0, 115.0, 115.0)), encoding="utf-8")
    with pytest.warns(UserWarning, match="every line is slack") as caught:
        load_model(file)
    assert len(caught) == 1 and caught[0].filename == __file__
    file.write_text(yaml.safe_dump(platform(100.0, 100.0, 100.0)), encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        load_model(file)


@pytest.mark.slow
def test_a_campaign_finds_it(tmp_path) -> None:
    """With the other warnings on its platform file."""
    (tmp_path / "platform.yaml").write_text(yaml.safe_dump(platform(115.0, 105.0, 105.0)), encoding="utf-8")
    rows = "\n".join(f"{0.5 * i},{0.2 * math.cos(0.6 * i) * math.exp(-0.02 * i)}" for i in range(240))
    (tmp_path / "heave.csv").write_text(f"t,heave\n{rows}\n", encoding="utf-8")
    manifest = {
        "name": "tank",
        "platform": "platform.yaml",
        "channels": {"time": {"column": "t", "unit": "s"}, "heave": {"column": "heave", "unit": "m"}},
        "tests": [{"id": "one", "kind": "decay", "degree_of_freedom": "heave", "file": "heave.csv"}],
    }
    (tmp_path / "campaign.yaml").write_text(yaml.safe_dump(manifest), encoding="utf-8")
    slack_findings = [finding for finding in load_campaign(tmp_path).findings if "slack" in finding.message]
    assert (
        len(slack_findings) == 1
        and slack_findings[0].place == "platform.yaml"
        and slack_findings[0].message.startswith("mooring.lines: one line is")
    )
