"""Fits a jaxhydro model to measurements: `load_campaign`, then `calibrate`, or `calibrate_in_waves`."""

from calibration.campaign import Campaign, load_campaign
from calibration.fit import Interrupted, Progress, calibrate
from calibration.result import Calibration, Estimate, Series, TestFit
from calibration.sea_fit import calibrate_in_waves

__all__ = [
    "Calibration", "Campaign", "Estimate", "Interrupted", "Progress", "Series", "TestFit", "calibrate", "calibrate_in_waves",
    "load_campaign",
]  # fmt: skip
