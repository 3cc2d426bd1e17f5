"""Static offsets and natural periods within a fit: errors and weights."""

from typing import ClassVar

import numpy as np
from jaxtyping import Array, Float

from calibration.fitting.weighted_residuals import AbstractPart, Kind, Loss, ResidualErrors, mean_square
from calibration.residuals.abstract_residual import Unknowns
from calibration.residuals.static import OffsetProblem, PeriodProblem
from jaxhydro.exported_programs import exported_jit

MIN_OFFSET_ERROR = 1e-3  # share of the held motion below which a fit proves nothing


class OffsetPart(AbstractPart):
    """Static offsets within a fit, all of one error."""

    kind: ClassVar[Kind] = "offsets"
    problem: OffsetProblem

    def __init__(self, problem: OffsetProblem, loss: Loss = "squares") -> None:
        super().__init__(loss)
        self.problem, self.weight = problem, np.ones((1, 1))

    def estimate(self, unknowns: Unknowns) -> ResidualErrors:
        (residual,) = _residuals(self.problem, unknowns.shared)
        variance = max(2.0 * mean_square(np.asarray(residual), self.loss), MIN_OFFSET_ERROR**2)
        return ResidualErrors(np.array([[variance]]), np.ones((1, 1)))

    def mean_squares(self) -> tuple[np.ndarray, np.ndarray]:
        assert self.products is not None, "nothing has been minimised yet"
        count = np.array([float(len(self.problem.compared))])
        return self.products[0, :, -1, -1] / count, count


class PeriodPart(AbstractPart):
    """Stated natural periods within a fit: their errors are stated, too."""

    kind: ClassVar[Kind] = "periods"
    robust: ClassVar[bool] = False
    problem: PeriodProblem

    def __init__(self, problem: PeriodProblem) -> None:
        super().__init__()
        self.problem, self.weight = problem, np.ones((1, 1))

    def estimate(self, unknowns: Unknowns) -> ResidualErrors:
        return ResidualErrors(np.ones((1, 1)), np.ones((1, 1)))

    def mean_squares(self) -> tuple[np.ndarray, np.ndarray]:
        return np.zeros(0), np.zeros(0)


@exported_jit
def _residuals(problem: OffsetProblem, x: Float[Array, " p"]) -> tuple[Float[Array, " n"]]:
    return problem.residuals(x)
