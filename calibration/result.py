"""Result of a calibration: estimates, and tests measured against simulated."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from calibration.campaign.manifest_sections import Use
from jaxhydro.dynamics.model import Model

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes

    from calibration.identifiability.findings import Identifiability

NOT_FOLLOWED_ERROR = 0.5  # RMSE over standard deviation beyond which a model does not follow its record


@dataclass(frozen=True, eq=False)
class Estimate:
    """A calibrated parameter and its uncertainty.

    Attributes:
        label: Name of the parameter, such as `column.Cd_t`.
        value: Calibrated value, in `unit`.
        standard_deviation: Standard deviation in `unit`; None where the records do not determine the parameter.
        unit: Unit of the parameter.
        meaning: Description of the parameter.
        start: Value where the fit began, in `unit`.
        at_bound: Whether the value is at one of its bounds.
        identifiable: Whether the records determine the parameter.
    """

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
    """Measured and simulated motion of one channel of one test, in SI units, zero in still water.

    Attributes:
        channel: Degree of freedom, such as `surge`.
        measured: (n,) measured motion less the sensor offset (m, rad).
        simulated: (n,) simulated motion at the recorded times (m, rad).
        offset: Sensor offset, taken off `measured` (m, rad).
        noise: Standard deviation of the measurement noise (m, rad).
        scored: Whether the series counts in the objective; of a decay, only its own degree of freedom does.
    """

    channel: str
    measured: np.ndarray
    simulated: np.ndarray
    offset: float
    noise: float
    scored: bool

    @property
    def rmse(self) -> float:
        """Root mean square of simulated less measured (m, rad)."""
        return float(np.sqrt(np.mean((self.measured - self.simulated) ** 2)))

    @property
    def relative(self) -> float:
        """RMSE over the standard deviation of the measured channel."""
        return self.rmse / max(float(np.std(self.measured)), 1e-300)


def error_of_energies(errors: Iterable[float]) -> float:
    """Root mean square of ln(simulated / measured) over relative errors of energies."""
    return float(np.sqrt(np.mean(np.log1p(np.maximum(list(errors), -0.999999)) ** 2)))


class BandError(NamedTuple):
    """Relative error of the energy in a band of a motion's spectrum, (simulated - measured) / measured.

    Attributes:
        after: Error after calibration.
        before: Error before calibration.
        low: Lower limit of the band (Hz).
        high: Upper limit of the band (Hz).
    """

    after: float
    before: float
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class TestFit:
    """Measured and simulated motions of one test.

    Attributes:
        id: Name of the test.
        use: Use of the test: `fit`, `holdout` or `ignore`.
        kind: Kind of the test, such as `decay` or `irregular`.
        degree_of_freedom: Degree of freedom that was released; None for tests in waves.
        time: (n,) recorded times (s).
        series: Measured and simulated motion, one entry per channel.
        start: Motion of the model before calibration (m, rad), by channel.
        file: Path of the data file.
        bands: Errors of energy, by channel and band.
    """

    __test__: ClassVar[bool] = False  # pytest takes names that begin so for tests

    id: str
    use: Use
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
    """A calibrated model, and how well it follows the campaign.

    Attributes:
        campaign: Name of the campaign.
        model: The calibrated model.
        parameters: Calibrated parameters, by label.
        tests: Measured and simulated motions, one entry per test.
        converged: Whether the fit converged and followed its records.
        iterations: Number of iterations.
        seconds: Duration of the calibration (s).
        history: Objective at each accepted iteration.
        notes: Findings in words.
        platform: Name of the platform.
        identifiability: What the fitted records determine; None where it was not computed.
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
        """Objective J: sum of RMSE over standard deviation, over the scored series of the tests of one use.

        Args:
            use: Use of the tests: `fit` or `holdout`.
            channel: Degree of freedom to which the sum is limited; None for all.

        Returns:
            The objective, or None where there is no such series.
        """
        scored = [s for test in self.tests if test.use == use for s in test.series if s.scored]
        parts = [s.relative for s in scored if channel in (None, s.channel)]
        return float(sum(parts)) if parts else None

    def __repr__(self) -> str:
        """The result in a sentence, and the parameters with their standard deviations."""
        from calibration.display.summaries import calibration_summary

        return calibration_summary(self)

    def _repr_html_(self) -> str:
        from calibration.display.data_frames import calibration_html

        return calibration_html(self)

    def to_xarray(self) -> "xr.Dataset":
        """Measured and simulated motions of all tests (m, deg), as in simulated.nc.

        Returns:
            Variables `measured`, `simulated`, `before` by test, channel and time; NaN where there is none.
        """
        from calibration.results.tests_dataset import dataset

        return dataset(self)

    def to_dataframe(self) -> "pd.DataFrame":
        """Calibrated parameters, in their own units.

        Returns:
            Columns `value`, `standard_deviation` (NaN where the records do not determine the parameter), `unit`, `start`,
            `identifiable`, `at_bound` and `meaning`; index `parameter`.
        """
        from calibration.display.data_frames import parameters_frame

        return parameters_frame(self)

    def plot(self, tests: Collection[str] | None = None) -> "list[Axes]":
        """Plot measured motion, that of the calibrated model and that before, of all tests.

        Args:
            tests: Names of the tests to show; None: all.

        Returns:
            Axes, one for each motion that counts in the objective; `axes[0].figure` is the figure.

        Raises:
            UnknownName: There is no such test.
            ValueError: There is no test to show.
        """
        from calibration.display.axes import calibration_axes

        return calibration_axes(self, tests)
