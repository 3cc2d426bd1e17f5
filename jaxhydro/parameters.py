"""Parameters of physical effects, and the base class of loads, water effects and sensor effects."""

import math
import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar, NamedTuple, Self

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.choices import unknown

METADATA_KEY = "parameter"  # of what `parameter` and `parameters` say of a field


class Parameter(NamedTuple):
    """Unit, meaning, bounds and neutral value of a load's parameter.

    A `lower` bound of 0 or more means that the quantity cannot be negative, as drag, stiffness and times cannot (`check`). All
    other bounds only limit where a fit searches: published values beyond them, such as a Cd of 30 for a plate, are not wrong.

    Attributes:
        unit: Unit, "-" where there is none.
        meaning: What the parameter is, in words.
        lower: Lower bound.
        upper: Upper bound.
        neutral: Neutral value, at which the parameter has no effect.
        of_hull: Whether bounds that are lengths or times scale with the platform's size.
        coefficient: Group and name, such as Cd_t, of the member coefficient that it is or belongs to; None for others.
    """

    unit: str
    meaning: str
    lower: float = float("-inf")
    upper: float = float("inf")
    neutral: float = 0.0
    of_hull: bool = True  # bounds that are lengths or times follow the platform's size; not where a wave gauge may have stood
    coefficient: tuple[str, str] | None = None

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
            values = ", ".join(f"{number:g}" for number in numbers.ravel()[:3])
            raise ValueError(f"{label}: expected {expected} ({self.unit}: {self.meaning}), found {values}")

    def sized(self, size: float, pace: float) -> "Parameter":
        """The parameter with bounds for a platform of another size.

        Args:
            size: Length scale (-) relative to VolturnUS-S (`jaxhydro.scales`).
            pace: Time scale (-) relative to VolturnUS-S.

        Returns:
            The same parameter; bounds in m, s, Hz or m/s are scaled where `of_hull` is set.
        """
        factor = {"m": size, "s": pace, "Hz": 1 / pace, "m/s": size / pace}.get(self.unit, 1.0)
        lower, upper = min(self.lower * factor, self.neutral), max(self.upper * factor, self.neutral)
        return self if factor == 1.0 or not self.of_hull else self._replace(lower=lower, upper=upper)


@dataclass(frozen=True)
class ParameterField:
    """How a field of an effect holds its parameters: a number, or one number for each key of a mapping.

    Attributes:
        about: Unit, meaning, bounds and neutral value, from the effect and a key (None for a single number).
        label: Template of the labels, of the effect's `prefix`, the field's `name` and a `key`.
    """

    about: Callable[[Any, Any], Parameter]
    label: str


def parameter(
    unit: str,
    meaning: str,
    lower: float = float("-inf"),
    upper: float = float("inf"),
    neutral: float = 0.0,
    of_hull: bool = True,
    prefix: str = "{prefix}",
) -> Any:
    """Field of an effect that is one parameter, `prefix.name`; its default is the neutral value.

    Args:
        unit: Unit, "-" where there is none.
        meaning: What the parameter is, in words.
        lower: Lower bound.
        upper: Upper bound.
        neutral: Neutral value, at which the parameter has no effect.
        of_hull: Whether bounds that are lengths or times scale with the platform's size.
        prefix: First part of the label, where it is not the effect's.
    """
    about = Parameter(unit, meaning, lower, upper, neutral, of_hull)
    metadata = {METADATA_KEY: ParameterField(lambda effect, key: about, prefix + ".{name}")}
    return eqx.field(converter=_number, default=neutral, metadata=metadata)


def parameters(about: Callable[[Any, Any], Parameter], label: str = "{prefix}.{key}.{name}") -> Any:
    """Field of an effect with one parameter for each key of a mapping, for example a degree of freedom.

    Args:
        about: Unit, meaning, bounds and neutral value, from the effect and a key.
        label: Template of the labels, of the effect's `prefix`, the field's `name` and the `key`.
    """
    metadata = {METADATA_KEY: ParameterField(about, label)}
    return eqx.field(converter=_numbers, default_factory=dict, metadata=metadata)


def _number(value: Any) -> Float[Array, ""]:
    return jnp.asarray(value, float)


def _numbers(values: Mapping[Any, Any]) -> dict[Any, Float[Array, ""]]:
    return {key: jnp.asarray(value, float) for key, value in values.items()}


class _Slot(NamedTuple):
    """Field and key of a parameter, its description, and the template of its label."""

    field: str
    key: Any
    about: Callable[[Any, Any], Parameter]
    template: str


class AbstractEffect(eqx.Module):
    """Base class of loads, water effects and sensor effects.

    An effect is one physical effect with named, bounded parameters. It knows nothing of batches, of the model around it or
    of calibration. Its parameters are the fields made by `parameter` and `parameters`. The parameters of an effect that is a
    field are its own, too.

    Attributes:
        label_prefix: First part of the parameters' labels; empty: the class's name in words.
        source: Publication or program that the law was taken from.
    """

    label_prefix: ClassVar[str] = ""
    source: ClassVar[str] = ""

    @property
    def prefix(self) -> str:
        """First part of the labels of the parameters."""
        return self.label_prefix or re.sub("(?<!^)(?=[A-Z])", "_", type(self).__name__).lower()

    @property
    def values(self) -> dict[str, Float[Array, ""]]:
        """Every parameter by label."""
        own = {label: _at(getattr(self, slot.field), slot.key) for label, slot in self._slots().items()}
        return {label: value for inner in self._inner().values() for label, value in inner.values.items()} | own

    @property
    def keys(self) -> dict[str, Any]:
        """Key of each parameter in its field's mapping, by label; None for a field that is one number."""
        inner = {label: key for effect in self._inner().values() for label, key in effect.keys.items()}
        return inner | {label: slot.key for label, slot in self._slots().items()}

    def about(self, label: str) -> Parameter:
        """Unit, meaning, bounds and neutral value of a parameter.

        Raises:
            UnknownName: There is no parameter of that label (a KeyError).
        """
        if (slot := self._slots().get(label)) is not None:
            return slot.about(self, slot.key)
        for inner in self._inner().values():
            if label in inner.values:
                return inner.about(label)
        raise unknown("parameter", label, self.values)

    def at_values(self, values: Mapping[str, Float[Array, ""] | float]) -> Self:
        """This effect with some parameters changed, unchecked; labels of other effects are ignored."""
        new: dict[str, Any] = {name: inner.at_values(values) for name, inner in self._inner().items()}
        for label, slot in self._slots().items():
            if label in values and slot.key is None:
                new[slot.field] = values[label]
            elif label in values:
                new[slot.field] = {**new.get(slot.field, getattr(self, slot.field)), slot.key: values[label]}
        return replace(self, **new) if new else self

    def label_for(self, label: str, key: Any) -> str:
        """Label that a parameter of a mapping would have with another key."""
        for inner in self._inner().values():
            if label in inner.values:
                return inner.label_for(label, key)
        slot = self._slots()[label]
        return slot.template.format(prefix=self.prefix, name=slot.field, key=key)

    def restricted(self, keys: Collection[Any]) -> Self:
        """This effect with the parameters of some keys only, such as degrees of freedom; single numbers stay."""
        mappings = {field.name: getattr(self, field.name) for field in fields(self) if METADATA_KEY in field.metadata}
        selected: dict[str, Any] = {
            name: {key: value for key, value in mapping.items() if key in keys}
            for name, mapping in mappings.items()
            if isinstance(mapping, Mapping)
        }
        return replace(self, **selected)

    def _slots(self) -> dict[str, _Slot]:
        """Fields and keys of the parameters of this effect's own fields, by label."""
        slots = {}
        for field in fields(self):
            if (metadata := field.metadata.get(METADATA_KEY)) is None:
                continue
            value = getattr(self, field.name)
            for key in value if isinstance(value, Mapping) else (None,):
                slots[metadata.label.format(prefix=self.prefix, name=field.name, key=key)] = _Slot(
                    field.name, key, metadata.about, metadata.label
                )
        return slots

    def _inner(self) -> dict[str, "AbstractEffect"]:
        """Effects that are fields of this one, by field."""
        held = {field.name: getattr(self, field.name) for field in fields(self)}
        return {name: value for name, value in held.items() if isinstance(value, AbstractEffect)}


def _at(value: Any, key: Any) -> Float[Array, ""]:
    return value if key is None else value[key]


def strongly_typed(tree: Any) -> Any:
    """A model or load without JAX's weak types.

    Programs are compiled by type. Without this, a model whose numbers were changed would compile again.
    """
    return jax.tree.map(lambda x: jnp.asarray(x, x.dtype) if eqx.is_array(x) else x, tree)
