"""A fit with some effects in the model, and its residual in every motion."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.eliminated_least_squares import minus_two_log_likelihood
from calibration.discovery.linearisations import Linearisation
from calibration.discovery.study import Study


class ResidualSummary(NamedTuple):
    """Residual above the noise floor, by motion and frequency region.

    Attributes:
        squares: Sum over degrees of freedom of (residual / floor)^2 less 1, by series and region (s, 3).
        parts: Root mean square above the floor (m, rad), by series and region (s, 3). Regions: see `Study.by_region`.
        likelihood: -2 ln L by series (s,).
    """

    squares: np.ndarray
    parts: np.ndarray
    likelihood: np.ndarray

    @classmethod
    def of(cls, study: Study, residual: np.ndarray) -> "ResidualSummary":
        """The summary of a residual given in rows (n,)."""
        above = study.dof * np.maximum(study.mean_squares(residual) - 1, 0.0)
        samples = np.array([series.samples for series in study.series])
        squares = study.by_region(study.pooled * np.maximum(study.levels(residual) - 1, 0.0))
        parts = np.sqrt(study.by_region(above * study.floor**2) / samples[:, None])
        return cls(squares, parts, minus_two_log_likelihood(study, residual))

    @property
    def error(self) -> np.ndarray:
        """Root mean square above the floor by series (s,; m, rad)."""
        return np.sqrt((self.parts**2).sum(axis=1))


@dataclass(frozen=True)
class FitState:
    """A fit with some effects in the model.

    Attributes:
        chosen: The effects in the model.
        linearisation: Linearisation at the fitted point.
        residual: Residual of all tests, in rows (n,).
        settled: Whether the fit converged.
        iterations: Iterations taken.
        likelihood: -2 ln L by series (s,).
        summary: Residual above the noise floor.
    """

    chosen: tuple[Candidate, ...]
    linearisation: Linearisation
    residual: np.ndarray
    settled: bool
    iterations: int
    likelihood: np.ndarray
    summary: ResidualSummary
