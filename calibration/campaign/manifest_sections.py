"""Sections of campaign.yaml: channels, zero, tests, records, and what is calibrated."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, PlainValidator, model_validator

from calibration.campaign.stated_sea import Sea
from jaxhydro.errors import Faults, Problem, shown
from jaxhydro.input_schema import NonNegative, Number, Positive, Schema, Text
from jaxhydro.units import SI
from jaxhydro.waves import second_order
from jaxhydro.waves.irregular_sea import Acting

DOFS = ("surge", "sway", "heave", "roll", "pitch", "yaw")
CHANNELS = ("time", *DOFS)
WAVE = "wave"  # the wave channel's name among the others
SECOND_WAVE = "second_wave"  # that of a second wave gauge
GAUGES = (WAVE, SECOND_WAVE)


def quantity(channel: str) -> str:
    """What a channel measures: time, length or angle."""
    return "time" if channel == "time" else "angle" if channel in DOFS[3:] else "length"


def _column(value: Any) -> Any:
    if not (isinstance(value, str) and value) and not (type(value) is int and value >= 0):
        raise ValueError("a column's name, or its number, 0 for the first")
    return value


Use = Literal["fit", "holdout", "ignore"]
Kind = Literal["decay", "regular", "irregular", "static", "forced"]
IN_WAVES: tuple[Kind, ...] = ("regular", "irregular")
Motion = Literal["surge", "sway", "heave", "roll", "pitch", "yaw"]
Name = Annotated[Text, BeforeValidator(lambda value: str(value) if type(value) is int else value)]
Column = Annotated[str | int, PlainValidator(_column)]
Unit = Annotated[Text, Field(description="a unit: " + ", ".join(unit for units in SI.values() for unit in units))]
Sign = Annotated[Literal[1, -1], BeforeValidator(lambda value: int(value) if value in (1.0, -1.0) else value)]
Window = tuple[Number, Number]  # on the file's own time axis


class Channel(Schema):
    """One column of the files."""

    column: Column
    unit: Unit
    sign: Sign = 1


class WaveChannel(Channel):
    """The undisturbed elevation. `position` is where it was measured, m at the scale of the files."""

    position: tuple[Number, Number] | None = None


class Override(Schema):
    """What differs in one test's file."""

    column: Column | None = None
    unit: Unit | None = None
    sign: Sign | None = None


class Zero(Schema):
    """Where still water is: a window of the same file, or a test."""

    window: Window | None = None
    test: Name | None = None

    @model_validator(mode="after")
    def _one_of_them(self) -> Zero:
        if (self.window is None) == (self.test is None):
            raise Faults(Problem("", "either a window or a test", "both" if self.test else "neither"))
        return self


class Test(Schema):
    """One test: a file, or a window of it."""

    __test__ = False  # not for pytest

    id: Name
    kind: Kind
    file: Name
    use: Use = "fit"
    degree_of_freedom: Motion | None = None
    window: Window | None = None
    channels: dict[str, Override | None] = Field(default_factory=dict)
    repeat_of: Name | None = None
    sea: Sea = Sea()
    significant_wave_height: Positive | None = None
    peak_period: Positive | None = None
    wave_height: Positive | None = None
    period: Positive | None = None
    transient: NonNegative = 0.0
    weight: Positive = 1.0


class Recording(Schema):
    """Waves that the records have.

    Attributes:
        order: 1: linear waves; 2: with the bound waves of second order.
        kinds: Pairs of waves that bind others: at sums or differences of their frequencies.
        highest_difference: Highest difference frequency (Hz on the files' time axis) of bound waves; None: all.
        acting: Where bound waves act on the platform.
    """

    order: Literal[1, 2] = 2
    kinds: Annotated[tuple[second_order.Kind, ...], Field(min_length=1)] = second_order.KINDS
    highest_difference: Positive | None = None
    acting: Acting = "everywhere"

    @model_validator(mode="after")
    def _second_order(self) -> Recording:
        if self.order == 1 and (stated := sorted(self.model_fields_set - {"order"})):
            raise Faults(*(Problem(key, "nothing, since linear waves bind none", shown(getattr(self, key))) for key in stated))
        return self


class Period(Schema):
    """A natural period, s, and its standard deviation."""

    value: Positive
    standard_deviation: Positive


class Prior(Schema):
    """A normal prior, in the parameter's own unit."""

    value: Number
    standard_deviation: Positive


class Calibrate(Schema):
    """Parameters to calibrate, as labels or patterns such as `column.*`.

    Without `free`, all parameters that the model declares are calibrated.
    """

    free: tuple[Text, ...] | None = None
    fixed: tuple[Text, ...] = ()
    bounds: dict[str, tuple[Number, Number]] = Field(default_factory=dict)
    priors: dict[str, Prior] = Field(default_factory=dict)
    natural_periods: dict[Text, Period] = Field(default_factory=dict)
