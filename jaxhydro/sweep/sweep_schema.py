"""Schema of the sweep file: checked, plain values in s, Hz, m and degrees."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated, Any, Literal, Self, TypeAlias

from pydantic import Discriminator, Field, Tag, model_validator

from jaxhydro.dynamics.requested_sea import MIN_SAMPLES, usual_transient
from jaxhydro.environment import DOFS
from jaxhydro.errors import Faults, Problem
from jaxhydro.input_schema import Consistent, Flag, Gamma, NonNegative, Number, Positive, Schema, Seed, Spreading, Text
from jaxhydro.integrators.mixed_precision import Precision
from jaxhydro.sweep.sea_states import OF_SWELL, swell_problems, table_problems
from jaxhydro.waves.sea import Stretching

Exponent = Annotated[float, Field(strict=True, ge=1, le=20)]
Dof: TypeAlias = Literal["surge", "sway", "heave", "roll", "pitch", "yaw"]
MAX_SAMPLES = 5_000_000  # samples of a run
COLUMNS = ("hs", "tp", "probability", "gamma", "heading", "spreading", *OF_SWELL)  # of a scatter table


class SeaState(Schema):
    """Sea state of a scatter table.

    Attributes:
        hs: Significant wave height (m).
        tp: Peak period (s).
        probability: Share of the time, in any unit.
        gamma: JONSWAP's peak enhancement (-); None: IEC's.
        heading: Direction that the waves travel to (deg); None: the headings of the sweep.
        spreading: Exponent s of the wind sea (-); None: that of the sweep.
        swell_hs: Significant wave height of a swell beside it (m); None: no swell.
        swell_tp: Peak period of the swell (s).
        swell_gamma: Peak enhancement of the swell (-); None: IEC's.
        swell_heading: Direction that the swell travels to (deg); None: that of the wind sea.
        swell_spreading: Exponent s of the swell (-); None: long-crested.
    """

    hs: Positive
    tp: Positive
    probability: NonNegative = 1.0
    gamma: Gamma | None = None
    heading: Number | None = None
    spreading: Spreading | None = None
    swell_hs: Positive | None = None
    swell_tp: Positive | None = None
    swell_gamma: Gamma | None = None
    swell_heading: Number | None = None
    swell_spreading: Spreading | None = None

    @model_validator(mode="after")
    def _swell_is_whole(self) -> Self:
        if problems := list(swell_problems(self.model_dump())):
            raise Faults(*problems)
        return self


class Grid(Schema):
    """Every wave height (m) with every period (s), and a row of probabilities for each height."""

    hs: Annotated[tuple[Positive, ...], Field(min_length=1)]
    tp: Annotated[tuple[Positive, ...], Field(min_length=1)]
    probability: tuple[tuple[NonNegative, ...], ...] | None = None

    @model_validator(mode="after")
    def _is_full(self) -> Self:
        if self.probability is not None:
            if len(self.probability) != len(self.hs):
                raise Faults(Problem("probability", f"{len(self.hs)} rows, one for each hs", f"{len(self.probability)}"))
            for i, row in enumerate(self.probability):
                if len(row) != len(self.tp):
                    raise Faults(Problem(f"probability[{i}]", f"{len(self.tp)} numbers, one for each tp", f"{len(row)}"))
        return self

    def states(self) -> tuple[SeaState, ...]:
        """Sea states of the grid, row by row."""
        shares = self.probability or ((1.0,) * len(self.tp),) * len(self.hs)
        return tuple(
            SeaState(hs=hs, tp=tp, probability=share) for hs, row in zip(self.hs, shares) for tp, share in zip(self.tp, row)
        )


class Heading(Schema):
    """Direction that the waves travel to (deg, from x towards y), and its share of the time in any unit."""

    heading: Number
    probability: NonNegative = 1.0


class Fatigue(Schema):
    """Slopes m of S-N curves, and the frequency (Hz) of the damage-equivalent ranges."""

    exponents: Annotated[tuple[Exponent, ...], Field(min_length=1)] = (3.0, 4.0, 5.0)
    equivalent_frequency: Positive = 1.0


def _form(value: Any) -> str:
    return "file" if isinstance(value, str) else "grid" if isinstance(value, dict | Grid) else "rows"


def _number_or(value: Any) -> str:
    return "one" if isinstance(value, int | float) else "more"


Rows: TypeAlias = Annotated[tuple[SeaState, ...], Field(min_length=1)]
Scatter = Annotated[
    Annotated[Text, Tag("file")] | Annotated[Rows, Tag("rows")] | Annotated[Grid, Tag("grid")], Discriminator(_form)
]
OneHeading = Annotated[Annotated[Number, Tag("one")] | Annotated[Heading, Tag("more")], Discriminator(_number_or)]
Many: TypeAlias = Annotated[tuple[Seed, ...], Field(min_length=1)]
MAX_SEEDS = 100_000
Number1 = Annotated[int, Field(strict=True, ge=1, le=MAX_SEEDS)]
Seeds = Annotated[Annotated[Number1, Tag("one")] | Annotated[Many, Tag("more")], Discriminator(_number_or)]


def _some_without_share(key: str, rows: tuple[Any, ...]) -> Iterator[Problem]:
    """Sea states or headings of a list without a probability, where others have one."""
    stated = [isinstance(row, Schema) and "probability" in row.model_fields_set for row in rows]
    if any(stated):
        for i, has_probability in enumerate(stated):
            if not has_probability:
                yield Problem(f"{key}[{i}]", "a probability, as others in the list have", "none")


class Sweep(Consistent):
    """Checked contents of a sweep file: every sea state with every heading and every seed.

    Defaults are those of `jaxhydro simulate`.
    """

    platform: Text
    calibration: Text | None = None
    scatter: Scatter = Field(description="a CSV file, a list of sea states (hs, tp, probability), or a grid (hs, tp)")
    spectrum: Literal["jonswap", "pierson_moskowitz"] = "jonswap"
    amplitudes: Literal["deterministic", "rayleigh"] = "deterministic"
    spreading: NonNegative | None = Field(
        default=None, description="short-crested: exponent s of cos^2s of half the angle; with order 1"
    )
    headings: Annotated[tuple[OneHeading, ...], Field(min_length=1)] = (0.0,)
    seeds: Seeds = Field(default=1, description=f"a number of seeds, 1 to {MAX_SEEDS}, or a list of whole numbers >= 0")
    duration: Positive = 3600.0
    transient: NonNegative | None = None
    time_step: Positive = 0.5
    step: Positive | None = None
    order: Literal[1, 2] = 2
    stretching: Stretching = "vertical"
    diffraction: Literal["maccamy_fuchs", "ramp", "none"] | None = None
    precision: Precision = "double"
    low: NonNegative | None = None
    cutoff: Positive | None = None
    motions: Annotated[tuple[Dof, ...], Field(min_length=1)] = DOFS  # type: ignore[assignment]
    time_series: Flag = False
    fatigue: Fatigue = Fatigue()

    def _faults(self) -> Iterator[Problem]:
        if self.spreading is not None and self.order != 1:
            yield Problem("order", "1 with spreading: second order is of long-crested seas", f"{self.order}")
        if self.low is not None and self.cutoff is not None and self.cutoff <= self.low:
            yield Problem("cutoff", f"a number above low, {self.low:g} Hz", f"{self.cutoff:g}")
        if self.transient is not None and self.transient >= self.duration:
            yield Problem("transient", f"less than the duration, {self.duration:g} s", f"{self.transient:g}")
            return
        for key in ("time_step", "step"):
            value = getattr(self, key)
            if value is not None and not 1 <= self.duration / value <= MAX_SAMPLES:
                limits = f"a number from {self.duration / MAX_SAMPLES:g} to {self.duration:g} s"
                yield Problem(key, f"{limits}, for a duration of {self.duration:g} s", f"{value:g}")
                return
        samples = (self.duration - self.start) / self.time_step
        if samples < MIN_SAMPLES:
            expected = f"{MIN_SAMPLES} samples or more after the transient of {self.start:g} s"
            yield Problem("duration", expected, f"{samples:.0f} of them {self.time_step:g} s apart")
        if not isinstance(self.scatter, str | Grid):
            for problem in self.faults_of_states(self.scatter):
                yield replace(problem, where=f"scatter{problem.where}")
        turns = [towards.heading % 360 for towards in self.towards]
        if twice := [turn for i, turn in enumerate(turns) if turn in turns[:i]]:
            yield Problem("headings", "each one once", f"{twice[0]:g} deg twice")
        for key in ("scatter", "headings"):
            if isinstance(rows := getattr(self, key), tuple):
                yield from _some_without_share(key, rows)
        lists: dict[str, Any] = {"motions": self.motions, "seeds": self.seeds, "fatigue.exponents": self.fatigue.exponents}
        for key, values in lists.items():
            if isinstance(values, tuple) and len(set(values)) < len(values):
                twice = next(value for i, value in enumerate(values) if value in values[:i])
                yield Problem(key, "each one once", f"{twice!r} twice")

    def faults_of_states(self, states: tuple[SeaState, ...]) -> Iterator[Problem]:
        """Mistakes in the sea states of this sweep; `where` begins with their number in brackets."""
        headings = [towards.heading for towards in self.towards] if "headings" in self.model_fields_set else None
        yield from table_problems(states, self.spectrum, self.order, headings)

    @property
    def towards(self) -> tuple[Heading, ...]:
        """Headings with their probabilities."""
        return tuple(item if isinstance(item, Heading) else Heading(heading=float(item)) for item in self.headings)

    @property
    def start(self) -> float:
        """Time (s) from which statistics are taken."""
        return usual_transient(self.duration) if self.transient is None else self.transient
