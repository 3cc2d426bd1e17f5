"""Motions for other programs: motion.nc and motion.outb beside motion.csv."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from fake_simulation import SEA, hull, motion

from jaxhydro.cli.simulation_files import SeaState, write_motion
from jaxhydro.interop.data_files import read_table

MOTIONS = ["PtfmSurge", "PtfmSway", "PtfmHeave", "PtfmRoll", "PtfmPitch", "PtfmYaw"]


def written(folder: Path, *formats: str) -> pd.DataFrame:
    """A simulation's files; its motion.csv."""
    about = {"wave_height": 3.0, "heading": 30.0, "calibration": None}
    write_motion(motion(60.0), folder, "buoy", "jaxhydro 0.1.0", None, False, hull(), about, formats)
    return pd.read_csv(folder / "motion.csv")


def test_netcdf_after_the_cf_conventions(tmp_path: Path) -> None:
    table = written(tmp_path, "netcdf")
    with xr.open_dataset(tmp_path / "motion.nc", engine="h5netcdf", decode_timedelta=False) as data:
        for column in table.columns:
            np.testing.assert_allclose(data[column.split("_")[0]], table[column], rtol=1e-8, atol=1e-12)
        assert {name: data.attrs[name] for name in ("platform", "wave_height", "heading")} == {
            "platform": "buoy",
            "wave_height": 3.0,
            "heading": 30.0,
        }
        assert data.attrs["Conventions"] == "CF-1.8" and "calibration" not in data.attrs
        assert data["pitch"].attrs["standard_name"] == "platform_pitch" and data["pitch"].attrs["units"] == "degree"
        assert data["wave"].attrs["standard_name"] == "water_surface_height_above_reference_datum"
        assert "_FillValue" not in data["time"].encoding


def test_netcdf_has_the_sea(tmp_path: Path) -> None:
    moved = motion(60.0)
    assert moved.wave is not None
    results = {"window": [0.0, 59.5], "statistics": {}}
    state = SeaState(moved.wave, None, SEA, results)
    write_motion(moved, tmp_path, "buoy", "jaxhydro 0.1.0", state, False, formats=("netcdf",))
    with xr.open_dataset(tmp_path / "motion.nc", engine="h5netcdf", decode_timedelta=False) as data:
        assert {name: data.attrs[name] for name in SEA} == SEA


def test_openfast_binary(tmp_path: Path) -> None:
    """Half a step of the 16-bit integers."""
    pytest.importorskip("openfast_io")
    table = written(tmp_path, "outb")
    read = read_table(tmp_path / "motion.outb")
    assert list(read.columns) == ["Time", *MOTIONS, "Wave1Elev"]
    assert read.attrs["stated"] == {"Time": "s", **dict(zip(MOTIONS, 3 * ["m"] + 3 * ["deg"])), "Wave1Elev": "m"}
    step = np.ptp(table.to_numpy(), axis=0) / 65535
    assert (np.abs(read.to_numpy() - table.to_numpy()) <= 0.51 * step + 1e-8).all()


def test_a_simulation_without_them_takes_them_away(tmp_path: Path) -> None:
    written(tmp_path, "netcdf", "outb")
    assert {path.name for path in tmp_path.iterdir()} == {"motion.csv", "simulated.nc", "motion.nc", "motion.outb"}
    written(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"motion.csv", "simulated.nc"}
