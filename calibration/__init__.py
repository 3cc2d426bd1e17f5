"""Calibration of a model to measurements, and diagnosis of what the model lacks.

Load a campaign with `load_campaign`. Fit it with `calibrate` or `calibrate_in_waves`; `search` finds a starting point first.
`diagnose` finds effects that the model lacks.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

import jaxhydro as _jaxhydro  # noqa: F401  # sets JAX up

if TYPE_CHECKING:
    from calibration.campaign.load_campaign import Campaign, load_campaign
    from calibration.decay_analysis.linear_quadratic import classical, equivalent_damping
    from calibration.decay_analysis.model_damping import drag_coefficient, model_damping, motion_shape
    from calibration.discovery.diagnose import diagnose
    from calibration.discovery.diagnosis import Diagnosis
    from calibration.discovery.effects.candidates import Candidate
    from calibration.fitting.decay_calibration import calibrate
    from calibration.fitting.fit_conclusion import identifiability_of
    from calibration.fitting.joint_fit import calibrate_jointly
    from calibration.fitting.law_choice import SeaLaws, choose_law
    from calibration.fitting.progress import Interrupted, Progress
    from calibration.fitting.sea_fit import calibrate_in_waves
    from calibration.global_search.run_search import Found, SearchInterrupted, search
    from calibration.global_search.task import Budget
    from calibration.identifiability.findings import Identifiability
    from calibration.result import Calibration, Estimate, Series, TestFit
    from calibration.uncertainty.bootstrap import bootstrap_blocks, bootstrap_repeats
    from calibration.uncertainty.bootstrap_draws import Bootstrap
    from calibration.uncertainty.further_tests import decay_information, effective_noise, expected_information, rank_tests
    from calibration.uncertainty.likelihood import Likelihood
    from calibration.uncertainty.likelihood_of_fit import likelihood
    from calibration.uncertainty.nuts import sample
    from calibration.uncertainty.posterior_samples import Samples
    from calibration.uncertainty.profile import Profile, profile

__all__ = [
    "Bootstrap",
    "Budget",
    "Calibration",
    "Campaign",
    "Candidate",
    "Diagnosis",
    "Estimate",
    "Found",
    "Identifiability",
    "Interrupted",
    "Likelihood",
    "Profile",
    "Progress",
    "Samples",
    "SeaLaws",
    "SearchInterrupted",
    "Series",
    "TestFit",
    "bootstrap_blocks",
    "bootstrap_repeats",
    "calibrate",
    "calibrate_in_waves",
    "calibrate_jointly",
    "choose_law",
    "classical",
    "decay_information",
    "diagnose",
    "drag_coefficient",
    "effective_noise",
    "equivalent_damping",
    "expected_information",
    "identifiability_of",
    "likelihood",
    "load_campaign",
    "model_damping",
    "motion_shape",
    "profile",
    "rank_tests",
    "sample",
    "search",
]

_NAMES = {  # of each module: imported when they are asked for, so that a command imports what it needs
    "calibration.campaign.load_campaign": ("Campaign", "load_campaign"),
    "calibration.decay_analysis.linear_quadratic": ("classical", "equivalent_damping"),
    "calibration.decay_analysis.model_damping": ("drag_coefficient", "model_damping", "motion_shape"),
    "calibration.discovery.diagnose": ("diagnose",),
    "calibration.discovery.diagnosis": ("Diagnosis",),
    "calibration.discovery.effects.candidates": ("Candidate",),
    "calibration.fitting.decay_calibration": ("calibrate",),
    "calibration.fitting.fit_conclusion": ("identifiability_of",),
    "calibration.fitting.joint_fit": ("calibrate_jointly",),
    "calibration.fitting.law_choice": ("SeaLaws", "choose_law"),
    "calibration.fitting.progress": ("Interrupted", "Progress"),
    "calibration.fitting.sea_fit": ("calibrate_in_waves",),
    "calibration.global_search.run_search": ("Found", "SearchInterrupted", "search"),
    "calibration.global_search.task": ("Budget",),
    "calibration.identifiability.findings": ("Identifiability",),
    "calibration.result": ("Calibration", "Estimate", "Series", "TestFit"),
    "calibration.uncertainty.bootstrap": ("bootstrap_blocks", "bootstrap_repeats"),
    "calibration.uncertainty.bootstrap_draws": ("Bootstrap",),
    "calibration.uncertainty.further_tests": ("decay_information", "effective_noise", "expected_information", "rank_tests"),
    "calibration.uncertainty.likelihood": ("Likelihood",),
    "calibration.uncertainty.likelihood_of_fit": ("likelihood",),
    "calibration.uncertainty.nuts": ("sample",),
    "calibration.uncertainty.posterior_samples": ("Samples",),
    "calibration.uncertainty.profile": ("Profile", "profile"),
}
_MODULES = {name: module for module, names in _NAMES.items() for name in names}


def __getattr__(name: str) -> Any:
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value = getattr(import_module(_MODULES[name]), name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
