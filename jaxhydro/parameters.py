"""Parameters of physical effects, and the base class of loads, water effects and sensor effects."""

import abc
import math
from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple, Self

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float


class Parameter(NamedTuple):
    """Unit, meaning, bounds and neutral value of a load's parameter.

    A `lower` bound of 0 or more means that the quantity cannot be negative, as drag, stiffness and times cannot (`check`). All
    other bounds only limit where a fit searches: published values beyond them, such as a Cd of 30 for a plate, are not wrong.

    Attributes:
        unit: Unit, "-" where there is none.
        meaning: What the parameter is, in words.
        lower: Lower bound.
        upper: Upper bound.
        null: Neutral value, at which the parameter has no effect.
        of_hull: Whether bounds that are lengths or times scale with the platform's size.
    """

    unit: str
    meaning: str
    lower: float = float("-inf")
    upper: float = float("inf")
    null: float = 0.0
    of_hull: bool = True  # bounds that are lengths or times follow the platform's size; not where a wave gauge may have stood

    def check(self, label: str, value: Any) -> None:
        """Raise ValueError for a value that is not finite, or is negative where it cannot be.

        Args:
            label: Label of the parameter, for the message.
            value: Number or array to check.

        Raises:
            ValueError: The value is not a finite number, or is negative although `lower` is 0 or more.
        """
        try:
            numbers = np.asarray(value, float)
        except (TypeError, ValueError):
            raise ValueError(f"{label}: expected a number ({self.unit}), found {value!r}") from None
        least = 0.0 if self.lower >= 0 else -math.inf
        if not (np.isfinite(numbers) & (numbers >= least)).all():
            expected = "a finite number" if least < 0 else "a finite number of 0 or more"
            found = ", ".join(f"{one:g}" for one in numbers.ravel()[:3])
            raise ValueError(f"{label}: expected {expected} ({self.unit}: {self.meaning}), found {found}")

    def sized(self, size: float, pace: float) -> "Parameter":
        """The parameter with bounds for a platform of another size.

        Args:
            size: Length scale (-) relative to VolturnUS-S (`jaxhydro.scales`).
            pace: Time scale (-) relative to VolturnUS-S.

        Returns:
            The same parameter; bounds in m, s, Hz or m/s are scaled where `of_hull` is set.
        """
        factor = {"m": size, "s": pace, "Hz": 1 / pace, "m/s": size / pace}.get(self.unit, 1.0)
        lower, upper = min(self.lower * factor, self.null), max(self.upper * factor, self.null)
        return self if factor == 1.0 or not self.of_hull else self._replace(lower=lower, upper=upper)


class AbstractEffect(eqx.Module):
    """Base class of loads, water effects and sensor effects: named, bounded parameters of one physical effect.

    An effect knows nothing of batches, of the model around it or of calibration.

    Attributes:
        values: Parameters that may be calibrated, by label.
        source: Publication or program that the law was taken from.
    """

    values: eqx.AbstractVar[Mapping[str, Float[Array, ""]]]
    source: ClassVar[str] = ""

    @abc.abstractmethod
    def about(self, label: str) -> Parameter:
        """Unit, meaning, bounds and neutral value of one parameter."""

    def at_values(self, values: Mapping[str, Float[Array, ""] | float]) -> Self:
        """This effect with some parameters changed, unchecked; labels of other effects are ignored."""
        new = {label: jnp.asarray(values.get(label, old), float) for label, old in self.values.items()}
        return eqx.tree_at(lambda x: x.values, self, new) if new else self


def strongly_typed(tree: Any) -> Any:
    """A model or load without JAX's weak types.

    Programs are compiled by type. Without this, a model whose numbers were changed would compile again.
    """
    return jax.tree.map(lambda x: jnp.asarray(x, x.dtype) if eqx.is_array(x) else x, tree)
