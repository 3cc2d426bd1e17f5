"""The band of a campaign's first-order waves: stated, or by the size of the hull."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

from calibration import load_campaign
from calibration.campaign.manifest import Manifest, read_manifest
from calibration.campaign.wave_band import wave_band
from calibration.residuals.wave_options import options_of
from jaxhydro.errors import InputError


def manifest(**changes) -> Manifest:
    channels = {"time": {"column": "t", "unit": "s"}, "surge": {"column": "x", "unit": "m"}}
    tests = [{"id": "a", "kind": "decay", "degree_of_freedom": "surge", "file": "a.csv"}]
    return Manifest.model_validate({"name": "n", "platform": "volturnus-s", "channels": channels, "tests": tests, **changes})


def waves(frequency: float) -> SimpleNamespace:
    """A record of regular waves (Hz)."""
    time = np.arange(0.0, 200.0 / frequency, 0.05 / frequency)
    return SimpleNamespace(kind="regular", use="fit", time=time, wave=np.sin(2 * np.pi * frequency * time))


def test_by_the_records_and_the_size_of_the_hull() -> None:
    """0.03 to 0.3 Hz for waves of an ocean, a small buoy's, too; ten times that for waves of a flume and a hull in it."""
    for pace in (1.0, 0.1, 0.5):
        assert wave_band(manifest(), SimpleNamespace(pace=pace), [waves(0.12)]) == (0.03, 0.3)
    assert wave_band(manifest(), SimpleNamespace(pace=0.1), [waves(1.2)]) == (0.3, 3.0)
    assert wave_band(manifest(), SimpleNamespace(pace=0.1), [waves(50.0)]) == (0.3, 3.0)  # such a hull feels no such waves


def test_as_stated() -> None:
    """In Hz on the files' time axis, 50 times as long a hull having the root of 50 slower waves."""
    low, cutoff = wave_band(manifest(scale=50.0, wave_band=[0.25, 2.5]), SimpleNamespace(pace=1.0), ())
    assert (low, cutoff) == pytest.approx((0.25 / 50**0.5, 2.5 / 50**0.5))


def test_of_a_campaign(tmp_path) -> None:
    document = manifest(wave_band=[0.05, 0.2]).model_dump(mode="json", exclude_unset=True)
    (tmp_path / "campaign.yaml").write_text(json.dumps(document))
    (tmp_path / "a.csv").write_text("t,x\n" + "\n".join(f"{0.5 * i},{8 * 0.999**i * (-1) ** (i // 130)}" for i in range(900)))
    options = options_of(load_campaign(tmp_path))
    assert (options.low, options.cutoff) == (0.05, 0.2)
    (tmp_path / "campaign.yaml").write_text(json.dumps({**document, "wave_band": [0.2, 0.05]}))
    with pytest.raises(InputError, match="wave_band: expected two numbers, the first less than the second"):
        read_manifest(tmp_path)
