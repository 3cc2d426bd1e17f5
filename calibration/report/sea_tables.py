"""Tables of tests in waves: seas, motions, energy in bands."""

import math

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest_sections import IN_WAVES
from calibration.formatting import number, percent
from calibration.results.comparison_file import ComparisonFile, Pair
from calibration.vocabulary import Rows

MOMENTS = ("mean", "standard_deviation")
BAND_NAMES = {"low_frequency": "low", "wave_frequency": "wave"}


def counted(campaign: Campaign) -> str:
    """How many tests there are to be simulated, and how many others."""
    waves = sum(test.kind in IN_WAVES and test.use != "ignore" for test in campaign.manifest.tests)
    others = len(campaign.manifest.tests) - waves
    return f"{waves} {'test' if waves == 1 else 'tests'} in waves" + (f"; left aside: {others}" if others else "")


def seas_table(saved: ComparisonFile) -> Rows:
    """Height of every sea as stated, measured and simulated at the gauge."""
    rows = []
    for id, test in saved.tests.items():
        heights = test.significant_wave_height or test.wave_height
        both = [number(x, 3) for x in (heights.measured, heights.simulated)] if heights else ["–", "–"]
        stated, period = number(test.stated_height, 3), number(test.peak_period, 3)
        rows.append((id, test.kind, saved.error[id].use, stated, *both, period))
    return ("Test", "Waves", "Use", "Height stated (m)", "Measured (m)", "Simulated (m)", "Period (s)"), rows


def motions_table(saved: ComparisonFile) -> Rows:
    """Mean, standard deviation and RMSE of the motions that matter."""
    rows = []
    for id, test in saved.tests.items():
        for name, error in saved.error[id].channels.items():
            statistics = test.statistics[name]
            if statistics.moving:
                means, deviations = (
                    [number(getattr(x, key), 3) for x in (statistics.measured, statistics.simulated)] for key in MOMENTS
                )
                rows.append((id, f"{name} ({statistics.unit})", *means, *deviations, percent(error.relative)))
    heads = ("Test", "Motion", "Mean measured", "Mean simulated", "SD measured", "SD simulated", "RMSE / SD")
    return heads, rows


def bands_table(saved: ComparisonFile) -> Rows:
    """Band integrals per sea state and motion; of regular waves amplitudes."""
    rows = []
    for id, test in saved.tests.items():
        units = {name: statistics.unit for name, statistics in test.statistics.items() if statistics.moving}
        for name, unit in units.items():
            if name in test.amplitude:
                rows.append((id, f"{name} ({unit})", "amplitude", *_cells(test.amplitude[name])))
            for key, pair in test.bands.get(name, {}).items():
                limits = f"{BAND_NAMES[key]}, {pair.band[0]:g}-{pair.band[1]:g} Hz"
                rows.append((id, f"{name} ({unit}²)", limits, *_cells(pair)))
    return ("Test", "Channel", "Band", "Measured", "Simulated", "Error"), rows


def _cells(pair: Pair) -> tuple[str, str, str]:
    off = 100 * (pair.simulated / pair.measured - 1) if pair.measured > 0 else math.nan
    error = f"{round(off) or 0:+d} %" if math.isfinite(off) else "–"
    return number(pair.measured, 3), number(pair.simulated, 3), error
