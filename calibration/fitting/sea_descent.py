"""State of a calibration in waves: rounds of descent, estimated error, identifiability."""

import math
from collections.abc import Callable, Iterator
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from calibration.fitting.levenberg_marquardt import DescentState, descend
from calibration.identifiability.directions import Identifiability, identifiability_at
from calibration.identifiability.standard_deviations import Spread, correlated_samples
from calibration.residuals.decays import condensed_groups
from calibration.residuals.seas import residuals_and_reach
from jaxhydro.dynamics.model import Model

MAX_ROUNDS = 4  # times that the model's error is estimated anew
ERROR_TOLERANCE = 0.05  # relative change of that estimate that is none
TOLERANCE = 1e-3  # relative decrease of the sum of squares that ends a round
# trust in a descent's first step (`descend`): logarithms of energies are far from linear in those of coefficients
FIRST_STEP_TRUST = 1.0


def _objective(x, args):
    """Residuals of the tests and of the prior, for optimistix."""
    problem, mean, ridge = args
    rows, products = condensed_groups(x, problem, jnp.ones(len(problem.in_bands)))
    return (rows, ridge * (x - mean)), products


class SeaFit:
    """State of a calibration in waves.

    Every parameter's prior weighs as one observation beside the tests' own. Their error is that of the model. It is
    estimated from the residuals, and the fit repeated, until both agree.
    """

    def __init__(self, set_up: Callable[[Model], Any], declared: Model, report: Callable[..., None]) -> None:
        self.set_up, self.report = set_up, report
        self.problem = problem = set_up(declared)
        self.mean, self.width = problem.space.prior
        self.unknowns, self.products = self.begin(), np.zeros(0)
        self.iterations, self.converged = 0, False
        self.history: list[float] = []
        self.groups: list[np.ndarray] = []
        self.error, _ = self.residual_rms()

    def begin(self) -> Any:
        """The unknowns that a descent starts from."""
        return self.problem.space.start

    @property
    def x(self) -> Float[Array, " p"]:
        """Coordinates of the free parameters."""
        return self.unknowns

    @property
    def notes(self) -> tuple[str, ...]:
        """What there is to say of the fit itself."""
        return ()

    def descent(self) -> Iterator[DescentState]:
        """Descend once, with the present error."""
        ridge = jnp.asarray(max(self.error, 1e-6) / self.width)
        return descend(_objective, self.unknowns, (self.problem, self.mean, ridge), TOLERANCE, FIRST_STEP_TRUST)

    def squares(self) -> float:
        """Sum of squared residuals over all observations, from the `products`."""
        return float(self.products[:, -1, -1].sum())

    def residual_rms(self) -> tuple[float, bool]:
        """Root mean square residual of an observation, and whether the hull stays within the prepared sea."""
        groups, inside = residuals_and_reach(self.problem, self.x)
        self.groups = [np.asarray(group) for group in groups]
        return math.sqrt(sum(float(np.sum(group**2)) for group in self.groups) / self.problem.observations), bool(inside)

    def run(self) -> None:
        """Run all rounds of descent and error estimate."""
        for number in range(MAX_ROUNDS):
            for i, now in enumerate(self.descent()):
                self.unknowns, self.products, self.converged = now.unknowns, np.asarray(now.aux), now.settled
                self.iterations += 1
                self.history.append(math.sqrt(self.squares() / self.problem.observations))
                share = (number + min(1.0, i / 10)) / MAX_ROUNDS
                self.report(f"round {number + 1} in waves", self.iterations, self.history[-1], share)
            before = self.error
            self.error, inside = self.residual_rms()
            if not inside:
                self.problem = self.set_up(self.problem.space.model(self.problem.model, self.x))
                self.converged = False
                self.error, _ = self.residual_rms()
            if self.converged and abs(self.error / before - 1) < ERROR_TOLERANCE:
                return

    def identifiability(self) -> tuple[Spread, Identifiability]:
        """Covariance of the coordinates, and what it says. A motion's residual counts as many times as it is independent; bands
        once each, with the variance that is left after what the parameters and their prior took."""
        groups, ridge = self.groups, self.error / self.width
        whole = self.products[:, :-1, :-1].sum(axis=0)
        used = float(np.trace(np.linalg.solve(whole + np.diag(ridge**2), whole)))
        total = sum(len(g) if bands else len(g) / correlated_samples(g) for g, bands in zip(groups, self.problem.in_bands))
        variance = np.array([float(np.mean(g**2)) for g in groups]) * total / max(total - used, 1.0)
        inflation = np.array([1.0 if bands else correlated_samples(g) for g, bands in zip(groups, self.problem.in_bands)])
        parts = (self.products[None], np.ones((1, len(groups))), variance[None], inflation[None])
        space, model = self.problem.space, self.problem.model
        return identifiability_at(space, model, np.asarray(self.x), parts, ridge, self.width, "the tests in waves")
