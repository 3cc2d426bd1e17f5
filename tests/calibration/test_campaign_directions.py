"""Campaigns whose tests state short-crested seas or several wave systems beside the record of one gauge."""

import math

import jax.numpy as jnp
import numpy as np
import pytest
from fake_sweep import PLATFORM
from numpy.testing import assert_allclose
from test_seas import document, plain, write

import jaxhydro as jh
from calibration.campaign.load_campaign import load_campaign
from calibration.campaign.stated_sea import Sea
from calibration.campaign.wave_directions import stated_directions
from calibration.fitting.sea_fit import calibrate_in_waves
from calibration.residuals.measured_seas import compare
from calibration.residuals.run_seas import seas_of
from calibration.residuals.wave_options import Options
from jaxhydro.errors import InputError
from jaxhydro.input_schema import validate
from jaxhydro.waves.recorded_waves import record_components
from jaxhydro.waves.spreading import circular_moments

WATER = jh.Environment(1025.0, 60.0, 9.81)
WIND_SEA = {"hs": 0.5, "tp": 6.0, "heading": -40.0, "spreading": 9.0}
SWELL = {"hs": 0.5, "tp": 14.0, "heading": 30.0}


def sea(**stated) -> Sea:
    return validate(Sea, stated, "sea")


def waves():
    """First-order waves of a record of two systems, seen by a gauge at (-30, 10) m."""
    times = np.arange(0.0, 2000.0, 0.5)
    rng = np.random.default_rng(5)
    f = rng.uniform(0.05, 0.25, 200)
    record = (np.cos(2 * np.pi * f * times[:, None] + rng.uniform(0, 7, 200)) * 0.1).sum(axis=1)
    return record_components(times, record, WATER, position=(-30.0, 10.0), low=0.03, cutoff=0.3, order=1), times


def test_the_record_stays_at_the_gauge_and_directions_are_those_stated() -> None:
    """The elevation at the gauge is unchanged to rounding; mean and width of the directions are those of the law."""
    recorded, times = waves()
    stated = stated_directions(sea(heading=20.0, spreading=9.0), 1.0)
    assert stated is not None
    turned = stated.turned(recorded, (-30.0, 10.0))
    before, after = (jh.IrregularSea(components, WATER, 1).gauge(times, (-30.0, 10.0)) for components in (recorded, turned))
    assert_allclose(after, before, atol=1e-9)
    whole = np.linspace(0.0, float(recorded.period), 4096, endpoint=False)
    away = jh.IrregularSea(turned, WATER, 1).gauge(whole, (200.0, 0.0))
    assert np.var(away) == pytest.approx(0.5 * (np.asarray(recorded.amplitude) ** 2).sum(), rel=1e-9)
    moments = circular_moments(np.asarray(turned.heading), np.ones(turned.omega.size))
    assert moments.mean == pytest.approx(math.radians(20.0), abs=0.02)
    assert moments.width == pytest.approx(math.sqrt(2 / 10), rel=0.03)


def test_systems_share_the_waves_by_their_spectra_at_full_scale() -> None:
    """At 1:100 in the file. Long waves are the swell's, short ones the wind sea's."""
    recorded, _ = waves()
    small = [{**system, "hs": system["hs"] / 100, "tp": system["tp"] / 10} for system in (WIND_SEA, SWELL)]
    stated, full = stated_directions(sea(systems=small), 100.0), stated_directions(sea(systems=[WIND_SEA, SWELL]), 1.0)
    assert stated is not None and full is not None
    headings = stated.headings(recorded)
    assert_allclose(headings, full.headings(recorded), atol=1e-9)
    f = np.asarray(recorded.omega) / (2 * np.pi)
    assert_allclose(np.degrees(headings[(f > 0.055) & (f < 0.08)]), 30.0, atol=1e-6)
    short = f > 0.16
    wind, swell = (np.asarray(jh.jonswap(recorded.omega[short], system["hs"], system["tp"])) for system in (WIND_SEA, SWELL))
    share = swell / (wind + swell)
    assert np.degrees(headings[short]).mean() == pytest.approx((30.0 * share - 40.0 * (1 - share)).mean(), abs=3.0)


def test_what_does_not_go_together_is_told() -> None:
    with pytest.raises(InputError, match="heading: expected nothing, since systems have their own, found 10"):
        sea(heading=10, systems=[SWELL])
    with pytest.raises(InputError, match=r"systems\[0\]\.tp"):
        sea(systems=[{"hs": 1.0}])
    assert stated_directions(sea(systems=[SWELL]), 1.0) is None and sea(systems=[SWELL]).mean_heading == 30.0


def of_short_crested(folder, **records):
    tests = document()["tests"]
    tests = [tests[0], {**tests[1], "sea": {"spreading": 6.0}}]
    return write(folder, text=PLATFORM, sea=plain(), tests=tests, **records)


@pytest.mark.slow
def test_a_short_crested_campaign_is_compared_and_not_fitted(tmp_path) -> None:
    """Simulated by direct summation, with a note; a fit and second order are refused."""
    with pytest.raises(InputError, match=r"tests\[1\]\.sea: expected records: \{order: 1\} with waves of several headings"):
        load_campaign(of_short_crested(tmp_path))
    campaign = load_campaign(of_short_crested(tmp_path, records={"order": 1}))
    with pytest.raises(InputError, match="can be simulated and compared, not fitted"):
        calibrate_in_waves(campaign)
    options = Options(order=1, low=0.05, cutoff=0.2)
    with pytest.raises(InputError, match="1 in a sea of several headings"):
        seas_of(campaign, campaign.model.environment, Options(order=2), several_headings=True)
    comparison = compare(campaign, campaign.model, options)
    (test,), ((_, sea),) = comparison.tests, comparison.seas
    assert not sea.sea.long_crested and any("drawn from what its test states (seed 0)" in note for note in comparison.notes)
    surge = next(series for series in test.fit.series if series.channel == "surge")
    assert np.isfinite(surge.simulated).all() and np.std(surge.simulated) > 1e-3
    assert float(jnp.std(sea.sea.components.heading)) > 0.2
