"""Tests in waves within a fit: errors and weights of energies in bands, and of motions."""

from collections.abc import Callable
from typing import ClassVar

import numpy as np

from calibration.fitting.weighted_residuals import AbstractPart, Kind, Loss, ResidualErrors, mean_square
from calibration.identifiability.information import MIN_VARIANCE
from calibration.identifiability.standard_deviations import WeightedProducts, correlated_samples
from calibration.residuals.abstract_residual import Unknowns
from calibration.residuals.seas import SeaProblem, residuals_and_reach
from jaxhydro.dynamics.model import Model

MIN_BAND_ERROR = 0.02  # error of ln(energy) below which a joint fit proves nothing
MIN_POOLED_ERROR = 1e-6  # of an observation: that of a record made without noise


class SeaPart(AbstractPart):
    """Tests in waves within a fit.

    Attributes:
        set_up: Function from a model to its residuals, in seas prepared for its motion.
        pooled: Whether all groups have one error. A motion is then one observation. Otherwise every group has its own, and a
            motion is as many observations as its residual has independent samples.
        groups: Residuals where errors were last estimated.
    """

    kind: ClassVar[Kind] = "waves"
    problem: SeaProblem

    def __init__(self, set_up: Callable[[Model], SeaProblem], model: Model, pooled: bool, loss: Loss = "squares") -> None:
        super().__init__(loss)
        self.set_up, self.problem, self.pooled = set_up, set_up(model), pooled
        self.weight = np.ones((1, len(self.problem.in_bands)))
        self.groups: list[np.ndarray] = []
        self.inside = True

    def estimate(self, unknowns: Unknowns) -> ResidualErrors:
        groups, inside = residuals_and_reach(self.problem, unknowns.shared)
        self.groups, self.inside = [np.asarray(group) for group in groups], bool(inside)
        if self.pooled:
            square = sum(float(np.sum(group**2)) for group in self.groups) / self.problem.observations
            same = np.ones((1, len(groups)))
            return ResidualErrors(same * max(square, MIN_POOLED_ERROR**2), same)
        total = float(self.independent.sum())
        spare = total / max(total - len(self.problem.space.free), 0.5 * total)
        least = np.where(self.problem.in_bands, MIN_BAND_ERROR**2, MIN_VARIANCE)
        variance = np.maximum(spare * np.array([mean_square(group, self.loss) for group in self.groups]), least)
        return ResidualErrors(variance[None], self.inflation[None])

    @property
    def inflation(self) -> np.ndarray:
        """Number of correlated samples that count as one, by group (g,)."""
        pairs = zip(self.groups, self.problem.in_bands, strict=True)
        return np.array([1.0 if bands else correlated_samples(group) for group, bands in pairs])

    @property
    def independent(self) -> np.ndarray:
        """Number of independent residuals in each group (g,)."""
        return np.array([float(len(group)) for group in self.groups]) / self.inflation

    def mean_squares(self) -> tuple[np.ndarray, np.ndarray]:
        assert self.products is not None, "nothing has been minimised yet"
        squares = self.products[0, :, -1, -1]
        if self.pooled:
            count = self.problem.observations
            return np.array([squares.sum() / count]), np.array([float(count)])
        lengths = np.array([float(len(group)) for group in self.groups])
        # motions are scaled to the root of their number of samples
        return squares / np.where(self.problem.in_bands, lengths, 1.0), self.independent

    def outgrown(self, unknowns: Unknowns) -> bool:
        if not self.inside:
            self.problem = self.set_up(self.problem.space.model(self.problem.model, unknowns.shared))
            return True
        return False

    def covariance_parts(self, unknowns: Unknowns, ridge: np.ndarray) -> WeightedProducts:
        """As in `AbstractPart`; with a pooled error, variances and inflations are those of the groups.

        A motion's residual then counts as many times as it has independent samples. Variances are raised for the share that
        the parameters and their prior have absorbed.
        """
        parts = super().covariance_parts(unknowns, ridge)
        if not self.pooled:
            return parts
        products, weight, *_ = parts
        whole = np.einsum("rgkl,rg->kl", products[..., :-1, :-1], weight)
        used = float(np.trace(np.linalg.solve(whole + np.diag(ridge**2), whole)))
        total = float(self.independent.sum())
        variance = np.array([float(np.mean(group**2)) for group in self.groups]) * total / max(total - used, 1.0)
        return products, weight, variance[None], self.inflation[None]
