"""Units and scales that a record itself tells, held against what the manifest or the command line states."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from calibration.campaign.load_campaign import load_campaign
from jaxhydro.cli import sea_options
from jaxhydro.dynamics.requested_sea import RequestedSea
from jaxhydro.errors import InputError
from jaxhydro.interop.data_files import read_table
from jaxhydro.interop.stated_units import stated_unit

T = np.arange(0.0, 300.0, 0.1)


@pytest.mark.parametrize(
    ("column", "unit"),
    [
        ("Roll [rad]", "rad"),
        ("eta (mm)", "mm"),
        ("Time[s]", "s"),
        ("surge_m", "m"),
        ("pitch in deg", "deg"),
        ("Pitch, degrees", "deg"),
        ("t / ms", "ms"),
        ("Heave [Metres]", "m"),
        ("roll (°)", "deg"),
        ("PtfmSurge", None),
        ("x_t", None),
        ("F [kN]", None),
        ("surge_x", None),
        ("wave_1", None),
        ("v (m/s)", None),
        ("PtfmPitch_deg", "deg"),
        ("eta {cm}", "cm"),
        ("heave_ft", "ft"),
    ],
)
def test_the_unit_in_a_name(column, unit):
    assert stated_unit(column, {}) == unit
    assert stated_unit(column, {column: "(mm)"}) == "mm"


def test_units_of_a_row_and_of_netcdf(tmp_path):
    (tmp_path / "a.csv").write_text("t,roll\n(s),(rad)\n0,1\n1,2\n")
    assert read_table(tmp_path / "a.csv").attrs["stated"] == {"t": "s", "roll": "rad"}
    xr.Dataset({"x": ("t", T, {"units": "mm"})}, {"t": T}).to_netcdf(tmp_path / "a.nc")
    assert read_table(tmp_path / "a.nc").attrs["stated"] == {"x": "mm"}


def campaign(folder: Path, column: str, unit: str, size: float, scale: float = 1.0, period: float = 2.0) -> list[str]:
    """Findings on a roll decay of a body with a period of 2 s at full scale."""
    (folder / "platform.yaml").write_text("""
name: a body
water: {density: 1000.0, depth: 5.0}
rigid_body: {mass: 900.0, centre_of_mass: [0, 0, 0], inertia: {Ixx: 15.0, Iyy: 300.0, Izz: 300.0}}
added_mass: {A44: 5.0}
linear_damping: {B44: 1.0}
stiffness: {C44: 197.4}
members: []
mooring: {kind: none}
hydrostatics: {displaced_volume: 0.9, C33: 2.0e4}
""")
    t = T * period / 10
    roll = size * np.exp(-0.02 * np.pi * t / period) * np.cos(2 * np.pi * t / period)
    roll += 1e-3 * size * np.random.default_rng(1).normal(size=len(t))
    rows = "\n".join(f"{a:.6f},{b:.8f}" for a, b in zip(t, roll))
    (folder / "d.csv").write_text(f"time,{column}\n{rows}\n")
    channels = {"time": {"column": 0, "unit": "s"}, "roll": {"column": 1, "unit": unit}}
    test = {"id": "d", "kind": "decay", "degree_of_freedom": "roll", "file": "d.csv"}
    manifest = {"name": "d", "platform": "platform.yaml", "scale": scale, "channels": channels, "tests": [test]}
    (folder / "campaign.yaml").write_text(json.dumps(manifest))
    return [finding.message for finding in load_campaign(folder).findings]


@pytest.mark.parametrize(
    ("column", "unit", "size", "words"),
    [
        ("Roll [deg]", "deg", 5.0, []),
        ("Roll", "deg", 5.0, []),
        ("Roll [rad]", "rad", 0.1, []),
        ("Roll [rad]", "deg", 0.09, ["the file states rad for column 1, and the manifest deg", "moves by 0.08"]),
        ("Roll", "deg", 0.09, ["moves by 0.08"]),
        ("Roll [deg]", "rad", 0.5, ["the file states deg for column 1, and the manifest rad"]),
    ],
)
def test_a_file_that_states_another_unit(tmp_path, column, unit, size, words):
    warnings = campaign(tmp_path, column, unit, size)
    assert len(warnings) == len(words) and all(message.startswith(word) for message, word in zip(warnings, words))


@pytest.mark.parametrize(
    ("scale", "period", "words"),
    [
        (4.0, 1.0, None),
        (4.0, 2.0, "longer by the square root of `scale`, 2. If records and platform file are at one scale"),
        (4.0, 0.5, "shorter by the square root of `scale`, 2. Were times scaled down before?"),
        (1.0, 0.25, "a `scale` of about 64"),
        (1.0, 2.0, None),
        (1.0, 1.7, None),
    ],
)
def test_a_period_that_is_the_root_of_the_scale_away(tmp_path, scale, period, words):
    warnings = campaign(tmp_path, "Roll", "deg", 5.0, scale, period)
    assert [words in message for message in warnings] == ([True] if words else [])


def record(elevation: np.ndarray, name: str = "wave", stated: dict[str, str] | None = None, **given: str) -> RequestedSea:
    table = pd.DataFrame({"time_s": T, name: elevation})
    table.attrs["stated"] = stated or {}
    options = {"--wave": "tank.csv", "--wave-column": name, **{f"--wave-{key}": value for key, value in given.items()}}
    sea = sea_options.asked(options, 0.0)
    assert sea is not None
    return sea_options.with_record(sea, Path("tank.csv"), table, options)


def test_a_wave_record_has_a_unit_and_waves_that_can_stand():
    wave = 1.5 * np.cos(2 * np.pi * T / 9)
    metres = record(wave).record
    millimetres = record(1e3 * wave, unit="mm", stated={"wave": "mm"}).record
    assert metres is not None and millimetres is not None
    np.testing.assert_allclose(millimetres.elevation, metres.elevation)
    with pytest.raises(InputError, match=r"waves less than 1/7 as high as long, .* found waves 4\.24e\+03 m high"):
        record(1e3 * wave)
    with pytest.raises(InputError, match="expected a unit of m, found mm, as the file states"):
        record(1e3 * wave, stated={"wave": "mm"})
    with pytest.raises(Exception, match="one of m, cm, mm, ft expected, found inch"):
        record(wave, unit="inch")
