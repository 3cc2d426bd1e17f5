"""Runs of a sweep on a dask.distributed cluster."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from jaxhydro.errors import InputError, Problem
from jaxhydro.sweep.worker import RunsDone, fail_runs, simulate_runs

RETRIES = 3
SCHEDULER_TIMEOUT = 30.0  # s, for the scheduler to answer


def client_of(scheduler: str) -> Any:
    """Client of a dask scheduler.

    Args:
        scheduler: Address of the scheduler.

    Raises:
        InputError: dask.distributed is not installed, or nothing answers.
    """
    try:
        from distributed import Client
    except ImportError:
        problem = Problem("", "dask.distributed", "no such package", "pip install 'jaxhydro[distributed]'")
        raise InputError("--scheduler", [problem]) from None
    try:
        return Client(scheduler, timeout=SCHEDULER_TIMEOUT)
    except (OSError, ValueError) as error:
        message = " ".join(str(error).split())[:200] or type(error).__name__
        raise InputError("--scheduler", [Problem("", "a scheduler that answers", f"{scheduler!r} ({message})")]) from None


def workers_of(scheduler: str) -> int:
    """Number of workers that a scheduler has now.

    Raises:
        InputError: As `client_of`.
    """
    with client_of(scheduler) as client:
        return len(client.nthreads())


def simulate_on_cluster(folder: Path, batches: Sequence[Sequence[int]], scheduler: str) -> Iterator[RunsDone]:
    """Simulate batches of runs on a cluster; yields each batch when it is in the store.

    Workers write to the store themselves and must see `folder` by the same path. The runs of a lost worker are repeated
    elsewhere. Runs that end `RETRIES` workers are marked as failed.

    Args:
        folder: Folder of the sweep.
        batches: Numbers of the runs of each batch.
        scheduler: Address of the scheduler.

    Raises:
        InputError: As `client_of`.
    """
    client = client_of(scheduler)
    from distributed import as_completed

    with client:
        path = str(folder.resolve())
        futures = {client.submit(simulate_runs, path, list(batch), pure=False, retries=RETRIES): batch for batch in batches}
        for future in as_completed(futures):
            if future.status == "finished":
                yield future.result()
            else:
                lost = future.exception()
                yield fail_runs(path, futures[future], f"lost on the cluster ({type(lost).__name__}: {lost})"[:500])
            future.release()
