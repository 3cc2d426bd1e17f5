"""Trial of strip conventions, for records that another program made."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.strip_conventions import DEFAULT_STRIPS, StripConventions
from calibration.discovery.acceptance import MIN_LIKELIHOOD_GAIN
from calibration.fitting.decay_fit import prepare_fit, run_fit
from calibration.fitting.decay_part import independent_observations
from calibration.fitting.fit import Fit
from jaxhydro.environment import DOFS
from jaxhydro.loads.strip_drag import StripDrag

SIMPLER_STRIPS = StripConventions(
    directions="earth", drag_speed="component", centripetal=False
)  # as simpler programs take them
SIMPLER_STRIPS_NOTE = (
    "decays are followed better with strips loaded along earth axes, drag by components of the speed and no centripetal "
    f"acceleration, as programs may have it ({SIMPLER_STRIPS} in a platform file): so are they taken here, and in what is found"
)


class StripTrial(NamedTuple):
    """Outcome of a trial of strip conventions.

    Attributes:
        campaign: The campaign, its model with the conventions that the decays prefer.
        fit: Calibration to the decays with them; None: no trial was needed.
        strips: The conventions, where not as the platform file says.
        notes: The reason, in words.
    """

    campaign: Campaign
    fit: Fit | None = None
    strips: StripConventions | None = None
    notes: tuple[str, ...] = ()


def try_strip_conventions(campaign: Campaign, say: Callable[[str, float], None]) -> StripTrial:
    """Choose the strip conventions that the decays prefer.

    The platform file's conventions stay where it states them, or has drag laws other than a constant coefficient.
    """
    decays = [record for record in campaign.used("fit") if record.kind == "decay"]
    model = campaign.model
    said = (
        bool(set(StripConventions.model_fields) & campaign.platform.model_fields_set)
        or StripConventions.of(model) != DEFAULT_STRIPS
    )
    other_drag = any(hasattr(load, "coupled") and not isinstance(load, StripDrag) for load in model.loads)
    if said or other_drag or campaign.platform.sea_state_laws is not None or not decays or not model.hull.strips.element:
        return StripTrial(campaign)
    say("calibrating to the decays", 0.01)
    run_fit(fit := prepare_fit(campaign), near=True)
    say("calibrating to the decays, strips as simpler programs take them", 0.02)
    other = campaign.with_model(SIMPLER_STRIPS.applied_to(model))
    run_fit(again := prepare_fit(other), near=True)
    if (better := _unlikelihood(fit) - _unlikelihood(again)) < MIN_LIKELIHOOD_GAIN:
        return StripTrial(campaign, fit)
    return StripTrial(other, again, SIMPLER_STRIPS, (f"{SIMPLER_STRIPS_NOTE} (by {better:.0f} in -2 ln L of the decays)",))


def _unlikelihood(fit: Fit) -> float:
    """-2 ln L of calibrated decays, errors no smaller than the stated noise."""
    data = fit.decays.problem.data
    noise = np.array([[record.noise.get(DOFS[dof], 0.0) for dof in data.dofs] for record in fit.decays.records])
    squares = np.maximum(fit.decays.residual_mean_squares(), noise**2)
    there = np.asarray(data.present).sum(axis=-1) > 0
    return float(np.sum(independent_observations(data)[:, None] * np.where(there, np.log(np.maximum(squares, 1e-300)), 0.0)))
