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
    releases: Float[Array, "r 3*c"],
    weight: Float[Array, "r c"],
    until: Float[Array, " r"],
    x: Float[Array, "n p"],
) -> Float[Array, " n"]:
    """Objective J of n points: sum of weight times RMSE over records and channels.

    A sensor's offset is linear in the residual. Its least-squares value is the mean, which is taken off exactly, so that the
    offsets in `releases` do not matter. J is not a number where a simulation gives none.

    Args:
        problem: The decay records and the model.
        releases: The records' own unknowns, (r, 3*c).
        weight: Weights (1/m, 1/rad), (r, c): 1 over the measured standard deviation in the released channels, else 0.
        until: End of the samples that count (s), (r,).
        x: Coordinates of the points, (n, p).
    """

    def of_point(x: Float[Array, " p"]) -> Float[Array, ""]:
        def of_record(inputs):
            release, record, weight = inputs
            record = shortened(record)
            counted = record.present * (record.time <= record.until)
            samples = jnp.maximum(counted.sum(axis=-1), 1.0)
            residual = problem.motion(x, release, record) - record.measured
            mean = (residual * counted).sum(axis=-1, keepdims=True) / samples[:, None]
            return weight @ jnp.sqrt((((residual - mean) * counted) ** 2).sum(axis=-1) / samples)

        return jax.lax.map(of_record, (releases, problem.up_to(until).data, weight)).sum()

    return jax.vmap(of_point)(x)


def _scales(space: ParameterSpace) -> np.ndarray:
    """Scales (p,) in coordinate = scale * logit(share of the range).

    Raises:
        ValueError: A parameter has no range.
    """
    scales = []
    for p in space.free:
        if not isinstance(p.transform, LogInterval | Interval):
            raise ValueError(f"{p.label}: expected a lower and an upper bound to search between, found none")
        scales.append(0.25 * p.transform.span if isinstance(p.transform, LogInterval) else 1.0)
    return np.array(scales)


def coordinates(space: ParameterSpace, shares: np.ndarray) -> np.ndarray:
    """Coordinates (n, p) of points in the unit cube.

    Args:
        space: The free parameters.
        shares: Shares of each parameter's range, of the range of its logarithm where it is positive, (n, p).
    """
    inside = np.clip(shares, EDGE_SHARE, 1 - EDGE_SHARE)
    return _scales(space) * np.log(inside / (1 - inside))


def ranges(
    model: Model, labels: Sequence[str], bounds: Mapping[str, tuple[float, float]], factor: float, source: str
) -> dict[str, tuple[float, float]]:
    """Ranges that are searched, by label.

    Args:
        model: The model.
        labels: Labels of the parameters.
        bounds: Bounds by label. Others are searched from 1/factor to factor times the model's value, within physical limits.
        factor: The factor.
        source: Name of the file that errors refer to.

    Raises:
        InputError: A parameter of value zero or of either sign has no bounds.
    """
    searched, problems = dict(bounds), []
    for label in labels:
        value, about = float(model.values[label]), model.about(label)
        if label in bounds:
            continue
        lower, upper = max(value / factor, about.lower), min(value * factor, about.upper)
        if about.lower < 0 or not 0 < lower < upper or not math.isfinite(upper):
            expected = "bounds to search between, as there is no range about a value of zero or of either sign"
            problems.append(Wrong(f"calibrate.bounds.{label}", expected, f"none, and a value of {value:g}"))
        searched[label] = (lower, upper)
    if problems:
        raise InputError(source, problems)
    return searched
