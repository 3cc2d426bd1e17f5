"""Schema of liquid column dampers in the hull, in SI."""

import math
from collections.abc import Iterator

import numpy as np

from jaxhydro.errors import Problem, shown
from jaxhydro.input_schema import Consistent, NonNegative, Positive, Text, Vector


class LiquidColumnDamper(Consistent):
    """A U-tube of cross-section `area` (m²) along a horizontal `direction` of the hull.

    The middle of the tube is at `point` (m). `width` (m) is the distance of the columns' centrelines. `column` (m) is the
    height of the liquid at rest above the tube's centreline. `head_loss` (-) and `density` (kg/m³) are those of the liquid.
    It is not part of the mass of `rigid_body` (`jaxhydro.loads.LiquidColumnDampers`).
    """

    name: Text
    point: Vector
    direction: Vector
    width: Positive
    column: Positive
    area: Positive
    head_loss: NonNegative = 0.0
    density: Positive = 1000.0

    def _faults(self) -> Iterator[Problem]:
        if self.direction[2] != 0.0 or not any(self.direction):
            yield Problem("direction", "a horizontal vector that is not 0", shown(list(self.direction)))

    def line(self) -> np.ndarray:
        """Unit vector along the tube, body axes."""
        return np.array(self.direction, float) / np.linalg.norm(self.direction)

    def length(self) -> float:
        """Length of the liquid (m)."""
        return self.width + 2 * self.column

    def mass(self) -> float:
        """Mass of the liquid (kg)."""
        return self.density * self.area * self.length()

    def period(self, gravity: float) -> float:
        """Period (s) with the hull held: Sakai, Takaeda and Tamaki 1989; gravity in m/s²."""
        return 2 * math.pi * math.sqrt(self.length() / (2 * gravity))
