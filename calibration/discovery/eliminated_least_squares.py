"""Least squares with the decays' own unknowns eliminated: weights, normal equations, gains.

-2 ln L is the sum over motions and pools of bands of n ln m, and the squares of the priors. n is the number of degrees of
freedom of the pool, m its mean square over the floor's. The spectrum is known up to a factor by pool, which is estimated (see
`expected_residuals`). It is at least the floor's: where m < 1 the term is n (m - 1).

A fit minimises n (m^p - 1) / p in place of n ln m (Box-Cox transformation). Near the floor both agree, but no record is given
up for the others.

References:
    Whittle 1953, Arkiv for Matematik 2, 423-434.
    Box and Cox 1964, Journal of the Royal Statistical Society B 26, 211-252.
"""

from typing import NamedTuple

import numpy as np
import scipy  # its parts are imported when they are used: that takes a second

from calibration.discovery.linearisations import Linearisation, Point, Prior
from calibration.discovery.study import Study
from calibration.fitting.normal_equations import OWN_ROUNDING, ArrowMatrix, own_of
from calibration.identifiability.information import pseudo_inverse
from calibration.residuals.abstract_residual import Unknowns

BOX_COX_POWER = 0.2  # p; 0 is the logarithm
STEEP_PRIOR_DEVIATIONS = 3.0  # standard deviations beyond which a prior is steep
REWEIGHTINGS = 6  # updates of the weights
EIGENVALUE_ROUNDING = 1e-12  # of the largest eigenvalue of scaled equations: the accuracy of updated slopes


def deviances(study: Study, residual: np.ndarray, power: float) -> np.ndarray:
    """Deviance of every series and pool of bands (s, b).

    n (m^p - 1) / p with p = `power`, n ln m for p = 0; n (m - 1) below the floor.
    """
    mean_square = study.levels(residual)
    return study.pooled * (scipy.special.boxcox(np.maximum(mean_square, 1.0), power) + np.minimum(mean_square - 1, 0.0))


def cost_of(
    study: Study, linearisation: Linearisation, residual: np.ndarray, point: Point, used: np.ndarray, prior: Prior
) -> float:
    """The cost that a fit minimises: deviances of the fitted series, and squares of the priors.

    Args:
        study: The study.
        linearisation: Linearisation whose directions are free.
        residual: Residual in rows (n,).
        point: The point that the residual is of.
        used: Which series (s,) are fitted.
        prior: Priors of the directions.
    """
    value = float(deviances(study, residual, BOX_COX_POWER)[used].sum())
    value += float((prior_residuals(study, point, prior)[0][list(linearisation.active)] ** 2).sum())
    return value + float(((point.own / study.own_width) ** 2).sum())


def prior_residuals(study: Study, point: Point, prior: Prior) -> tuple[np.ndarray, np.ndarray]:
    """Residuals of the priors, and their slopes along the directions (each d,).

    z (1 + (z / 3)^2) with z the distance from the mean in standard deviations (`STEEP_PRIOR_DEVIATIONS` is 3). A Gaussian prior
    is too weak against thousands of samples of what the model lacks: a weighed mass would be moved by twenty deviations.
    """
    z = (study.steps(point.x) - prior.mean) / prior.width
    return z * (1 + (z / STEEP_PRIOR_DEVIATIONS) ** 2), (1 + 3 * (z / STEEP_PRIOR_DEVIATIONS) ** 2) / prior.width


def minus_two_log_likelihood(study: Study, residual: np.ndarray) -> np.ndarray:
    """-2 ln L of every series (s,)."""
    return deviances(study, residual, 0.0).sum(axis=1)


def row_weights(study: Study, residual: np.ndarray) -> np.ndarray:
    """Weights of rows (n,) in the quadratic approximation of `cost_of`."""
    each = study.pooled * np.maximum(study.levels(residual), 1.0) ** (BOX_COX_POWER - 1)
    return each.ravel()[study.pool] * study.share


class NormalEquations(NamedTuple):
    """Gauss-Newton equations of parameters and of every decay's own unknowns.

    Attributes:
        matrix: Gauss-Newton matrix.
        gradient: Gradient.
        fitted: Which decays are fitted (r,).
    """

    matrix: ArrowMatrix
    gradient: Unknowns
    fitted: np.ndarray

    def reduced(self, damping: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Matrix and gradient of the parameters with the fitted decays' own unknowns eliminated.

        Returns:
            Matrix (q, q), gradient (q,), and by decay the matrix that recovers its own unknowns (r, o, q + 1).
        """
        size = np.diagonal(self.matrix.own, axis1=1, axis2=2)
        ridge = damping * size + OWN_ROUNDING * size.mean(axis=1, keepdims=True) if size.size else size
        matrix, slope, back = self.matrix.eliminated(self.gradient, ridge, self.fitted.astype(float))
        return matrix + damping * np.diag(np.diag(self.matrix.shared)), slope, back


def normal_equations(
    study: Study, linearisation: Linearisation, weight: np.ndarray, used: np.ndarray, prior: Prior
) -> NormalEquations:
    """Normal equations of a linearisation.

    Args:
        study: The study.
        linearisation: The linearisation.
        weight: Weights of rows (n,).
        used: Which series (s,) are fitted; every decay's own unknowns take part.
        prior: Priors of the directions.
    """
    active = list(linearisation.active)
    far, steep = (values[active] for values in prior_residuals(study, linearisation.point, prior))
    mine = weight * used[study.row_series]
    shared = linearisation.slopes.T @ (mine[:, None] * linearisation.slopes) + np.diag(steep**2)
    slope = linearisation.slopes.T @ (mine * linearisation.residual) + steep * far
    (records, size), q = study.own_width.shape, len(active)
    own_matrix, cross, own_slope = np.zeros((records, size, size)), np.zeros((records, q, size)), np.zeros((records, size))
    for i, span in enumerate(study.spans):
        weighed = weight[span, None] * linearisation.own[span]
        own_matrix[i] = weighed.T @ linearisation.own[span] + np.diag(1 / study.own_width[i] ** 2)
        cross[i] = linearisation.slopes[span].T @ weighed
        own_slope[i] = weighed.T @ linearisation.residual[span] + linearisation.point.own[i] / study.own_width[i] ** 2
    fitted = np.array([used[study.row_series[span]].any() for span in study.spans], bool)
    gradient = Unknowns(slope, own_slope)  # type: ignore[arg-type]
    return NormalEquations(ArrowMatrix(shared, cross, own_matrix), gradient, fitted)


def symmetric_inverse(matrix: np.ndarray) -> np.ndarray:
    """Inverse or pseudo-inverse of a symmetric matrix, whatever the parameters' scales."""
    return pseudo_inverse(matrix, EIGENVALUE_ROUNDING)


def damped_step(
    study: Study, linearisation: Linearisation, used: np.ndarray, prior: Prior, damping: float
) -> tuple[np.ndarray, np.ndarray]:
    """Damped step of the parameters (q,), and of the fitted decays' own unknowns (r, o)."""
    equations = normal_equations(study, linearisation, row_weights(study, linearisation.residual), used, prior)
    matrix, slope, back = equations.reduced(damping)
    step = -symmetric_inverse(matrix) @ slope
    return step, -own_of(back, -step) * equations.fitted[:, None]


def linear_residual(study: Study, linearisation: Linearisation, step: np.ndarray, own_step: np.ndarray) -> np.ndarray:
    """Residual in rows (n,) after a step, by the linearisation."""
    residual = linearisation.residual + linearisation.slopes @ step
    for span, mine in zip(study.spans, own_step):
        residual[span] += linearisation.own[span] @ mine
    return residual


def projected_products(study: Study, linearisation: Linearisation, columns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Products of columns with the residual, after projection.

    The part that the directions of the linearisation and the decays' own unknowns can explain is projected out. Rows are
    weighed as in a fit.

    Args:
        study: The study.
        linearisation: The linearisation.
        columns: Columns in rows (n, k).

    Returns:
        Products with the residual (k,), and the columns' squares (k,).
    """
    root = np.sqrt(row_weights(study, linearisation.residual) * study.used[study.row_series])[:, None]
    base, columns, residual = (root * rows for rows in (linearisation.slopes, columns, linearisation.residual[:, None]))
    for span in study.spans:
        basis = np.linalg.qr(root[span] * linearisation.own[span][:, linearisation.own[span].any(axis=0)])[0]
        for part in (base, columns, residual):
            part[span] -= basis @ (basis.T @ part[span])
    size = np.linalg.norm(base, axis=0)
    basis = np.linalg.qr(base[:, size > 0] / size[size > 0])[0]
    columns, residual = (part - basis @ (basis.T @ part) for part in (columns, residual))
    return (columns * residual).sum(axis=0), (columns**2).sum(axis=0)


class FirstOrderGain(NamedTuple):
    """First-order gain of a step.

    Attributes:
        step: Step of the parameters (q,).
        gain: Decrease of -2 ln L by series (s,).
        used: Which series are of fitted tests (s,).
        covariance: Covariance of the parameters (q, q).
    """

    step: np.ndarray
    gain: np.ndarray
    used: np.ndarray
    covariance: np.ndarray

    @property
    def fitted(self) -> float:
        """Decrease of -2 ln L in the fitted tests."""
        return float(self.gain[self.used].sum())

    @property
    def held(self) -> float:
        """Decrease of -2 ln L in the held-out tests."""
        return float(self.gain[~self.used].sum())

    @property
    def deviation(self) -> np.ndarray:
        """Standard deviations of the parameters (q,)."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0.0))


def predict_gain(study: Study, linearisation: Linearisation, prior: Prior) -> FirstOrderGain:
    """Gain that the directions of a linearisation would bring if the model were linear.

    The decays' own unknowns move too, and weights are updated.
    """
    residual, step = linearisation.residual, np.zeros(len(linearisation.active))
    covariance = np.zeros((len(step), len(step)))
    for _ in range(REWEIGHTINGS):
        equations = normal_equations(study, linearisation, row_weights(study, residual), study.used, prior)
        matrix, slope, back = equations.reduced()
        covariance = symmetric_inverse(matrix)
        step = -covariance @ slope
        residual = linear_residual(study, linearisation, step, -own_of(back, -step))
    gain = minus_two_log_likelihood(study, linearisation.residual) - minus_two_log_likelihood(study, residual)
    return FirstOrderGain(step, gain, study.used, covariance)
