"""How the bench takes times: process CPU time on one core, contestants taking turns in one run."""

import os
import statistics
import time
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

LEAST = 0.1  # s of CPU that a contestant's turn takes at least


class Row(NamedTuple):
    """One line of the results. `what` is its key and the same in every run."""

    what: str
    result: str
    goal: str = ""
    prototype: str = ""


class Turns(NamedTuple):
    """Seconds of one contestant, turn by turn."""

    seconds: tuple[float, ...]

    @property
    def median(self) -> float:
        return statistics.median(self.seconds)

    def over(self, contestant: "Turns") -> float:
        """How many times as long as another: the median over rounds, so that both had the same neighbours."""
        return statistics.median(a / b for a, b in zip(self.seconds, contestant.seconds, strict=True))


def pin() -> None:
    """Onto one core. To be called before NumPy and JAX are imported, which size their thread pools by it."""
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ[name] = "1"


def contest(
    contestants: Mapping[str, Callable[[], Any]], rounds: int, now: Callable[[], float] = time.process_time
) -> dict[str, Turns]:
    """All contestants `rounds` times in turns, after one call each that is not counted; calls wait for results. `now` is the
    clock (s): a device's time is no CPU time."""
    for call in contestants.values():
        call()
    seconds: dict[str, list[float]] = {name: [] for name in contestants}
    for _ in range(rounds):
        for name, call in contestants.items():
            count, begun = 0, now()
            while count == 0 or now() - begun < LEAST:
                call()
                count += 1
            seconds[name].append((now() - begun) / count)
    return {name: Turns(tuple(values)) for name, values in seconds.items()}


def times(ratio: float) -> str:
    """A ratio as text."""
    return f"{ratio:.3g} times"


def three(values: Any) -> str:
    """Relative errors of surge, heave and pitch as text."""
    return " / ".join(f"{value:.0e}" for value in values)
