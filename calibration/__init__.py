"""Fits a jaxhydro model to measurements: `load_campaign`, then `calibrate`, `calibrate_in_waves`, or `search` first; and
finds what the model lacks: `diagnose`."""

from calibration.bootstrap import Bootstrap, bootstrap_blocks, bootstrap_repeats
from calibration.campaign import Campaign, load_campaign
from calibration.candidates import decay_information, effective_noise, expected_information, rank_tests
from calibration.classical import classical, equivalent_damping
from calibration.directions import Identifiability
from calibration.discovery.candidates import Candidate
from calibration.discovery.diagnose import diagnose
from calibration.discovery.result import Diagnosis
from calibration.fit import Interrupted, Progress, calibrate
from calibration.fit_uncertainty import identifiability_of
from calibration.joint import calibrate_jointly
from calibration.likelihood import Likelihood, likelihood
from calibration.model_damping import drag_coefficient, model_damping, motion_shape
from calibration.profile import Profile, profile
from calibration.result import Calibration, Estimate, Series, TestFit
from calibration.sampling import Samples, sample
from calibration.sea_fit import calibrate_in_waves
from calibration.sea_laws import SeaLaws, choose_law
from calibration.search import Found, SearchInterrupted, search
from calibration.searches import Budget

__all__ = [
    "Bootstrap", "Budget", "Calibration", "Campaign", "Candidate", "Diagnosis", "Estimate", "Found",
    "Identifiability", "Interrupted", "Likelihood", "Profile", "Progress", "Samples", "SeaLaws",
    "SearchInterrupted", "Series", "TestFit", "bootstrap_blocks", "bootstrap_repeats", "calibrate",
    "calibrate_in_waves", "calibrate_jointly", "choose_law", "classical", "decay_information", "diagnose",
    "drag_coefficient", "effective_noise", "equivalent_damping", "expected_information", "identifiability_of",
    "likelihood", "load_campaign", "model_damping", "motion_shape", "profile", "rank_tests", "sample", "search",
]  # fmt: skip
