"""Waves that a campaign's records have: as stated, and a hint where the records lack what theory binds."""

import dataclasses
import shutil
from pathlib import Path

import numpy as np
import pytest

from calibration import load_campaign
from calibration.campaign.manifest_sections import Recording
from calibration.campaign.runs import Run
from calibration.campaign.second_order_hint import second_order_hint
from calibration.residuals.run_seas import sea_of, seas_of
from calibration.residuals.wave_options import Options, options_of
from jaxhydro.environment import Environment
from jaxhydro.errors import InputError
from jaxhydro.waves.irregular import spectrum_components
from jaxhydro.waves.irregular_sea import IrregularSea
from jaxhydro.waves.spectra import jonswap

COMPLETE = Path(__file__).resolve().parents[1] / "fixtures" / "golden" / "campaigns" / "complete"
WATER = Environment(1025.0, 200.0, 9.81)
BAND = (0.05, 0.2)  # Hz
ALL = ("sum", "difference")


def recorded(*kinds, scale: float = 1.0) -> tuple[Run, IrregularSea]:
    """A gauge's record of waves with these second-order kinds, and its sea with all of theory's."""
    time = np.arange(0.0, 900.0, 0.5)
    waves = spectrum_components(lambda w: jonswap(w, 5.0 * scale, 9.0), 900.0, WATER, low=BAND[0], cutoff=BAND[1], seed=3)
    wave = np.asarray(IrregularSea(waves, WATER, 2 if kinds else 1, kinds=kinds or ALL).gauge(time))
    records = (dataclasses.make_dataclass("Record", ["noise", "kind"])({"wave": 1e-3}, "irregular"),)
    run = Run("sea.csv", time, wave, (0.0, 0.0), 0.0, records, ())
    return run, sea_of(run, WATER, Options(low=BAND[0], cutoff=BAND[1])).sea


@pytest.mark.parametrize(
    ("kinds", "key"),
    [((), "records: {order: 1}"), (("difference",), "records: {kinds: [difference]}"), (("sum",), "records: {kinds: [sum]}")],
)
def test_what_records_lack_is_told(kinds, key):
    (hint,) = second_order_hint([recorded(*kinds)], BAND)
    assert key in hint and all((f" % at {kind}s" in hint) is (kind not in kinds) for kind in ALL)


def test_records_with_second_order_have_no_hint():
    assert second_order_hint([recorded(*ALL)], BAND) == ()


def test_what_noise_hides_is_not_told():
    """Of waves of 25 cm nothing of second order is above the gauge's noise."""
    assert second_order_hint([recorded(scale=0.05)], BAND) == ()


def test_most_records_decide():
    """One linear record among two with second order is not the campaign's."""
    whole = recorded(*ALL)
    assert second_order_hint([whole, recorded(), whole], BAND) == ()


def with_records(folder: Path, **stated):
    campaign = load_campaign(folder)
    return dataclasses.replace(campaign, manifest=campaign.manifest.model_copy(update={"records": Recording(**stated)}))


@pytest.mark.parametrize("stated", [{}, {"order": 1}, {"order": 2}, {"kinds": ["sum", "difference"]}])
def test_records_are_looked_at_where_nothing_is_stated(stated, monkeypatch):
    """The hint is with the first run's notes, and by itself."""
    looked = []
    monkeypatch.setattr(
        "calibration.residuals.run_seas.second_order_hint", lambda runs, band: looked.append(band) or ("a hint",)
    )
    campaign = with_records(COMPLETE, **stated)
    ((_, made),) = seas_of(campaign, campaign.model.environment, options_of(campaign))
    assert looked == ([] if stated else [(0.03, 0.3)]) and ("a hint" in made.notes) is not bool(stated)
    assert made.order_hint == ("" if stated else "a hint")


def test_seas_are_made_as_stated(tmp_path):
    """The highest difference frequency is in Hz on the files' time axis."""
    path = shutil.copytree(COMPLETE, tmp_path / "campaign") / "campaign.yaml"
    text = path.read_text()
    assert options_of(load_campaign(path)) == Options()
    stated = "records: {kinds: [difference], highest_difference: 0.5, acting: at the origin}\n"
    path.write_text(text.replace("scale: 1.0", "scale: 50.0") + stated + "wave_band: [0.2, 2.0]\n")
    options = options_of(load_campaign(path))
    assert (options.order, options.kinds, options.acting) == (2, ("difference",), "at the origin")
    assert (options.low, options.cutoff, options.highest_difference) == pytest.approx(np.array([0.2, 2.0, 0.5]) / 50**0.5)
    path.write_text(text + "records: {order: 1}\n")
    assert options_of(load_campaign(path)) == Options(order=1)


@pytest.mark.parametrize(
    ("stated", "pattern"),
    [
        ("{order: 3}", r"records.order: expected .*1.*2.*, found 3"),
        ("{kinds: [sums]}", r"records.kinds\[0\]: expected .*sum.*difference.*, found .*sums"),
        ("{kinds: []}", r"records.kinds: expected .*1"),
        ("{highest_difference: 0}", r"records.highest_difference: expected a number > 0, found 0"),
        ("{acting: at origin}", r"records.acting: expected .*at the origin.*, found .*at origin"),
        ("{order: 1, acting: nowhere}", r"records.acting: expected nothing, since linear waves bind none, found 'nowhere'"),
        ("{order: 1, kinds: [sum]}", r"records.kinds: expected nothing, since linear waves bind none"),
    ],
)
def test_what_waves_cannot_have_is_refused(stated, pattern, tmp_path):
    path = shutil.copytree(COMPLETE, tmp_path / "campaign") / "campaign.yaml"
    path.write_text(path.read_text() + f"records: {stated}\n")
    with pytest.raises(InputError, match=pattern):
        load_campaign(path)
