"""What a sweep runs, in order: every case, a sea state from a heading, with every seed. Plain values, as kept on disk."""

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

from jaxhydro.problems import InputError, Problem, shown
from jaxhydro.sweep.schema import Grid, SeaState, Sweep


class Case(NamedTuple):
    """A sea state (m, s; gamma None: IEC's, or no JONSWAP), where it runs to (deg) and its share of the time."""

    hs: float
    tp: float
    gamma: float | None
    heading: float
    probability: float


class Run(NamedTuple):
    """One sea: its number in the sweep, those of its case and of its seed, the case and the seed."""

    number: int
    row: int
    column: int
    case: Case
    seed: int


@dataclass(frozen=True)
class Plan:
    """A sweep that can be run: run `number` is case number // seeds with seed number % seeds.

    The random seed of a run is its seed and nothing else, as in `jaxhydro simulate --seed`: so it does not depend on the order,
    and one seed's phases are the same in all cases. Units are those of `Sweep`; `start` (s) is where statistics begin.
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

    def __len__(self) -> int:
        return len(self.cases) * len(self.seeds)

    def run(self, number: int) -> Run:
        """The run of a number."""
        row, column = divmod(number, len(self.seeds))
        return Run(number, row, column, self.cases[row], self.seeds[column])

    def to_json(self) -> str:
        """As text, from which the same plan is read."""
        return json.dumps(asdict(self), indent=1, allow_nan=False) + "\n"

    @classmethod
    def from_json(cls, text: str) -> "Plan":
        """From what `to_json` wrote."""
        data = json.loads(text)
        lists = {name: tuple(value) for name, value in data.items() if isinstance(value, list)}
        return cls(**data | lists | {"cases": tuple(Case(*row) for row in data["cases"])})

    def differences(self, other: "Plan") -> Iterator[tuple[str, str, str]]:
        """Keys of two plans that differ, with the values of both as text."""
        mine, others = asdict(self), asdict(other)
        for name, value in mine.items():
            if value != others[name]:
                if name != "cases":
                    yield name, _short(value), _short(others[name])
                    continue
                apart = [(i, a, b) for i, (a, b) in enumerate(zip(value, others[name])) if a != b]
                if len(value) != len(others[name]) or not apart:
                    yield "cases", f"{len(value)} of them", f"{len(others[name])}"
                else:
                    i, a, b = apart[0]
                    yield f"case {i}", _short(list(a)), _short(list(b))


def _short(value: Any) -> str:
    return shown(list(value) if isinstance(value, tuple) else value)


def plan_of(sweep: Sweep, source: str) -> tuple[Plan, int]:
    """The plan of a sweep whose files are read, and the number of cases of probability 0, which are left out.

    Shares of sea states and of headings multiply, and are divided by their sum. Raises InputError that names `source` where
    none is above 0.
    """
    states: tuple[SeaState, ...] = sweep.scatter.states() if isinstance(sweep.scatter, Grid) else sweep.scatter  # type: ignore[assignment]
    every = [
        Case(state.hs, state.tp, state.gamma, one.heading, state.probability * one.probability)
        for state in states
        for one in sweep.towards
    ]
    total = sum(case.probability for case in every)
    if not total > 0:
        key = "headings" if any(state.probability > 0 for state in states) else "scatter"
        raise InputError(source, [Problem(key, "a probability above 0", "none")])
    cases = tuple(case._replace(probability=case.probability / total) for case in every if case.probability > 0)
    seeds = tuple(range(sweep.seeds)) if isinstance(sweep.seeds, int) else sweep.seeds
    same: tuple[str, ...] = ("spectrum", "amplitudes", "duration", "start", "time_step", "step", "order", "stretching",
    "diffraction", "low", "cutoff", "motions", "time_series")  # fmt: skip
    fatigue: dict[str, Any] = {"exponents": sweep.fatigue.exponents, "equivalent_frequency": sweep.fatigue.equivalent_frequency}
    options: dict[str, Any] = {name: getattr(sweep, name) for name in same}
    return Plan(cases, seeds, **options, **fatigue), len(every) - len(cases)
