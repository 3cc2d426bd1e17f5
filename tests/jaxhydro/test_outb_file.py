"""OpenFAST's binary outputs, written here and read by openfast_io."""

from pathlib import Path

import numpy as np
import pytest

from jaxhydro.interop.data_files import read_table
from jaxhydro.interop.outb_file import write_outb


def test_channels_come_back_to_their_resolution(tmp_path: Path) -> None:
    """To half a step of the 16-bit integers, or float32's: of a still channel, one far from zero, and a tiny one."""
    pytest.importorskip("openfast_io")
    time = 100.0 + 0.25 * np.arange(4000)
    wave = np.sin(time)
    values = np.stack([np.full_like(time, 3.7), 1e4 + 1e-3 * wave, 1e-9 * wave, -5.0 + 12 * wave, 0 * wave], axis=1)
    names = ["Still", "Far", "Tiny", "Usual", "Zero"]
    write_outb(tmp_path / "a.outb", 100.0, 0.25, names, ["m"] * 5, values, "Größe")
    table = read_table(tmp_path / "a.outb")
    assert list(table.columns) == ["Time", *names] and table.attrs["stated"]["Far"] == "m"
    np.testing.assert_allclose(table["Time"], time, atol=1e-9)
    error = np.abs(table[names].to_numpy() - values).max(axis=0)
    resolution = np.maximum(np.ptp(values, axis=0) / 65535, np.abs(values).max(axis=0) * 2.0**-22)
    assert (error <= 0.51 * resolution).all()
    assert error[3] > 0.3 * 24 / 65535  # not finer than integers can be


def test_names_that_the_format_cannot_hold(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="found 'MuchTooLongName'"):
        write_outb(tmp_path / "a.outb", 0.0, 0.1, ["MuchTooLongName"], ["m"], np.zeros((2, 1)), "")
    with pytest.raises(ValueError, match="for each of 1 channels"):
        write_outb(tmp_path / "a.outb", 0.0, 0.1, ["A", "B"], ["m", "m"], np.zeros((2, 1)), "")
