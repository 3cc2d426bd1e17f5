"""Identifiability of the parameters: weak directions, known combinations, what to fix.

Everything is local and linear, about the fitted values, in the coordinates of the fit: logarithms of positive parameters
within their bounds. Information is that of the records alone; the fit's prior enters only where `covariance` is named.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import jax.numpy as jnp
import numpy as np

from calibration.formatting import listed, number, percent
from calibration.identifiability.information import (
    IDENTIFIABLE_DEVIATION,
    collinearity,
    deviations_of,
    principal_directions,
    pseudo_inverse,
    shared_information,
    submatrix,
    varimax,
)
from calibration.identifiability.standard_deviations import Spread, WeightedProducts, sandwich_covariance
from calibration.identifiability.statements import Collinear, Combination, Direction, Fix, Parameters
from calibration.parameters.families import parameter_family
from calibration.parameters.space import VAGUE_DEVIATION, ParameterSpace, slopes
from jaxhydro.dynamics.model import Model
from jaxhydro.platform.drag_laws import law_labels

COLLINEAR = 10.0  # collinearity index from which a group is poorly identifiable: 10 to 15 (Brun et al. 2001)
ZERO_VARIANCE = 1e-20  # variance of a coordinate that is rounding: fixed before, or collinear with what is
MAX_REPORTED_DIRECTIONS = 4  # weak directions in words
MIN_VARIANCE_GAIN = 0.01  # of the others' summed variance: what takes less away is no advice
MIN_NAMED_DEVIATION = 0.5 * IDENTIFIABLE_DEVIATION  # of a parameter that is named in a direction


@dataclass(frozen=True, eq=False)
class Identifiability:
    """What the records of a calibration determine. Rows and columns are in the order of `parameters`.

    Attributes:
        parameters: The free parameters.
        information: (p, p) information of the records, without prior; each record's own unknowns are eliminated.
        covariance: (p, p) posterior covariance, with the prior.
        source: Description of the records.
        spectrum: (p,) standard deviations along `axes`, ascending; inf where the records say nothing.
        axes: (p, p) principal directions, as columns of unit length.
        correlation: (p, p) correlation matrix.
        collinear: Collinear groups of two and three parameters of one family, worst first.
        weak: Directions that the records do not determine.
        fixes: Parameter to fix for each entry of `weak`; each supposes those before it.
        untouched: Labels of parameters that the records do not respond to.
        at_bound: Labels of parameters at a bound.
    """

    parameters: Parameters
    information: np.ndarray
    covariance: np.ndarray
    source: str
    spectrum: np.ndarray
    axes: np.ndarray
    correlation: np.ndarray
    collinear: tuple[Collinear, ...]
    weak: tuple[Direction, ...]
    fixes: tuple[Fix, ...]
    untouched: tuple[str, ...]
    at_bound: tuple[str, ...]

    def sentences(self) -> tuple[str, ...]:
        """The statements as sentences, most important first."""
        clear, total = int((self.spectrum < IDENTIFIABLE_DEVIATION).sum()), len(self.spectrum)
        summary = (
            f"{clear} of {total} independent combinations of parameters known to better than {percent(IDENTIFIABLE_DEVIATION)}"
        )
        sentences = [f"{self.source}: {summary}"]
        if bound := self.at_bound:
            verbs = ("stands", "is") if len(bound) == 1 else ("stand", "are")
            sentences.append(f"{listed(bound)} {verbs[0]} at a bound and {verbs[1]} taken as fixed there")
        if idle := self.untouched:
            it = "it" if len(idle) == 1 else "them"
            sentences.append(f"no record responds to {listed(idle)}: fix {it}, or add tests that move {it}")
        stated: set[str] = set()
        for weak, fix in list(zip(self.weak, self.fixes, strict=True))[:MAX_REPORTED_DIRECTIONS]:
            # one combination may be what is known of several directions
            again = str(weak.known) in stated
            sentences += [weak.sentence(self.source, again), *([str(fix)] if fix.share >= MIN_VARIANCE_GAIN else [])]
            stated.add(str(weak.known))
        if rest := self.weak[MAX_REPORTED_DIRECTIONS:]:
            labels = listed(list(dict.fromkeys(label for weak in rest for label in weak.movement)))
            sentences.append(
                f"{len(rest)} further combinations of {labels} are not known to {percent(IDENTIFIABLE_DEVIATION)} either"
            )
        told = [set(a.movement) for a in self.weak]
        alike: list[tuple[set[str], float]] = []  # groups with parameters in common are one
        for group in sorted(self.collinear, key=lambda group: len(group.labels)):
            # a group is at least as bad as any part of it, and a weak direction says more
            if group.gamma > COLLINEAR and not any(part <= set(group.labels) for part in told):
                told.append(set(group.labels))
                met = [entry for entry in alike if entry[0] & told[-1]]
                whole = told[-1].union(*(labels for labels, _ in met)), max(group.gamma, *(gamma for _, gamma in met), 0.0)
                alike = [*(entry for entry in alike if entry not in met), whole]
        for members, gamma in alike:
            index = f"index {number(gamma, 2)}" if math.isfinite(gamma) else "index without bound"
            sentences.append(
                f"{listed([x for x in self.parameters.labels if x in members])} act alike (collinearity {index}, poor "
                f"from {COLLINEAR:.0f}): only exact records tell them apart"
            )
        return tuple(sentences)


def identifiability(
    parameters: Parameters,
    information: np.ndarray,
    covariance: np.ndarray,
    source: str = "these records",
    at_bound: Sequence[str] = (),
) -> Identifiability:
    """Identifiability of parameters.

    Args:
        parameters: The free parameters.
        information: (p, p) information of the records on their coordinates.
        covariance: (p, p) posterior covariance of their coordinates.
        source: Description of the records.
        at_bound: Labels of parameters at a bound.
    """
    labels, d = parameters.labels, np.sqrt(np.diag(covariance))
    active, untouched = active_parameters(parameters, information, at_bound)
    spectrum, axes = principal_directions(submatrix(information, active))
    groups = [
        Collinear(tuple(labels[i] for i in g), collinearity(information[np.ix_(g, g)]))
        for size in (2, 3)
        for g in combinations(active, size)
        if len({parameters.family[i] for i in g}) == 1
    ]
    weak = weak_directions(parameters, information, active)
    # what no record responds to is as wide as its prior whatever is fixed, and no measure of anything
    fixes: list[Fix] = []
    remaining = submatrix(covariance, active)
    for direction in weak:
        open_ = [label for label in direction.movement if label not in {fix.label for fix in fixes}]
        fix, remaining = _best_fix(labels, remaining, open_ or list(direction.movement))
        fixes.append(fix)
    return Identifiability(
        parameters,
        information,
        covariance,
        source,
        spectrum,
        axes,
        covariance / np.outer(d, d),
        tuple(sorted(groups, key=lambda g: (-g.gamma, len(g.labels)))),
        weak,
        tuple(fixes),
        untouched,
        tuple(at_bound),
    )


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


def identifiability_at(
    space: ParameterSpace,
    model: Model,
    x: np.ndarray,
    parts: WeightedProducts,
    ridge: np.ndarray,
    width: np.ndarray,
    source: str,
) -> tuple[Spread, Identifiability]:
    """Covariance of all unknowns, and identifiability of the parameters, at their coordinates.

    Args:
        space: The free parameters.
        model: A model with these parameters.
        x: Their coordinates (p,).
        parts: First four arguments of `sandwich_covariance`.
        ridge: As in `sandwich_covariance`.
        width: As in `sandwich_covariance`.
        source: Description of the records.
    """
    spread = sandwich_covariance(*parts, ridge, width)
    values = np.array([float(p.transform.forward(jnp.asarray(c))) for p, c in zip(space.free, x, strict=True)])
    units = tuple(model.about(label).unit for label in space.labels)
    bound = [p.label for p, c in zip(space.free, x, strict=True) if p.transform.at_bound(float(c))]
    laws = law_labels(model)
    families = tuple(parameter_family(label, laws) for label in space.labels)
    parameters = Parameters(space.labels, values, slopes(space, x), units, families)
    posterior = spread.covariance[: len(x), : len(x)]
    return spread, identifiability(parameters, shared_information(*parts, len(x)), posterior, source, bound)


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


def _best_fix(labels: Sequence[str], covariance: np.ndarray, candidates: Sequence[str]) -> tuple[Fix, np.ndarray]:
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
