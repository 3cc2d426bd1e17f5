"""Cases and runs of a sweep, in order: sea states, headings and seeds as plain values."""

import json
import math
import statistics
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

from jaxhydro.errors import InputError, Problem, shown
from jaxhydro.integrators.mixed_precision import Precision
from jaxhydro.sweep.sea_states import State, named
from jaxhydro.sweep.sweep_schema import Grid, Heading, SeaState, Sweep
from jaxhydro.waves.wave_bands import of_spectra


class Case(NamedTuple):
    """Sea state and heading.

    Attributes:
        hs: Significant wave height (m).
        tp: Peak period (s).
        gamma: Peak enhancement (-); None: IEC's, or not a JONSWAP spectrum.
        heading: Direction that the waves travel to (deg).
        probability: Fraction of the time.
        spreading: As in `State`, and so are all that follow.
        swell_hs: Significant wave height of the swell (m).
        swell_tp: Peak period of the swell (s).
        swell_gamma: Peak enhancement of the swell (-).
        swell_heading: Direction that the swell travels to (deg).
        swell_spreading: Exponent s of the swell (-).
    """

    hs: float
    tp: float
    gamma: float | None
    heading: float
    probability: float
    spreading: float | None = None
    swell_hs: float | None = None
    swell_tp: float | None = None
    swell_gamma: float | None = None
    swell_heading: float | None = None
    swell_spreading: float | None = None

    @property
    def state(self) -> State:
        """Sea state without its heading."""
        return State.of(self)

    @property
    def towards(self) -> set[float]:
        """Mean directions that its systems travel to (deg)."""
        return {self.heading} if self.swell_hs is None or self.swell_heading is None else {self.heading, self.swell_heading}


class Run(NamedTuple):
    """One simulation of a sweep.

    Attributes:
        number: Number of the run in the sweep.
        row: Number of its case.
        column: Number of its seed.
        case: Sea state and heading.
        seed: Seed of the random numbers.
    """

    number: int
    row: int
    column: int
    case: Case
    seed: int


@dataclass(frozen=True)
class Plan:
    """Cases, seeds and options of a sweep.

    Run `number` has case number // seeds and seed number % seeds. The random seed of a run is its seed alone, as in
    `jaxhydro simulate --seed`. So it does not depend on the order, and one seed's phases are the same in all cases. Units
    are those of `Sweep`; statistics begin at `start` (s).
    """

    cases: tuple[Case, ...]
    seeds: tuple[int, ...]
    spectrum: str
    amplitudes: str
    duration: float
    start: float
    time_step: float
    step: float | None
    order: int
    stretching: str
    diffraction: str | None
    low: float
    cutoff: float
    motions: tuple[str, ...]
    time_series: bool
    exponents: tuple[float, ...]
    equivalent_frequency: float
    spreading: float | None = None
    precision: Precision = "double"

    def __len__(self) -> int:
        return len(self.cases) * len(self.seeds)

    def run(self, number: int) -> Run:
        """Run of a number."""
        row, column = divmod(number, len(self.seeds))
        return Run(number, row, column, self.cases[row], self.seeds[column])

    def to_json(self) -> str:
        """JSON text of the plan."""
        return json.dumps(asdict(self), indent=1, allow_nan=False) + "\n"

    @classmethod
    def from_json(cls, text: str) -> "Plan":
        """Plan from the text of `to_json`."""
        data = json.loads(text)
        lists = {name: tuple(value) for name, value in data.items() if isinstance(value, list)}
        return cls(**data | lists | {"cases": tuple(Case(*row) for row in data["cases"])})

    def differences(self, other: "Plan") -> Iterator[tuple[str, str, str]]:
        """Keys in which two plans differ, with both values as text."""
        mine, others = asdict(self), asdict(other)
        for name, value in mine.items():
            if value != others[name]:
                if name != "cases":
                    yield name, _short(value), _short(others[name])
                    continue
                yield self._case_apart(other)

    def _case_apart(self, other: "Plan") -> tuple[str, str, str]:
        """`differences` of cases: the heading or the sea state that changed."""
        by: dict[str, tuple[str, Callable[[Case], Any], Callable[[Any], str]]] = {
            "headings": ("headings", lambda case: case.heading, lambda heading: f"heading {heading:g} deg"),
            "scatter": ("sea states", lambda case: case.state, named),
        }
        for key, (many, value_of, text) in by.items():
            mine, others = (_shares(plan.cases, value_of) for plan in (self, other))
            if len(mine) != len(others):
                return key, f"{len(mine)} {many}", f"{len(others)}"
            pairs = list(zip(mine.items(), others.items()))
            moved = next(((a, b) for a, b in pairs if a[0] != b[0]), None)
            if moved is None:
                # those of all others are divided by another sum
                ratio = [math.log(b[1] / a[1]) for a, b in pairs]
                usual = statistics.median_low(ratio)
                away = [abs(logarithm - usual) for logarithm in ratio]
                moved = pairs[away.index(max(away))] if max(away) > 1e-9 else None
            if moved is not None:
                before, after = (f"{text(value)}, with {share:.4%} of the life" for value, share in moved)
                return key, before, after
        return "scatter", f"{len(self.cases)} cases of a probability above 0", f"{len(other.cases)}"


def _shares(cases: Sequence[Case], value_of: Callable[[Case], Any]) -> dict[Any, float]:
    """Fractions of the lifetime, summed by the value of `value_of` for each case."""
    shares: dict[Any, float] = {}
    for case in cases:
        shares[value_of(case)] = shares.get(value_of(case), 0.0) + case.probability
    return shares


def _short(value: Any) -> str:
    return shown(list(value) if isinstance(value, tuple) else value)


def plan_of(sweep: Sweep, source: str, pace: float = 1.0) -> tuple[Plan, list[str]]:
    """Plan of a sweep, for a platform of a `pace`, and notes on how it was made.

    Without a band in the sweep, it is that of the sea states by `jaxhydro.waves.wave_bands`, weighted by Hs² and
    probability. Probabilities of sea states and of headings multiply and are divided by their sum. Those of a sea state that
    is in the table more than once add up.

    Args:
        sweep: Checked contents of a sweep file.
        source: Name of the sweep in errors.
        pace: Time scale (-) of the platform relative to VolturnUS-S.

    Raises:
        InputError: No probability is above 0, or the band is empty.
    """
    states: tuple[SeaState, ...] = sweep.scatter.states() if isinstance(sweep.scatter, Grid) else sweep.scatter  # type: ignore[assignment]
    notes: list[str] = []
    shares: dict[tuple[State, float | None], float] = {}
    twice: dict[State, None] = {}
    for row in states:
        state = State.of(row)
        if (state, row.heading) in shares:
            twice[state] = None
        shares[state, row.heading] = shares.get((state, row.heading), 0.0) + row.probability
    if twice:
        more = f" and {len(twice) - 1} more are" if len(twice) > 1 else " is"
        notes.append(f"{named(next(iter(twice)))}{more} in the table more than once: run once, and its probabilities add up")
    every = [
        Case(state.hs, state.tp, state.gamma, towards.heading, share * towards.probability, *state[3:])
        for (state, heading), share in shares.items()
        for towards in (sweep.towards if heading is None else (Heading(heading=heading),))
    ]
    total = sum(case.probability for case in every)
    if not total > 0:
        key = "headings" if any(share > 0 for share in shares.values()) else "scatter"
        raise InputError(source, [Problem(key, "a probability above 0", "none")])
    cases = tuple(case._replace(probability=case.probability / total) for case in every if case.probability > 0)
    if left_out := len(every) - len(cases):
        notes.append(f"{left_out} case{'s' * (left_out > 1)} of probability 0 {'are' if left_out > 1 else 'is'} left out")
    seeds = tuple(range(sweep.seeds)) if isinstance(sweep.seeds, int) else sweep.seeds
    same: tuple[str, ...] = (
        "spectrum",
        "amplitudes",
        "duration",
        "start",
        "time_step",
        "step",
        "order",
        "stretching",
        "diffraction",
        "motions",
        "time_series",
        "spreading",
        "precision",
    )
    if sweep.precision == "mixed":
        notes.append("loads were computed in float32 (precision: mixed)")
    peaks = [(tp, case.probability * hs**2) for case in cases for hs, tp in case.state.peaks]
    usual = of_spectra([tp for tp, _ in peaks], pace, [weight for _, weight in peaks])
    low, cutoff = (default if limit is None else limit for limit, default in zip((sweep.low, sweep.cutoff), usual))
    if not cutoff > low:
        raise InputError(source, [Problem("cutoff", f"a number above low, {low:g} Hz", f"{cutoff:g}")])
    fatigue: dict[str, Any] = {"exponents": sweep.fatigue.exponents, "equivalent_frequency": sweep.fatigue.equivalent_frequency}
    options: dict[str, Any] = {name: getattr(sweep, name) for name in same}
    return Plan(cases, seeds, low=low, cutoff=cutoff, **options, **fatigue), notes
