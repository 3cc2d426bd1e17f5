"""The sweep command: from a sweep file to its store, tables and figures."""

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from jaxhydro.command import print_rest, print_used
from jaxhydro.console import complain, counting, say, table
from jaxhydro.problems import InputError, Problem
from jaxhydro.sweep.cluster import workers_of
from jaxhydro.sweep.load import load_sweep
from jaxhydro.sweep.outputs import Summary, summary_of, write_outputs
from jaxhydro.sweep.resources import chosen
from jaxhydro.sweep.run import Prepared, Progress, Ran, opened, prepared, run_all, to_do
from jaxhydro.sweep.store import RESULTS, open_results

LISTED = 5  # failures that are printed


class Stopped(Exception):
    """Stopped by a key, by SIGTERM, or for want of a scheduler: what is done is kept."""


def sweep(
    source: Path,
    out: Path,
    workers: int | None = None,
    batch: int | None = None,
    restart: bool = False,
    retry_failed: bool = False,
    scheduler: str | None = None,
) -> bool:
    """Run a sweep or what is left of it, write and print; False where runs failed.

    Raises InputError for bad input, EquilibriumError where the platform does not rest, Stopped.
    """
    os.environ.setdefault("XLA_PYTHON_CLIENT_PREALLOCATE", "false")  # GPU memory is for the workers
    with ended_by_signal():
        try:
            return _sweep(source, out, workers, batch, restart, retry_failed, scheduler)
        except KeyboardInterrupt:
            raise Stopped(f"stopped; {_kept(out)}") from None


def _kept(out: Path) -> str:
    if (out / RESULTS).is_dir():
        return f"what is done is in {out / RESULTS}, and the same command goes on"
    return "nothing was written"


def _sweep(
    source: Path, out: Path, workers: int | None, batch: int | None, restart: bool, retry_failed: bool, scheduler: str | None
) -> bool:
    made = prepared(load_sweep(source), str(source))
    # bad input is told before anything is begun
    workers_there = 0 if scheduler is None else workers_of(scheduler)
    resumed = opened(out, made, restart)
    numbers = to_do(out, retry_failed)
    _print_plan(made)
    if resumed:
        done = len(made.inputs.plan) - len(numbers)
        say(f"{out} has {done} of {len(made.inputs.plan)} runs" + (": they stay" if numbers else ": nothing is left to do"))
    ran = Ran(0, 0, 0.0, 0.0)
    if numbers:
        how = chosen(made.setup, len(numbers), workers, batch)
        say(how.words if scheduler is None else _cluster(scheduler, workers_there, how.batch), stderr=True)
        with counting(len(made.inputs.plan), len(made.inputs.plan) - len(numbers), "runs") as show:
            try:
                ran = run_all(out, made, numbers, how, scheduler, lambda now: show(now.done + now.failed, _remark(now)))
            except OSError as error:
                said = str(error.strerror or error)
                if scheduler is not None:  # workers write, and say it themselves where they cannot
                    raise Stopped(f"the scheduler at {scheduler} was lost ({said}); {_kept(out)}") from None
                raise InputError("--out", [Problem("", "a folder that can be written", f"{str(out)!r} ({said})")]) from None
        say(f"{ran.runs} runs in {ran.seconds:.1f} s, {ran.simulated / ran.seconds:.0f} times real time", stderr=True)
    data = open_results(out)
    summary = summary_of(data)
    write_outputs(out, data, summary, _about(made, source))
    _print_results(summary, data.exponent.values)
    say(f"Results are in {out}")
    return not summary.failed


@contextmanager
def ended_by_signal() -> Iterator[None]:
    """SIGTERM, which schedulers of clusters send before they kill, stops as a key does."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGTERM, stop)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _cluster(scheduler: str, workers: int, batch: int) -> str:
    there = f"{workers} worker{'s' * (workers != 1)}" if workers else "no worker yet, and nothing runs until there is one"
    return f"On the cluster of {scheduler}: {there}; {batch} run{'s' * (batch != 1)} at a time each"


def _about(made: Prepared, source: Path) -> dict[str, Any]:
    """What sweep.json says first."""
    about: dict[str, Any] = {"sweep": str(source), "platform": Path(made.platform).stem}
    if made.calibration is not None:
        about["calibration"] = {"file": made.calibration, "values": made.setup.calibrated}
    return about | {"notes": made.notes + made.setup.warnings}


def _remark(now: Progress) -> str:
    failed = f"{now.failed} failed, " if now.failed else ""
    return f"{failed}{now.speed:.0f} times real time"


def _print_plan(made: Prepared) -> None:
    plan = made.inputs.plan
    print_rest(made.setup.model, made.platform)
    headings = sorted({case.heading for case in plan.cases})
    states = {(case.hs, case.tp, case.gamma) for case in plan.cases}
    rows = [
        ("Sea states", f"{len(states)}"),
        ("Headings", ", ".join(f"{heading:g}" for heading in headings[:8]) + (" ..." if len(headings) > 8 else "") + " deg"),
        ("Seeds", f"{len(plan.seeds)}"),
        ("Runs", f"{len(plan)} of {plan.duration:g} s, statistics from {plan.start:g} s on"),
        ("Step at most", f"{made.setup.limit:.3g} s"),
    ]
    table("Sweep", ("Property", "Value"), rows, left=2)
    for note in made.notes:
        say(f"Note: {note}")
    if made.calibration is not None:
        print_used(made.setup.calibrated, made.setup.warnings)


def _print_results(summary: Summary, exponents) -> None:
    rows = []
    for channel, one in summary.lifetimes.items():
        numbers = (one.mean, one.standard_deviation, one.standard_deviation_spread, one.maximum_of_seed, one.maximum_spread)
        shown = ("-" if value != value else f"{value:.4g}" if abs(value) > 1e-9 else "0" for value in (*numbers, *one.ranges))
        rows.append((f"{channel} ({summary.units[channel]})", *shown))
    heads = ("Channel", "Mean", "Standard deviation", "over seeds", "Maximum of a seed", "over seeds")
    if summary.failed < summary.total:
        table("Over the life", (*heads, *(f"Equivalent range m = {m:g}" for m in exponents)), rows)
    if summary.failed:
        share = f"; sea states of which no run is left have {summary.missing:.2%} of the life" if summary.missing else ""
        complain(f"{summary.failed} of {summary.total} runs failed{share}")
        for run in summary.failures[:LISTED]:
            where = f"Hs {run['hs']:g} m, Tp {run['tp']:g} s, heading {run['heading']:g} deg, seed {run['seed']}"
            complain(f"{where}: {run['reason']}")
        if summary.failed > LISTED:
            complain(f"and {summary.failed - LISTED} more: see sweep.json")
