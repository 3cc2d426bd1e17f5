"""Mooring lines as straight springs that may go slack."""

from collections.abc import Mapping
from typing import ClassVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.abstract_lines import AbstractLines
from jaxhydro.parameters import Parameter, parameters


class MooringLines(AbstractLines):
    """Massless elastic mooring lines from fairlead to anchor.

    T = k max(0, l - l0) along the straight line from the displaced fairlead to the anchor.

    This is the geometric law of a massless elastic line (Faltinsen 1990, Sea Loads, chapter 8). It includes pretension
    stiffness, large offsets and slack. Labels are `mooring.line1.stiffness` (N/m) and `mooring.line1.unstretched_length`
    (m).
    """

    stiffness: Mapping[str, Float[Array, ""] | float] = parameters(
        lambda load, line: Parameter("N/m", f"axial stiffness of {line}", 0.0)
    )
    unstretched_length: Mapping[str, Float[Array, ""] | float] = parameters(
        lambda load, line: Parameter("m", f"unstretched length of {line}", 0.0)
    )
    source: ClassVar[str] = "Faltinsen 1990, chapter 8"

    def tension(
        self, position: Float[Array, "6"], matrix: Float[Array, "3 3"]
    ) -> tuple[Float[Array, " l"], Float[Array, "3 l"]]:
        """Tension (N), (l,), and unit vectors to the anchors in body axes, (3, l)."""
        lines = [f"line{i + 1}" for i in range(self.anchor.shape[1])]
        stiffness, unstretched = (
            jnp.stack([mapping[line] for line in lines]) for mapping in (self.stiffness, self.unstretched_length)
        )
        length, towards = self.chord(position, matrix)
        return stiffness * jnp.maximum(length - unstretched, 0.0), towards

    def pull(self, position: Float[Array, "6"], matrix: Float[Array, "3 3"]) -> Float[Array, "3 l"]:
        """Force of each line at its fairlead (N), body axes, (3, l)."""
        tension, towards = self.tension(position, matrix)
        return tension * towards
