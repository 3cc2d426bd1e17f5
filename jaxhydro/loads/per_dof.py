"""Base of loads with a law in each degree of freedom, and fields for their parameters.

Vectors over the degrees of freedom that a load acts in are "k" long, in the order of `DOFS`.
"""

from collections.abc import Iterable, Mapping
from typing import Any, ClassVar, Self

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.choices import unknown
from jaxhydro.environment import DOFS
from jaxhydro.loads.base import AbstractLoad
from jaxhydro.parameters import METADATA_KEY, Parameter, parameters

PerDof = Mapping[str, Float[Array, ""] | float]
"""One number for each degree of freedom that a load acts in."""


def by_dof(
    translation: str | Parameter,
    rotation: str | Parameter,
    meaning: str = "",
    lower: float = float("-inf"),
    upper: float = float("inf"),
    neutral: float = 0.0,
) -> Any:
    """Field of a load with one parameter, `prefix.dof.name`, in each degree of freedom.

    Args:
        translation: Unit in a translation, or the whole parameter.
        rotation: Unit in a rotation, or the whole parameter.
        meaning: What the parameter is; {dof} is filled in.
        lower: Lower bound.
        upper: Upper bound.
        neutral: Neutral value.
    """
    both = [
        unit if isinstance(unit, Parameter) else Parameter(unit, meaning, lower, upper, neutral)
        for unit in (translation, rotation)
    ]

    def about(load: Any, dof: str) -> Parameter:
        parameter = both[dof in DOFS[3:]]
        return parameter._replace(meaning=parameter.meaning.format(dof=dof))

    return parameters(about)


class AbstractLoadPerDof(AbstractLoad):
    """Base class of loads with a law in each degree of freedom.

    Each parameter is a mapping from degrees of freedom.
    """

    allowed: ClassVar[tuple[str, ...]] = DOFS

    def __check_init__(self) -> None:
        """Raise UnknownName for a degree of freedom that does not exist or that the law does not apply to."""
        for name in self._per_dof():
            for dof in getattr(self, name):
                if dof not in self.allowed:
                    raise unknown("degree of freedom", dof, self.allowed)

    @classmethod
    def neutral(cls, dofs: Iterable[str], **values: float | None) -> Self:
        """Load at its neutral value.

        Args:
            dofs: Degrees of freedom that it acts in.
            values: Values of parameters, by name, in place of neutral ones; None is ignored.
        """
        empty, mappings = cls(), {}
        for field, about in empty._per_dof().items():
            value = values.get(field)
            mappings[field] = {dof: about(empty, dof).neutral if value is None else value for dof in dofs}
        return cls(**mappings)

    @classmethod
    def _per_dof(cls) -> dict[str, Any]:
        """Unit, meaning, bounds and neutral value of the parameters, by field."""
        metadata = {name: field.metadata.get(METADATA_KEY) for name, field in cls.__dataclass_fields__.items()}
        return {name: entry.about for name, entry in metadata.items() if entry is not None}

    @property
    def dofs(self) -> tuple[str, ...]:
        """Degrees of freedom that the load acts in, in the order of `DOFS`."""
        named = {dof for name in self._per_dof() for dof in getattr(self, name)}
        return tuple(dof for dof in DOFS if dof in named)

    def entries(self, values: PerDof, missing: float | None = None) -> Float[Array, " k"]:
        """One of the parameters over the degrees of freedom, (k,).

        Raises:
            KeyError: A degree of freedom lacks it, and `missing` is not given.
        """
        default = {} if missing is None else dict.fromkeys(DOFS, missing)
        several = [jnp.asarray((default | dict(values))[dof], float) for dof in self.dofs]
        return jnp.stack(several) if several else jnp.zeros(0)

    def dofs_only(self, six: Float[Array, "6"]) -> Float[Array, " k"]:
        """Entries of a six-vector for the load's degrees of freedom, (k,)."""
        return six[np.array([DOFS.index(dof) for dof in self.dofs], dtype=int)]

    def all_dofs(self, values: Float[Array, " k"]) -> Float[Array, "6"]:
        """Six-vector from values over the load's degrees of freedom, 0 on the others.

        By a product: scatters are slow on a CPU.
        """
        basis = np.array([[dof == other for other in DOFS] for dof in self.dofs], float).reshape(-1, 6)
        return values @ basis


def magnitude(x: Float[Array, "..."], small: float) -> Float[Array, "..."]:
    """Smooth magnitude |x| = x² (x² + small)^(-1/2).

    It is exactly 0 at 0 and smooth there, so that a memory at rest stays at rest.
    """
    return x * x / jnp.sqrt(x * x + small)
