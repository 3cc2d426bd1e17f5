"""Schema of tuned mass dampers in the hull, in SI."""

import math
from collections.abc import Iterator

import numpy as np

from jaxhydro.errors import Problem, shown
from jaxhydro.input_schema import Consistent, NonNegative, Positive, Text, Vector


class TunedMassDamper(Consistent):
    """A mass (kg) on a damped spring that slides along a `direction` of the hull.

    Its line goes through `point` (m, from the reference point). The spring has a `period` (s) or a `stiffness` (N/m), the
    damper a `damping_ratio` (-) or a `damping` (N s/m), all with the hull held. The mass is not part of that of `rigid_body`
    (`jaxhydro.loads.TunedMassDampers`).
    """

    name: Text
    mass: Positive
    point: Vector
    direction: Vector
    period: Positive | None = None
    stiffness: Positive | None = None
    damping_ratio: NonNegative | None = None
    damping: NonNegative | None = None

    def _faults(self) -> Iterator[Problem]:
        for first, second in (("period", "stiffness"), ("damping_ratio", "damping")):
            stated = [key for key in (first, second) if getattr(self, key) is not None]
            if len(stated) != 1:
                yield Problem("", f"either {first} or {second}", "both" if stated else "neither")
        if not any(self.direction):
            yield Problem("direction", "a vector that is not 0", shown(list(self.direction)))

    def line(self) -> np.ndarray:
        """Unit vector along the line, body axes."""
        return np.array(self.direction, float) / np.linalg.norm(self.direction)

    def tuning(self) -> tuple[float, float]:
        """Period (s) and damping ratio (-), the hull held."""
        if self.period is not None:
            period = self.period
        else:
            assert self.stiffness is not None
            period = 2 * math.pi * math.sqrt(self.mass / self.stiffness)
        if self.damping_ratio is not None:
            return period, self.damping_ratio
        assert self.damping is not None
        return period, self.damping * period / (4 * math.pi * self.mass)
