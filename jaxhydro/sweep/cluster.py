"""Runs of a sweep on a dask.distributed cluster, whose workers write to the store themselves."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from jaxhydro.errors import InputError, Problem
from jaxhydro.sweep.worker import Found, fail_runs, simulate_runs

RETRIES = 3
PATIENCE = 30.0  # s, for the scheduler to answer


def client_of(scheduler: str) -> Any:
    """A client of the scheduler at an address. Raises InputError where dask is not there or nothing answers."""
    try:
        from distributed import Client
    except ImportError:
        problem = Problem("", "dask.distributed", "no such package", "pip install 'jaxhydro[distributed]'")
        raise InputError("--scheduler", [problem]) from None
    try:
        return Client(scheduler, timeout=PATIENCE)
    except (OSError, ValueError) as error:
        said = " ".join(str(error).split())[:200] or type(error).__name__
        raise InputError("--scheduler", [Problem("", "a scheduler that answers", f"{scheduler!r} ({said})")]) from None


def workers_of(scheduler: str) -> int:
    """How many workers a scheduler has now. Raises InputError as `client_of`."""
    with client_of(scheduler) as client:
        return len(client.nthreads())


def simulated_there(folder: Path, batches: Sequence[Sequence[int]], scheduler: str) -> Iterator[Found]:
    """Each batch's runs when they are in the store, in the order in which they come. Workers must see `folder` by the same
    path.

    A worker that is lost costs the runs that it had in hand: they are done again elsewhere. Runs that end `RETRIES` workers are
    failed. Raises InputError as `client_of`.
    """
    client = client_of(scheduler)
    from distributed import as_completed

    with client:
        place = str(folder.resolve())
        futures = {client.submit(simulate_runs, place, list(batch), pure=False, retries=RETRIES): batch for batch in batches}
        for future in as_completed(futures):
            if future.status == "finished":
                yield future.result()
            else:
                lost = future.exception()
                yield fail_runs(place, futures[future], f"lost on the cluster ({type(lost).__name__}: {lost})"[:500])
            future.release()
