"""Covariance of scores: least squares with errors that are alike within groups, against many simulated records."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from calibration.discovery.score_covariance import MIN_DISCREPANCY, discrepancy_of, overdispersion, score_matrix, without_own
from calibration.discovery.selection.dispersion import dispersion
from calibration.discovery.selection.linear_model import LinearModel

GROUPS, SIZE = 150, 8  # groups of rows, rows of a group


def columns_of(random: np.random.Generator) -> np.ndarray:
    """Two columns that vary slowly: alike within a group (n, 2)."""
    return np.repeat(random.normal(size=(GROUPS, 2)), SIZE, axis=0)


@pytest.mark.parametrize(("alike", "expected"), [(0.0, 1.0), (1.0, SIZE)])
def test_the_sandwich_is_the_spread_of_estimates(alike: float, expected: float) -> None:
    """Errors of variance 1, independent or the same in every row of a group."""
    random, group = np.random.default_rng(1), np.repeat(np.arange(GROUPS), SIZE)
    columns = columns_of(random)
    inverse = np.linalg.inv(columns.T @ columns)
    estimates, covariances, factors = [], [], []
    for _ in range(400):
        errors = np.sqrt(alike) * random.normal(size=GROUPS)[group] + np.sqrt(1 - alike) * random.normal(size=group.size)
        step = -inverse @ columns.T @ errors
        scores = score_matrix(columns, errors + columns @ step, group)
        estimates.append(step)
        covariances.append(inverse @ scores @ inverse)
        factors.append(overdispersion(inverse, columns.T @ columns, scores))
    spread = np.cov(np.array(estimates).T)
    assert_allclose(np.mean(covariances, axis=0), spread, atol=0.15 * spread.max())
    assert_allclose(np.diag(spread), expected * np.diag(inverse), rtol=0.2)
    assert np.mean(factors) == pytest.approx(expected, rel=0.1)


def linear_model(errors: np.ndarray, group: np.ndarray) -> LinearModel:
    """A linear model of two columns and these errors, all rows one pool."""
    columns = columns_of(np.random.default_rng(2))
    none, rows = np.zeros(2), group.size
    share, freedom, far = np.full(rows, 1 / rows), np.array([float(rows)]), np.full(2, 1e3)
    return LinearModel(
        columns, errors, (), np.zeros(rows, int), share, freedom, none, none + 1e3, -far, far, none, none > 0, group
    )


def test_the_likelihood_counts_for_less_where_errors_above_the_noise_are_alike() -> None:
    random, group = np.random.default_rng(3), np.repeat(np.arange(GROUPS), SIZE)
    alike, apart = 3 * random.normal(size=GROUPS)[group], 3 * random.normal(size=group.size)
    factors = []
    for errors in (alike, apart, apart / 3):
        model = linear_model(errors, group)
        factors.append(dispersion(model, model.fit([0, 1])))
    assert factors[0] == pytest.approx(SIZE, rel=0.35)
    assert factors[1] == pytest.approx(3.0, rel=0.05)  # at least by how far they are above the noise
    assert factors[2] == 1.0


def test_what_a_decay_s_own_unknowns_follow_has_no_score() -> None:
    random = np.random.default_rng(4)
    own = random.normal(size=(40, 3))
    columns = np.concatenate([own @ random.normal(size=(3, 2)), random.normal(size=(20, 2))])
    rest = without_own(columns, [(slice(0, 40), own, np.full(3, 1e6))])
    assert_allclose(rest[:40], 0, atol=1e-9)
    assert_allclose(rest[40:], columns[40:])
    assert_allclose(score_matrix(rest, np.ones(60), np.zeros(60, int)), 0)  # one group has no covariance


def test_residuals_at_the_noise_have_no_discrepancy() -> None:
    assert discrepancy_of(np.array([0.5, 1.0]), np.array([10.0, 20.0])) == 1.0 < MIN_DISCREPANCY
    assert discrepancy_of(np.array([16.0, 1.0]), np.array([10.0, 10.0])) == pytest.approx(2.0)
