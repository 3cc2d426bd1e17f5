"""Schema of the steady current in a platform file, in SI, headings in degrees."""

from collections.abc import Iterator
from itertools import pairwise
from typing import Annotated

import numpy as np
from pydantic import Field

from jaxhydro.errors import Problem, shown
from jaxhydro.input_schema import Consistent, NonNegative, Number, Schema

LEVELS = 81  # heights at which a power law is stated, closer towards the bed, where it is steep


class CurrentLevel(Schema):
    """Speed (m/s) and heading (deg) of the current at a height z (m; 0 still water, negative below)."""

    z: Number
    speed: NonNegative
    heading: Number = 0.0


class SteadyCurrent(Consistent):
    """Steady current with a power law over depth, or by `levels`.

    U(z) = speed ((depth + z) / depth)^exponent, DNV-RP-C205, section 4.1.4.2. `speed` (m/s) is that at still water, towards
    `heading` (deg). An exponent of 0 means the same speed at all depths, 1/7 a tidal current.
    """

    speed: NonNegative | None = None
    heading: Number = 0.0
    exponent: Annotated[float, Field(strict=True, ge=0, le=2)] | int = 0.0
    levels: tuple[CurrentLevel, ...] = ()

    def _faults(self) -> Iterator[Problem]:
        if (self.speed is None) == (not self.levels):
            yield Problem("", "either `speed` or `levels`", "both" if self.levels else "neither")
        if self.levels and (self.exponent or self.heading):
            key = "exponent" if self.exponent else "heading"
            yield Problem(key, "nothing beside `levels`, which have their own speeds and headings", shown(getattr(self, key)))
        heights = [level.z for level in self.levels]
        for i, (above, below) in enumerate(pairwise(heights), start=1):
            if below >= above:
                yield Problem(f"levels[{i}].z", f"levels from the surface down: z below {above:g} m", f"{below:g} m")

    def profile(self, depth: float) -> tuple[np.ndarray, np.ndarray]:
        """Heights of a current profile, and the velocity at each.

        Args:
            depth: Water depth (m).

        Returns:
            Heights (m), increasing, (k,), and velocity along x and y (m/s), (2, k).
        """
        if self.levels:
            rows = [(level.z, level.speed, level.heading) for level in self.levels[::-1]]
        elif self.exponent:
            share = np.linspace(0.0, 1.0, LEVELS) ** 3  # of the depth, over the bed
            rows = [(depth * (x - 1.0), self._speed * x**self.exponent, self.heading) for x in share]
        else:
            rows = [(0.0, self._speed, self.heading)]
        height, speed, heading = np.array(rows, float).T
        angle = np.radians(heading)
        return height, speed * np.stack([np.cos(angle), np.sin(angle)])

    @property
    def _speed(self) -> float:
        assert self.speed is not None
        return self.speed
