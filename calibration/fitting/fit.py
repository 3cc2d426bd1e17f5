"""A fit under way: residuals of any kinds, unknowns, covariance, rounds of error estimates."""

import math
from collections.abc import Callable, Sequence

import numpy as np
from jaxtyping import Array, Float

from calibration.fitting.decay_part import DecayPart
from calibration.fitting.levenberg_marquardt import DEFAULT_TRUST, descend
from calibration.fitting.normal_equations import LeastSquares, normal_equations
from calibration.fitting.weighted_residuals import AbstractPart
from calibration.identifiability.findings import Identifiability, identifiability_at
from calibration.identifiability.standard_deviations import Spread, WeightedProducts
from calibration.parameters.space import ParameterSpace
from calibration.residuals.abstract_residual import Unknowns
from jaxhydro.dynamics.model import Model
from jaxhydro.quick_jit import as_data, on_device

ERROR_TOLERANCE = 0.1  # change of the logarithm of an estimated variance that is none
# inverse of the damping at first of residuals in units of their errors: logarithms of energies are far from linear in those of
# coefficients
CAUTIOUS_TRUST = 1.0
USUAL_ITERATIONS = 10  # of a stage, for the reported progress

Report = Callable[[str, int, float, float], None]  # stage, iteration, objective, fraction done


class Fit:
    """A fit under way.

    Attributes:
        parts: Residuals by kind, with their weights.
        unknowns: Coordinates reached so far.
        mean: Means of the shared unknowns' priors.
        width: Standard deviations of these priors.
        ridge: Square roots of the priors' weights.
        iterations: Number of iterations so far.
        converged: Whether the last descent ended before the limit of iterations.
        history: Objective after every iteration.
    """

    def __init__(
        self,
        parts: Sequence[AbstractPart],
        unknowns: Unknowns,
        report: Report = lambda *_: None,
        objective: Callable[["Fit"], float] | None = None,
    ) -> None:
        self.parts, self.unknowns, self.report = tuple(parts), unknowns, report
        self.objective = remaining_error if objective is None else objective
        nuisances = sum(part.nuisances for part in parts)
        mean, width = self.space.prior
        self.mean, self.width = on_device(np.append(mean, np.zeros(nuisances))), np.append(width, np.ones(nuisances))
        self.ridge = 1 / self.width
        self.iterations, self.converged = 0, False
        self.history: list[float] = []

    @property
    def space(self) -> ParameterSpace:
        """The free parameters."""
        return self.parts[0].problem.space

    @property
    def x(self) -> Float[Array, " p"]:
        """Coordinates of the free parameters."""
        return self.unknowns.shared[: len(self.space.free)]

    @property
    def model(self) -> Model:
        """The model with the parameters reached so far."""
        return self.space.model(self.parts[0].problem.model, self.x)

    @property
    def decays(self) -> DecayPart:
        """The part of the decays; the fit has to have one."""
        return next(part for part in self.parts if isinstance(part, DecayPart))

    def minimise(self, stage: str, tolerance: float, fraction: tuple[float, float], trust: float = DEFAULT_TRUST) -> bool:
        """Levenberg-Marquardt from where the fit is, with the present weights.

        Args:
            stage: Name of the stage, for the report.
            tolerance: Smallest relative decrease of the weighted squares that is worth a further iteration.
            fraction: Share of the whole work that is done before and after this stage.
            trust: Inverse of the damping at first.

        Returns:
            Whether it ended before the limit of iterations.
        """
        weights = tuple(as_data(part.weight) for part in self.parts)
        args = LeastSquares(tuple(part.fitted for part in self.parts), weights, self.mean, as_data(self.ridge))
        begin, end = fraction
        for i, now in enumerate(descend(normal_equations, self.unknowns, args, tolerance, trust)):
            self.unknowns, self.converged = now.unknowns, now.settled
            for part, products in zip(self.parts, now.aux, strict=True):
                part.products = np.asarray(products)
            self.iterations += 1
            self.history.append(self.objective(self))
            done = begin + (end - begin) * min(1.0, i / USUAL_ITERATIONS)
            self.report(stage, self.iterations, self.history[-1], done)
        return self.converged

    def run_rounds(self, stage: str, rounds: int, tolerance: float) -> None:
        """Alternate descents and new estimates of the residuals' errors, until both agree.

        The error of each kind is that of the model, estimated from its residuals (iterated feasible least squares).

        Args:
            stage: Name of a stage, with {} for the number of the round.
            rounds: Largest number of rounds.
            tolerance: As in `minimise`.

        References:
            Seber and Wild 1989, Nonlinear Regression, section 2.8.8.
        """
        self.renew_errors()
        for number in range(rounds):
            for part in self.parts:
                part.begin_round(self.unknowns)
            before = [part.errors for part in self.parts]
            self.minimise(stage.format(number + 1), tolerance, (number / rounds, (number + 1) / rounds), CAUTIOUS_TRUST)
            self.renew_errors()
            if any([part.outgrown(self.unknowns) for part in self.parts]):
                self.converged = False
                self.renew_errors()
            pairs = zip(self.parts, before, strict=True)
            changes = [np.abs(np.log(part.errors.variance / old.variance)).max() for part, old in pairs]  # type: ignore[union-attr]
            if self.converged and max(changes) < ERROR_TOLERANCE:
                return

    def renew_errors(self) -> None:
        """Estimate errors and weights of all parts where the fit is."""
        for part in self.parts:
            part.renew(self.unknowns)

    def uncertainty(self, source: str) -> tuple[Spread, Identifiability]:
        """Covariance of the coordinates, and which parameters and combinations the records determine.

        Args:
            source: Description of the records.
        """
        p = len(self.space.free)
        parts = stacked([part.covariance_parts(self.unknowns, self.ridge) for part in self.parts], p)
        model = self.parts[0].problem.model
        return identifiability_at(self.space, model, np.asarray(self.x), parts, self.ridge[:p], self.width[:p], source)


def remaining_error(fit: Fit) -> float:
    """Geometric mean of the groups' root mean squares, weighted by their independent observations.

    It is NaN without observations.
    """
    squares, counts = (np.concatenate(arrays) for arrays in zip(*(part.mean_squares() for part in fit.parts), strict=True))
    if not len(counts):
        return math.nan
    return math.exp(0.5 * float(counts @ np.log(np.maximum(squares, 1e-300))) / float(counts.sum()))


def stacked(parts: Sequence[WeightedProducts], shared: int) -> WeightedProducts:
    """Stack products, weights, variances and inflations of several kinds.

    Args:
        parts: Those of each kind; at most one has unknowns of its own.
        shared: Number of shared unknowns.
    """
    size, groups = max(part[0].shape[-1] for part in parts), max(part[0].shape[1] for part in parts)
    products, rows = [], []
    for part_products, *others in parts:
        keep = np.r_[0 : part_products.shape[-1] - 1, size - 1]
        assert len(keep) in (size, shared + 1), "one kind at most has unknowns of its own"
        wide = np.zeros((*part_products.shape[:2], size, size))
        wide[..., keep[:, None], keep] = part_products
        more = [(0, 0), (0, groups - part_products.shape[1])]
        products.append(np.pad(wide, [*more, (0, 0), (0, 0)]))
        # what is not there has weight 0
        rows.append([np.pad(row, more, constant_values=float(i > 0)) for i, row in enumerate(others)])
    weight, variance, inflation = (np.concatenate(row) for row in zip(*rows, strict=True))
    return np.concatenate(products), weight, variance, inflation
