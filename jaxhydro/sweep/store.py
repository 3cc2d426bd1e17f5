"""Store of a sweep: results.zarr and the inputs it was made of.

The store (zarr v3, for `xarray.open_zarr`) is whole from the beginning. Every variable has one chunk per run, so writers
never share one. A run's numbers are written first and its status last, each chunk by renaming a finished file. A process
killed at any moment leaves a run that is done or one to be repeated.
"""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
import zarr
from filelock import FileLock, Timeout
from jaxtyping import Float

from jaxhydro.errors import InputError, Problem
from jaxhydro.files import staged
from jaxhydro.fingerprint import computed_with
from jaxhydro.sweep.batch import CALIBRATION, PLAN, PLATFORM, Setup
from jaxhydro.sweep.cases import Plan, Run
from jaxhydro.sweep.run_statistics import RunResults
from jaxhydro.sweep.store_layout import DONE, FAILED, RESULT_VARIABLES, Inputs, create_arrays

RESULTS, INPUTS, UNFINISHED, LOCK = "results.zarr", "inputs", ".results", ".lock"


@contextmanager
def locked_folder(folder: Path) -> Iterator[None]:
    """Lock the folder, made where absent, against other sweeps.

    Where the file system has no locks nothing is checked.

    Raises:
        InputError: Another sweep writes to the folder.
    """
    folder.mkdir(parents=True, exist_ok=True)
    lock = FileLock(folder / LOCK, fallback_to_soft=False)  # a soft lock outlives a killed process
    try:
        lock.acquire(timeout=0)
    except Timeout:
        actual = f"{str(folder)!r}, which another sweep writes now"
        raise InputError("--out", [Problem("", "a folder of its own", actual)]) from None
    except (NotImplementedError, OSError):
        pass
    try:
        yield
    finally:
        lock.release()


def create(folder: Path, inputs: Inputs, setup: Setup, shares: Float[np.ndarray, " c"]) -> None:
    """Write the folder's inputs and its store, with all runs to do.

    Args:
        folder: Folder of the sweep.
        inputs: Plan, platform file and calibration file.
        setup: Model and options that all runs share.
        shares: Fraction of each case's spectrum within the band, (case,).

    Raises:
        InputError: They cannot be written.
    """
    discard(folder)
    with staged(folder) as temporary:
        made = temporary / INPUTS
        made.mkdir()
        (made / PLAN).write_text(inputs.plan.to_json(), encoding="utf-8")
        (made / PLATFORM).write_text(inputs.platform, encoding="utf-8")
        if inputs.calibration is not None:
            (made / CALIBRATION).write_text(inputs.calibration, encoding="utf-8")
    create_arrays(folder / UNFINISHED, inputs, setup, shares)
    (folder / UNFINISHED).rename(folder / RESULTS)


def discard(folder: Path) -> None:
    """Remove a store, its inputs and its outputs."""
    shutil.rmtree(folder / UNFINISHED, ignore_errors=True)
    if (folder / RESULTS).is_dir():
        (folder / RESULTS).rename(folder / UNFINISHED)  # at once no store any more
    for name in (UNFINISHED, INPUTS):
        shutil.rmtree(folder / name, ignore_errors=True)
    for name in ("sweep.json", "lifetime.csv", "scatter.png", "exceedance.png", "report.html"):
        (folder / name).unlink(missing_ok=True)


def check_same(folder: Path, inputs: Inputs) -> None:
    """Raise InputError where the folder's store was made of other inputs or by another program."""
    inputs_folder = folder / INPUTS
    problems = []
    try:
        old = Inputs(
            Plan.from_json((inputs_folder / PLAN).read_text(encoding="utf-8")),
            (inputs_folder / PLATFORM).read_text(encoding="utf-8"),
            (inputs_folder / CALIBRATION).read_text(encoding="utf-8") if (inputs_folder / CALIBRATION).is_file() else None,
        )
    except (OSError, ValueError, TypeError, KeyError) as error:
        actual = f"{str(inputs_folder)!r}, which cannot be read ({error})"
        raise InputError("--out", [Problem("", "a folder with a sweep's inputs", actual, RESTART_HINT)]) from None
    for key, before, now in old.plan.differences(inputs.plan):
        problems.append(Problem(key, f"{before}, as in the runs that are there", now, RESTART_HINT))
    for name, noun in (("platform", "platform file"), ("calibration", "calibration")):
        if getattr(old, name) != getattr(inputs, name):
            problems.append(Problem(name, f"the {noun} of the runs that are there", "another", RESTART_HINT))
    try:
        group = zarr.open_group(folder / RESULTS, mode="r", zarr_format=3, use_consolidated=False)
        made_by: Any = group.attrs.get("computed_with")
    except (OSError, ValueError, KeyError):  # of another format
        made_by = None
    for name, now in computed_with().items():
        earlier = made_by.get(name) if isinstance(made_by, dict) else None
        if earlier != now:
            told = "another" if name == "source code" else now
            were = "that" if name == "source code" else f"{earlier or 'that'},"
            problems.append(Problem(name, f"{were} which made the runs that are there", told, RESTART_HINT))
    if problems:
        raise InputError(f"--out {folder}", problems[:1])


RESTART_HINT = "Another --out keeps both; --restart begins anew."


class Store:
    """Open store, to write runs to."""

    def __init__(self, folder: Path) -> None:
        self.group = zarr.open_group(folder / RESULTS, mode="r+", zarr_format=3, use_consolidated=False)
        self.arrays: dict[str, Any] = {name: array for name, array in self.group.arrays()}

    def status(self) -> np.ndarray:
        """Status of every run by number: TO_DO, DONE or FAILED."""
        return np.asarray(self.arrays["status"][:]).reshape(-1)

    def write(self, run: Run, outcome: RunResults | str) -> bool:
        """Write the results of a run, or the reason why it failed; whether it is done."""
        index = (run.row, run.column)
        if isinstance(outcome, str):
            self.arrays["reason"][index] = outcome
            self.arrays["status"][index] = FAILED
            return False
        if self.arrays["status"][index] == FAILED:
            self.arrays["reason"][index] = ""
        for name in RESULT_VARIABLES:
            values = getattr(outcome, name)
            if values is not None:
                self.arrays[name][index] = values
        self.arrays["status"][index] = DONE
        return True


def open_results(folder: Path) -> xr.Dataset:
    """Results of a sweep; variables are loaded from disk where used."""
    data = xr.open_zarr(folder / RESULTS, chunks=None, zarr_format=3)
    return data.assign_coords({name: coordinate.load() for name, coordinate in data.coords.items()})
