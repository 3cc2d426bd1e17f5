"""Tables of tests in waves: seas, motions, energy in bands."""

import math

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest import IN_WAVES
from calibration.campaign.signals import wave_height
from calibration.formatting import number, percent
from calibration.residuals.measured_seas import Comparison
from calibration.residuals.sea_errors import amplitude, channels, in_bands, moving
from calibration.vocabulary import Rows
from jaxhydro.units import unit_of

BAND_NAMES = {"low_frequency": "low", "wave_frequency": "wave"}


def counted(campaign: Campaign) -> str:
    """How many tests there are to be simulated, and how many others."""
    waves = sum(test.kind in IN_WAVES and test.use != "ignore" for test in campaign.manifest.tests)
    others = len(campaign.manifest.tests) - waves
    return f"{waves} {'test' if waves == 1 else 'tests'} in waves" + (f"; left aside: {others}" if others else "")


def seas_table(found: Comparison) -> Rows:
    """Height of every sea as stated, measured and simulated at the gauge."""
    rows = []
    for test in found.tests:
        irregular = test.fit.kind == "irregular"
        heights = [number(wave_height(x, irregular), 3) for x in (test.wave, test.simulated_wave)]
        stated = number(test.stated_height, 3)
        rows.append((test.fit.id, test.fit.kind, test.fit.use, stated, *heights, number(test.peak_period, 3)))
    return ("Test", "Waves", "Use", "Height stated (m)", "Measured (m)", "Simulated (m)", "Period (s)"), rows


def motions_table(found: Comparison) -> Rows:
    """Mean, standard deviation and RMSE of the motions that matter."""
    rows = []
    for test in found.tests:
        both, relative = channels(test), {s.channel: s.relative for s in test.fit.series}
        for name in moving(test):
            cells = [number(float(f(x)), 3) for f in (np.mean, np.std) for x in both[name]]
            rows.append((test.fit.id, f"{name} ({unit_of(name)})", *cells, percent(relative[name])))
    heads = ("Test", "Motion", "Mean measured", "Mean simulated", "SD measured", "SD simulated", "RMSE / SD")
    return heads, rows


def bands_table(found: Comparison) -> Rows:
    """Band integrals per sea state and motion; of regular waves amplitudes."""
    rows = []
    for test in found.tests:
        if test.fit.kind == "regular":
            for name, pair in channels(test).items():
                if name == "wave" or name in moving(test):
                    a, b = (amplitude(test, x) for x in pair)
                    rows.append((test.fit.id, f"{name} ({unit_of(name)})", "amplitude", *_cells(a, b)))
            continue
        for name, row in in_bands(test).items():
            if name == "wave" or name in moving(test):
                for key, band in row.items():
                    limits = f"{BAND_NAMES[key]}, {band.low:g}-{band.high:g} Hz"
                    rows.append((test.fit.id, f"{name} ({unit_of(name)}²)", limits, *_cells(band.measured, band.simulated)))
    return ("Test", "Channel", "Band", "Measured", "Simulated", "Error"), rows


def _cells(measured: float, simulated: float) -> tuple[str, str, str]:
    off = 100 * (simulated / measured - 1) if measured > 0 else math.nan
    return number(measured, 3), number(simulated, 3), f"{round(off) or 0:+d} %" if math.isfinite(off) else "–"
