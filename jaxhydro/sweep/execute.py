"""Run or resume a sweep, from its file to its results."""

import json
import time as clock
from collections.abc import Callable, Iterator
from dataclasses import replace
from hashlib import sha256
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from jaxtyping import Float

from jaxhydro.calibrated_model import calibration_file
from jaxhydro.dynamics.rest_remarks import wave_remarks
from jaxhydro.dynamics.statics import stable_modes
from jaxhydro.errors import InputError, Problem, read_yaml
from jaxhydro.files import check_folder
from jaxhydro.platform.schema import builtin_platforms, builtin_text, load_platform
from jaxhydro.remarks import Remark
from jaxhydro.sweep.batch import Setup, pace_of_platform, setup_of
from jaxhydro.sweep.cases import plan_of
from jaxhydro.sweep.local import simulate_locally
from jaxhydro.sweep.resources import Workload, chosen, supports_of
from jaxhydro.sweep.sea_states import named
from jaxhydro.sweep.store import RESULTS, Store, check_same, create, discard, locked_folder, open_results
from jaxhydro.sweep.store_layout import DONE, FAILED, TO_DO, Inputs
from jaxhydro.sweep.sweep_file import load_sweep
from jaxhydro.sweep.sweep_remarks import impossible, near_limits, notes, outside, shares_in_band
from jaxhydro.sweep.sweep_schema import Sweep
from jaxhydro.sweep.worker import RunsDone
from jaxhydro.sweep.write_sweep import results_of, write_outputs


class PreparedSweep(NamedTuple):
    """Sweep that can be stored and run.

    Attributes:
        inputs: Plan, platform file and calibration file as text.
        setup: Model and options that all runs share.
        source: Name of the sweep file.
        platform: The platform as asked for.
        calibration: The calibration as asked for, or None.
        shares: Fraction of each case's spectrum within the band, (case,).
        notes: Notes on the sweep.
        remarks: Remarks on the tables of the platform.
    """

    inputs: Inputs
    setup: Setup
    source: str
    platform: str
    calibration: str | None
    shares: Float[np.ndarray, " c"]
    notes: list[str]
    remarks: tuple[Remark, ...] = ()

    @property
    def about(self) -> dict[str, Any]:
        """First entries of sweep.json."""
        about: dict[str, Any] = {"sweep": self.source, "platform": Path(self.platform).stem}
        notes = [remark.text for remark in sorted(self.remarks, key=lambda remark: not remark.warning)] + self.notes
        if (used := self.setup.calibrated) is None:
            return about | {"notes": notes}
        reference = {} if used.reference is None else {"sea_state_reference": used.reference._asdict()}
        strips = {} if used.strips is None else {"strips": used.strips.model_dump()}
        about["calibration"] = {"file": self.calibration, "values": used.values} | reference | strips
        return about | {"notes": notes + used.warnings}


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


def prepared(sweep: Sweep, source: str) -> PreparedSweep:
    """Read the files that a sweep names, and build its model.

    All mistakes except those of single seas show here.

    Args:
        sweep: Checked contents of a sweep file.
        source: Name of the sweep in errors.

    Raises:
        InputError: A file has mistakes, or no sea state is possible.
        EquilibriumError: The platform has no stable equilibrium.
    """
    try:
        pace = pace_of_platform(sweep.platform)
    except InputError as error:
        raise InputError(f"{source}: platform: {error.source}", error.problems) from None
    plan, remarks_in_words = plan_of(sweep, source, pace)
    calibration = None if sweep.calibration is None else calibration_file(sweep.calibration)
    try:
        setup = setup_of(plan, sweep.platform, calibration)
    except InputError as error:
        key = "calibration" if error.source == str(calibration) else "platform"
        raise InputError(f"{source}: {key}: {error.source}", error.problems) from None
    stable_modes(setup.model)
    # as chosen for this platform: workers need not choose again
    setup = setup._replace(plan=(plan := replace(plan, step=setup.limit)))
    failing = impossible(setup)
    if all(case.state in failing for case in plan.cases):
        state, reason = next(iter(failing.items()))
        raise InputError(source, [Problem("scatter", "a sea state that can be", f"none: {named(state)}: {reason}")])
    supports_of(setup, source)
    shares = shares_in_band(plan)
    remarks_in_words += notes(plan, setup.model, shares, failing)
    remarks = (
        *setup.model.remarks,
        *wave_remarks(setup.model),
        *outside(plan, setup.model, failing),
        *near_limits(plan, setup.model.environment, failing),
    )
    text = None if calibration is None else calibration.read_text(encoding="utf-8-sig")
    inputs = Inputs(plan, _platform_text(sweep.platform), text)
    return PreparedSweep(inputs, setup, source, sweep.platform, sweep.calibration, shares, remarks_in_words, remarks)


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


def _platform_text(asked: str) -> str:
    name = asked.lower()
    if name in builtin_platforms() and not Path(asked).is_file():
        return builtin_text(name)
    platform, data = load_platform(asked), read_yaml(asked)
    # a store is elsewhere, and has to find the files; JSON is YAML
    beside = {key: data[key] | {"file": file} for key, file in platform.files().items()}
    if not beside:
        return Path(asked).read_text(encoding="utf-8-sig")
    # a comment for each file, so that another file of the same name is another platform
    contents = [
        f"# {entry['file']}: sha256 {sha256(Path(entry['file']).read_bytes()).hexdigest()}" for entry in beside.values()
    ]
    return "\n".join([json.dumps(data | beside, indent=1), *contents, ""])
