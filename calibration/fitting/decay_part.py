"""Decays within a fit: errors, weights, objective J."""

from collections.abc import Sequence
from typing import ClassVar

import jax
import numpy as np

from calibration.campaign.records import Record
from calibration.fitting.weighted_residuals import AbstractPart, Kind, Loss, ResidualErrors, mean_square
from calibration.identifiability.information import MIN_VARIANCE
from calibration.identifiability.standard_deviations import WeightedProducts, correlated_samples
from calibration.residuals.abstract_residual import Unknowns
from calibration.residuals.decays import DecayData, DecayProblem
from calibration.result import Series, TestFit
from jaxhydro.environment import DOFS
from jaxhydro.exported_programs import exported_jit

# weight of a record's other channels against the released one, both in metres of the hull
SIDE_CHANNEL_WEIGHT = 0.1


class DecayPart(AbstractPart):
    """Decays within a fit.

    Attributes:
        problem: Their residuals, up to the end of the present window.
        records: The records.
        ends: Last recorded times (r,) in s.
        scored: Which channels count in J (r, c): of each record the one that was released.
        spread: Standard deviations of the measured channels (r, c) in m, rad.
        tests: Measured and simulated series where the fit was last simulated.
    """

    kind: ClassVar[Kind] = "decays"
    problem: DecayProblem

    def __init__(self, problem: DecayProblem, records: Sequence[Record], loss: Loss = "squares") -> None:
        super().__init__(loss)
        self.problem, self.records = problem, tuple(records)
        self.ends = np.array([record.time[-1] for record in records])
        self.scored, self.spread = scored_channels(records, problem.data)
        self.weight = np.ones(self.scored.shape)
        self.tests: list[TestFit] = []

    @property
    def samples(self) -> np.ndarray:
        """Number of samples in the present window (r, c)."""
        return samples_until(self.problem.data, self.problem.data.until)

    @property
    def share(self) -> float:
        """Share of the records' time in the present window."""
        begin = np.asarray(self.problem.data.time[:, 0])
        return float(np.sum(np.asarray(self.problem.data.until) - begin) / np.sum(self.ends - begin))

    @property
    def information(self) -> float:
        """Number of `independent_observations` in the present window."""
        return float(np.sum(independent_observations(self.problem.data)))

    def window(self, cycles: float) -> np.ndarray:
        """End of the first `cycles` cycles of the released motion (r,) in s."""
        data = self.problem.data
        return np.minimum(np.asarray(data.time[:, 0]) + cycles * 2 * np.pi / np.asarray(data.pace), self.ends)

    def record_weights(self, factor: np.ndarray, until: np.ndarray | None = None) -> np.ndarray:
        """Weights of the squares (r, c).

        With `factor` 1 the weighted sum is the sum over records of (RMSE / spread)^2. The other channels of a record tell how
        it was released. They count on the footing of the scored one, in metres of the hull (an angle times the radius of
        gyration), and not by their own small spread.

        Args:
            factor: Factor of every record (r,).
            until: End of the window (r,) in s; None for whole records.
        """
        data = self.problem.data
        samples = samples_until(data, self.ends if until is None else until)
        scale = np.where(self.scored, self.spread, np.asarray(data.unit))
        return np.where(self.scored, 1.0, SIDE_CHANNEL_WEIGHT) * factor[:, None] / (np.maximum(samples, 1) * scale**2)

    def residual_mean_squares(self) -> np.ndarray:
        """Mean square residual by record and channel over the present window (m2, rad2)."""
        assert self.products is not None, "nothing has been minimised yet"
        return self.products[..., -1, -1] / np.maximum(self.samples, 1)

    def objective(self) -> float:
        """J = sum of RMSE / standard deviation over the scored series."""
        return float(np.sum(np.where(self.scored, np.sqrt(self.residual_mean_squares()) / self.spread, 0.0)))

    def mean_squares(self) -> tuple[np.ndarray, np.ndarray]:
        assert self.errors is not None, "nothing has been estimated yet"
        relative, counts = self.residual_mean_squares() / self.spread**2, self.samples / self.errors.inflation
        return relative[self.scored], counts[self.scored]

    def series(self, unknowns: Unknowns) -> list[TestFit]:
        """Measured and simulated series of all records."""
        self.tests = series_of(self.problem, self.records, unknowns)
        return self.tests

    def estimate(self, unknowns: Unknowns) -> ResidualErrors:
        """Errors of every record's channels, not below their noise."""
        variance, inflation = np.full(self.scored.shape, MIN_VARIANCE), np.ones(self.scored.shape)
        for i, (test, record) in enumerate(zip(self.series(unknowns), self.records, strict=True)):
            for series in test.series:
                j = self.problem.data.dofs.index(DOFS.index(series.channel))
                r = series.simulated - series.measured
                n = len(r)
                variance[i, j] = max(mean_square(r, self.loss) * n / max(n - 3, 1), record.noise[series.channel] ** 2)
                inflation[i, j] = correlated_samples(r)
        return ResidualErrors(variance, inflation)

    def weigh(self, errors: ResidualErrors) -> np.ndarray:
        stated = np.array([record.test.weight for record in self.records])
        variance = errors.variance * errors.inflation
        precision = np.where(self.scored, self.samples * self.spread**2 / variance, 0.0).sum(axis=1)
        return self.record_weights(stated * precision)

    def covariance_parts(self, unknowns: Unknowns, ridge: np.ndarray) -> WeightedProducts:
        assert self.products is not None, "nothing has been minimised yet"
        return self.products, self.weight, *(self.errors or self.left_errors(self.series(unknowns)))

    def left_errors(self, tests: Sequence[TestFit]) -> ResidualErrors:
        """Errors of the residuals that a finished fit left.

        Args:
            tests: Series of the fit; those of its records come first.
        """
        data, products = self.problem.data, self.products
        assert products is not None, "nothing has been minimised yet"
        samples = np.maximum(np.asarray(data.present).sum(axis=-1), 1)
        inflation = np.ones(samples.shape)
        for i, test in enumerate(tests[: len(self.records)]):
            for series in test.series:
                inflation[i, data.dofs.index(DOFS.index(series.channel))] = correlated_samples(
                    series.simulated - series.measured
                )
        unknowns_per_channel = (products.shape[-1] - 1) / len(data.dofs)
        return ResidualErrors(products[..., -1, -1] / np.maximum(samples - unknowns_per_channel, 1), inflation)


def independent_observations(data: DecayData) -> np.ndarray:
    """Number of independent observations in the window of each record (r,).

    There are four in every cycle of the released motion. This holds where residuals are the model's error, not noise.

    Args:
        data: The records.
    """
    return 4 * (np.asarray(data.until) - np.asarray(data.time[:, 0])) / (2 * np.pi / np.asarray(data.pace))


def scored_channels(records: Sequence[Record], data: DecayData) -> tuple[np.ndarray, np.ndarray]:
    """Channels that count in the objective, and the standard deviation of every channel.

    Args:
        records: The records.
        data: The records as arrays.

    Returns:
        Whether each channel of each record counts (r, c), and its standard deviation (r, c) in m, rad.
    """
    counts = np.zeros((len(records), len(data.dofs)), dtype=bool)
    spread = np.ones((len(records), len(data.dofs)))
    for i, record in enumerate(records):
        for j, dof in enumerate(data.dofs):
            if DOFS[dof] in record.values:
                spread[i, j] = max(float(np.std(record.values[DOFS[dof]])), 1e-300)
                counts[i, j] = DOFS[dof] == record.degree_of_freedom
    return counts, spread


def samples_until(data: DecayData, until) -> np.ndarray:
    """Number of samples of every record and channel up to `until` (s, by record)."""
    return (np.asarray(data.present) * (np.asarray(data.time) <= np.asarray(until)[:, None])[:, None]).sum(axis=-1)


@exported_jit
def _motions(problem: DecayProblem, unknowns: Unknowns, x):
    return jax.lax.map(lambda inputs: problem.motion(x, *inputs), (unknowns.own, problem.data))


def series_of(
    problem: DecayProblem, records: Sequence[Record], unknowns: Unknowns, before: DecayProblem | None = None
) -> list[TestFit]:
    """Measured and simulated series of every record.

    Args:
        problem: Residuals of the calibrated model.
        records: The records.
        unknowns: Coordinates that the fit reached.
        before: The same with the model that the calibration started from; None: `problem`.
    """
    data = problem.data
    after = np.asarray(_motions(problem, unknowns, unknowns.shared))
    earlier = problem if before is None else before
    start = np.asarray(_motions(earlier, unknowns, earlier.space.start))
    offsets = np.asarray(unknowns.own).reshape(len(records), 3, -1)[:, 2] * np.asarray(data.unit)
    tests = []
    for i, record in enumerate(records):
        n, series, first = len(record.time), [], {}
        for j, dof in enumerate(data.dofs):
            channel = DOFS[dof]
            if channel not in record.values:
                continue
            offset = float(offsets[i, j])
            series.append(
                Series(
                    channel,
                    record.values[channel] - offset,
                    after[i, j, :n] - offset,
                    offset,
                    record.noise[channel],
                    channel == record.degree_of_freedom,
                )
            )
            first[channel] = start[i, j, :n] - offset
        tests.append(
            TestFit(
                record.id, record.use, record.kind, record.degree_of_freedom, record.time, tuple(series), first, record.file
            )
        )
    return tests
