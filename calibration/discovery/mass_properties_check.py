"""Check of mass properties at the end of a search: whether they are further off than weighing usually is."""

import math

import numpy as np

from calibration.discovery.acceptance import MIN_BIC_GAIN, MIN_HELD_OUT_GAIN, MIN_SIGNIFICANCE
from calibration.discovery.eliminated_least_squares import prior_residuals
from calibration.discovery.fit_state import FitState
from calibration.discovery.score_covariance import deviations_of
from calibration.discovery.search import AcceptedEffect, Search

MASS_DEVIATIONS_ALLOWED = 2.0  # standard deviations by which weighed mass properties may be off


def with_mass_properties(search: Search, state: FitState) -> FitState:
    """The model with mass properties as an effect, where they are further off than weighing usually is.

    They are free within their priors in every fit, so that no error shows that they are wrong.

    Args:
        search: The search; its record gets the effect and a note.
        state: The verified model.

    Returns:
        The model with them as an effect, or `state`.
    """
    fits, record = search
    candidate = next((candidate for candidate in fits.setup.candidates if candidate.effect == "mass_properties"), None)
    if candidate is None or candidate in state.chosen:
        return state
    mine, width = fits.study.index(candidate.amplitudes), fits.setup.prior.width[fits.study.index(candidate.amplitudes)]
    if np.abs(fits.study.steps(state.linearisation.point.x)[mine] / width).max() < 1:
        return state
    chosen = (*state.chosen, candidate)
    after = fits.refit_from(state, chosen, "mass properties let go", 0.98)
    prior = fits.prior(chosen)
    deviation = deviations_of(fits.study, after.linearisation, prior)[[after.linearisation.active.index(i) for i in mine]]
    far = (np.abs(fits.study.steps(after.linearisation.point.x)[mine]) - MASS_DEVIATIONS_ALLOWED * width) / deviation
    squares = [
        float((prior_residuals(fits.study, fitted.linearisation.point, by)[0][mine] ** 2).sum())
        for fitted, by in ((state, fits.prior(state.chosen)), (after, prior))
    ]
    gain = fits.likelihood_gain(state, after) + squares[0] - squares[1]
    off = [label for label, beyond in zip(candidate.amplitudes, far) if beyond > MIN_SIGNIFICANCE]
    if not off or gain - len(off) * math.log(fits.count) < MIN_BIC_GAIN:
        return state
    verdict = fits.assess(state, after, candidate, last=True)
    if verdict.net < -MIN_HELD_OUT_GAIN:
        return state
    # scores and BIC are of errors, and none tells of it
    record.accepted[candidate.name] = AcceptedEffect(
        math.nan, state, after, verdict._replace(bic=math.nan, refused=None), (), math.nan, np.zeros(0)
    )
    record.rejected.pop(candidate.name, None)
    names = " and ".join(label.split(".")[1].replace("_", " ") for label in off)
    record.notes.append(
        f"{names} {'are' if len(off) > 1 else 'is'} further from the platform file's values than what was weighed usually "
        "is. The records are followed no better for it: mass properties are free to move a little in every fit"
    )
    return after
