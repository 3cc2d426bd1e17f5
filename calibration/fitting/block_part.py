"""Tests in waves within a fit by blocks (multiple shooting): errors, weights and jumps between blocks."""

from collections.abc import Callable
from typing import ClassVar

import numpy as np
from jaxtyping import Array, Float

from calibration.fitting.weighted_residuals import AbstractPart, Kind, ResidualErrors
from calibration.formatting import listed, percent
from calibration.identifiability.information import pseudo_inverse
from calibration.identifiability.standard_deviations import WeightedProducts, correlated_samples, gauss_newton_matrix
from calibration.residuals.abstract_residual import Unknowns
from calibration.residuals.seas import SeaProblem
from calibration.residuals.shooting import BlockProblem, set_up_blocks, simulate_blocks, slowest
from jaxhydro.dynamics.model import Model
from jaxhydro.environment import DOFS

# largest error that a fit begins with: at first the coefficients cause most of the residual, not the model
INITIAL_ERROR = 0.1
MIN_POOLED_ERROR = 1e-6  # of a motion, over its standard deviation: that of a record made without noise


class BlockPart(AbstractPart):
    """Tests in waves within a fit by blocks.

    Each motion of a test counts as one observation, and all motions have the same error. The prior of a block's own
    unknowns weighs as one observation times the block's share of the test. The prior of a constant weighs as one.

    Attributes:
        set_up: Function from a model to its residuals, in seas prepared for its motion.
        groups: Residuals by motion of a test, where errors were last estimated.
    """

    kind: ClassVar[Kind] = "waves"
    problem: BlockProblem

    def __init__(self, set_up: Callable[[Model], SeaProblem], model: Model) -> None:
        super().__init__()
        sea = set_up(model)
        self.set_up, self.period = set_up, slowest(sea)
        self.problem = set_up_blocks(sea, self.period)
        self.nuisances = self.problem.observations
        self.groups: list[np.ndarray] = []
        self.weight = np.ones((len(self.problem.piece), len(self.problem.dofs) + 1))

    def parameters(self, unknowns: Unknowns) -> Float[Array, " p"]:
        """Coordinates of the parameters (p,)."""
        return unknowns.shared[: len(self.problem.space.free)]

    def share(self) -> np.ndarray:
        """Share of each block in the samples of its test (b,)."""
        counts = np.concatenate([np.asarray((blocks.factor > 0).any(axis=1).sum(axis=1)) for blocks in self.problem.blocks])
        test = np.asarray(self.problem.piece).min(axis=1)
        return counts / np.array([counts[test == index].sum() for index in test])

    def begin_round(self, unknowns: Unknowns) -> None:
        """Start motions that are not fitted from the continuous run with the present coefficients."""
        self.problem = self.problem.continued(self.parameters(unknowns))

    def estimate(self, unknowns: Unknowns) -> ResidualErrors:
        self.shot = simulate_blocks(self.problem, unknowns)
        residual, piece = np.asarray(self.shot.residual), np.asarray(self.problem.piece)
        present = np.concatenate(
            [
                np.pad(f, ((0, 0), (0, 0), (0, residual.shape[2] - f.shape[2])))
                for f in (np.asarray(blocks.factor) > 0 for blocks in self.problem.blocks)
            ]
        )
        self.groups = [residual[(piece == i)[..., None] & present] for i in range(self.problem.observations)]
        error = np.sqrt(sum(float(np.sum(group**2)) for group in self.groups) / self.problem.observations)
        if self.errors is None:
            error = min(error, INITIAL_ERROR)
        same = np.ones((len(piece), len(self.problem.dofs)))
        return ResidualErrors(same * max(error, MIN_POOLED_ERROR) ** 2, same)

    def weigh(self, errors: ResidualErrors) -> np.ndarray:
        """Weights of the squares, by block and channel.

        The last column weighs the prior of the block's own unknowns.
        """
        return np.column_stack([super().weigh(errors), self.share()])

    def mean_squares(self) -> tuple[np.ndarray, np.ndarray]:
        assert self.products is not None, "nothing has been minimised yet"
        count = self.problem.observations
        return np.array([self.products[:, :-1, -1, -1].sum() / count]), np.array([float(count)])

    def outgrown(self, unknowns: Unknowns) -> bool:
        if (np.asarray(self.shot.beyond) <= 0).all():
            return False
        sea = self.set_up(self.problem.space.model(self.problem.model, self.parameters(unknowns)))
        self.problem = set_up_blocks(sea, self.period)  # as many blocks each time
        return True

    def covariance_parts(self, unknowns: Unknowns, ridge: np.ndarray) -> WeightedProducts:
        """Groups for `sandwich_covariance`, with the blocks' own unknowns eliminated.

        There is one group for each motion of a test. Then there is one for the priors of own unknowns of each test, and one for
        the priors of the constants. Variances are raised for the share that all unknowns and their priors have absorbed.
        """
        assert self.products is not None, "nothing has been minimised yet"
        problem, weight, piece = self.problem, self.weight, np.asarray(self.problem.piece)
        p, m = len(problem.space.free), problem.observations
        bread = np.einsum("bckl,bc->bkl", self.products[..., :-1, :-1], weight)
        own_count = bread.shape[-1] - p - m
        motions_only = np.einsum("bckl,bc->bkl", self.products[:, :-1], weight[:, :-1])
        data = gauss_newton_matrix(motions_only, p + m)
        prior = np.diag(np.concatenate([ridge**2, np.repeat(weight[:, -1], own_count)]))
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
        weights = [*np.full(m, weight[0, 0]), *weights, ridge[-1] ** 2]
        variance = [float(np.mean(g**2)) * total / max(total - used, 1.0) for g in self.groups] + [1.0] * (len(priors) + 1)
        inflation = [correlated_samples(g) for g in self.groups] + [1.0] * (len(priors) + 1)
        return stack[None], np.array(weights)[None], np.array(variance)[None], np.array(inflation)[None]

    @property
    def jumps(self) -> dict[str, float]:
        """Root mean square jump between consecutive blocks, by degree of freedom.

        It is relative to the standard deviation of the motion.
        """
        piece = np.asarray(self.problem.piece)
        span = np.concatenate([np.asarray(blocks.span) for blocks in self.problem.blocks])
        last, first = np.asarray(self.shot.last), np.asarray(self.shot.first)
        wide = np.append(np.asarray(self.problem.wide), np.inf)
        jumps = {}
        for j, dof in enumerate(self.problem.dofs):
            index = np.flatnonzero((span > 0) & (piece[:, j] < len(wide) - 1))
            if len(index):
                jump = (first[index + 1, j] - last[index, j]) / wide[piece[index, j]]
                jumps[DOFS[dof]] = float(np.sqrt(np.mean(jump**2)))
        return jumps

    def notes(self) -> tuple[str, ...]:
        sizes = listed([f"{percent(jump)} in {dof}" for dof, jump in self.jumps.items()])
        blocks = f"{len(self.problem.piece)} blocks that start anew"
        jumps = f"From one to the next the simulated motion jumps by {sizes} of its standard deviation (root mean square)"
        return (f"{blocks}. {jumps}. Large jumps say what the model lacks",)
