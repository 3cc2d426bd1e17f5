"""Draws of a bootstrap: refits by Gauss-Newton, many side by side, and their summary.

The draws go through one compiled program in one process, CHUNK_SIZE of them side by side in every operation. For a body without
members that halves the time of a refit. For a hull of hundreds of strips it takes as long as one after the other.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import scipy  # its parts are imported when they are used: that takes a second
from jaxtyping import Array, Float

from calibration.fitting.normal_equations import LeastSquares, clipped, normal_equations
from calibration.identifiability.information import WEAK_PRIOR_ROUNDING, pseudo_inverse
from calibration.residuals.abstract_residual import Unknowns
from calibration.residuals.decays import DecayProblem
from calibration.uncertainty.likelihood import DEFAULT_LEVEL, Likelihood
from jaxhydro.choices import check
from jaxhydro.interrupts import stop_if_asked

if TYPE_CHECKING:
    from arviz import InferenceData


CHUNK_SIZE = 16
MAX_STEPS = 12  # Gauss-Newton at most
MAX_STEP = 0.7  # step of a coordinate
MAX_LAST_STEP = 0.03  # standard deviations that the last step moves at most

Progress = Callable[[int, int], None]
Prior = tuple[Float[Array, " p"], Float[Array, " p"]]


@dataclass(frozen=True, eq=False)
class Bootstrap:
    """Bootstrap draws of the free parameters.

    Attributes:
        method: "repeats" or "blocks".
        labels: Names of the p parameters.
        coordinate: (d, p) coordinates of the draws.
        value: (d, p) values of the draws, in the parameters' units.
        estimate: (p,) coordinates of the fit.
        groups: Names of repeated tests by the first one's; or length of a block (s) by record.
        unsettled: Number of draws that had not converged; these are kept unless they diverged.
        seed: Seed of the random numbers.
        likelihood: Likelihood of the fit.
    """

    method: Literal["repeats", "blocks"]
    labels: tuple[str, ...]
    coordinate: np.ndarray
    value: np.ndarray
    estimate: np.ndarray
    groups: dict[str, tuple[str, ...] | float]
    unsettled: int
    seed: int
    likelihood: Likelihood

    def deviation(self) -> np.ndarray:
        """Standard deviations (p,) of the coordinates."""
        return np.asarray(self.coordinate.std(axis=0, ddof=1))

    def interval(
        self, label: str, level: float = DEFAULT_LEVEL, kind: Literal["percentile", "basic", "normal"] = "percentile"
    ) -> tuple[float, float]:
        """Confidence interval of a parameter, in its own unit.

        Args:
            label: Label of the parameter.
            level: Probability of the interval.
            kind: "percentile": quantiles of the draws. "basic": these mirrored at the estimate, which takes a bias off.
                "normal": the estimate and the draws' standard deviation, for which 50 draws are enough.

        Returns:
            Lower and upper end.

        Raises:
            InputError: The label is unknown.
            UnknownName: The kind is unknown.

        References:
            Davison and Hinkley 1997, chapter 5.
        """
        check(kind=(kind, ("percentile", "basic", "normal")))
        i, sides = self.likelihood.index(label), [0.5 - 0.5 * level, 0.5 + 0.5 * level]
        ends = np.quantile(self.coordinate[:, i], sides)
        if kind == "normal":
            ends = self.estimate[i] + scipy.stats.norm.ppf(sides) * self.deviation()[i]
        if kind == "basic":
            ends = (2 * self.estimate[i] - ends)[::-1]
        low, high = sorted(self.likelihood.value(label, float(x)) for x in ends)
        return low, high

    def __repr__(self) -> str:
        """Method, and numbers of draws and parameters."""
        draws, count = self.value.shape
        return f"Bootstrap over {self.method}: {draws} draws of {count} parameters, {self.unsettled} of them not converged"

    def to_arviz(self) -> InferenceData:
        """Draws as ArviZ's inference data (an extra: pip install jaxhydro[arviz]).

        Returns:
            Inference data whose group `posterior` has a variable for each parameter, by chain and draw, in its own unit. The
            draws are one chain. They are a sampling distribution, not a posterior: the attribute `method` says so.

        Raises:
            ImportError: ArviZ is not installed.
        """
        from calibration.display.arviz_draws import inference_data

        return inference_data(self)


@eqx.filter_jit
def _steps(
    problem: DecayProblem,
    unknowns: Unknowns,
    measured: Float[Array, "d r c t"],
    weight: Float[Array, "d r c"],
    prior: Prior,
) -> Unknowns:
    """One Gauss-Newton step of many draws at once, none longer than MAX_STEP."""

    def stepped(unknowns, measured, weight):
        resampled = eqx.tree_at(lambda q: q.data.measured, problem, measured)
        info, _ = normal_equations(unknowns, LeastSquares((resampled,), (weight,), *prior))
        step = clipped(info.hessian.solve(info.grad), MAX_STEP)
        return Unknowns(unknowns.shared - step.shared, unknowns.own - step.own)

    return jax.vmap(stepped)(unknowns, measured, weight)


def _linear(likelihood: Likelihood, measured: np.ndarray, weight: np.ndarray) -> Unknowns:
    """Unknowns of the draws by the slopes at the estimate.

    This needs no simulation, and is exact for a model that is linear in its unknowns.
    """
    fit, slope = likelihood.fit, likelihood.slope
    data, p = fit.decays.problem.data, len(fit.decays.problem.space.free)
    residual = likelihood.residual + (np.asarray(data.measured) - measured) * np.asarray(data.present)
    score = np.einsum("rctk,drct,drc->drk", slope, residual, weight)
    mean, ridge = map(np.asarray, (fit.mean, fit.ridge))
    shared = score[..., :p].sum(axis=1) + ridge**2 * (likelihood.estimate[:p] - mean)
    step = -np.concatenate([shared, score[..., p:].reshape(len(score), -1)], axis=1) @ pseudo_inverse(
        likelihood.hessian, WEAK_PRIOR_ROUNDING
    )
    step *= np.minimum(1.0, MAX_STEP / np.maximum(np.abs(step).max(axis=1, keepdims=True), 1e-300))
    own = fit.unknowns.own
    return Unknowns(fit.unknowns.shared + step[:, :p], own + step[:, p:].reshape(-1, *own.shape))


def refit_draws(
    likelihood: Likelihood,
    method: Literal["repeats", "blocks"],
    inputs: Callable[[slice], tuple[np.ndarray, np.ndarray]],
    draws: int,
    seed: int,
    groups: dict[str, tuple[str, ...] | float],
    progress: Progress | None,
) -> Bootstrap:
    """Refit all draws, CHUNK_SIZE at once."""
    fit = likelihood.fit
    prior = (jnp.asarray(fit.mean), jnp.asarray(fit.ridge))
    scale, coordinates, unsettled = likelihood.deviation(), [], 0
    for begin in range(0, draws, CHUNK_SIZE):
        series, weights = inputs(slice(begin, min(begin + CHUNK_SIZE, draws)))
        count = len(weights)
        # the last chunk is filled up, so that one compilation serves all
        fill = [(0, CHUNK_SIZE - count), (0, 0), (0, 0)]
        measured = jnp.asarray(np.pad(series, [*fill, (0, 0)], mode="edge"))
        weight = jnp.asarray(np.pad(weights, fill, mode="edge"))
        unknowns, change = _linear(likelihood, np.asarray(measured), np.asarray(weight)), np.full((CHUNK_SIZE, 1), np.inf)
        for _ in range(MAX_STEPS):
            stop_if_asked()
            before, unknowns = unknowns, _steps(fit.decays.problem, unknowns, measured, weight, prior)
            change = np.abs(np.asarray(unknowns.shared - before.shared)) / scale
            if (change < MAX_LAST_STEP).all() or not np.isfinite(change).any():
                break
        coordinates.append(np.asarray(unknowns.shared)[:count])
        unsettled += int((~np.asarray((change < MAX_LAST_STEP).all(axis=1))[:count]).sum())
        if progress is not None:
            progress(begin + count, draws)
    coordinate = np.concatenate(coordinates)
    coordinate = coordinate[np.isfinite(coordinate).all(axis=1)]  # a motion that ran away
    forward = [jax.vmap(p.transform.forward) for p in fit.decays.problem.space.free]
    value = np.stack([np.asarray(f(jnp.asarray(x))) for f, x in zip(forward, coordinate.T, strict=True)], axis=1)
    estimate = likelihood.estimate[: len(scale)]
    return Bootstrap(method, likelihood.labels, coordinate, value, estimate, groups, unsettled, seed, likelihood)
