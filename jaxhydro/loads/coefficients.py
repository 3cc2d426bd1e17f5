"""Parameters of member groups, such as column.Cd_t, and their values on strips and ends."""

from collections.abc import Mapping
from typing import Any

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.hull.coefficient_labels import coefficient_of
from jaxhydro.hull.ends import Ends
from jaxhydro.hull.strips import Elements
from jaxhydro.parameters import Parameter, parameters

PerGroup = Mapping[tuple[str, str], Float[Array, ""] | float]
"""Values by group of members and kind: "t" across members, "z" vertical or axial."""


def by_group(
    unit: str,
    meaning: str,
    lower: float = float("-inf"),
    upper: float = float("inf"),
    neutral: float = 0.0,
    *,
    t: Mapping[str, str] | None = None,
    z: Mapping[str, str] | None = None,
    label: str = "{key[0]}.{name}_{key[1]}",
    symbol: str,
) -> Any:
    """Field of a load with one parameter, `column.Cd_t`, for each group of members and kind.

    Args:
        unit: Unit.
        meaning: What the parameter is; {group}, and the words of `t` or `z`, are filled in.
        lower: Lower bound.
        upper: Upper bound.
        neutral: Neutral value.
        t: Words for parameters across members.
        z: Words for vertical or axial parameters.
        label: Template of the labels; `key` is group and kind.
        symbol: Symbol of the member coefficient that the parameter is or belongs to: Ca, Cd or Cp.
    """

    def about(load: Any, key: tuple[str, str]) -> Parameter:
        words = (t if key[1] == "t" else z) or {}
        return Parameter(
            unit,
            meaning.format(group=key[0], **words),
            lower,
            upper,
            neutral,
            coefficient=(key[0], coefficient_of(symbol, key[1])),
        )

    return parameters(about, label)


def spread(elements: Elements, values: PerGroup, symbol: str, missing: float | None = None) -> Float[Array, "2 e"]:
    """Coefficients by direction and load element.

    Args:
        elements: Load elements.
        values: Coefficients by group and kind.
        symbol: Name of the coefficient, which groups may share.
        missing: Value of groups that are not in `values`.

    Raises:
        KeyError: A coefficient is absent and `missing` is None.
    """
    if not elements.labels:
        return jnp.zeros((2, 0))
    return _stacked(values, elements.owners(symbol), missing)[jnp.asarray(elements.label)]


def spread_ends(ends: Ends, values: PerGroup, symbol: str, missing: float | None = None) -> Float[Array, " m"]:
    """Coefficients by end; arguments as in `spread`.

    Raises:
        KeyError: A coefficient is absent and `missing` is None.
    """
    if not ends.labels:
        return jnp.zeros(len(ends.label))
    return _stacked(values, ends.owners(symbol), missing)[jnp.asarray(ends.label)]


def _stacked(values: PerGroup, keys: list[tuple[str, str]], missing: float | None) -> Float[Array, " c"]:
    return jnp.stack([jnp.asarray(values[key] if missing is None else values.get(key, missing)) for key in keys])
