"""Simulations of the decays of a campaign, one by one, all by the same compiled programs."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from calibration.discovery.residual_slopes import Frame, decay_residual, decay_slopes
from calibration.residuals.decays import DecayData, DecayProblem, padded


@dataclass(frozen=True)
class DecaySimulations:
    """Simulations of the decays of a campaign.

    Attributes:
        problem: The decays.
        size: Numbers of samples and of steps that decays are padded to, so that studies share programs.
        width: Number of directions that are differentiated at a time.
    """

    problem: DecayProblem
    size: tuple[int, int]
    width: int

    @cached_property
    def padded_data(self) -> list[DecayData]:
        """The decays one by one, padded."""
        leaves, kind = jax.tree.flatten(padded(self.problem.data, *self.size))
        return [jax.tree.unflatten(kind, decay) for decay in zip(*leaves, strict=True)]

    @cached_property
    def problem_without_data(self) -> DecayProblem:
        """The problem of the decays without their records: one program serves any number of them."""
        return eqx.tree_at(lambda problem: problem.data, self.problem, None)

    def run(self, program: Callable[..., Any], where: Any, own: np.ndarray, i: int) -> Any:
        """Result of a program of a decay, without the padding.

        Args:
            program: `decay_residual` or `decay_slopes`.
            where: Its point or frame.
            own: Own unknowns of the decay (o,).
            i: Number of the decay.
        """
        result = program(self.problem_without_data, where, jnp.asarray(own), self.padded_data[i])
        samples = self.problem.data.time.shape[1]
        return jax.tree.map(lambda array: np.asarray(array)[:, :samples], result)

    def compile(self, x: np.ndarray) -> None:
        """Compile the programs, unless they are; for a thread beside other work.

        Args:
            x: Any parameter coordinates (p,).
        """
        where, own = jnp.asarray(x), np.zeros(3 * len(self.problem.data.dofs))
        frame = Frame(where, jnp.zeros((len(x), self.width)))
        for program, at in ((decay_residual, where), (decay_slopes, frame)):
            self.run(program.prepare, at, own, 0)
