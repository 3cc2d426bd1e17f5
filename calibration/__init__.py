"""Fits a jaxhydro model to measurements: `load_campaign`, then `calibrate`."""

from calibration.campaign import Campaign, load_campaign
from calibration.fit import Interrupted, Progress, calibrate
from calibration.result import Calibration, Estimate, Series, TestFit

__all__ = ["Calibration", "Campaign", "Estimate", "Interrupted", "Progress", "Series", "TestFit", "calibrate", "load_campaign"]
