"""Free parameters of a model: choice, bounds, priors."""

import fnmatch
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from calibration.parameters.transforms import AbstractTransform, Interval, LogInterval, Scaled
from jaxhydro.dynamics.model import Model
from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError, Problem, suggest
from jaxhydro.platform.drag_laws import law_labels
from jaxhydro.quick_jit import on_device

VAGUE_DEVIATION = 1.5  # standard deviation of a coordinate that no record touches: a factor of 4.5 either way
DEFAULT_RANGE_FACTOR = 1000.0  # a positive parameter may move by this factor from where it starts, within what its load allows
NOT_FREE_BY_DEFAULT = (
    "mooring.",
    "stiffness.",
    "guided_masses.",
    "tuned_mass_dampers.",
    "liquid_column_dampers.",
    "rotor.",
)  # what a decay cannot tell from inertia is left alone unless asked for
THEORY = (
    "computed_excitation.",
    "computed_radiation.",
    "computed_added_mass.",
    "diffraction_correction.",
    "drift_transfer.",
    "slender_body_forces.",
)  # tables and laws of theory are complete where a platform states them, unless their share is asked for


class FreeParameter(NamedTuple):
    """A free parameter: start, transform, and a Gaussian prior on its coordinate."""

    label: str
    start: float
    transform: AbstractTransform
    prior_mean: float
    prior_deviation: float  # inf: none


class ParameterSpace(NamedTuple):
    """Free parameters of a model, in order."""

    free: tuple[FreeParameter, ...]

    @property
    def labels(self) -> tuple[str, ...]:
        return tuple(p.label for p in self.free)

    @property
    def moves_equilibrium(self) -> bool:
        """Whether the platform's static equilibrium depends on them."""
        return any(label.startswith(NOT_FREE_BY_DEFAULT) for label in self.labels)

    @property
    def start(self) -> Float[Array, " p"]:
        """Coordinates of the starting values."""
        return on_device([p.transform.inverse(p.start) for p in self.free])

    @property
    def prior(self) -> tuple[Float[Array, " p"], np.ndarray]:
        """Means and standard deviations of the coordinates.

        A parameter without a stated prior has VAGUE_DEVIATION about its start.
        """
        with_prior = [math.isfinite(p.prior_deviation) for p in self.free]
        means = [p.prior_mean if stated else s for p, s, stated in zip(self.free, np.asarray(self.start), with_prior)]
        widths = [p.prior_deviation if stated else VAGUE_DEVIATION for p, stated in zip(self.free, with_prior)]
        return on_device(means), np.array(widths)

    def values(self, x: Float[Array, " p"]) -> dict[str, Float[Array, ""]]:
        """Parameter values at coordinates."""
        return {p.label: p.transform.forward(x[i]) for i, p in enumerate(self.free)}

    def model(self, model: Model, x: Float[Array, " p"]) -> Model:
        """The model with its free parameters at coordinates."""
        return model.at_values(self.values(x))


def default_free(model: Model, released: Iterable[str]) -> tuple[str, ...]:
    """Labels of the parameters that are free by default in decays of some degrees of freedom.

    They are coefficients of the members, and the lumped damping and added mass of these degrees of freedom. Parameters of value
    zero stay zero. Laws over the sea state mean nothing in still water. How drag depends on the motion (`drag_`) is free
    only where it is asked for, and so is the share of what theory gives (`THEORY`).

    Args:
        model: The model of the platform file.
        released: The degrees of freedom.
    """
    digits = {str(DOFS.index(dof) + 1) for dof in released}
    labels, laws = [], law_labels(model)
    for label, value in model.values.items():
        lumped = label.split(".")[0] in ("linear_damping", "quadratic_damping", "added_mass")
        if label.startswith(NOT_FREE_BY_DEFAULT + THEORY) or label in laws or float(value) == 0:
            continue
        if lumped and not digits >= set(label[-2:]):
            continue
        labels.append(label)
    return tuple(labels)


def match_free_labels(
    model: Model,
    released: Sequence[str],
    free: Sequence[str] | None = None,
    fixed: Sequence[str] = (),
    source: str = "campaign.yaml",
) -> tuple[str, ...]:
    """Labels of the free parameters, from patterns such as `column.*`.

    Args:
        model: The model.
        released: Degrees of freedom of the decays, for `default_free`.
        free: Patterns of free parameters; None: `default_free`.
        fixed: Patterns of parameters that are not free.
        source: Name of the file that errors refer to.

    Raises:
        InputError: A pattern matches no parameter.
    """
    names = tuple(model.values)
    problems = [
        Problem(f"calibrate.{key}", f"a parameter of this platform ({', '.join(names)})", pattern, _hint(pattern, names, model))
        for key, patterns in (("free", free or ()), ("fixed", fixed))
        for pattern in patterns
        if not fnmatch.filter(names, pattern)
    ]
    if problems:
        raise InputError(source, problems)
    chosen = default_free(model, released) if free is None else [k for k in names if any(fnmatch.fnmatch(k, p) for p in free)]
    return tuple(label for label in chosen if not any(fnmatch.fnmatch(label, p) for p in fixed))


def parameter_space(
    model: Model,
    labels: Sequence[str],
    bounds: Mapping[str, tuple[float, float]] | None = None,
    priors: Mapping[str, tuple[float, float]] | None = None,
    source: str = "campaign.yaml",
) -> ParameterSpace:
    """Set up free parameters with their transforms, bounds and priors.

    A parameter that cannot be negative is on a logarithmic scale. By default it stays within a factor of 1000 of its start
    and within its physical range. A value of 0 starts in the middle of that range.

    Args:
        model: The model, whose values are the start.
        labels: Labels of the free parameters.
        bounds: Lower and upper bound in the parameter's unit, by label.
        priors: Mean and standard deviation in the parameter's unit, by label.
        source: Name of the file that errors refer to.

    Returns:
        The free parameters.

    Raises:
        InputError: If bounds or priors are invalid.
    """
    bounds, priors, free, problems = bounds or {}, priors or {}, [], []
    for key, stated in (("bounds", bounds), ("priors", priors)):
        problems += [
            Problem(
                f"calibrate.{key}.{label}", f"a free parameter ({', '.join(labels)})", "another", _hint(label, labels, model)
            )
            for label in stated
            if label not in labels
        ]
    for label in labels:
        start, about = float(model.values[label]), model.about(label)
        lower, upper = bounds.get(label, (about.lower, about.upper))
        if not (about.lower <= lower < upper <= about.upper):
            physical = f"two numbers between {about.lower:g} and {about.upper:g}"
            problems.append(Problem(f"calibrate.bounds.{label}", physical, f"[{lower:g}, {upper:g}]"))
            continue
        if not about.lower <= start <= about.upper:
            physical = f"a value between {about.lower:g} and {about.upper:g} to begin from"
            problems.append(Problem(f"calibrate: {label}", physical, f"{start:g}"))
            continue
        transform: AbstractTransform
        if about.lower >= 0:
            size = start if start > 0 else (upper if math.isfinite(upper) else 1.0)
            lower = max(lower, size / DEFAULT_RANGE_FACTOR)
            transform = LogInterval(lower, min(upper, size * DEFAULT_RANGE_FACTOR) if label not in bounds else upper)
            # at the end of a logarithmic scale nothing moves
            start = start if start > 0 else math.sqrt(transform.lower * transform.upper)
        elif math.isfinite(lower) and math.isfinite(upper):
            transform = Interval(lower, upper)
        else:
            transform = Scaled(start, abs(start) if start else 1.0)
        mean, deviation = 0.0, math.inf
        if label in priors:
            value, width = priors[label]
            if not (lower < value < upper):
                inside = f"a value between {lower:.4g} and {upper:.4g}"
                problems.append(Problem(f"calibrate.priors.{label}.value", inside, f"{value:g}"))
                continue
            mean = transform.inverse(value)
            deviation = width / float(jax.grad(transform.forward)(jnp.asarray(mean)))
        free.append(FreeParameter(label, start, transform, mean, deviation))
    if problems:
        raise InputError(source, problems)
    return ParameterSpace(tuple(free))


def _hint(label: str, labels: Sequence[str], model: Model) -> str:
    return model.shared_hint(label) or suggest(label, labels)


def slopes(space: ParameterSpace, x: np.ndarray) -> np.ndarray:
    """d value / d x of every free parameter."""
    return np.array([float(jax.grad(p.transform.forward)(jnp.asarray(x[i]))) for i, p in enumerate(space.free)])
