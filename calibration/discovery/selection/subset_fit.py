"""Fit of a selected subset of effects, with the slopes of the linear model that it was selected on."""

import numpy as np

from calibration.discovery.broyden_fit import MIN_RELATIVE_GAIN, far_step
from calibration.discovery.effect_fits import EffectFits
from calibration.discovery.effects.effect_names import effect_in_words
from calibration.discovery.fit_state import FitState
from calibration.discovery.linearisations import Linearisation
from calibration.discovery.selection.candidate_columns import CandidateColumns
from calibration.discovery.selection.study_linear_model import step_of_decays
from calibration.discovery.selection.subsets import Subset
from calibration.formatting import listed

STEP_ITERATIONS = 15  # iterations of a fit with the slopes at hand


def fit_subset(
    fits: EffectFits,
    state: FitState,
    columns: CandidateColumns,
    subset: Subset,
    stage: str,
    share: float,
    tolerance: float = MIN_RELATIVE_GAIN,
) -> FitState:
    """Fit the effects of a subset, from a state on, with the slopes of a linear model.

    Args:
        fits: Study, candidates, priors.
        state: The state that was linearised.
        columns: The linear model.
        subset: The subset.
        stage: Stage to report.
        share: Progress to report (0 to 1).
        tolerance: Relative gain in cost of a step that ends the fit.

    Returns:
        The state that the fit reached.
    """
    point, candidates = state.linearisation.point, {candidate.name: candidate for candidate in fits.setup.candidates}
    chosen = tuple(candidates[columns.variants[i].name] for i in subset.variants)
    present = {candidate.name for candidate in state.chosen}
    gone = [label for candidate in state.chosen if candidate not in chosen for label in candidate.labels]
    point, anew = fits.with_starting_values(point, gone) if gone else point, False
    for i, candidate in zip(subset.variants, chosen, strict=True):
        if candidate.name not in present:
            point = fits.with_values(point, columns.values[i])
            anew |= any(label in candidate.amplitudes for label in columns.values[i])
    mine = [i for i in subset.fit.columns if i in columns.base or columns.directions[i] not in fits.base]
    directions = tuple(columns.directions[i] for i in mine)
    if anew:  # far from where slopes were taken
        linearisation = fits.study.linearise(point, directions)
    else:
        residual = fits.study.residual(point) if gone else columns.linearisation.residual
        slopes = columns.model.slopes[:, mine]
        linearisation = Linearisation(point, directions, residual, slopes, columns.linearisation.own)
        moved = np.array(columns.directions)[list(subset.fit.columns)]  # nearly known properties have two columns
        step = np.array([subset.fit.step[moved == i].sum() for i in directions])
        own_step = step_of_decays(fits.study, columns.linearisation, subset.fit.own)
        linearisation = far_step(fits.study, linearisation, fits.study.used, fits.prior(chosen), step, own_step)
    names = listed([effect_in_words(candidate.name) for candidate in chosen]) or "no effect"
    reached = fits.fit(linearisation, chosen, STEP_ITERATIONS, 0, f"{stage}: fit with {names}", share, tolerance)
    return fits.state(chosen, reached)
