"""Schema of moorings of straight springs, or of a stiffness matrix, in SI."""

from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Discriminator, Field, Tag, model_validator

from jaxhydro.errors import Faults, Problem, shown
from jaxhydro.input_schema import NonNegative, Number, Positive, Schema, Vector
from jaxhydro.platform.matrix_schema import Entries, Matrix6, Stiffness


class NoMooring(Schema):
    """No mooring."""

    kind: Literal["none"] = "none"


class Line(Schema):
    """Straight massless spring from anchor to fairlead (m).

    It has a stiffness (N/m) and the pretension (N) at the reference position; or the axial stiffness EA (N) and the
    unstretched length (m).
    """

    anchor: Vector
    fairlead: Vector
    stiffness: Positive | None = None
    pretension: NonNegative | None = None
    axial_stiffness: Positive | None = None
    unstretched_length: Positive | None = None

    def spring(self, length_at_rest: float | None = None) -> tuple[float, float]:
        """Stiffness (N/m) and unstretched length (m).

        The pretension holds at `length_at_rest` (m); default: the distance from anchor to fairlead at the reference
        position.
        """
        if self.axial_stiffness is not None and self.unstretched_length is not None:
            return self.axial_stiffness / self.unstretched_length, self.unstretched_length
        assert self.stiffness is not None and self.pretension is not None
        if length_at_rest is None:
            length_at_rest = float(np.linalg.norm(np.subtract(self.anchor, self.fairlead)))
        return self.stiffness, length_at_rest - self.pretension / self.stiffness

    def slack(self) -> tuple[float, float] | None:
        """Distance from anchor to fairlead and unstretched length (m) of a slack line, or None.

        The distance is that at the reference position.
        """
        distance, unstretched = float(np.linalg.norm(np.subtract(self.anchor, self.fairlead))), self.spring()[1]
        return (distance, unstretched) if unstretched > distance * (1 + 1e-9) else None

    @model_validator(mode="after")
    def _one_spring(self) -> Self:
        if self.anchor == self.fairlead:
            raise Faults(Problem("fairlead", "a point that is not the anchor", shown(self.fairlead)))
        pairs = (("stiffness", "pretension"), ("axial_stiffness", "unstretched_length"))
        stated = [[key for key in pair if getattr(self, key) is not None] for pair in pairs]
        either = "either stiffness and pretension, or axial_stiffness and unstretched_length"
        if all(stated):
            raise Faults(Problem("", either, ", ".join(stated[0] + stated[1])))
        if not any(stated):
            raise Faults(Problem("", either, "neither"))
        for pair, got in zip(pairs, stated):
            if len(got) == 1:
                lacking = pair[1 - pair.index(got[0])]
                raise Faults(Problem(lacking, f"a number, since {got[0]} is given", "nothing"))
        return self


class LinearSprings(Schema):
    """Mooring of straight elastic lines."""

    kind: Literal["linear_springs"]
    lines: Annotated[tuple[Line, ...], Field(min_length=1)]

    def slackness(self) -> str:
        """Warning of lines that are slack at the reference position; "" where none is."""
        slack = [(i, *lengths) for i, line in enumerate(self.lines, 1) if (lengths := line.slack()) is not None]
        if not slack:
            return ""
        shown = [f"line {i}: {distance:.4g} m to its anchor, {length:.4g} m unstretched" for i, distance, length in slack[:6]]
        shown += [f"and {len(slack) - 6} more"] if len(slack) > 6 else []
        every = len(slack) == len(self.lines)
        counted = f"{len(slack)} of {len(self.lines)} lines are" if len(slack) > 1 else "one line is"
        subject = "every line is" if every else counted
        return (
            f"mooring.lines: {subject} slack at the reference position ({'; '.join(shown)})"
            + (", so nothing holds the platform there. " if every else ", and pulls nothing there. ")
            + "Lines here are straight, weightless springs. For a catenary take kind: catenary. Or take kind: "
            "stiffness_matrix with its stiffness and preload (its pull) at the reference position."
        )


Row = tuple[Number, Number, Number, Number, Number, Number]
Square = Annotated[
    Annotated[Stiffness, Tag("entries")] | Annotated[tuple[Row, Row, Row, Row, Row, Row], Tag("rows")],
    Discriminator(lambda value: "entries" if isinstance(value, dict | Entries) else "rows"),
]


class StiffnessMatrix(Schema):
    """Mooring about the reference position: force on the platform = preload - stiffness @ motion."""

    kind: Literal["stiffness_matrix"]
    stiffness: Square = Field(description="6 rows of 6 numbers, or entries C11 to C66")
    preload: Row = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)

    def matrix(self) -> Matrix6:
        """The stiffness, N/m, N/rad, N m/rad."""
        return self.stiffness.matrix() if isinstance(self.stiffness, Entries) else np.array(self.stiffness)
