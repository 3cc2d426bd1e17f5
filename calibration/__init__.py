"""Fits a jaxhydro model to measurements: `load_campaign`, then `calibrate`, or `calibrate_in_waves`."""

from calibration.campaign import Campaign, load_campaign
from calibration.candidates import decay_information, effective_noise, expected_information, rank_tests
from calibration.classical import classical, equivalent_damping
from calibration.directions import Identifiability, identifiability_of
from calibration.fit import Interrupted, Progress, calibrate
from calibration.model_damping import drag_coefficient, model_damping, motion_shape
from calibration.result import Calibration, Estimate, Series, TestFit
from calibration.sea_fit import calibrate_in_waves

__all__ = [
    "Calibration", "Campaign", "Estimate", "Identifiability", "Interrupted", "Progress", "Series", "TestFit", "calibrate",
    "calibrate_in_waves", "classical", "decay_information", "drag_coefficient", "effective_noise", "equivalent_damping",
    "expected_information", "identifiability_of", "load_campaign", "model_damping", "motion_shape", "rank_tests",
]  # fmt: skip
