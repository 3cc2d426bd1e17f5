"""Parameters of a model's effects by label: what they mean, which are shared, and checks of their values."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import jax
from jaxtyping import Array, Float

from jaxhydro.choices import UnknownName, unknown
from jaxhydro.parameters import Parameter

if TYPE_CHECKING:
    from jaxhydro.dynamics.model import Model


def about_parameter(model: "Model", label: str) -> Parameter:
    """Unit, meaning, bounds and neutral value of a parameter, as `Model.about`.

    Args:
        model: The platform.
        label: Label of the parameter.

    Raises:
        UnknownName: No effect has a parameter of that label.
    """
    for effect in model.effects:
        if label in effect.values:
            parameter = effect.about(label).sized(float(model.size), float(model.pace))
            shares = model.hull.elements.shares
            others = [share.group for share in shares if (share.owner, share.name) == parameter.coefficient]
            return parameter._replace(meaning=f"{parameter.meaning}; shared by {', '.join(others)}") if others else parameter
    raise _unknown(model, label)


def check_values(model: "Model", values: Mapping[str, Float[Array, ""] | float]) -> None:
    """Check labels and values of parameters; values that are traced are not checked.

    Args:
        model: The platform.
        values: New values by label.

    Raises:
        UnknownName: No effect has a parameter of a label.
        ValueError: A value is not finite, or is negative where physics does not allow it (`Parameter.check`).
    """
    about = {label: effect.about for effect in model.effects for label in effect.values}
    for label, value in values.items():
        if label not in about:
            raise _unknown(model, label)
        if not isinstance(value, jax.core.Tracer):
            about[label](label).check(label, value)


def shared_hint(model: "Model", label: str) -> str:
    """Hint that a coefficient is shared, with the label that it has; empty for other labels.

    Args:
        model: The platform.
        label: Label that the coefficient would have in a group that shares it.
    """
    for effect in model.effects if model.hull.elements.shares else ():
        for owner_label, key in effect.keys.items():
            coefficient = effect.about(owner_label).coefficient
            for share in model.hull.elements.shares:
                shared = (share.owner, share.name) == coefficient
                if shared and effect.label_for(owner_label, (share.group, key[1])) == label:
                    return f"It is shared: {owner_label}."
    return ""


def _unknown(model: "Model", label: str) -> UnknownName:
    return unknown("parameter", label, sorted(model.values), shared_hint(model, label))
