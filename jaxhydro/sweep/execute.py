"""Run or resume a sweep, from its file to its results."""

import time as clock
from collections.abc import Callable, Iterator
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import xarray as xr

from jaxhydro.files import check_folder
from jaxhydro.sweep.local import simulate_locally
from jaxhydro.sweep.prepared_sweep import PreparedSweep, prepared
from jaxhydro.sweep.resources import Workload, chosen
from jaxhydro.sweep.store import RESULTS, Store, check_same, create, discard, locked_folder, open_results
from jaxhydro.sweep.store_layout import DONE, FAILED, TO_DO
from jaxhydro.sweep.sweep_file import load_sweep
from jaxhydro.sweep.sweep_schema import Sweep
from jaxhydro.sweep.worker import RunsDone
from jaxhydro.sweep.write_sweep import results_of, write_outputs


class Progress(NamedTuple):
    """Progress of a sweep.

    Attributes:
        done: Number of runs done.
        failed: Number of runs that failed.
        total: Number of runs in all.
        speed: Simulated seconds per second of this session.
    """

    done: int
    failed: int
    total: int
    speed: float


class SessionResult(NamedTuple):
    """Result of a session.

    Attributes:
        runs: Number of runs simulated.
        failed: Number of these that failed.
        seconds: Duration of the session (s).
        simulated: Simulated time (s).
    """

    runs: int
    failed: int
    seconds: float
    simulated: float


def opened(folder: Path, made: PreparedSweep, restart: bool = False) -> bool:
    """Make the folder's store where there is none; whether runs of this sweep are already there.

    Args:
        folder: Folder of the sweep.
        made: The sweep.
        restart: Discard earlier runs.

    Raises:
        InputError: The store belongs to other inputs.
    """
    if restart:
        discard(folder)
    if (folder / RESULTS).is_dir():
        check_same(folder, made.inputs)
        return True
    create(folder, made.inputs, made.setup, made.shares)
    return False


def to_do(folder: Path, retry_failed: bool = False) -> list[int]:
    """Numbers of the runs still to do, in order.

    Args:
        folder: Folder of the sweep.
        retry_failed: Include runs that failed.
    """
    wanted = (TO_DO, FAILED) if retry_failed else (TO_DO,)
    return [number for number, status in enumerate(Store(folder).status()) if status in wanted]


def run_all(
    folder: Path,
    made: PreparedSweep,
    numbers: list[int],
    how: Workload,
    scheduler: str | None = None,
    progress: Callable[[Progress], None] = lambda now: None,
) -> SessionResult:
    """Simulate runs; each is written to the store when it is done.

    Args:
        folder: Folder of the sweep.
        made: The sweep.
        numbers: Numbers of the runs.
        how: Processes and batches.
        scheduler: Address of a dask scheduler; None: this machine.
        progress: Called after each batch.
    """
    if how.devices:  # what is simulated at once has one heading
        numbers = sorted(numbers, key=lambda number: made.inputs.plan.run(number).case.heading)
    batches = [numbers[i : i + how.batch] for i in range(0, len(numbers), how.batch)]
    before = Store(folder).status()
    total, earlier = len(before), int((before == DONE).sum())
    done = failed = 0
    since = clock.perf_counter()
    for outcomes in _answers(folder, batches, how, scheduler):
        done += sum(good for _, good in outcomes)
        failed += sum(not good for _, good in outcomes)
        speed = (done + failed) * made.inputs.plan.duration / (clock.perf_counter() - since)
        progress(Progress(earlier + done, failed, total, speed))
    return SessionResult(done + failed, failed, clock.perf_counter() - since, (done + failed) * made.inputs.plan.duration)


def _answers(folder: Path, batches: list[list[int]], how: Workload, scheduler: str | None) -> Iterator[RunsDone]:
    if scheduler is None:
        return simulate_locally(folder, batches, how.workers, how.devices)
    from jaxhydro.sweep.cluster import simulate_on_cluster

    return simulate_on_cluster(folder, batches, scheduler)


def run_sweep(
    sweep: Sweep | str | PathLike[str],
    out: str | PathLike[str],
    *,
    workers: int | None = None,
    batch: int | None = None,
    restart: bool = False,
    retry_failed: bool = False,
    scheduler: str | None = None,
    progress: Callable[[Progress], None] = lambda now: None,
) -> xr.Dataset:
    """Run a sweep, or what is left of it, and open its results.

    The folder gets all files of the command: see docs/guide/sweeps.md. On the CPU results do not depend on `workers` or
    `batch`.

    Args:
        sweep: Sweep, or path of a sweep file.
        out: Folder of the results.
        workers: Number of processes; None: what fits.
        batch: Runs at a time per process; None: what fits.
        restart: Discard earlier runs.
        retry_failed: Repeat the runs that failed.
        scheduler: Address of a dask.distributed scheduler; None: this machine.
        progress: Called with the progress after each batch.

    Returns:
        The results, loaded from disk where used.

    Raises:
        InputError: The sweep has mistakes, or the folder has runs of another sweep.
        EquilibriumError: The platform has no stable equilibrium.
    """
    source = "sweep" if isinstance(sweep, Sweep) else str(sweep)
    made = prepared(sweep if isinstance(sweep, Sweep) else load_sweep(source), source)
    folder = check_folder(out, "out")
    with locked_folder(folder):
        opened(folder, made, restart)
        if numbers := to_do(folder, retry_failed):
            run_all(folder, made, numbers, chosen(made.setup, len(numbers), workers, batch), scheduler, progress)
        data = open_results(folder)
        write_outputs(folder, data, results_of(data, made.about))
    return data
