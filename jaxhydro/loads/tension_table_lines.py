"""Elastic ropes whose tension is a table over stretch or strain."""

from collections.abc import Mapping
from typing import ClassVar, NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.loads.abstract_lines import AbstractLines
from jaxhydro.parameters import Parameter, parameters


class TensionTable(NamedTuple):
    """Tension of a rope over its stretch or strain, as a cubic between the entries of a table.

    Attributes:
        start: Where each interval begins (m or -), (n,): the entries; the last interval has no end.
        cubic: Coefficients of each interval's cubic, highest power first, (4, n).
    """

    start: Float[Array, " n"]
    cubic: Float[Array, "4 n"]

    def tension(self, stretch: Float[Array, " l"]) -> Float[Array, " l"]:
        """Tension (N) at a stretch (m) or strain (-); none where that is below 0."""
        interval = jnp.clip(jnp.searchsorted(self.start, stretch, side="right") - 1, 0, len(self.start) - 1)
        past = stretch - self.start[interval]
        a, b, c, d = self.cubic[:, interval]
        return jnp.where(stretch > 0.0, ((a * past + b) * past + c) * past + d, 0.0)


class TensionTableLines(AbstractLines):
    """Massless elastic ropes from fairlead to anchor, whose tension is a table over stretch or strain.

    T = f T_table(l - l0), or T = f T_table((l - l0)/l0), along the straight line from the displaced fairlead to the anchor.
    Slack ropes pull nothing. Beyond the last entry a rope is as stiff as there.

    The geometric law is that of a massless elastic line (Faltinsen 1990, Sea Loads, chapter 8). The stiffness of synthetic
    ropes depends on their tension, on the rate and on their history (Flory, Banfield and Petruska 2004, OTC 16588). The table
    is that of one state of the rope. Labels are `mooring.rope1.unstretched_length` (m) and `mooring.rope1.tension_factor` (-).

    Attributes:
        tables: Tension of each rope.
        over_strain: Whether the table of each rope is over strain; else over stretch.
        rope_of: Which of the ropes each line is, from 0.
        unstretched_length: Unstretched length (m) by line.
        tension_factor: Factor on the table's tension (-) by line; 0: no line.
    """

    tables: tuple[TensionTable, ...]
    over_strain: tuple[bool, ...] = eqx.field(static=True)
    rope_of: tuple[int, ...] = eqx.field(static=True)
    unstretched_length: Mapping[str, Float[Array, ""] | float] = parameters(
        lambda load, rope: Parameter("m", f"unstretched length of {rope}", 0.0, neutral=1.0)
    )
    tension_factor: Mapping[str, Float[Array, ""] | float] = parameters(
        lambda load, rope: Parameter("-", f"factor on the tension of {rope}", 0.0)
    )
    source: ClassVar[str] = "Faltinsen 1990, chapter 8; a table of tension"

    def _by_line(self, values: Mapping[str, Float[Array, ""] | float]) -> Float[Array, " l"]:
        return jnp.stack([jnp.asarray(values[f"rope{i + 1}"]) for i in range(len(self.rope_of))])

    def strain(self, position: Float[Array, "6"], matrix: Float[Array, "3 3"]) -> Float[Array, " l"]:
        """Stretch over unstretched length (-), below 0 where a line is slack, (l,)."""
        unstretched = self._by_line(self.unstretched_length)
        return self.chord(position, matrix)[0] / unstretched - 1.0

    def tension(
        self, position: Float[Array, "6"], matrix: Float[Array, "3 3"]
    ) -> tuple[Float[Array, " l"], Float[Array, "3 l"]]:
        """Tension (N), (l,), and unit vectors to the anchors in body axes, (3, l)."""
        length, towards = self.chord(position, matrix)
        unstretched = self._by_line(self.unstretched_length)
        stretch = length - unstretched
        tension = jnp.zeros_like(length)
        for number, (table, relative) in enumerate(zip(self.tables, self.over_strain, strict=True)):
            of_table = table.tension(stretch / unstretched if relative else stretch)
            tension = jnp.where(np.array(self.rope_of) == number, of_table, tension)
        return self._by_line(self.tension_factor) * tension, towards

    def pull(self, position: Float[Array, "6"], matrix: Float[Array, "3 3"]) -> Float[Array, "3 l"]:
        """Force of each line at its fairlead (N), body axes, (3, l)."""
        tension, towards = self.tension(position, matrix)
        return tension * towards
