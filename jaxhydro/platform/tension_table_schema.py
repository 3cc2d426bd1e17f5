"""Schema of ropes whose tension is a table over stretch or strain, in SI, headings in degrees."""

import itertools
from collections.abc import Iterator
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from jaxhydro.errors import Problem, shown, suggest
from jaxhydro.input_schema import Consistent, NonNegative, Positive, Text
from jaxhydro.platform.anchored_line import AnchoredLine

Column = Annotated[tuple[NonNegative, ...], Field(min_length=2)]


class Rope(Consistent):
    """Tension (N) of a rope over its `strain` (-) or its `stretch` (m), both from 0."""

    tension: Column
    strain: Column | None = None
    stretch: Column | None = None
    interpolation: Literal["linear", "pchip"] = "linear"

    def _faults(self) -> Iterator[Problem]:
        stated = [key for key in ("strain", "stretch") if getattr(self, key) is not None]
        if len(stated) != 1:
            yield Problem("", "either strain or stretch", "both" if stated else "neither")
            return
        (key,) = stated
        column = getattr(self, key)
        if len(column) != len(self.tension):
            yield Problem("tension", f"{len(column)} numbers, as {key} has", f"{len(self.tension)} numbers")
        for name, values in ((key, column), ("tension", self.tension)):
            if values[0] != 0.0:
                yield Problem(f"{name}[0]", "0, where the rope begins to pull", shown(values[0]))
        for i, (before, after) in enumerate(itertools.pairwise(column), 1):
            if after <= before:
                yield Problem(f"{key}[{i}]", f"a number > {before:g}, the one before", shown(after))
        for i, (before, after) in enumerate(zip(self.tension[:-1], self.tension[1:]), 1):
            if after < before:
                yield Problem(f"tension[{i}]", f"a number >= {before:g}, the one before", shown(after))

    @property
    def over_strain(self) -> bool:
        """Whether the table is over strain; else over stretch."""
        return self.strain is not None

    def entries(self) -> np.ndarray:
        """Strain (-) or stretch (m) of the table's entries, (n,)."""
        return np.array(self.strain if self.strain is not None else self.stretch, float)


class RopeLine(AnchoredLine, Consistent):
    """Straight line of a rope from anchor to fairlead (m), copied to each `heading` (deg).

    Headings are about the z axis.
    """

    rope: Text
    unstretched_length: Positive

    def _faults(self) -> Iterator[Problem]:
        if self.anchor == self.fairlead:
            yield Problem("fairlead", "a point that is not the anchor", shown(self.fairlead))


class TensionTableMooring(Consistent):
    """Mooring of straight ropes whose tension is a table."""

    kind: Literal["tension_table"]
    ropes: Annotated[dict[Text, Rope], Field(min_length=1)]
    lines: Annotated[tuple[RopeLine, ...], Field(min_length=1)]

    def _faults(self) -> Iterator[Problem]:
        names, used = ", ".join(self.ropes), {line.rope for line in self.lines}
        for i, line in enumerate(self.lines):
            if line.rope not in self.ropes:
                expected = f"a rope of `ropes` ({names})"
                yield Problem(f"lines[{i}].rope", expected, shown(line.rope), suggest(line.rope, self.ropes))
        for name in self.ropes:
            if name not in used and not suggest(name, used - set(self.ropes)):
                yield Problem(f"ropes.{name}", f"a rope that a line has ({', '.join(sorted(used))})", shown(name))

    def remarks(self) -> list[str]:
        """Warnings of lines that are slack, or stretched beyond their table, at the reference position."""
        slack, beyond, number = [], [], 0
        for line in self.lines:
            rope = self.ropes[line.rope]
            stretch = line.distance() - line.unstretched_length
            taken = stretch / line.unstretched_length if rope.over_strain else stretch
            for _ in line.heading:
                number += 1
                if stretch < -1e-9 * line.distance():
                    length = f"{line.unstretched_length:.4g} m unstretched"
                    slack.append(f"rope {number}: {line.distance():.4g} m to its anchor, {length}")
                elif taken > rope.entries()[-1]:
                    beyond.append(f"rope {number}: {taken:.4g}, and {rope.entries()[-1]:.4g} at the table's end")
        remarks = []
        if slack:
            remarks.append(f"mooring.lines: slack at the reference position, and pulling nothing there: {'; '.join(slack)}")
        if beyond:
            remarks.append(
                f"mooring.lines: stretched beyond the table at the reference position: {'; '.join(beyond)}. There the tension "
                "goes on as steeply as at the table's end"
            )
        return remarks
