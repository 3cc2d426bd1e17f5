"""Schema of the directions of a test's waves: heading, spreading, or wave systems."""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from jaxhydro.errors import Faults, Problem, shown
from jaxhydro.input_schema import Gamma, Number, Positive, Schema, Seed, Spreading


class System(Schema):
    """A wave system of a sea: wind sea or swell.

    Its keys are those of `jaxhydro simulate --sea`; lengths and times (m, s) are as in the files.
    """

    hs: Positive
    tp: Positive
    gamma: Gamma | None = None
    heading: Number = 0.0
    spreading: Spreading | None = None
    spectrum: Literal["jonswap", "pierson-moskowitz"] = "jonswap"


class Sea(Schema):
    """Directions of a test's waves.

    Attributes:
        heading: Direction that they travel to (deg): 0 is along +x.
        spreading: Exponent s of a short-crested sea (-); None: long-crested.
        systems: Wave systems with their own headings, in place of both; empty: one.
        seed: Seed of the random directions of a sea of several headings.
    """

    heading: Number = 0.0
    spreading: Spreading | None = None
    systems: tuple[System, ...] = ()
    seed: Seed = 0

    @model_validator(mode="after")
    def _one_of_them(self) -> Sea:
        if self.systems and (stated := sorted(self.model_fields_set & {"heading", "spreading"})):
            raise Faults(*(Problem(key, "nothing, since systems have their own", shown(getattr(self, key))) for key in stated))
        return self

    @property
    def long_crested(self) -> bool:
        """Whether all waves travel one way."""
        headings = {system.heading % 360 for system in self.systems}
        return self.spreading is None and len(headings) < 2 and all(system.spreading is None for system in self.systems)

    @property
    def mean_heading(self) -> float:
        """Heading of the sea, or of its highest system (deg)."""
        return max(self.systems, key=lambda system: system.hs).heading if self.systems else self.heading
