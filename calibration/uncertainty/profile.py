"""Profile likelihood of one parameter."""

from __future__ import annotations

from dataclasses import dataclass

import jax.numpy as jnp
import numpy as np
import optimistix as optx
import scipy  # its parts are imported when they are used: that takes a second

from calibration.fitting.levenberg_marquardt import descend
from calibration.fitting.normal_equations import ArrowMatrix, LeastSquares, normal_equations
from calibration.formatting import number, readable_unit
from calibration.residuals.abstract_residual import Unknowns
from calibration.uncertainty.likelihood import DEFAULT_LEVEL, Likelihood
from jaxhydro.interrupts import stop_if_asked

SIGNED_ROOT_STEP = 0.7  # of the signed root from one point of the grid to the next: three points to the 95 % level's 1.96
MAX_ROOT_STEP = 1.5  # what is farther away is gone to in smaller steps
MAX_GRID_POINTS = 16  # points on either side at most: steps double where nothing happens, so that is far
MAX_REFIT_SHARE = 0.01  # of the drop at the level: what a refit may leave


@dataclass(frozen=True, eq=False)
class Profile:
    """Profile likelihood of one parameter: rise of -2 log likelihood, all other unknowns refitted.

    Attributes:
        label: Name of the parameter.
        unit: Unit of the parameter.
        estimate: Calibrated value, in `unit`.
        grid: (n,) values, ascending, in `unit`.
        coordinate: (n,) coordinates of these values.
        drop: (n,) rise of -2 log likelihood, adjusted for errors that are neither white nor of known size (Kent 1982).
        lower: Lower end of the interval; None where the records do not bound the parameter.
        upper: Upper end of the interval; None where the records do not bound the parameter.
        level: Probability of the interval.
        laplace: Interval by the fit's covariance.
        nu: Divisor of the drop of the sum of squares.
    """

    label: str
    unit: str
    estimate: float
    grid: np.ndarray
    coordinate: np.ndarray
    drop: np.ndarray
    lower: float | None
    upper: float | None
    level: float
    laplace: tuple[float, float]
    nu: float

    @property
    def interval(self) -> tuple[float | None, float | None]:
        return self.lower, self.upper

    def holds(self, value: float) -> bool:
        """Whether a value is in the interval.

        Args:
            value: The value, in the parameter's unit.
        """
        return (self.lower is None or value >= self.lower) and (self.upper is None or value <= self.upper)

    def __str__(self) -> str:
        unit = f" {shown}" if (shown := readable_unit(self.unit)) else ""
        low, high = ("" if x is None else number(x, 3) for x in self.interval)
        if not low and not high:
            return f"{self.label}: the records bound it on neither side"
        words = f"between {low} and {high}{unit}" if low and high else f"at {'least' if low else 'most'} {low or high}{unit}"
        return f"{self.label}: {words} ({100 * self.level:.0f} %)"


def _held(unknowns: Unknowns, args):
    """`normal_equations` with one shared coordinate held at a value.

    Nothing depends on that coordinate, so that no step moves it.
    """
    fit, index, value = args
    held = unknowns._replace(shared=unknowns.shared.at[index].set(value))
    info, products = normal_equations(held, fit)
    free = jnp.ones(len(held.shared)).at[index].set(0.0)
    gradient = info.grad._replace(shared=info.grad.shared * free)
    matrix = ArrowMatrix(info.hessian.shared * jnp.outer(free, free), info.hessian.cross * free[:, None], info.hessian.own)
    return optx.FunctionInfo.EvalGradHessian(info.f, gradient, matrix), products


class _Refit:
    """Q and the other unknowns with one coordinate held."""

    def __init__(self, likelihood: Likelihood, label: str, level: float) -> None:
        fit = likelihood.fit
        self.index, self.start = likelihood.index(label), fit.unknowns
        self.nu, self.move = likelihood.stretch(label)
        self.ridge = np.array(fit.ridge)
        if not np.isfinite(likelihood.free(label).prior_deviation):
            self.ridge[self.index] = 0.0  # a vague prior is no record
        self.mean, self.weight = np.asarray(fit.mean), np.asarray(fit.decays.weight)
        self.args = LeastSquares(
            (fit.decays.problem,), (jnp.asarray(self.weight),), jnp.asarray(self.mean), jnp.asarray(self.ridge)
        )
        self.size = 1.0  # of Q, for a tolerance relative to it: a fit normalises its weights so
        self.gain = MAX_REFIT_SHARE * self.nu * float(scipy.stats.chi2.ppf(level, 1))

    def moved(self, unknowns: Unknowns, step: float) -> Unknowns:
        """Unknowns after a step of the held coordinate, to first order."""
        p, move = len(unknowns.shared), jnp.asarray(self.move * step)
        return Unknowns(unknowns.shared + move[:p], unknowns.own + move[p:].reshape(unknowns.own.shape))

    def __call__(self, unknowns: Unknowns, value: float) -> tuple[float, Unknowns]:
        """Q and the unknowns with the coordinate at `value`, begun from `unknowns`."""
        args = (self.args, jnp.asarray(self.index), jnp.asarray(value))
        cost, reached = np.inf, unknowns
        for now in descend(_held, unknowns, args, self.gain / self.size):
            shared = now.unknowns.shared.at[self.index].set(value)
            rest = float(np.sum((self.ridge * (np.asarray(shared) - self.mean)) ** 2))
            cost = float(np.sum(np.asarray(now.aux[0])[..., -1, -1] * self.weight)) + rest
            reached = now.unknowns._replace(shared=shared)
        return cost, reached


def profile(likelihood: Likelihood, label: str, level: float = DEFAULT_LEVEL) -> Profile:
    """Compute the profile likelihood of a free parameter.

    It goes outwards from the estimate on either side, until the drop exceeds the level or the parameter's range ends. For a
    model that is linear in its unknowns the interval is that of the covariance.

    Args:
        likelihood: Likelihood of a finished fit.
        label: Name of the parameter.
        level: Probability of the interval.

    Returns:
        The profile and its interval.

    Raises:
        InputError: If the label is unknown.

    References:
        Wilks 1938, Annals of Mathematical Statistics 9, 60-62: (min Q | psi - min Q) / nu is a chi-square of one degree of
        freedom, nu by `Likelihood.stretch`.
    """
    refit = _Refit(likelihood, label, level)
    estimate = float(likelihood.estimate[refit.index])
    lowest, start = refit(refit.start, estimate)
    refit.size = lowest
    points = {estimate: lowest}
    for sign in (-1, 1):
        points |= _outward(refit, likelihood, label, estimate, lowest, start, sign, level)
    x = np.array(sorted(points))
    cost = np.array([points[c] for c in x])
    x, cost = x[np.isfinite(cost)], cost[np.isfinite(cost)]
    # a parameter that is hardly known may have been left short of the lowest point
    drop = (cost - cost.min()) / refit.nu
    limit, middle = float(np.sqrt(scipy.stats.chi2.ppf(level, 1))), int(np.argmin(cost))
    ends = [_crossing(x[: middle + 1][::-1], drop[: middle + 1][::-1], limit), _crossing(x[middle:], drop[middle:], limit)]
    lower, upper = (None if end is None else likelihood.value(label, end) for end in ends)
    about = likelihood.fit.decays.problem.model.about(label)
    return Profile(
        label,
        about.unit,
        likelihood.value(label, estimate),
        np.array([likelihood.value(label, c) for c in x]),
        x,
        drop,
        lower,
        upper,
        level,
        likelihood.interval(label, level),
        refit.nu,
    )


def _outward(
    refit: _Refit,
    likelihood: Likelihood,
    label: str,
    estimate: float,
    lowest: float,
    unknowns: Unknowns,
    sign: int,
    level: float,
) -> dict[float, float]:
    """Q by coordinate on one side, its points even in the signed root."""
    transform, limit = likelihood.free(label).transform, float(np.sqrt(scipy.stats.chi2.ppf(level, 1)))
    points: dict[float, float] = {}
    root, x = 0.0, estimate
    step = SIGNED_ROOT_STEP * float(likelihood.deviation()[refit.index])
    while len(points) < MAX_GRID_POINTS and not (points and transform.at_bound(x)):
        stop_if_asked()
        cost, reached = refit(refit.moved(unknowns, sign * step), x + sign * step)
        before, root = root, float(np.sqrt(max(cost - lowest, 0.0) / refit.nu))
        if not root - before < MAX_ROOT_STEP:  # a long step that the others do not follow in a straight line
            unmoved_cost, unmoved = refit(unknowns, x + sign * step)
            if unmoved_cost < cost or not np.isfinite(cost):
                cost, reached, root = unmoved_cost, unmoved, float(np.sqrt(max(unmoved_cost - lowest, 0.0) / refit.nu))
        points[x + sign * step] = cost
        if not root - before < MAX_ROOT_STEP:  # too far to draw a line through, or a motion that has run away
            step, root = 0.4 * step, before
            continue
        x, unknowns = x + sign * step, reached
        if root > limit:
            break
        step *= float(np.clip(SIGNED_ROOT_STEP / max(root - before, 1e-9), 0.5, 2.0))
    return points


def _crossing(x: np.ndarray, drop: np.ndarray, limit: float) -> float | None:
    """Coordinate where the root of the drop first reaches the limit outwards; None where it does not."""
    root = np.sqrt(drop)
    beyond = np.flatnonzero(root > limit)
    if not len(beyond):
        return None
    last = int(beyond[0])
    rising = [0]
    rising += [k for k in range(1, last + 1) if root[k] > root[rising[-1]] + 1e-9]
    return float(scipy.interpolate.PchipInterpolator(root[rising], x[rising])(limit)) if len(rising) > 1 else None
