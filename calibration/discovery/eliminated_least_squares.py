"""Least squares with the decays' own unknowns eliminated: weights, equations, steps, and what a step would gain.

-2 ln L = sum over motions and pools of bands of n ln m, n the pool's degrees of freedom and m the mean square over the floor's
(Whittle 1953, Arkiv for Matematik 2, 423-434, with a spectrum that is known up to a factor by pool, which is estimated: see
`expected_residuals`), and the priors' squares. The spectrum is the floor's at least: where m < 1 the term is
n (m - 1). A fit minimises n (m^p - 1) / p in place of n ln m (Box and Cox 1964, Journal of the Royal Statistical Society B 26,
211-252): near the floor the same, but a record that is not followed is not given up for others.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.special import boxcox

from calibration.discovery.linearisations import Linearisation, Point, Prior
from calibration.discovery.study import Study
from calibration.identifiability.information import inverse

BOX_COX_POWER = 0.2  # p: 0 is the logarithm
STEEP_PRIOR_DEVIATIONS = 3.0  # standard deviations of a prior: beyond them it is steep
REWEIGHTINGS = 6  # of weights
ROUNDING = 1e-12  # of the largest eigenvalue of scaled equations: slopes that Broyden's update mended are no better


def deviances(study: Study, residual: np.ndarray, power: float) -> np.ndarray:
    """n (m^p - 1) / p of every series and pool (s, b), n ln m for p = 0; n (m - 1) below the floor."""
    mean_square = study.levels(residual)
    return study.pooled * (boxcox(np.maximum(mean_square, 1.0), power) + np.minimum(mean_square - 1, 0.0))


def cost_of(study: Study, look: Linearisation, residual: np.ndarray, place: Point, used: np.ndarray, prior: Prior) -> float:
    """What is minimised, of the `used` series (s,) and the priors, with this residual at this place."""
    value = float(deviances(study, residual, BOX_COX_POWER)[used].sum())
    value += float((prior_residuals(study, place, prior)[0][list(look.active)] ** 2).sum())
    return value + float(((place.own / study.own_width) ** 2).sum())


def prior_residuals(study: Study, place: Point, prior: Prior) -> tuple[np.ndarray, np.ndarray]:
    """What priors are the squares of (p,), and its slopes along the directions: z (1 + (z / FAR)^2), z how far from what is
    expected in standard deviations.

    A Gaussian prior is no match for thousands of samples of what the model lacks: a mass that was weighed would be moved by
    twenty of its deviations.
    """
    z = (study.steps(place.x) - prior.mean) / prior.width
    return z * (1 + (z / STEEP_PRIOR_DEVIATIONS) ** 2), (1 + 3 * (z / STEEP_PRIOR_DEVIATIONS) ** 2) / prior.width


def minus_two_log_likelihood(study: Study, residual: np.ndarray) -> np.ndarray:
    """-2 ln L of every series (s,)."""
    return deviances(study, residual, 0.0).sum(axis=1)


def row_weights(study: Study, residual: np.ndarray) -> np.ndarray:
    """By which rows' squares count where `cost_of` is taken as quadratic."""
    each = study.pooled * np.maximum(study.levels(residual), 1.0) ** (BOX_COX_POWER - 1)
    return each.ravel()[study.pool] * study.share


class DecayBlock(NamedTuple):
    """Of one decay: Gauss-Newton matrix and gradient of its own unknowns, and the cross block; whether it is fitted."""

    own: np.ndarray
    cross: np.ndarray
    slope: np.ndarray
    fitted: bool


class NormalEquations(NamedTuple):
    """Gauss-Newton matrix and gradient of the parameters, and every decay's block: an arrow."""

    matrix: np.ndarray
    slope: np.ndarray
    blocks: list[DecayBlock]

    def reduced(self, damping: float = 0.0) -> tuple[np.ndarray, np.ndarray, list[np.ndarray]]:
        """Matrix and gradient of the parameters with the fitted decays' own unknowns eliminated, and what gives all of these
        back."""
        matrix, slope = self.matrix + damping * np.diag(np.diag(self.matrix)), self.slope
        back = []
        for block in self.blocks:
            size = len(block.own)
            ridge = damping * np.diag(np.diag(block.own)) + 1e-12 * np.trace(block.own) / size * np.eye(size)
            back.append(np.linalg.solve(block.own + ridge, np.column_stack([block.cross, block.slope])))
            if block.fitted:
                matrix = matrix - block.cross.T @ back[-1][:, :-1]
                slope = slope - block.cross.T @ back[-1][:, -1]
        return matrix, slope, back


def normal_equations(study: Study, look: Linearisation, weight: np.ndarray, used: np.ndarray, prior: Prior) -> NormalEquations:
    """Of the `used` series (s,) for the parameters; of all decays for their own unknowns. `weight` (n,) by row."""
    active = list(look.active)
    far, steep = (one[active] for one in prior_residuals(study, look.place, prior))
    mine = weight * used[study.row_series]
    matrix = look.slopes.T @ (mine[:, None] * look.slopes) + np.diag(steep**2)
    slope = look.slopes.T @ (mine * look.residual) + steep * far
    blocks = []
    for i, span in enumerate(study.spans):
        own, slopes, w = look.own[span], look.slopes[span], weight[span]
        blocks.append(
            DecayBlock(
                own.T @ (w[:, None] * own) + np.diag(1 / study.own_width[i] ** 2),
                own.T @ (w[:, None] * slopes),
                own.T @ (w * look.residual[span]) + look.place.own[i] / study.own_width[i] ** 2,
                bool(used[study.row_series[span]].any()),
            )
        )
    return NormalEquations(matrix, slope, blocks)


def decay_unknown_steps(study: Study, back: Sequence[np.ndarray], step: np.ndarray) -> np.ndarray:
    """What the decays' own unknowns do where the parameters take a step."""
    return np.array([-(one[:, -1] + one[:, :-1] @ step) for one in back]).reshape(study.own_width.shape)


def symmetric_inverse(matrix: np.ndarray) -> np.ndarray:
    """A symmetric matrix's inverse, or pseudo-inverse, of parameters of any size."""
    return inverse(matrix, ROUNDING)


def damped_step(
    study: Study, look: Linearisation, used: np.ndarray, prior: Prior, damping: float
) -> tuple[np.ndarray, np.ndarray]:
    """A damped step of the parameters, and of every used decay's own unknowns."""
    found = normal_equations(study, look, row_weights(study, look.residual), used, prior)
    matrix, slope, back = found.reduced(damping)
    step = -symmetric_inverse(matrix) @ slope
    fitted = np.array([block.fitted for block in found.blocks], float)[:, None]
    return step, decay_unknown_steps(study, back, step) * fitted


def linear_residual(study: Study, look: Linearisation, step: np.ndarray, own: np.ndarray) -> np.ndarray:
    """Rows of the residual after a step, were the model linear."""
    residual = look.residual + look.slopes @ step
    for span, mine in zip(study.spans, own):
        residual[span] += look.own[span] @ mine
    return residual


def projected_products(study: Study, look: Linearisation, columns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of columns (n, k): their products (k,) with a look's residual, and their squares (k,), when what its directions and the
    decays' unknowns can do instead, without limit, is projected out; weighed as a fit of the used tests does."""
    root = np.sqrt(row_weights(study, look.residual) * study.used[study.row_series])[:, None]
    base, columns, residual = (root * one for one in (look.slopes, columns, look.residual[:, None]))
    for span in study.spans:
        own = np.linalg.qr(root[span] * look.own[span][:, look.own[span].any(axis=0)])[0]
        for part in (base, columns, residual):
            part[span] -= own @ (own.T @ part[span])
    size = np.linalg.norm(base, axis=0)
    own = np.linalg.qr(base[:, size > 0] / size[size > 0])[0]
    columns, residual = (part - own @ (own.T @ part) for part in (columns, residual))
    return (columns * residual).sum(axis=0), (columns**2).sum(axis=0)


class FirstOrderGain(NamedTuple):
    """Steps of the parameters, gains of -2 ln L by series (s,), which of these are of `used` tests, and the covariance."""

    step: np.ndarray
    gain: np.ndarray
    used: np.ndarray
    covariance: np.ndarray

    @property
    def fitted(self) -> float:
        """The gain in the fitted tests."""
        return float(self.gain[self.used].sum())

    @property
    def held(self) -> float:
        """The gain in the held-out tests."""
        return float(self.gain[~self.used].sum())

    @property
    def deviation(self) -> np.ndarray:
        """Standard deviations."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0.0))


def predict_gain(study: Study, look: Linearisation, prior: Prior) -> FirstOrderGain:
    """What a look's directions would gain were the model linear, releases and offsets moving with them, weights renewed."""
    residual, step = look.residual, np.zeros(len(look.active))
    covariance = np.zeros((len(step), len(step)))
    for _ in range(REWEIGHTINGS):
        found = normal_equations(study, look, row_weights(study, residual), study.used, prior)
        matrix, slope, back = found.reduced()
        covariance = symmetric_inverse(matrix)
        step = -covariance @ slope
        residual = linear_residual(study, look, step, decay_unknown_steps(study, back, step))
    gain = minus_two_log_likelihood(study, look.residual) - minus_two_log_likelihood(study, residual)
    return FirstOrderGain(step, gain, study.used, covariance)
