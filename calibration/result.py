"""Result of a calibration: estimates, and tests measured against simulated."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from jaxhydro.dynamics.model import Model

if TYPE_CHECKING:
    from calibration.identifiability.directions import Identifiability


@dataclass(frozen=True, eq=False)
class Estimate:
    """A calibrated parameter. `standard_deviation` is None where the records do not determine it (`identifiable` False)."""

    label: str
    value: float
    standard_deviation: float | None
    unit: str
    meaning: str
    start: float
    at_bound: bool
    identifiable: bool


@dataclass(frozen=True, eq=False)
class Series:
    """One channel of one test: measured and simulated at the recorded times, SI, still water at zero, sensor offset taken
    off the measured one. `scored`: it counts in the objective (a decay's own degree of freedom does; the others are shown)."""

    channel: str
    measured: np.ndarray
    simulated: np.ndarray
    offset: float
    noise: float
    scored: bool

    @property
    def rmse(self) -> float:
        """Root mean square of measured less simulated (m, rad)."""
        return float(np.sqrt(np.mean((self.measured - self.simulated) ** 2)))

    @property
    def relative(self) -> float:
        """RMSE over the standard deviation of the measured channel."""
        return self.rmse / max(float(np.std(self.measured)), 1e-300)


def error_of_energies(errors: Iterable[float]) -> float:
    """Root mean square of ln(simulated / measured) over relative errors of energies."""
    return float(np.sqrt(np.mean(np.log1p(np.maximum(list(errors), -0.999999)) ** 2)))


class BandError(NamedTuple):
    """(simulated - measured) / measured energy in a band of a motion's spectrum, after and before calibration; limits in Hz."""

    after: float
    before: float
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class TestFit:
    """One test: its records against the model's motion. `start` is the model's motion before calibration, by channel."""

    id: str
    use: str
    kind: str
    degree_of_freedom: str | None
    time: np.ndarray
    series: tuple[Series, ...]
    start: dict[str, np.ndarray]
    file: str
    bands: Mapping[str, Mapping[str, "BandError"]] = field(default_factory=dict)  # by channel and band

    @property
    def main(self) -> Series:
        """The series of the released degree of freedom, or the first."""
        return next((s for s in self.series if s.channel == self.degree_of_freedom), self.series[0])


@dataclass(frozen=True, eq=False)
class Calibration:
    """A calibrated model and how well it follows its campaign.

    `objective` is J = sum of RMSE over standard deviation over the scored series of the tests of one use; None where there
    are none. `history` is J at each accepted iteration. `notes` are findings in words, `identifiability` the numbers of what
    the fitted records determine.
    """

    campaign: str
    model: Model
    parameters: dict[str, Estimate]
    tests: tuple[TestFit, ...]
    converged: bool
    iterations: int
    seconds: float
    history: tuple[float, ...]
    notes: tuple[str, ...]
    platform: str = ""
    identifiability: "Identifiability | None" = None

    def objective(self, use: str, channel: str | None = None) -> float | None:
        """J over the tests of one use (fit, holdout): of all motions that are scored, or what one of them has in it."""
        scored = [s for test in self.tests if test.use == use for s in test.series if s.scored]
        parts = [s.relative for s in scored if channel in (None, s.channel)]
        return float(sum(parts)) if parts else None
