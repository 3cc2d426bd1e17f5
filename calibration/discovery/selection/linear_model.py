"""Linearised model of all records: fits of any few columns, within bounds, in linear algebra.

Near a point the residual is r + X theta + Y y. theta are steps along columns: coefficients, nuisances, candidate effects. y are
the decays' own unknowns. A fit minimises -2 ln L (see `eliminated_least_squares`) and the squares of the priors. The deviance
n ln m of a pool of bands is concave in its mean square m. Least squares with weights n / m decrease it at each update.

References:
    Hunter and Lange 2004, American Statistician 58, 30-37: majorisation by a tangent.
    Kass and Raftery 1995, Journal of the American Statistical Association 90, 773-795, equation 5: Laplace approximation.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy  # its parts are imported when they are used: that takes a second

from calibration.discovery.score_covariance import discrepancy_of
from calibration.discovery.selection.bounded_quadratic import RIDGE, bounded_minimum
from calibration.discovery.selection.pooled_products import OwnUnknowns, PooledProducts, WeightedSums

REWEIGHTINGS = 12  # updates of the weights at most
SMALL_CHANGE = 0.01  # of -2 ln L: an update that changes less is the last


class LinearFit(NamedTuple):
    """Fit of some columns.

    Attributes:
        columns: Numbers of the columns (m,).
        step: Steps along them (m,).
        own: Steps of every decay's own unknowns.
        levels: Mean square over the floor's by pool (p,).
        deviance: -2 ln L by pool (p,).
        penalty: Squares of the priors.
        matrix: Gauss-Newton matrix of the columns, the decays' own unknowns eliminated (m, m).
        at_bound: Which columns are at a bound (m,).
    """

    columns: tuple[int, ...]
    step: np.ndarray
    own: tuple[np.ndarray, ...]
    levels: np.ndarray
    deviance: np.ndarray
    penalty: float
    matrix: np.ndarray
    at_bound: np.ndarray

    @property
    def cost(self) -> float:
        """-2 ln L and the squares of the priors."""
        return float(self.deviance.sum()) + self.penalty


@dataclass(frozen=True)
class LinearModel:
    """Residual and slopes of the fitted tests, with priors and bounds of all columns.

    Attributes:
        slopes: Slopes along the columns (n, k).
        residual: Residual (n,).
        own: The decays' own unknowns.
        pool: Pool of every row (n,).
        share: Weight of every row's square in the mean square of its pool, over the floor's (n,).
        freedom: Degrees of freedom by pool (p,).
        mean: Means of the priors, as steps from here (k,).
        width: Standard deviations of the priors (k,).
        lower: Lowest steps (k,).
        upper: Highest steps (k,).
        neutral: Steps to where columns have no effect (k,); columns that are not fitted are there.
        ends: Which columns have the ends of a plausible range as bounds (k,).
        group: Group of every row (n,), whose errors are alike. See `score_covariance`.
    """

    slopes: np.ndarray
    residual: np.ndarray
    own: tuple[OwnUnknowns, ...]
    pool: np.ndarray
    share: np.ndarray
    freedom: np.ndarray
    mean: np.ndarray
    width: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    neutral: np.ndarray
    ends: np.ndarray
    group: np.ndarray

    @cached_property
    def products(self) -> PooledProducts:
        """Products of all columns and, as the last one, of the residual, by pool."""
        every = np.column_stack([self.slopes, self.residual])
        return PooledProducts.of(every, self.own, self.pool, self.share)

    def with_freedom(self, freedom: np.ndarray) -> "LinearModel":
        """The model with other degrees of freedom by pool (p,); the products stay."""
        changed = replace(self, freedom=freedom)
        changed.__dict__["products"] = self.products  # as `cached_property` keeps it
        return changed

    def levels(self, residual: np.ndarray) -> np.ndarray:
        """Mean square over the floor's by pool (p,)."""
        return np.bincount(self.pool, self.share * residual**2, len(self.freedom))

    def deviances(self, level: np.ndarray) -> np.ndarray:
        """-2 ln L by pool (p,), of mean squares by pool (p,): n ln m, and n (m - 1) below the floor."""
        return self.freedom * (np.log(np.maximum(level, 1.0)) + np.minimum(level - 1, 0.0))

    def weights(self, level: np.ndarray) -> np.ndarray:
        """Weights of the pools that have rows (p,) in the tangent of -2 ln L, at their mean squares (p,)."""
        return self.freedom[self.products.pools] / np.maximum(level, 1.0)

    def eliminated(self, sums: WeightedSums, values: Sequence[np.ndarray]) -> tuple[np.ndarray, list[np.ndarray]]:
        """Weighted sums of products with the decays' own unknowns eliminated.

        Args:
            sums: The sums, of columns of which the last is the residual.
            values: The decays' own unknowns at the point of the residual.

        Returns:
            The sum (k, k), and by decay the matrix B that gives its own unknowns, -B @ [step, 1] (o, k).
        """
        whole, back = sums.whole.copy(), []
        for unknowns, (cross, inner), value in zip(self.own, sums.own, values, strict=True):
            cross = cross + np.pad((value / unknowns.width**2)[:, None], ((0, 0), (cross.shape[1] - 1, 0)))
            inner = inner + np.diag(1 / unknowns.width**2)
            inner[np.diag_indices_from(inner)] += RIDGE * np.diag(inner).mean()
            solved = scipy.linalg.cho_solve(scipy.linalg.cho_factor(inner), cross)
            whole -= cross.T @ solved
            back.append(solved)
        return whole, back

    def fit(self, columns: Sequence[int], begin: LinearFit | None = None, start: np.ndarray | None = None) -> LinearFit:
        """Fit some columns and the decays' own unknowns.

        Args:
            columns: Numbers of the columns.
            begin: A fit whose weights are the first.
            start: Steps along all columns before the fit, and 1 (k + 1,); None: columns that are not fitted are neutral.
        """
        columns = list(columns)
        mean, width = self.mean[columns], self.width[columns]
        low, high = self.lower[columns], self.upper[columns]
        products = self.products.combined(columns, self._without(columns) if start is None else start)
        values = [unknowns.value for unknowns in self.own]
        if begin is None:
            level = products.levels(np.append(np.zeros(len(columns)), 1.0), [0 * value for value in values])
        else:
            level = begin.levels[products.pools]
        cost, result = math.inf, None
        for _ in range(REWEIGHTINGS):
            sums = products.weighted(self.weights(level))
            whole, back = self.eliminated(sums, values)
            matrix = whole[:-1, :-1] + np.diag(1 / width**2)
            step = bounded_minimum(matrix, whole[:-1, -1] - mean / width**2, low, high)
            own_steps = tuple(-(solved @ np.append(step, 1.0)) for solved in back)
            level = products.levels(np.append(step, 1.0), own_steps)
            penalty = float((((step - mean) / width) ** 2).sum())
            penalty += sum(
                float((((unknowns.value + y) / unknowns.width) ** 2).sum())
                for unknowns, y in zip(self.own, own_steps, strict=True)
            )
            at_bound = (step <= low) | (step >= high)
            levels = self._by_pool(level)
            before = cost
            result = LinearFit(tuple(columns), step, own_steps, levels, self.deviances(levels), penalty, matrix, at_bound)
            cost = result.cost
            if abs(before - cost) < SMALL_CHANGE:
                break
        assert result is not None
        return result

    def products_after(self, fit: LinearFit) -> np.ndarray:
        """Products of all columns and of the residual after a fit, with that fit's weights (k + 1, k + 1)."""
        sums = self.products.weighted(self.weights(fit.levels[self.products.pools]))
        values = [unknowns.value + y for unknowns, y in zip(self.own, fit.own, strict=True)]
        return self.eliminated(sums.moved(self.steps_after(fit), fit.own), values)[0]

    def steps_after(self, fit: LinearFit) -> np.ndarray:
        """Steps along all columns after a fit, and 1 for the residual (k + 1,)."""
        steps = self._without(fit.columns)
        steps[list(fit.columns)] = fit.step
        return steps

    def residual_after(self, fit: LinearFit) -> np.ndarray:
        """Residual (n,) after the steps of a fit."""
        steps = self.steps_after(fit)[:-1]
        moved = np.flatnonzero(steps)
        residual = self.residual + self.slopes[:, moved] @ steps[moved]
        for unknowns, y in zip(self.own, fit.own, strict=True):
            residual[unknowns.rows] += unknowns.slopes @ y
        return residual

    def _without(self, columns: Sequence[int]) -> np.ndarray:
        """Steps to where all other columns are neutral, and 1 for the residual (k + 1,)."""
        steps = np.append(self.neutral, 1.0)
        steps[list(columns)] = 0.0
        return steps

    def _by_pool(self, level: np.ndarray) -> np.ndarray:
        """Mean squares by pool (p,), 0 in pools without rows.

        Args:
            level: Mean squares of the pools that have rows.
        """
        every = np.zeros(len(self.freedom))
        every[self.products.pools] = level
        return every

    def log_evidence(self, fit: LinearFit) -> float:
        """Logarithm of the evidence of a fit's columns, by Laplace's approximation.

        A column that a bound keeps neutral counts as fixed.
        """
        free = ~(fit.at_bound & (np.abs(fit.step - self.neutral[list(fit.columns)]) < 1e-12))
        width = self.width[list(fit.columns)][free]
        scaled = fit.matrix[np.ix_(free, free)] * np.outer(width, width)
        return -0.5 * fit.cost - 0.5 * float(np.linalg.slogdet(scaled)[1])

    def at_end(self, fit: LinearFit) -> bool:
        """Whether a column of a fit is at the end of its plausible range."""
        columns = list(fit.columns)
        return bool((fit.at_bound & self.ends[columns] & (np.abs(fit.step - self.neutral[columns]) > 1e-12)).any())

    def discrepancy(self, residual: np.ndarray) -> float:
        """Geometric mean of a residual's root mean square over the floor's, at least 1."""
        return discrepancy_of(self.levels(residual), self.freedom)

    def tempered(self, dispersion: float) -> "LinearModel":
        """The model with fewer degrees of freedom, by a factor."""
        return self.with_freedom(self.freedom / dispersion)

    @cached_property
    def used(self) -> np.ndarray:
        """Which pools count (p,)."""
        return self.freedom > 0
