"""Simulations of all records of a campaign at any point, and slopes of their motions, on all cores."""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import reduce
from itertools import islice
from typing import Any, TypeAlias

import jax.numpy as jnp
import numpy as np

from calibration.discovery.decay_simulations import DecaySimulations
from calibration.discovery.frequency_bands import FourierRows
from calibration.discovery.linearisations import Linearisation, Point, SeaSelection
from calibration.discovery.residual_slopes import Frame, SeaRecord, decay_residual, decay_slopes, sea_residuals
from calibration.discovery.sea_slopes import COMPARED_AT_ONCE, Accelerations, sea_slopes
from calibration.fitting.cores import cores
from jaxhydro.interrupts import stoppable_threads

OVERFLOW = 1e100  # motions and slopes from here on are those of a diverging simulation

LinearisationJob: TypeAlias = tuple[Point, Sequence[int]]  # a point, and the directions to linearise along
KnownSlopes: TypeAlias = dict[tuple[str, ...], Accelerations]  # of accelerations by the state, by the tests of a run
_Slopes: TypeAlias = Callable[[], list[tuple[np.ndarray, np.ndarray] | None]]  # waits for residuals and slopes


@dataclass(frozen=True)
class RecordSimulations:
    """Simulations of all records of a campaign, side by side: XLA runs a loop on one core.

    Attributes:
        decays: Simulations of the decays, or None.
        seas: The runs in waves.
        with_fitted: Which runs have a fitted test.
        cuts: Rows of the decays and of every run in waves.
        directions: Orthogonal directions (d, p).
        width: Number of directions that are differentiated at a time.
    """

    decays: DecaySimulations | None
    seas: tuple[SeaRecord, ...]
    with_fitted: tuple[bool, ...]
    cuts: tuple[FourierRows, ...]
    directions: np.ndarray
    width: int

    def motions(self, point: Point, seas: SeaSelection) -> list[np.ndarray | None]:
        """Simulated minus measured motions in time.

        Returns:
            Arrays (s, t) of the decays, if there are any, and of every run in waves. None: not simulated.
        """
        x = jnp.asarray(point.x)

        def of_decay(decays: DecaySimulations, i: int) -> np.ndarray:
            return np.asarray(decays.run(decay_residual, x, point.own[i], i))

        def of_sea(record: SeaRecord) -> np.ndarray:
            motions = np.asarray(sea_residuals(record, x, jnp.asarray(_step_count(record, seas))))
            return motions.reshape(-1, record.measured.shape[-1])

        with stoppable_threads(cores()) as pool:
            in_decays, in_seas = self._jobs(pool, of_decay, of_sea, seas)
            first = [np.concatenate([job.result() for job in in_decays])] if in_decays else []
            return [*first, *(None if job is None else job.result() for job in in_seas)]

    def residual(self, point: Point, seas: SeaSelection) -> np.ndarray:
        """Residual at a point in rows (n,); zeros of runs that are not simulated."""
        motions = self.motions(point, seas)
        return np.concatenate(
            [np.zeros(2 * len(cut.take)) if part is None else cut(part) for cut, part in zip(self.cuts, motions)]
        )

    def linearise(self, jobs: Sequence[LinearisationJob], seas: SeaSelection, keep: KnownSlopes | None) -> list[Linearisation]:
        """Residual and slopes at several points along some directions each.

        Args:
            jobs: Points and directions.
            seas: Which runs are simulated.
            keep: Receives slopes by the state at the first point.
        """

        def begin(point: Point, active: tuple[int, ...], first: bool) -> _Slopes:
            return self._slopes(pool, workers, point, active, seas, keep if first else None)

        with stoppable_threads(cores()) as pool, stoppable_threads(cores()) as workers:
            return self._gathered(jobs, self.width, begin)

    def linearise_neutral(
        self, jobs: Sequence[LinearisationJob], by_state: KnownSlopes, moved: Sequence[int], seas: SeaSelection
    ) -> list[Linearisation]:
        """Residual and slopes along amplitudes of neutral candidates, at points where the motion is the same.

        It takes little time beside `linearise`, as slopes by the state are known.

        Args:
            jobs: Points and directions.
            by_state: Slopes by the state at such a point.
            moved: All directions that jobs ever have: one program is for all that they move.
            seas: Which runs are simulated.
        """

        def begin(point: Point, active: tuple[int, ...], first: bool) -> _Slopes:
            return self._slopes(pool, workers, point, active, seas, by_state=by_state, moved=moved)

        with stoppable_threads(cores()) as pool, stoppable_threads(cores()) as workers:
            return self._gathered(jobs, min(COMPARED_AT_ONCE, self.width - 1), begin)  # one column is for all that moves

    def time_slopes(self, point: Point, active: Sequence[int]) -> list[np.ndarray]:
        """Slopes of all motions in time along some directions.

        Slopes that overflow are zero, as in `linearise`.

        Returns:
            Arrays (s, t, q + o) of the decays, with slopes along their own unknowns last, and (s, t, q) of every run in waves.
        """
        chunks = _chunks(active, self.width)
        with stoppable_threads(cores()) as pool, stoppable_threads(cores()) as workers:
            jobs = [self._slopes(pool, workers, point, mine, "all") for mine in chunks]
            slopes_by_chunk = [[part[1] for part in parts() if part is not None] for parts in jobs]
        whole = []
        for i, parts in enumerate(zip(*slopes_by_chunk, strict=True)):
            columns = [part[..., : len(mine)] for part, mine in zip(parts, chunks, strict=True)]
            own_slopes = [parts[0][..., self.width :]] if i == 0 and self.decays is not None else []
            slopes = np.concatenate([*columns, *own_slopes], axis=-1)
            slopes[..., ~(np.abs(slopes) < OVERFLOW).all(axis=(0, 1))] = 0.0
            whole.append(slopes)
        return whole

    def _jobs(
        self, pool: Executor, decay: Callable[[DecaySimulations, int], Any], sea: Callable[[SeaRecord], Any], seas: SeaSelection
    ) -> tuple[list[Any], list[Any]]:
        """Parallel work on decays and runs in waves; None: not simulated."""
        selected = [seas == "all" or fitted for fitted in self.with_fitted]
        in_seas = [pool.submit(sea, record) if simulated else None for record, simulated in zip(self.seas, selected)]
        if (decays := self.decays) is None:
            return [], in_seas
        return [pool.submit(decay, decays, i) for i in range(len(decays.padded_data))], in_seas

    def _gathered(
        self, jobs: Sequence[LinearisationJob], width: int, begin: Callable[[Point, tuple[int, ...], bool], _Slopes]
    ) -> list[Linearisation]:
        """Begin all jobs, in groups of so many directions, and wait for them."""
        chunks = [(point, mine) for point, active in jobs for mine in _chunks(active, width)]
        begun = [begin(point, mine, i == 0) for i, (point, mine) in enumerate(chunks)]
        linearisations = iter(
            [self._linearisation(point, mine, parts()) for (point, mine), parts in zip(chunks, begun, strict=True)]
        )
        return [reduce(Linearisation.joined_with, islice(linearisations, len(_chunks(active, width)))) for _, active in jobs]

    def _slopes(
        self,
        pool: Executor,
        workers: Executor,
        point: Point,
        active: tuple[int, ...],
        seas: SeaSelection,
        keep: KnownSlopes | None = None,
        by_state: KnownSlopes | None = None,
        moved: Sequence[int] = (),
    ) -> _Slopes:
        """Begin work on residual and slopes at a point, along at most `width` directions.

        Returns:
            Function that waits for residual (s, t) and slopes (s, t, q) of the decays and of every run in waves. None: not
            simulated.
        """
        basis = np.zeros((len(point.x), self.width))
        basis[:, : len(active)] = self.directions[list(active)].T
        if moved:
            basis[:, -1] += self.directions[list(moved)].sum(axis=0)
        frame = Frame(jnp.asarray(point.x), jnp.asarray(basis))

        def flat(parts: Any) -> tuple[np.ndarray, np.ndarray]:
            residual, slopes = (np.asarray(part) for part in parts)
            return residual.reshape(-1, residual.shape[-1]), slopes.reshape(-1, *slopes.shape[-2:])

        def of_decay(decays: DecaySimulations, i: int) -> tuple[np.ndarray, np.ndarray]:
            return flat(decays.run(decay_slopes, frame, point.own[i], i))

        def of_sea(record: SeaRecord) -> tuple[np.ndarray, np.ndarray]:
            received = None if keep is None else keep.setdefault(record.tests, [])
            known_slopes = None if by_state is None else by_state[record.tests]
            return flat(sea_slopes(record, frame, _step_count(record, seas), len(active), workers, received, known_slopes))

        in_decays, in_seas = self._jobs(pool, of_decay, of_sea, seas)

        def results() -> list[tuple[np.ndarray, np.ndarray] | None]:
            each = [job.result() for job in in_decays]
            first = [(np.concatenate([r for r, _ in each]), np.concatenate([s for _, s in each]))] if each else []
            return [*first, *(None if job is None else job.result() for job in in_seas)]

        return results

    def _linearisation(
        self, point: Point, active: tuple[int, ...], parts: Sequence[tuple[np.ndarray, np.ndarray] | None]
    ) -> Linearisation:
        """Residual and slopes in rows; zeros of runs that are not simulated, and of slopes that overflow."""
        q = len(active)
        residual, slopes, own_slopes = [], [], np.zeros((0, 0))
        for i, (cut, part) in enumerate(zip(self.cuts, parts)):
            if part is None:
                residual.append(np.zeros(2 * len(cut.take)))
                slopes.append(np.zeros((2 * len(cut.take), q)))
                continue
            residual.append(cut(part[0]))
            slopes.append(cut(part[1][..., :q]))
            if i == 0 and self.decays is not None:
                own_slopes = cut(part[1][..., self.width :])
        along = np.concatenate(slopes)
        along[:, ~(np.abs(along) < OVERFLOW).all(axis=0)] = 0.0
        return Linearisation(point, active, np.concatenate(residual), along, own_slopes)


def _step_count(record: SeaRecord, seas: SeaSelection) -> int:
    """Number of steps that a run is simulated for."""
    return record.steps if seas == "all" else record.fitted


def _chunks(active: Sequence[int], width: int) -> list[tuple[int, ...]]:
    """Directions in groups of at most `width`; one empty group without any."""
    return [tuple(active[begin : begin + width]) for begin in range(0, max(len(active), 1), width)]
