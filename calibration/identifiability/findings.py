"""Identifiability of the parameters: what the records determine, and what they do not."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import jax.numpy as jnp
import numpy as np

from calibration.formatting import listed, number, percent
from calibration.identifiability.directions import MIN_VARIANCE_GAIN, active_parameters, best_fix, weak_directions
from calibration.identifiability.information import (
    IDENTIFIABLE_DEVIATION,
    collinearity,
    principal_directions,
    shared_information,
    submatrix,
)
from calibration.identifiability.standard_deviations import Spread, WeightedProducts, sandwich_covariance
from calibration.identifiability.statements import Collinear, Direction, Fix, Parameters
from calibration.parameters.families import parameter_family
from calibration.parameters.space import ParameterSpace, slopes
from jaxhydro.dynamics.model import Model
from jaxhydro.platform.drag_laws import law_labels

COLLINEAR = 10.0  # collinearity index from which a group is poorly identifiable: 10 to 15 (Brun et al. 2001)
MAX_REPORTED_DIRECTIONS = 4  # weak directions in words


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
        fix, remaining = best_fix(labels, remaining, open_ or list(direction.movement))
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
