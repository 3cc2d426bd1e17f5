"""Objective of a global search: J of many points of the unit cube at once."""

import math
from collections.abc import Mapping, Sequence

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from calibration.parameters.space import ParameterSpace
from calibration.parameters.transforms import Interval, LogInterval
from calibration.residuals.decays import DecayProblem, shortened
from jaxhydro.dynamics.model import Model
from jaxhydro.errors import InputError
from jaxhydro.errors import Problem as Wrong

EDGE_SHARE = 1e-6  # shares of a range are kept this far from its ends, where the coordinate is infinite


@eqx.filter_jit
def objectives(
    problem: DecayProblem,
    own: Float[Array, "r 3*c"],
    weight: Float[Array, "r c"],
    until: Float[Array, " r"],
    x: Float[Array, "n p"],
) -> Float[Array, " n"]:
    """J = sum of weight times RMSE over records and channels, over the samples up to `until` (s, by record), of n points.

    With `weight` (1/m, 1/rad) 1 over the standard deviation of what was measured in the released channels, 0 in the others, it
    is the contract's J. `own` are the records' releases. A sensor's offset is linear in the residual, so its least-squares
    value, the mean, is taken off exactly: that of `own` does not matter. Not a number where a simulation is none.
    """

    def of_point(x: Float[Array, " p"]) -> Float[Array, ""]:
        def of_record(inputs):
            own, record, weight = inputs
            record = shortened(record)
            seen = record.present * (record.time <= record.until)
            samples = jnp.maximum(seen.sum(axis=-1), 1.0)
            residual = problem.motion(x, own, record) - record.measured
            mean = (residual * seen).sum(axis=-1, keepdims=True) / samples[:, None]
            return weight @ jnp.sqrt((((residual - mean) * seen) ** 2).sum(axis=-1) / samples)

        return jax.lax.map(of_record, (own, problem.up_to(until).data, weight)).sum()

    return jax.vmap(of_point)(x)


def _scales(space: ParameterSpace) -> np.ndarray:
    """coordinate = scale * logit(share of the range), by parameter. Raises ValueError for one without a range."""
    found = []
    for p in space.free:
        if not isinstance(p.transform, LogInterval | Interval):
            raise ValueError(f"{p.label}: expected a lower and an upper bound to search between, found none")
        found.append(0.25 * p.transform.span if isinstance(p.transform, LogInterval) else 1.0)
    return np.array(found)


def coordinates(space: ParameterSpace, shares: np.ndarray) -> np.ndarray:
    """Coordinates (n, p) of points in the unit cube: shares of every range, of its logarithm's where positive."""
    inside = np.clip(shares, EDGE_SHARE, 1 - EDGE_SHARE)
    return _scales(space) * np.log(inside / (1 - inside))


def ranges(
    model: Model, labels: Sequence[str], given: Mapping[str, tuple[float, float]], factor: float, source: str
) -> dict[str, tuple[float, float]]:
    """What is searched: the bounds that are given, else from 1/factor to factor times the model's value, within what is
    physical. Raises InputError for a parameter of value zero or of either sign that has no bounds."""
    found, problems = dict(given), []
    for label in labels:
        value, about = float(model.values[label]), model.about(label)
        if label in given:
            continue
        lower, upper = max(value / factor, about.lower), min(value * factor, about.upper)
        if about.lower < 0 or not 0 < lower < upper or not math.isfinite(upper):
            expected = "bounds to search between, as there is no range about a value of zero or of either sign"
            problems.append(Wrong(f"calibrate.bounds.{label}", expected, f"none, and a value of {value:g}"))
        found[label] = (lower, upper)
    if problems:
        raise InputError(source, problems)
    return found
