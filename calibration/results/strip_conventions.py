"""Conventions of strip loads, read from a model and applied to another."""

from dataclasses import replace
from typing import Literal

from pydantic import BaseModel, ConfigDict

from jaxhydro.dynamics.model import Model
from jaxhydro.input_schema import Flag


class StripConventions(BaseModel):
    """Conventions of strip loads, by their keys in a platform file.

    Coefficients that were found with one convention are not those of another.

    Attributes:
        directions: Axes of the strips: those of the displaced body, or those of the earth.
        drag_speed: Whether drag goes with the speed of the velocity vector, or component by component.
        centripetal: Whether the acceleration of the strips has a centripetal part.
    """

    model_config = ConfigDict(frozen=True, extra="ignore")

    directions: Literal["body", "earth"]
    drag_speed: Literal["vector", "component"]
    centripetal: Flag

    @classmethod
    def of(cls, model: Model) -> "StripConventions":
        """Conventions of a model."""
        coupled = all(getattr(load, "coupled", True) for load in model.loads)
        return cls.model_validate(
            {
                "directions": model.conventions.directions,
                "drag_speed": "vector" if coupled else "component",
                "centripetal": model.conventions.centripetal,
            }
        )

    def applied_to(self, model: Model) -> Model:
        """The model with these conventions; the model itself where it has them."""
        if self == StripConventions.of(model):
            return model
        coupled = self.drag_speed == "vector"
        loads = tuple(
            replace(load, coupled=coupled) if hasattr(load, "coupled") else load  # type: ignore[call-arg]
            for load in model.loads
        )
        changed = model.with_conventions(directions=self.directions, centripetal=self.centripetal)
        return replace(changed, loads=loads)

    def __str__(self) -> str:
        return ", ".join(f"{key}: {str(value).lower()}" for key, value in self.model_dump().items())


DEFAULT_STRIPS = StripConventions(directions="body", drag_speed="vector", centripetal=True)
