"""Line from an anchor to a fairlead in a platform file."""

import math
from typing import Annotated

import numpy as np
from pydantic import Field

from jaxhydro.input_schema import Number, Schema, Vector


class AnchoredLine(Schema):
    """Line from anchor to fairlead (m), copied to each `heading` (deg) about the z axis."""

    anchor: Vector
    fairlead: Vector
    heading: Annotated[tuple[Number, ...], Field(min_length=1)] = (0.0,)

    def distance(self) -> float:
        """Distance (m) from anchor to fairlead at the reference position."""
        return float(np.linalg.norm(np.subtract(self.anchor, self.fairlead)))

    def copies(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """Anchor and fairlead (m) at each heading."""
        ends = []
        for heading in self.heading:
            c, s = math.cos(math.radians(heading)), math.sin(math.radians(heading))
            turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
            ends.append((turn @ np.array(self.anchor), turn @ np.array(self.fairlead)))
        return ends
