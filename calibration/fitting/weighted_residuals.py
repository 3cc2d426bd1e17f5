"""Base class of the residuals of one kind in a fit, with their errors and weights."""

import abc
from typing import ClassVar, Literal, NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from calibration.identifiability.standard_deviations import WeightedProducts
from calibration.residuals.abstract_residual import AbstractGroupedResidual, AbstractResidual, Unknowns

Kind = Literal["decays", "waves", "offsets", "periods"]
Loss = Literal["squares", "cauchy"]
# standard deviations: Cauchy's loss is then 95 % efficient on normal errors (Holland and Welsch 1977, table 1)
CAUCHY_SCALE = 2.385


class ResidualErrors(NamedTuple):
    """Errors of residuals by record and group.

    Attributes:
        variance: Variance of a residual (r, g).
        inflation: Number of correlated samples that count as one (r, g).
    """

    variance: np.ndarray
    inflation: np.ndarray


class AbstractPart(abc.ABC):
    """Residuals of one kind within a fit.

    Attributes:
        kind: Kind of measurement.
        problem: The residuals.
        weight: Weights of their squares (r, g).
        errors: Their errors where these were last estimated; None before.
        products: Products of residuals and slopes at the last iteration (r, g, k, k); None before the first.
        nuisances: Number of shared unknowns that are no parameters, after these; each has a standard normal prior.
        robust: Whether Cauchy's loss applies to them, where it is asked for.
    """

    kind: ClassVar[Kind]
    robust: ClassVar[bool] = True
    nuisances: int = 0
    problem: AbstractResidual
    weight: np.ndarray

    def __init__(self, loss: Loss = "squares") -> None:
        self.loss: Loss = loss
        self.errors: ResidualErrors | None = None
        self.products: np.ndarray | None = None

    @abc.abstractmethod
    def estimate(self, unknowns: Unknowns) -> ResidualErrors:
        """Errors of the residuals, estimated from the residuals at some unknowns."""

    def weigh(self, errors: ResidualErrors) -> np.ndarray:
        """Weights (r, g) of the squares: 1 / (variance times inflation)."""
        return 1 / (errors.variance * errors.inflation)

    @abc.abstractmethod
    def mean_squares(self) -> tuple[np.ndarray, np.ndarray]:
        """Mean squares by group at the last iteration, and their numbers of independent observations."""

    def renew(self, unknowns: Unknowns) -> None:
        """Estimate errors and weights anew."""
        self.errors = self.estimate(unknowns)
        self.weight = self.weigh(self.errors)

    def begin_round(self, unknowns: Unknowns) -> None:  # noqa: B027
        """Set what stays fixed during a descent from some unknowns; most kinds have nothing to set."""

    @property
    def fitted(self) -> AbstractResidual:
        """The problem that is minimised: with Cauchy's loss, residuals cease to count by their squares."""
        if self.loss == "squares" or not self.robust:
            return self.problem
        assert self.errors is not None, "errors are estimated before a descent"
        tail = CAUCHY_SCALE * np.sqrt(self.errors.variance)
        tail = jnp.asarray(tail[0] if isinstance(self.problem, AbstractGroupedResidual) else tail)
        return eqx.tree_at(lambda problem: problem.tail, self.problem, tail, is_leaf=lambda leaf: leaf is None)

    def outgrown(self, unknowns: Unknowns) -> bool:
        """Whether the problem no longer holds at the present unknowns; then it has been set up anew."""
        return False

    def covariance_parts(self, unknowns: Unknowns, ridge: np.ndarray) -> WeightedProducts:
        """Products, weights, variances and inflations for `sandwich_covariance`, at the last iteration.

        Args:
            unknowns: The unknowns there.
            ridge: Square roots of the priors' weights, as in `LeastSquares`.
        """
        assert self.products is not None and self.errors is not None, "nothing has been minimised yet"
        return self.products, self.weight, *self.errors

    def notes(self) -> tuple[str, ...]:
        """Remarks on the fit of this kind."""
        return ()


def mean_square(residual: np.ndarray, loss: Loss) -> float:
    """Mean square about zero.

    With Cauchy's loss it is that of a normal distribution of the same median magnitude.
    """
    return float((1.4826 * np.median(np.abs(residual))) ** 2 if loss == "cauchy" else np.mean(residual**2))
