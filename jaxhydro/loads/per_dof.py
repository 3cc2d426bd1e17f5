"""Functions that laws per degree of freedom share: labels, vectors, smooth magnitude.

A load has its law in the degrees of freedom that its labels name, in the order of `DOFS`; vectors over those are "k" long.
"""

from collections.abc import Mapping, Sequence

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.environment import DOFS
from jaxhydro.parameters import Parameter

Values = Mapping[str, Float[Array, ""]]
Parameters = Mapping[str, tuple[Parameter, Parameter]]
"""What a parameter means for a translation and for a rotation, by the last part of its label; {dof} is filled in."""


def both_units(
    translation: str,
    rotation: str,
    meaning: str,
    lower: float = float("-inf"),
    upper: float = float("inf"),
    null: float = 0.0,
) -> tuple[Parameter, Parameter]:
    """Parameter whose unit differs between translations and rotations."""
    return Parameter(translation, meaning, lower, upper, null), Parameter(rotation, meaning, lower, upper, null)


def about(label: str, parameters: Parameters) -> Parameter:
    """Unit, meaning and bounds of the parameter with a label `effect.dof.parameter`."""
    _, dof, name = label.split(".")
    found = parameters[name][dof in DOFS[3:]]
    return found._replace(meaning=found.meaning.format(dof=dof))


def nulls(
    effect: str, dofs: Sequence[str], parameters: Parameters, shape: Mapping[str, float | None] | None = None
) -> dict[str, Float[Array, ""]]:
    """Neutral values of all parameters, for some degrees of freedom.

    Args:
        effect: First part of the labels.
        dofs: Degrees of freedom.
        parameters: Parameters of the law, by name.
        shape: Values by name that replace neutral ones; None is ignored.

    Returns:
        Values by label.

    Raises:
        ValueError: A name is not a degree of freedom.
    """
    if unknown := set(dofs) - set(DOFS):
        raise ValueError(f"no degree of freedom {sorted(unknown)[0]!r}; there are: {', '.join(DOFS)}")
    given = {name: value for name, value in (shape or {}).items() if value is not None}
    return {
        f"{effect}.{dof}.{name}": jnp.asarray(given.get(name, pair[dof in DOFS[3:]].null), float)
        for dof in dofs
        for name, pair in parameters.items()
    }


def dofs_of(values: Values) -> tuple[str, ...]:
    """Degrees of freedom that labels name, in the order of `DOFS`."""
    named = {label.split(".")[1] for label in values}
    return tuple(dof for dof in DOFS if dof in named)


def entries(values: Values, name: str, missing: float | None = None) -> Float[Array, " k"]:
    """Values of one parameter over the law's degrees of freedom, (k,).

    Raises:
        KeyError: A degree of freedom lacks it, and `missing` is not given.
    """
    found = {label.split(".")[1]: value for label, value in values.items() if label.rsplit(".", 1)[1] == name}
    default = {} if missing is None else dict.fromkeys(DOFS, missing)
    several = [jnp.asarray((default | found)[dof], float) for dof in dofs_of(values)]
    return jnp.stack(several) if several else jnp.zeros(0)


def dofs_only(six: Float[Array, "6"], values: Values) -> Float[Array, " k"]:
    """Entries of a six-vector for the law's degrees of freedom, (k,)."""
    return six[np.array([DOFS.index(dof) for dof in dofs_of(values)], dtype=int)]


def all_dofs(some: Float[Array, " k"], values: Values) -> Float[Array, "6"]:
    """Six-vector from values over the law's degrees of freedom, 0 on the others.

    By a product: scatters are slow on a CPU.
    """
    basis = np.array([[dof == other for other in DOFS] for dof in dofs_of(values)], float).reshape(-1, 6)
    return some @ basis


def magnitude(x: Float[Array, "..."], small: float) -> Float[Array, "..."]:
    """Smooth magnitude |x| = x² (x² + small)^(-1/2).

    It is exactly 0 at 0 and smooth there, so that a memory at rest stays at rest.
    """
    return x * x / jnp.sqrt(x * x + small)
