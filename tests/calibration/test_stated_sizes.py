"""Plausible sizes in campaign.yaml: what is kept, and mistakes."""

import json

import pytest

from calibration.campaign.manifest import Manifest, read_manifest
from jaxhydro.errors import InputError


def manifest(folder, **plausible):
    channels = {"time": {"column": "t", "unit": "s"}, "surge": {"column": "x", "unit": "m"}}
    tests = [{"id": "a", "kind": "decay", "degree_of_freedom": "surge", "file": "a.csv"}]
    data = {"name": "n", "platform": "volturnus-s", "channels": channels, "tests": tests, "plausible": plausible}
    (folder / "campaign.yaml").write_text(json.dumps(data).replace("Infinity", ".inf").replace("NaN", ".nan"))
    (folder / "a.csv").write_text("t,x\n0,1\n1,2\n")
    return read_manifest(folder)[0]


def test_a_manifest_keeps_what_it_states(tmp_path):
    stated = {
        "mass": "2 %",
        "clock": "0.2 s",
        "umbilical.pull": 5e3,
        "inertia": "1e9 kg m²",
        "wave_drift.surge.envelope": "0.1 MN/m2",
    }
    read = manifest(tmp_path, **stated)
    assert read.plausible == stated
    assert Manifest.model_validate(read.model_dump(mode="json", exclude_unset=True)) == read


def test_as_it_is_written_by_hand(tmp_path):
    """Without quotes, in YAML."""
    manifest(tmp_path)
    path = tmp_path / "campaign.yaml"
    written = "{mass: 2 %, inertia: 5%, wave_gauge: 2 m, coulomb_friction: 50 kN, wave_drift.surge.envelope: 100 kN/m^2}"
    path.write_text(path.read_text().replace('"plausible": {}', f'"plausible": {written}'))
    assert list(read_manifest(path)[0].plausible.values()) == ["2 %", "5%", "2 m", "50 kN", "100 kN/m^2"]


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("mass", "-2 %", r"plausible.mass: expected a quantity greater than 0 with its unit, .*found '-2 %'"),
        ("mass", "0 %", "expected a quantity greater than 0"),
        ("mass", "nan %", "expected a quantity greater than 0 .*found 'nan %'"),
        ("mass", "1e999 %", "expected a quantity greater than 0"),
        ("mass", "two per cent", "expected a quantity greater than 0"),
        ("mass", True, "expected a quantity greater than 0 .*found true"),
        ("mass", [1, 2], "expected a quantity greater than 0"),
        ("umbilical.pull", float("nan"), "expected a quantity greater than 0"),
        ("umbilical.pull", float("inf"), "expected a quantity greater than 0"),
        ("umbilical.pull", -1.0, "expected a quantity greater than 0"),
        ("mass", "2 m", "plausible.mass: expected a quantity in kg or %, found '2 m'"),
        ("mass", 2.0, "plausible.mass: expected a quantity in kg or %, found 2.0"),
        ("clock", "2 %", "plausible.clock: expected a quantity in s, found '2 %'"),
        ("coulomb_friction", "50 kNn", r"plausible.coulomb_friction: expected a unit of .*found '50 kNn'. Did you mean 'kN'\?"),
        ("coulomb_friction", "50 kn", r"Did you mean 'kN'\?"),
        ("masss", "2 %", r"plausible.masss: expected a size \(mass, .*found 'masss'. Did you mean 'mass'\?"),
        ("wave_drft.surge.envelope", 1.0, r"Did you mean 'wave_drift.surge.envelope'\?"),
        ("sensor_lags", "2 s", r"Did you mean 'sensor_lag'\?"),
        ("sensor_lag", 2.0, "plausible.sensor_lag: expected a quantity greater than 0 with its unit.* found 2.0"),
    ],
)
def test_mistakes_in_a_manifest(tmp_path, key, value, message):
    with pytest.raises(InputError, match=message) as caught:
        manifest(tmp_path, **{key: value})
    assert len(caught.value.problems) == 1 and caught.value.source == str(tmp_path / "campaign.yaml")
