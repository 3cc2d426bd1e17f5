"""The linear model of a campaign's study, for the selection of effects."""

from collections.abc import Iterator, Sequence

import numpy as np

from calibration.discovery.effect_fits import EffectFits
from calibration.discovery.linearisations import Linearisation
from calibration.discovery.score_covariance import score_groups
from calibration.discovery.selection.linear_model import LinearModel
from calibration.discovery.selection.pooled_products import OwnUnknowns
from calibration.discovery.study import Study

MAX_COEFFICIENT_STEP = 1.0  # of a logarithm in one linearisation
MAX_NUISANCE = 3.0  # standard deviations of nearly known quantities


def linear_model(fits: EffectFits, linearisation: Linearisation, slopes: np.ndarray, directions: Sequence[int]) -> LinearModel:
    """The linear model of some columns at a linearisation's point.

    Args:
        fits: Study, candidates, priors.
        linearisation: The linearisation.
        slopes: The columns (n, k).
        directions: Their directions (k,).
    """
    study, prior = fits.study, fits.setup.prior
    directions, names = list(directions), np.array(study.names)[list(directions)]
    now = study.steps(linearisation.point.x)[directions]
    low, high = (study.limits[directions] - now[:, None]).T
    base = np.arange(len(directions)) < len(fits.base)
    further = ~base & np.isin(directions, fits.base)  # of nearly known properties, beside the base's column
    sizes = fits.setup.size_priors
    width = np.array([sizes[n][1] if more else w for n, more, w in zip(names, further, prior.width[directions])])
    step = np.where(study.logarithmic[directions], MAX_COEFFICIENT_STEP, np.inf)
    low, high = np.maximum(low, -step), np.minimum(high, step)
    nuisance = base & np.isin(directions, study.index(fits.setup.nuisances))
    low = np.where(nuisance, np.minimum(np.maximum(low, -MAX_NUISANCE * width - now), 0.0), low)
    high = np.where(nuisance, np.maximum(np.minimum(high, MAX_NUISANCE * width - now), 0.0), high)
    positive = {label for candidate in fits.setup.candidates for label in candidate.positive}
    signed = ~base & np.isin(names, sorted(positive))
    low = np.where(signed, np.maximum(low, -now), low)
    amplitudes = {label for candidate in fits.setup.candidates for label in candidate.amplitudes}
    sized = ~base & ~further & np.isin(names, sorted(amplitudes))
    expected = np.array([sizes[n][0] if is_sized else 0.0 for n, is_sized in zip(names, sized)])
    used = study.used[study.row_series]
    return LinearModel(
        slopes,
        linearisation.residual,
        own_unknowns(study, linearisation),
        study.pool,
        study.share * used,
        (study.pooled * study.used[:, None]).ravel(),
        np.where(further, 0.0, np.where(sized, expected, prior.mean[directions]) - now),
        width,
        low,
        high,
        np.where(sized, -now, 0.0),
        sized | further,
        score_groups(study),
    )


def decays_with_unknowns(
    study: Study, linearisation: Linearisation, fitted: bool
) -> Iterator[tuple[int, OwnUnknowns, np.ndarray]]:
    """Decays with unknowns of their own: the fitted ones, or those held out.

    Args:
        study: The study.
        linearisation: The linearisation.
        fitted: Which of both.

    Yields:
        Number of the decay, its unknowns, and which of all (o,) they are.
    """
    for i, (rows, used) in enumerate(zip(study.spans, study.fitted_decays, strict=True)):
        free = np.asarray(linearisation.own[rows].any(axis=0))
        if used == fitted and free.any():
            yield (
                i,
                OwnUnknowns(rows, linearisation.own[rows][:, free], study.own_width[i][free], linearisation.point.own[i][free]),
                free,
            )


def own_unknowns(study: Study, linearisation: Linearisation) -> tuple[OwnUnknowns, ...]:
    """The fitted decays' own unknowns."""
    return tuple(unknowns for _, unknowns, _ in decays_with_unknowns(study, linearisation, True))


def step_of_decays(study: Study, linearisation: Linearisation, steps: Sequence[np.ndarray]) -> np.ndarray:
    """Steps of all decays' own unknowns (r, o), from those of a fit."""
    whole = np.zeros_like(linearisation.point.own)
    for (i, _, free), step in zip(decays_with_unknowns(study, linearisation, True), steps, strict=True):
        whole[i, free] = step
    return whole
