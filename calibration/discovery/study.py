"""All records of a campaign and one model: residuals and linearisations at any point."""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import cached_property, reduce
from itertools import islice, pairwise
from typing import Any, TypeAlias

import jax
import jax.numpy as jnp
import numpy as np

from calibration.campaign.records import Record
from calibration.discovery.frequency_bands import FourierRows, step_of
from calibration.discovery.linearisations import Linearisation, MotionSeries, Point, SeaSelection
from calibration.discovery.residuals import Frame, SeaRecord, decay_residual, decay_slopes, sea_residuals
from calibration.discovery.sea_slopes import COMPARED_AT_ONCE, Accelerations, sea_slopes
from calibration.fitting.cores import cores
from calibration.parameters.space import ParameterSpace
from calibration.parameters.transforms import LogInterval, Scaled
from calibration.residuals.decays import DecayData, DecayProblem
from calibration.residuals.moving_channels import moving
from calibration.residuals.wave_options import Options
from jaxhydro.dynamics.model import Model
from jaxhydro.interrupts import stoppable_threads

OVERFLOW = 1e100  # motions and slopes from here on are those of a diverging simulation

LinearisationJob: TypeAlias = tuple[Point, Sequence[int]]  # a point, and the directions to linearise along
KnownSlopes: TypeAlias = dict[tuple[str, ...], Accelerations]  # of accelerations by the state, by the tests of a run
_Slopes: TypeAlias = Callable[[], list[tuple[np.ndarray, np.ndarray] | None]]  # waits for residuals and slopes


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
        notes: Remarks on the wave records, in words.
        expected: Expected size of rows (n,) over their floor (`expected_residuals`), or None.
        size_limits: Plausible steps from the start along every direction (d, 2), or None.
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
    notes: tuple[str, ...] = ()
    expected: np.ndarray | None = None
    size_limits: np.ndarray | None = None

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
        return np.stack([one.dof for one in self.series])

    @cached_property
    def floor(self) -> np.ndarray:
        """Standard deviations by series and band (m, rad; s, b) below which there is no error."""
        return np.stack([one.floor for one in self.series])

    @cached_property
    def used(self) -> np.ndarray:
        """Which series are of fitted tests (s,)."""
        return np.array([one.use == "fit" for one in self.series])

    @cached_property
    def main(self) -> np.ndarray:
        """Which series are what their tests are about (s,).

        In a decay its own motion; in waves the motions that are not small beside others of their unit.
        """
        own = {record.id: record.degree_of_freedom for record in self.decay_records}
        moves = {
            test: moving({one.channel: one.spread for one in self.series if one.test == test})
            for test in {one.test for one in self.series} - set(own)
        }
        return np.array(
            [one.channel == own[one.test] if one.test in own else one.channel in moves[one.test] for one in self.series]
        )

    @cached_property
    def row_series(self) -> np.ndarray:
        """Series of every row (n,)."""
        begins = np.cumsum([0, *(one.members for one in self.cuts)])
        return np.concatenate([one.series + begin for one, begin in zip(self.cuts, begins)])

    @cached_property
    def cell(self) -> np.ndarray:
        """Index of every row (n,) in a flattened array by series and band."""
        return self.row_series * self.dof.shape[1] + np.concatenate([one.band for one in self.cuts])

    @cached_property
    def frequency(self) -> np.ndarray:
        """Frequency (Hz) of every pair of rows: real and imaginary part of a Fourier line."""
        frequencies = []
        if self.decays is not None:
            times = np.asarray(self.decays.data.time)
            steps = np.repeat([step_of(one.time) for one in self.decay_records], len(self.decays.data.dofs))
            frequencies.append((self.cuts[0], times.shape[1] * steps))
        for record, cut in zip(self.seas, self.cuts[len(frequencies) :]):
            length = record.measured.shape[-1] * float(record.times[1] - record.times[0])
            frequencies.append((cut, np.full(cut.members, length)))
        return np.concatenate([cut.take % cut.lines / length[cut.take // cut.lines] for cut, length in frequencies])

    @cached_property
    def first_order(self) -> np.ndarray:
        """Which pairs of rows are at frequencies of first-order waves."""
        slow, seas = (np.array(each) for each in zip(*((one.slow, one.kind != "decay") for one in self.series)))
        mine = self.row_series[::2]
        return seas[mine] & (self.frequency > slow[mine])

    @cached_property
    def pooled(self) -> np.ndarray:
        """Degrees of freedom by pool (s, b), at the pool's first band."""
        totals = np.zeros_like(self.dof)
        for into, dof, one in zip(totals, self.dof, self.series):
            np.add.at(into, one.pool, dof)
        return totals

    def by_region(self, values: np.ndarray) -> np.ndarray:
        """Sums by region (s, 3) of values by band (s, b): in waves mean, slower, rest; a decay is one region."""
        return np.stack([np.bincount(one.region, mine, 3) for one, mine in zip(self.series, values)])

    @cached_property
    def pool(self) -> np.ndarray:
        """Index of every row's pool (n,) in a flattened array by series and band."""
        width = self.dof.shape[1]
        return self.row_series * width + np.stack([one.pool for one in self.series]).ravel()[self.cell]

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
        for at, row in zip(limits, self.directions):
            moved = np.flatnonzero(row)
            if len(moved) == 1 and isinstance(by := self.space.free[k := int(moved[0])].transform, Scaled):
                about = self.model.about(self.labels[k])
                ends = np.array([by.inverse(end) for end in (about.lower, about.upper)])
                at[:] = np.sort((ends - self.start[k]) / row[k])
        if self.size_limits is not None:
            limits = np.stack(
                [np.maximum(limits[:, 0], self.size_limits[:, 0]), np.minimum(limits[:, 1], self.size_limits[:, 1])], 1
            )
        return limits

    def value(self, label: str, x: np.ndarray) -> float:
        """A parameter (SI) at given coordinates (p,)."""
        i = self.labels.index(label)
        return float(self.space.free[i].transform.forward(x[i]))

    def selected_seas(self, seas: SeaSelection) -> list[bool]:
        """Which runs are simulated: those with a fitted test, or all."""
        uses = {one.test: one.use for one in self.series}
        return [seas == "all" or any(uses[test] == "fit" for test in record.tests) for record in self.seas]

    def _steps(self, record: SeaRecord, seas: SeaSelection) -> int:
        """Number of steps that a run is simulated for."""
        return record.steps if seas == "all" else record.fitted

    def motions(self, place: Point, seas: SeaSelection = "all") -> list[np.ndarray | None]:
        """Simulated minus measured motions in time (s, t), of the decays and of every run in waves."""
        x = jnp.asarray(place.x)

        def of_decay(i: int) -> np.ndarray:
            assert self.decays is not None
            return np.asarray(decay_residual(self.decays, x, jnp.asarray(place.own[i]), self.decay_data[i]))

        def of_sea(record: SeaRecord) -> np.ndarray:
            motions = np.asarray(sea_residuals(record, x, jnp.asarray(self._steps(record, seas))))
            return motions.reshape(-1, record.measured.shape[-1])

        with stoppable_threads(cores()) as pool:
            decays, found = self._jobs(pool, of_decay, of_sea, seas)
            first = [np.concatenate([job.result() for job in decays])] if decays else []
            return [*first, *(None if job is None else job.result() for job in found)]

    @cached_property
    def decay_data(self) -> list[DecayData]:
        """The decays one by one."""
        if self.decays is None:
            return []
        leaves, kind = jax.tree.flatten(self.decays.data)
        return [jax.tree.unflatten(kind, some) for some in zip(*leaves, strict=True)]

    def _jobs(
        self, pool: Executor, decay: Callable[[int], Any], sea: Callable[[SeaRecord], Any], seas: SeaSelection
    ) -> tuple[list[Any], list[Any]]:
        """Parallel work on decays and runs in waves (XLA runs a loop on one core); None: not simulated."""
        in_seas = [pool.submit(sea, one) if seen else None for one, seen in zip(self.seas, self.selected_seas(seas))]
        return [pool.submit(decay, i) for i in range(len(self.decay_records))], in_seas

    def residual(self, place: Point, seas: SeaSelection = "fit") -> np.ndarray:
        """Residual at a point in rows (n,); zeros of runs that are not simulated."""
        parts = self.motions(place, seas)
        return np.concatenate([np.zeros(2 * len(cut.take)) if one is None else cut(one) for cut, one in zip(self.cuts, parts)])

    def linearise(self, place: Point, active: Sequence[int], seas: SeaSelection = "fit") -> Linearisation:
        """Residual and slopes at a point, of the decays and of runs with a fitted test, or of all runs."""
        return self.linearise_all([(place, active)], seas)[0]

    def linearise_all(
        self, jobs: Sequence[LinearisationJob], seas: SeaSelection = "fit", keep: KnownSlopes | None = None
    ) -> list[Linearisation]:
        """Residual and slopes at several points along some directions each, side by side.

        Args:
            jobs: Points and directions.
            seas: Which runs are simulated.
            keep: Receives slopes by the state at the first point.
        """

        def begin(place: Point, active: tuple[int, ...], first: bool) -> _Slopes:
            return self._slopes(pool, workers, place, active, seas, keep if first else None)

        with stoppable_threads(cores()) as pool, stoppable_threads(cores()) as workers:
            return self._gathered(jobs, self.width, begin)

    def linearise_neutral(
        self, jobs: Sequence[LinearisationJob], known: KnownSlopes, moving: Sequence[int], seas: SeaSelection = "fit"
    ) -> list[Linearisation]:
        """Residual and slopes at points between which no motion changes, along amplitudes of neutral candidates.

        It takes little time beside `linearise_all`, as slopes by the state are known.

        Args:
            jobs: Points and directions.
            known: Slopes by the state at such a point.
            moving: All directions that jobs ever have: what they move is one program.
            seas: Which runs are simulated.
        """

        def begin(place: Point, active: tuple[int, ...], first: bool) -> _Slopes:
            return self._slopes(pool, workers, place, active, seas, known=known, moving=moving)

        with stoppable_threads(cores()) as pool, stoppable_threads(cores()) as workers:
            return self._gathered(jobs, COMPARED_AT_ONCE, begin)

    def _gathered(
        self, jobs: Sequence[LinearisationJob], width: int, begin: Callable[[Point, tuple[int, ...], bool], _Slopes]
    ) -> list[Linearisation]:
        """Begin all jobs, in groups of so many directions, and wait for them."""
        chunks = [(place, mine) for place, active in jobs for mine in self._chunks(active, width)]
        begun = [begin(place, mine, i == 0) for i, (place, mine) in enumerate(chunks)]
        looks = iter([self._linearisation(place, mine, parts()) for (place, mine), parts in zip(chunks, begun, strict=True)])
        return [reduce(Linearisation.joined_with, islice(looks, len(self._chunks(active, width)))) for _, active in jobs]

    def _chunks(self, active: Sequence[int], width: int) -> list[tuple[int, ...]]:
        """Directions in groups of at most `width`; one empty group without any."""
        return [tuple(active[begin : begin + width]) for begin in range(0, max(len(active), 1), width)]

    def time_slopes(self, place: Point, active: Sequence[int]) -> list[np.ndarray]:
        """Slopes of the motions in time along some directions (s, t, q), of the decays and of every run in waves.

        The decays' have their own unknowns' after them (s, t, q + o). Slopes that overflow are zero, as in `linearise`.
        """
        some = self._chunks(active, self.width)
        with stoppable_threads(cores()) as pool, stoppable_threads(cores()) as workers:
            jobs = [self._slopes(pool, workers, place, mine, "all") for mine in some]
            found = [[part[1] for part in parts() if part is not None] for parts in jobs]
        whole = []
        for i, parts in enumerate(zip(*found, strict=True)):
            columns = [part[..., : len(mine)] for part, mine in zip(parts, some, strict=True)]
            own = [parts[0][..., self.width :]] if i == 0 and self.decays is not None else []
            slopes = np.concatenate([*columns, *own], axis=-1)
            slopes[..., ~(np.abs(slopes) < OVERFLOW).all(axis=(0, 1))] = 0.0
            whole.append(slopes)
        return whole

    def _slopes(
        self,
        pool: Executor,
        workers: Executor,
        place: Point,
        active: tuple[int, ...],
        seas: SeaSelection = "fit",
        keep: KnownSlopes | None = None,
        known: KnownSlopes | None = None,
        moving: Sequence[int] = (),
    ) -> _Slopes:
        """Begin work on residual and slopes at a point, along at most `width` directions.

        Returns:
            What waits for residual (s, t) and slopes (s, t, q) of the decays and of every run in waves; None: not simulated.
        """
        basis = np.zeros((len(place.x), self.width))
        basis[:, : len(active)] = self.directions[list(active)].T
        if moving:
            basis[:, -1] += self.directions[list(moving)].sum(axis=0)
        frame = Frame(jnp.asarray(place.x), jnp.asarray(basis))

        def flat(parts: Any) -> tuple[np.ndarray, np.ndarray]:
            residual, slopes = (np.asarray(one) for one in parts)
            return residual.reshape(-1, residual.shape[-1]), slopes.reshape(-1, *slopes.shape[-2:])

        def of_decay(i: int) -> tuple[np.ndarray, np.ndarray]:
            assert self.decays is not None
            return flat(decay_slopes(self.decays, frame, jnp.asarray(place.own[i]), self.decay_data[i]))

        def of_sea(one: SeaRecord) -> tuple[np.ndarray, np.ndarray]:
            kept = None if keep is None else keep.setdefault(one.tests, [])
            by_state = None if known is None else known[one.tests]
            return flat(sea_slopes(one, frame, self._steps(one, seas), len(active), workers, kept, by_state))

        decays, in_seas = self._jobs(pool, of_decay, of_sea, seas)

        def found() -> list[tuple[np.ndarray, np.ndarray] | None]:
            each = [job.result() for job in decays]
            first = [(np.concatenate([r for r, _ in each]), np.concatenate([s for _, s in each]))] if each else []
            return [*first, *(None if job is None else job.result() for job in in_seas)]

        return found

    def _linearisation(
        self, place: Point, active: tuple[int, ...], parts: Sequence[tuple[np.ndarray, np.ndarray] | None]
    ) -> Linearisation:
        q = len(active)
        residual, slopes, own = [], [], np.zeros((0, 0))
        for i, (cut, part) in enumerate(zip(self.cuts, parts)):
            if part is None:
                residual.append(np.zeros(2 * len(cut.take)))
                slopes.append(np.zeros((2 * len(cut.take), q)))
                continue
            residual.append(cut(part[0]))
            slopes.append(cut(part[1][..., :q]))
            if i == 0 and self.decays is not None:
                own = cut(part[1][..., self.width :])
        along = np.concatenate(slopes)
        along[:, ~(np.abs(along) < OVERFLOW).all(axis=0)] = 0.0
        return Linearisation(place, active, np.concatenate(residual), along, own)

    def levels(self, residual: np.ndarray) -> np.ndarray:
        """Mean square over the floor's by series and pool (s, b)."""
        return np.bincount(self.pool, self.share * residual**2, self.dof.size).reshape(self.dof.shape)

    def mean_squares(self, residual: np.ndarray) -> np.ndarray:
        """Mean square over the floor's by series and band (s, b)."""
        power = np.bincount(self.cell, residual**2, self.dof.size).reshape(self.dof.shape)
        return np.where(self.dof > 0, power / np.where(self.dof > 0, self.dof, 1.0) / self.floor**2, 0.0)
