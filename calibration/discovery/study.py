"""Records of a campaign and a model with all candidates at neutral values: residuals and linearisations."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from calibration.campaign.records import Record
from calibration.discovery.baseline_simulations import BaselineSimulations
from calibration.discovery.decay_simulations import DecaySimulations
from calibration.discovery.frequency_bands import FourierRows, step_of
from calibration.discovery.linearisations import Linearisation, MotionSeries, Point, SeaSelection
from calibration.discovery.record_simulations import KnownSlopes, LinearisationJob, RecordSimulations
from calibration.discovery.residual_slopes import SeaRecord
from calibration.parameters.space import ParameterSpace
from calibration.parameters.transforms import LogInterval, Scaled
from calibration.residuals.decays import DecayProblem
from calibration.residuals.moving_channels import moving
from calibration.residuals.wave_options import Options
from jaxhydro.dynamics.model import Model


@dataclass(frozen=True)
class Study:
    """All records of a campaign that take part, and one model with every candidate at its neutral value.

    Attributes:
        space: All parameters.
        model: The model.
        names: Names of the directions.
        directions: Orthogonal directions (d, p); most are one parameter, some move several together.
        width: Number of directions that are differentiated at a time.
        decays: The decays, or None.
        seas: The runs in waves.
        series: All motions of all tests.
        decay_records: Records of the decays.
        own_width: Standard deviations of the decays' own unknowns (r, o).
        cuts: Rows of the decays and of every run in waves.
        options: How seas are reconstructed.
        decay_size: Numbers of samples and of steps that decays are padded to; those of the whole records in every study.
        notes: Remarks on the wave records, in words.
        order_hint: Remark that the wave records lack the second-order waves of theory; also among the notes. Empty: none.
        expected: Expected size of rows (n,) over their floor (`expected_residuals`), or None.
        size_limits: Plausible steps from the start along every direction (d, 2), or None.
        baseline: The model without candidates, for points at which all are neutral; None: it would save no time.
    """

    space: ParameterSpace
    model: Model
    names: tuple[str, ...]
    directions: np.ndarray
    width: int
    decays: DecayProblem | None
    seas: tuple[SeaRecord, ...]
    series: tuple[MotionSeries, ...]
    decay_records: tuple[Record, ...]
    own_width: np.ndarray
    cuts: tuple[FourierRows, ...]
    options: Options
    decay_size: tuple[int, int] = (0, 0)
    notes: tuple[str, ...] = ()
    order_hint: str = ""
    expected: np.ndarray | None = None
    size_limits: np.ndarray | None = None
    baseline: Model | None = None

    @property
    def labels(self) -> tuple[str, ...]:
        return self.space.labels

    @property
    def logarithmic(self) -> np.ndarray:
        """Which directions are logarithms (d,); long steps along them are meaningless."""
        flags = np.array([isinstance(free.transform, LogInterval) for free in self.space.free])
        return (np.abs(self.directions) * flags).sum(axis=1) > 0

    @cached_property
    def dof(self) -> np.ndarray:
        """Degrees of freedom by series and band (s, b)."""
        return np.stack([series.dof for series in self.series])

    @cached_property
    def floor(self) -> np.ndarray:
        """Standard deviations by series and band (m, rad; s, b) below which there is no error."""
        return np.stack([series.floor for series in self.series])

    @cached_property
    def used(self) -> np.ndarray:
        """Which series are of fitted tests (s,)."""
        return np.array([series.use == "fit" for series in self.series])

    @cached_property
    def main(self) -> np.ndarray:
        """Which series are what their tests are about (s,).

        In a decay its own motion; in waves the motions that are not small beside others of their unit.
        """
        channels: dict[str, Sequence[str | None]] = {record.id: [record.degree_of_freedom] for record in self.decay_records}
        for test in {series.test for series in self.series} - set(channels):
            channels[test] = moving({series.channel: series.spread for series in self.series if series.test == test})
        return np.array([series.channel in channels[series.test] for series in self.series])

    @cached_property
    def row_series(self) -> np.ndarray:
        """Series of every row (n,)."""
        begins = np.cumsum([0, *(cut.members for cut in self.cuts)])
        return np.concatenate([cut.series + begin for cut, begin in zip(self.cuts, begins)])

    @cached_property
    def cell(self) -> np.ndarray:
        """Index of every row (n,) in a flattened array by series and band."""
        return self.row_series * self.dof.shape[1] + np.concatenate([cut.band for cut in self.cuts])

    @cached_property
    def frequency(self) -> np.ndarray:
        """Frequency (Hz) of every pair of rows: real and imaginary part of a Fourier line."""
        durations: list[float | np.ndarray] = []
        if self.decays is not None:
            steps = np.repeat([step_of(record.time) for record in self.decay_records], len(self.decays.data.dofs))
            durations.append(self.decays.data.time.shape[1] * steps)
        durations += [sea.duration for sea in self.seas]
        return np.concatenate([cut.frequencies(duration) for cut, duration in zip(self.cuts, durations, strict=True)])

    @cached_property
    def first_order(self) -> np.ndarray:
        """Which pairs of rows are at frequencies of first-order waves."""
        slow, seas = (np.array(each) for each in zip(*((series.slow, series.kind != "decay") for series in self.series)))
        mine = self.row_series[::2]
        return seas[mine] & (self.frequency > slow[mine])

    @cached_property
    def pooled(self) -> np.ndarray:
        """Degrees of freedom by pool (s, b), at the pool's first band."""
        totals = np.zeros_like(self.dof)
        for total, dof, series in zip(totals, self.dof, self.series):
            np.add.at(total, series.pool, dof)
        return totals

    def by_region(self, values: np.ndarray) -> np.ndarray:
        """Sums by region (s, 3) of values by band (s, b): in waves mean, slower, rest; a decay is one region."""
        return np.stack([np.bincount(series.region, mine, 3) for series, mine in zip(self.series, values)])

    @cached_property
    def pool(self) -> np.ndarray:
        """Index of every row's pool (n,) in a flattened array by series and band."""
        width = self.dof.shape[1]
        return self.row_series * width + np.stack([series.pool for series in self.series]).ravel()[self.cell]

    @cached_property
    def share(self) -> np.ndarray:
        """Weight of a row's square (n,) in the mean square of its pool, proportional to 1 / expected^2."""
        rows = np.bincount(self.cell, minlength=self.dof.size)[self.cell]
        trust = 1.0 if self.expected is None else 1 / self.expected**2
        each = self.dof.ravel()[self.cell] / rows * trust
        whole = np.bincount(self.pool, each, self.dof.size)[self.pool]
        floor = self.floor.ravel()[self.cell]
        return np.where(each > 0, trust / np.where(whole > 0, whole, 1.0), 0.0) / floor**2

    @cached_property
    def spans(self) -> tuple[slice, ...]:
        """Rows of every decay."""
        if self.decays is None:
            return ()
        channels = len(self.decays.data.dofs)
        ends = np.searchsorted(self.cuts[0].series, channels * np.arange(len(self.decay_records) + 1))
        return tuple(slice(a, b) for a, b in pairwise(ends))

    @cached_property
    def fitted_decays(self) -> np.ndarray:
        """Which decays are fitted (r,)."""
        return np.array([record.use == "fit" for record in self.decay_records], bool)

    def index(self, names: Sequence[str]) -> list[int]:
        """Numbers of the named directions."""
        return [self.names.index(name) for name in names]

    @cached_property
    def start(self) -> np.ndarray:
        """Coordinates where the study starts (p,)."""
        return np.asarray(self.space.start)

    def steps(self, x: np.ndarray) -> np.ndarray:
        """Distance of coordinates from the start along every direction (d,)."""
        return self.directions @ (x - self.start) / (self.directions**2).sum(axis=1)

    @cached_property
    def limits(self) -> np.ndarray:
        """Smallest and largest step from the start along every direction (d, 2): bounds and plausible sizes."""
        limits = np.tile([-np.inf, np.inf], (len(self.names), 1))
        for limit, row in zip(limits, self.directions):
            moved = np.flatnonzero(row)
            if len(moved) == 1 and isinstance(by := self.space.free[k := int(moved[0])].transform, Scaled):
                about = self.model.about(self.labels[k])
                ends = np.array([by.inverse(end) for end in (about.lower, about.upper)])
                limit[:] = np.sort((ends - self.start[k]) / row[k])
        if self.size_limits is not None:
            limits = np.stack(
                [np.maximum(limits[:, 0], self.size_limits[:, 0]), np.minimum(limits[:, 1], self.size_limits[:, 1])], 1
            )
        return limits

    def value(self, label: str, x: np.ndarray) -> float:
        """A parameter (SI) at given coordinates (p,)."""
        i = self.labels.index(label)
        return float(self.space.free[i].transform.forward(x[i]))

    @cached_property
    def simulations(self) -> RecordSimulations:
        """Simulations of the records."""
        uses = {series.test: series.use for series in self.series}
        with_fitted = tuple(any(uses[test] == "fit" for test in record.tests) for record in self.seas)
        decays = None if self.decays is None else DecaySimulations(self.decays, self.decay_size, self.width)
        return RecordSimulations(decays, self.seas, with_fitted, self.cuts, self.directions, self.width)

    @cached_property
    def baseline_simulations(self) -> BaselineSimulations | None:
        """Simulations without candidates, or None."""
        return None if self.baseline is None else BaselineSimulations.of(self.simulations, self.baseline, self.space)

    def _simulations(self, point: Point) -> RecordSimulations | BaselineSimulations:
        mine = self.baseline_simulations
        return self.simulations if mine is None or not mine.serves(point) else mine

    def motions(self, point: Point, seas: SeaSelection = "all") -> list[np.ndarray | None]:
        """Simulated minus measured motions in time (s, t), of the decays and of every run in waves."""
        return self._simulations(point).motions(point, seas)

    def residual(self, point: Point, seas: SeaSelection = "fit") -> np.ndarray:
        """Residual at a point in rows (n,); zeros of runs that are not simulated."""
        return self._simulations(point).residual(point, seas)

    def linearise(self, point: Point, active: Sequence[int], seas: SeaSelection = "fit") -> Linearisation:
        """Residual and slopes at a point, of the decays and of runs with a fitted test, or of all runs."""
        return self.linearise_all([(point, active)], seas)[0]

    def linearise_all(
        self, jobs: Sequence[LinearisationJob], seas: SeaSelection = "fit", keep: KnownSlopes | None = None
    ) -> list[Linearisation]:
        """Residual and slopes at several points along some directions each. See `RecordSimulations.linearise`."""
        mine = self.baseline_simulations
        if keep is None and mine is not None and all(mine.serves(*job) for job in jobs):
            return mine.linearise(jobs, seas)
        return self.simulations.linearise(jobs, seas, keep)

    def linearise_neutral(
        self, jobs: Sequence[LinearisationJob], by_state: KnownSlopes, moved: Sequence[int], seas: SeaSelection = "fit"
    ) -> list[Linearisation]:
        """Residual and slopes along neutral candidates. See `RecordSimulations.linearise_neutral`."""
        return self.simulations.linearise_neutral(jobs, by_state, moved, seas)

    def levels(self, residual: np.ndarray) -> np.ndarray:
        """Mean square over the floor's by series and pool (s, b)."""
        return np.bincount(self.pool, self.share * residual**2, self.dof.size).reshape(self.dof.shape)

    def mean_squares(self, residual: np.ndarray) -> np.ndarray:
        """Mean square over the floor's by series and band (s, b)."""
        power = np.bincount(self.cell, residual**2, self.dof.size).reshape(self.dof.shape)
        return np.where(self.dof > 0, power / np.where(self.dof > 0, self.dof, 1.0) / self.floor**2, 0.0)
