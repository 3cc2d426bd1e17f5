"""State of a calibration in waves by blocks (multiple shooting)."""

import math
from collections.abc import Callable, Iterator

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from calibration.fitting.levenberg_marquardt import DescentState, descend
from calibration.fitting.sea_descent import TOLERANCE, SeaFit
from calibration.formatting import listed, percent
from calibration.identifiability.directions import Identifiability, identifiability_at
from calibration.identifiability.information import pseudo_inverse
from calibration.identifiability.standard_deviations import Spread, correlated_samples, gauss_newton_matrix
from calibration.residuals.decays import Unknowns, condensed_decays
from calibration.residuals.seas import SeaProblem
from calibration.residuals.shooting import BlockProblem, set_up_blocks, simulate_blocks, slowest
from jaxhydro.dynamics.model import Model
from jaxhydro.environment import DOFS

# largest error that a fit begins with: at first the coefficients cause most of the residual, not the model
INITIAL_ERROR = 0.1


def objective(unknowns: Unknowns, args):
    """Residuals of the blocks with the priors of their own unknowns, of the other priors, for optimistix."""
    problem, weight, mean, ridge = args
    rows, products = condensed_decays(unknowns, problem, weight, jnp.zeros(len(weight)))
    return (rows, ridge * (unknowns.shared - mean)), products


class ShootingFit(SeaFit):
    """A calibration by blocks under way: as `SeaFit`, where a motion of a test is one observation. The prior of a block's own
    unknowns weighs as one of its share of the test, that of a constant as one."""

    problem: BlockProblem

    def __init__(self, set_up: Callable[[Model], SeaProblem], declared: Model, report: Callable[..., None]) -> None:
        self.period = 0.0

        def cut(model: Model) -> BlockProblem:
            sea = set_up(model)
            self.period = self.period or slowest(sea)  # as many blocks each time
            return set_up_blocks(sea, self.period)

        super().__init__(cut, declared, report)
        self.error = min(self.error, INITIAL_ERROR)

    def begin(self) -> Unknowns:
        return self.problem.begin()

    @property
    def x(self) -> Float[Array, " p"]:
        return self.unknowns.shared[: len(self.problem.space.free)]

    def share(self) -> np.ndarray:
        """Of every block, how much of its test it is."""
        counts = np.concatenate([np.asarray((one.factor > 0).any(axis=1).sum(axis=1)) for one in self.problem.blocks])
        test = np.asarray(self.problem.piece).min(axis=1)
        return counts / np.array([counts[test == one].sum() for one in test])

    def weight(self) -> np.ndarray:
        """What multiplies the squares, by block and channel; the last is the prior of its own unknowns."""
        error = max(self.error, 1e-6)
        channels = np.ones((len(self.problem.piece), len(self.problem.dofs)))
        return np.column_stack([channels, error**2 * self.share()])

    def ridge(self) -> np.ndarray:
        """The priors' rows, of parameters and constants."""
        return max(self.error, 1e-6) / np.append(self.width, np.ones(self.problem.observations))

    def descent(self) -> Iterator[DescentState]:
        self.problem = self.problem.continued(self.x)
        mean = jnp.append(self.mean, jnp.zeros(self.problem.observations))
        args = (self.problem, jnp.asarray(self.weight()), mean, jnp.asarray(self.ridge()))
        return descend(objective, self.unknowns, args, TOLERANCE)

    def squares(self) -> float:
        return float(self.products[:, :-1, -1, -1].sum())

    def residual_rms(self) -> tuple[float, bool]:
        self.shot = simulate_blocks(self.problem, self.unknowns)
        residual, piece = np.asarray(self.shot.residual), np.asarray(self.problem.piece)
        present = np.concatenate(
            [
                np.pad(f, ((0, 0), (0, 0), (0, residual.shape[2] - f.shape[2])))
                for f in (np.asarray(one.factor) > 0 for one in self.problem.blocks)
            ]
        )
        of = [(piece == i)[..., None] & present for i in range(self.problem.observations)]
        self.groups = [residual[one] for one in of]
        total = sum(float(np.sum(group**2)) for group in self.groups)
        return math.sqrt(total / self.problem.observations), bool((np.asarray(self.shot.beyond) <= 0).all())

    @property
    def jumps(self) -> dict[str, float]:
        """Root mean square jump from the end of a block to the start of the next, over the motion's standard deviation."""
        piece = np.asarray(self.problem.piece)
        span = np.concatenate([np.asarray(blocks.span) for blocks in self.problem.blocks])
        last, first = np.asarray(self.shot.last), np.asarray(self.shot.first)
        wide = np.append(np.asarray(self.problem.wide), np.inf)
        found = {}
        for j, dof in enumerate(self.problem.dofs):
            at = np.flatnonzero((span > 0) & (piece[:, j] < len(wide) - 1))
            if len(at):
                jump = (first[at + 1, j] - last[at, j]) / wide[piece[at, j]]
                found[DOFS[dof]] = float(np.sqrt(np.mean(jump**2)))
        return found

    @property
    def notes(self) -> tuple[str, ...]:
        said = listed([f"{percent(jump)} in {dof}" for dof, jump in self.jumps.items()])
        blocks = f"{len(self.problem.piece)} blocks that start anew"
        jumps = f"from the end of one to the start of the next the simulated motion jumps by {said} of its standard deviation"
        return (f"{blocks}: {jumps} (root mean square); large jumps say what the model lacks",)

    def identifiability(self) -> tuple[Spread, Identifiability]:
        """As of `SeaFit`, what is the blocks' own eliminated by a Schur complement each, and the constants with it."""
        problem, p, m = self.problem, len(self.problem.space.free), self.problem.observations
        weight, piece, ridge = self.weight(), np.asarray(problem.piece), self.ridge()
        bread = np.einsum("bckl,bc->bkl", self.products[..., :-1, :-1], weight)
        own = bread.shape[-1] - p - m
        data = gauss_newton_matrix(self.products[:, :-1].sum(axis=1), p + m)
        prior = np.diag(np.concatenate([ridge**2, np.repeat(weight[:, -1], own)]))
        # what is there for all channels but no data stays as its prior has it
        used = float(np.trace(np.linalg.solve(data + prior, data)))
        total = sum(len(g) / correlated_samples(g) for g in self.groups)
        follow = np.stack(
            [np.vstack([np.eye(p + m), -pseudo_inverse(b[p + m :, p + m :]) @ b[p + m :, : p + m]]) for b in bread]
        )
        reduced = np.einsum("bkp,bckl,blq->bcpq", follow, self.products[..., :-1, :-1], follow)
        tests = piece.min(axis=1)
        priors = [reduced[tests == test, -1].sum(axis=0) for test in np.unique(tests)]
        weights = [weight[tests == test, -1].mean() for test in np.unique(tests)]
        motions = [reduced[:, :-1][piece == i].sum(axis=0) for i in range(m)]
        constants = np.diag(np.append(np.zeros(p), np.ones(m)))
        stack = np.pad(np.stack([*motions, *priors, constants]), ((0, 0), (0, 1), (0, 1)))
        weights = [*np.ones(m), *weights, ridge[-1] ** 2]
        variance = [float(np.mean(g**2)) * total / max(total - used, 1.0) for g in self.groups] + [1.0] * (len(priors) + 1)
        inflation = [correlated_samples(g) for g in self.groups] + [1.0] * (len(priors) + 1)
        rows = (np.array(weights)[None], np.array(variance)[None], np.array(inflation)[None])
        source = "the tests in waves by blocks"
        return identifiability_at(
            problem.space, problem.model, np.asarray(self.x), (stack[None], *rows), ridge[:p], self.width, source
        )
