"""Directions of the parameters that the records do not determine, known combinations, what to fix.

Everything is local and linear, about the fitted values, in the coordinates of the fit: logarithms of positive parameters
within their bounds. Information is that of the records alone; the fit's prior enters only where `covariance` is named.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from calibration.identifiability.information import (
    IDENTIFIABLE_DEVIATION,
    deviations_of,
    principal_directions,
    pseudo_inverse,
    varimax,
)
from calibration.identifiability.statements import Combination, Direction, Fix, Parameters
from calibration.parameters.space import VAGUE_DEVIATION

ZERO_VARIANCE = 1e-20  # variance of a coordinate that is rounding: fixed before, or collinear with what is
MIN_VARIANCE_GAIN = 0.01  # of the others' summed variance: what takes less away is no advice
MIN_NAMED_DEVIATION = 0.5 * IDENTIFIABLE_DEVIATION  # of a parameter that is named in a direction


def weak_directions(parameters: Parameters, information: np.ndarray, active: Sequence[int]) -> tuple[Direction, ...]:
    """Principal directions that are not known to IDENTIFIABLE_DEVIATION, least known first.

    Directions beyond VAGUE_DEVIATION are equally unknown, and any basis of their span is as good. The basis with the fewest
    parameters in each direction is reported (varimax).

    Args:
        parameters: The free parameters.
        information: (p, p) information of the records.
        active: Indices of the parameters that the records respond to.

    References:
        Kaiser 1958, Psychometrika 23, 187-200.
    """
    active = list(active)
    core = information[np.ix_(active, active)]
    deviation, axes = principal_directions(core)
    blind = deviation > VAGUE_DEVIATION
    axes[:, blind] = varimax(axes[:, blind])
    deviation = deviations_of(np.einsum("ik,ij,jk->k", axes, core, axes), np.abs(core).max(initial=0.0))
    order = [int(k) for k in np.argsort(-deviation, kind="stable") if deviation[k] > IDENTIFIABLE_DEVIATION]
    reach = np.abs(axes) * np.minimum(deviation, VAGUE_DEVIATION)
    named = [[int(i) for i in np.flatnonzero(reach[:, k] >= min(MIN_NAMED_DEVIATION, reach[:, k].max()))] for k in order]
    directions = []
    for k, members in zip(order, named, strict=True):
        combination = _combination(parameters, core, active, members) if len(members) > 1 else None
        if combination is None and len(members) > 1:
            # what other weak directions share with this one may be known together with it
            joint = sorted(set(members).union(*(others for others in named if set(others) & set(members))))
            combination = _combination(parameters, core, active, joint)
        change = (axes[:, k] * parameters.relative()[active])[members]
        change *= 0.1 / change[np.abs(change).argmax()] * np.sign(change[0] * change[np.abs(change).argmax()])
        movement = {parameters.labels[active[i]]: float(c) for i, c in zip(members, change, strict=True)}
        directions.append(Direction(movement, float(deviation[k]), combination))
    return tuple(directions)


def active_parameters(
    parameters: Parameters, information: np.ndarray, at_bound: Sequence[str]
) -> tuple[list[int], tuple[str, ...]]:
    """Indices of parameters that the records respond to, and labels of the others.

    A change of one of the others by a factor of 4.5 would go unseen even if it alone were unknown. Parameters at a bound are
    in neither.
    """
    free = [i for i, label in enumerate(parameters.labels) if label not in at_bound]
    responsive = [i for i in free if information[i, i] > 1 / VAGUE_DEVIATION**2]
    return responsive, tuple(parameters.labels[i] for i in free if i not in responsive)


def _combination(parameters: Parameters, core: np.ndarray, active: Sequence[int], members: Sequence[int]) -> Combination | None:
    """Best known combination of some parameters, whatever the others are.

    None where it is not known to IDENTIFIABLE_DEVIATION.
    """
    rest = [i for i in range(len(core)) if i not in members]
    across = core[np.ix_(rest, members)]
    deviation, axes = principal_directions(
        core[np.ix_(members, members)] - across.T @ pseudo_inverse(core[np.ix_(rest, rest)]) @ across
    )
    if not deviation[0] < IDENTIFIABLE_DEVIATION:
        return None
    indices = [active[i] for i in members]
    labels, units = [parameters.labels[i] for i in indices], {parameters.unit[i] for i in indices}
    value, slope, share = parameters.value[indices], parameters.slope[indices], axes[:, 0]
    alike = len(units) == 1 and len({parameters.family[i] for i in indices}) == 1
    product = not alike and bool((value > 0).all())
    raw = share / parameters.relative()[indices] if product else share / slope
    leading = int(np.abs(raw if alike or product else share).argmax())
    weight = raw / raw[leading]
    level = float(np.prod(value**weight) if product else weight @ value)
    small = float(deviation[0] / abs(raw[leading]))
    unit = "" if product else parameters.unit[indices[leading]]
    return Combination(dict(zip(labels, map(float, weight), strict=True)), product, level, small, unit)


def best_fix(labels: Sequence[str], covariance: np.ndarray, candidates: Sequence[str]) -> tuple[Fix, np.ndarray]:
    """Candidate that takes most from the summed variance of the others when it is fixed.

    Returns:
        The candidate, and the covariance (p, p) once it is fixed.
    """

    def fixed(i: int) -> np.ndarray:
        if not covariance[i, i] > ZERO_VARIANCE:
            return np.zeros_like(covariance)
        shared = covariance[i] / np.sqrt(covariance[i, i])
        return np.outer(shared, shared)

    lost = {i: float(np.delete(np.diag(fixed(i)), i).sum()) for i in map(labels.index, candidates)}
    best = max(lost, key=lambda i: lost[i])
    others = float(np.delete(np.diag(covariance), best).sum())
    remaining = covariance - fixed(best)
    after = {x: float(np.sqrt(max(remaining[i, i], 0.0))) for x in candidates if (i := labels.index(x)) != best}
    return Fix(labels[best], lost[best], lost[best] / others if others > 0 else 0.0, after), remaining
