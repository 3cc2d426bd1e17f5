"""Posterior draws of the free parameters, with credible intervals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from calibration.uncertainty.likelihood import DEFAULT_LEVEL, Likelihood

if TYPE_CHECKING:
    from arviz import InferenceData


@dataclass(frozen=True, eq=False)
class Samples:
    """Posterior draws of the free parameters.

    Attributes:
        labels: Names of the p parameters.
        coordinate: (chain, draw, p) coordinates.
        value: (chain, draw, p) values, in the parameters' units.
        r_hat: (p,) agreement of the halves of all chains, 1 once they agree (Gelman et al. 2013, equation 11.4).
        effective: (p,) effective number of independent draws.
        divergences: Number of divergent steps.
        seed: Seed of the random numbers.
        asked: Draws asked for in each chain; there are fewer where it was stopped.
        likelihood: Likelihood of the fit.
    """

    labels: tuple[str, ...]
    coordinate: np.ndarray
    value: np.ndarray
    r_hat: np.ndarray
    effective: np.ndarray
    divergences: int
    seed: int
    asked: int
    likelihood: Likelihood

    def deviation(self) -> np.ndarray:
        """Standard deviations (p,) of the coordinates."""
        return np.asarray(self.coordinate.reshape(-1, len(self.labels)).std(axis=0, ddof=1))

    def interval(self, label: str, level: float = DEFAULT_LEVEL) -> tuple[float, float]:
        """Equal-tailed credible interval of a parameter, in its own unit.

        Args:
            label: Label of the parameter.
            level: Probability of the interval.

        Returns:
            Lower and upper end.

        Raises:
            InputError: The label is unknown.
        """
        draws = self.value[..., self.likelihood.index(label)].ravel()
        low, high = np.quantile(draws, [0.5 - 0.5 * level, 0.5 + 0.5 * level])
        return float(low), float(high)

    def __repr__(self) -> str:
        """Numbers of chains, draws and parameters, and whether the chains agree."""
        chains, draws, count = self.value.shape
        agree = f"R-hat at most {float(np.max(self.r_hat)):.3f}, at least {float(np.min(self.effective)):.0f} effective draws"
        return f"Samples: {chains} chains of {draws} draws of {count} parameters; {agree}; {self.divergences} divergent steps"

    def to_arviz(self) -> InferenceData:
        """Draws as ArviZ's inference data (an extra: pip install jaxhydro[arviz]).

        Returns:
            Inference data whose group `posterior` has a variable for each parameter, by chain and draw, in its own unit.

        Raises:
            ImportError: ArviZ is not installed.
        """
        from calibration.display.arviz_draws import inference_data

        return inference_data(self)
