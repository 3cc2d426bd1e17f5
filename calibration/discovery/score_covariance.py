"""Covariance of scores: what records say where the model is wrong by more than noise.

A model's errors are alike over neighbouring frequencies and in all tests. So the rows of one motion in a narrow interval of
frequency, of all seas or of all decays, are one group. A score is the gradient of a group's part of the objective. With
independent errors, the covariance of the scores J would be the Gauss-Newton matrix H of the rows. Errors that are alike make
it larger:

- The covariance of parameters is H^-1 J H^-1 (sandwich), not H^-1.
- The likelihood counts for less by the factor tr(H^-1 J) / tr(H^-1 H_rows), which is 1 for independent errors (magnitude
  adjustment). H includes the priors, H_rows does not.

References:
    Liang and Zeger 1986, Biometrika 73, 13-22: covariance from groups.
    Ribatet, Cooley and Davison 2012, Statistica Sinica 22, 813-845: magnitude adjustment.
"""

from collections.abc import Iterable

import numpy as np

from calibration.discovery.eliminated_least_squares import predict_gain, row_weights
from calibration.discovery.linearisations import Linearisation, Prior
from calibration.discovery.study import Study
from calibration.identifiability.information import pseudo_inverse

INTERVAL_RATIO = 1.12  # of a group's highest frequency to its lowest
MIN_DISCREPANCY = 1.2  # of a residual's root mean square to the floor's; a smaller one may be noise by chance


def score_groups(study: Study) -> np.ndarray:
    """Group of every row (n,)."""
    kinds = [(series.kind == "decay", series.channel) for series in study.series]
    names = sorted(set(kinds))
    frequency = np.repeat(study.frequency, 2)
    lowest = float(frequency[frequency > 0].min(initial=1.0))
    interval = np.floor(np.log(np.maximum(frequency, lowest) / lowest) / np.log(INTERVAL_RATIO) + 1)
    interval[frequency == 0] = 0
    both = np.stack([np.array([names.index(kind) for kind in kinds])[study.row_series], interval], axis=1)
    return np.unique(both, axis=0, return_inverse=True)[1].ravel()


def score_matrix(columns: np.ndarray, residual: np.ndarray, group: np.ndarray) -> np.ndarray:
    """Covariance matrix of the scores of groups (q, q), times the number of groups.

    Args:
        columns: Weighted columns (n, q).
        residual: Weighted residual (n,).
        group: Group of every row (n,).
    """
    mine = (columns != 0).any(axis=1)
    numbers = np.unique(group[mine], return_inverse=True)[1].ravel()
    count = int(numbers.max(initial=-1)) + 1
    if count < 2:
        return np.zeros((columns.shape[1],) * 2)
    scores = np.stack([np.bincount(numbers, weights, count) for weights in (columns[mine] * residual[mine, None]).T], axis=1)
    scores -= scores.mean(axis=0)  # all together they balance the priors
    return scores.T @ scores * count / (count - 1)


def without_own(columns: np.ndarray, own: Iterable[tuple[slice, np.ndarray, np.ndarray]]) -> np.ndarray:
    """Weighted columns (n, q) without what the decays' own unknowns can follow.

    Args:
        columns: The columns.
        own: By decay: its rows, weighted slopes along its unknowns (m, o), standard deviations of their priors (o,).
    """
    columns = columns.copy()
    for rows, slopes, width in own:
        columns[rows] -= slopes @ (pseudo_inverse(slopes.T @ slopes + np.diag(1 / width**2)) @ (slopes.T @ columns[rows]))
    return columns


def discrepancy_of(level: np.ndarray, freedom: np.ndarray) -> float:
    """Geometric mean of a residual's root mean square over the floor's, at least 1.

    Args:
        level: Mean square over the floor's by pool (p,).
        freedom: Degrees of freedom by pool (p,).
    """
    logarithm = np.log(np.maximum(level, 1.0))
    return float(np.exp(0.5 * (freedom * logarithm).sum() / max(float(freedom.sum()), 1.0)))


def overdispersion(inverse: np.ndarray, rows: np.ndarray, scores: np.ndarray) -> float:
    """Factor by which the likelihood counts for less, at least 1.

    Args:
        inverse: Inverse of the Gauss-Newton matrix with priors, H^-1 (q, q).
        rows: Gauss-Newton matrix without priors, H_rows (q, q).
        scores: Matrix of the scores, J (q, q).
    """
    expected = float(np.trace(inverse @ rows))
    return max(float(np.trace(inverse @ scores)) / expected, 1.0) if expected > 0 else 1.0


def is_at_noise(study: Study, residual: np.ndarray) -> bool:
    """Whether the fitted series follow their records to about the floor, so that errors are independent."""
    level, freedom = study.levels(residual), study.pooled * study.used[:, None]
    return discrepancy_of(level, freedom) <= MIN_DISCREPANCY


def weighted_rows(study: Study, linearisation: Linearisation) -> tuple[np.ndarray, np.ndarray]:
    """Weighted slopes without the decays' own unknowns (n, q), and weighted residual (n,), of the fitted series."""
    root = np.sqrt(row_weights(study, linearisation.residual) * study.used[study.row_series])
    own = [
        (rows, root[rows, None] * linearisation.own[rows][:, free], width[free])
        for rows, width, fitted in zip(study.spans, study.own_width, study.fitted_decays, strict=True)
        if fitted and (free := linearisation.own[rows].any(axis=0)).any()
    ]
    return without_own(root[:, None] * linearisation.slopes, own), root * linearisation.residual


def dispersion_of(study: Study, linearisation: Linearisation, prior: Prior) -> float:
    """Factor by which the likelihood of a fitted model counts for less.

    It is 1 where the records are followed to about the noise.

    Args:
        study: The study.
        linearisation: Linearisation at the fitted point.
        prior: Priors of the directions.
    """
    if is_at_noise(study, linearisation.residual) or not linearisation.active:
        return 1.0
    columns, residual = weighted_rows(study, linearisation)
    scores = score_matrix(columns, residual, score_groups(study))
    return overdispersion(predict_gain(study, linearisation, prior).covariance, columns.T @ columns, scores)


def parameter_covariance(study: Study, linearisation: Linearisation, prior: Prior) -> np.ndarray:
    """Covariance of a fitted model's parameters (q, q).

    It is the inverse of the Gauss-Newton matrix where the records are followed to about the noise. Elsewhere it is that of the
    scores; no variance is below that of independent errors, or above that of the prior.

    Args:
        study: The study.
        linearisation: Linearisation at the fitted point.
        prior: Priors of the directions.
    """
    inverse = predict_gain(study, linearisation, prior).covariance
    if is_at_noise(study, linearisation.residual) or not linearisation.active:
        return inverse
    columns, residual = weighted_rows(study, linearisation)
    robust = inverse @ score_matrix(columns, residual, score_groups(study)) @ inverse
    least, now = np.diag(inverse), np.maximum(np.diag(robust), 1e-300)
    most = np.maximum(prior.width[list(linearisation.active)] ** 2, least)
    scale = np.sqrt(np.clip(now, least, most) / now)
    inside = scale < 1e6  # a parameter that no group moves has its own variance
    robust = np.where(np.outer(inside, inside), robust * np.outer(scale, scale), np.diag(least))
    return np.asarray(robust)


def deviations_of(study: Study, linearisation: Linearisation, prior: Prior) -> np.ndarray:
    """Standard deviations of a fitted model's parameters (q,). See `parameter_covariance`."""
    return np.sqrt(np.maximum(np.diag(parameter_covariance(study, linearisation, prior)), 0.0))
