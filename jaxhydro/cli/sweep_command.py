"""`jaxhydro sweep`: store, tables and figures."""

import os
from collections.abc import Callable
from functools import partial
from pathlib import Path

from jaxhydro.cli.console import complain, counting, say, table
from jaxhydro.cli.model_messages import print_remarks, print_rest, print_used
from jaxhydro.errors import InputError, Problem
from jaxhydro.interrupts import asked_to_stop, finished, stop_if_asked
from jaxhydro.sweep.cluster import workers_of
from jaxhydro.sweep.execute import Progress, SessionResult, opened, run_all, to_do
from jaxhydro.sweep.prepared_sweep import PreparedSweep, prepared
from jaxhydro.sweep.resources import chosen
from jaxhydro.sweep.sea_states import State, runs_in_words
from jaxhydro.sweep.store import RESULTS, locked_folder, open_results
from jaxhydro.sweep.sweep_file import load_sweep
from jaxhydro.sweep.sweep_results import SweepResults
from jaxhydro.sweep.write_sweep import results_of, write_outputs

MAX_PRINTED_FAILURES = 5  # failures that are printed, of runs that failed alike


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

    Raises:
        InputError: The input is wrong.
        EquilibriumError: The platform does not rest.
        Stopped: It was stopped.
    """
    os.environ.setdefault("XLA_PYTHON_CLIENT_PREALLOCATE", "false")  # GPU memory is for the workers
    if scheduler is not None and workers is not None:
        raise InputError("--workers", [Problem("", "none with --scheduler, whose cluster has its own", f"{workers}")])
    try:
        made = prepared(load_sweep(source), str(source))
        # bad input is told before anything is begun
        available_workers = 0 if scheduler is None else workers_of(scheduler)
        stop_if_asked()
        with locked_folder(out):
            return _sweep(made, out, workers, batch, restart, retry_failed, scheduler, available_workers)
    except (KeyboardInterrupt, Exception) as error:
        if not (asked_to_stop() or isinstance(error, KeyboardInterrupt)):
            raise
        raise Stopped(f"stopped; {_kept(out)}") from None


def _kept(out: Path) -> str:
    if (out / RESULTS).is_dir():
        return f"what is done is in {out / RESULTS}, and the same command goes on"
    return "nothing was written"


def _sweep(
    made: PreparedSweep,
    out: Path,
    workers: int | None,
    batch: int | None,
    restart: bool,
    retry_failed: bool,
    scheduler: str | None,
    available_workers: int,
) -> bool:
    print_remarks(made.remarks)
    resumed = opened(out, made, restart)
    numbers = to_do(out, retry_failed)
    _print_plan(made)
    if resumed:
        done = len(made.inputs.plan) - len(numbers)
        say(f"{out} has {done} of {len(made.inputs.plan)} runs" + (": they stay" if numbers else ": nothing is left to do"))
    ran = SessionResult(0, 0, 0.0, 0.0)
    if numbers:
        how = chosen(made.setup, len(numbers), workers, batch)
        say(how.words if scheduler is None else _cluster(scheduler, available_workers, how.batch), stderr=True)
        with counting(len(made.inputs.plan), len(made.inputs.plan) - len(numbers), "runs") as show:
            try:
                ran = run_all(out, made, numbers, how, scheduler, partial(_show, show))
            except OSError as error:
                reason = str(error.strerror or error)
                if scheduler is not None:  # workers write, and say it themselves where they cannot
                    raise Stopped(f"the scheduler at {scheduler} was lost ({reason}); {_kept(out)}") from None
                raise InputError("--out", [Problem("", "a folder that can be written", f"{str(out)!r} ({reason})")]) from None
        many = f"{ran.runs} run{'s' * (ran.runs != 1)}"
        say(f"{many} in {ran.seconds:.1f} s, {ran.simulated / ran.seconds:.0f} times real time", stderr=True)
    data = open_results(out)
    results = results_of(data, made.about)
    write_outputs(out, data, results)
    finished()
    _print_results(results)
    say(f"Results are in {out}")
    return not results.runs.failed


def _cluster(scheduler: str, workers: int, batch: int) -> str:
    available = f"{workers} worker{'s' * (workers != 1)}" if workers else "no worker yet, and nothing runs until there is one"
    return f"On the cluster of {scheduler}: {available}; {batch} run{'s' * (batch != 1)} at a time each"


def _show(show: Callable[[int, str], None], now: Progress) -> None:
    stop_if_asked()
    show(now.done + now.failed, _remark(now))


def _remark(now: Progress) -> str:
    failed = f"{now.failed} failed, " if now.failed else ""
    return f"{failed}{now.speed:.0f} times real time"


def _print_plan(made: PreparedSweep) -> None:
    plan = made.inputs.plan
    print_rest(made.setup.model, made.platform)
    headings = sorted({case.heading for case in plan.cases})
    states = {case.state for case in plan.cases}
    rows = [
        ("Sea states", f"{len(states)}"),
        ("Headings", ", ".join(f"{heading:g}" for heading in headings[:8]) + (" ..." if len(headings) > 8 else "") + " deg"),
        ("Cases, a sea state with a heading", f"{len(plan.cases)}"),
        ("Seeds", f"{len(plan.seeds)}"),
        ("Runs", f"{len(plan)} of {plan.duration:g} s, statistics from {plan.start:g} s on"),
        ("Step at most", f"{made.setup.limit:.3g} s"),
    ]
    table("Sweep", ("Property", "Value"), rows, left=2)
    for note in made.notes:
        say(f"Note: {note}")
    if made.setup.calibrated is not None:
        print_used(made.setup.calibrated)


def _print_results(results: SweepResults) -> None:
    rows = []
    for channel, statistics in results.lifetime.items():
        values = [
            statistics.mean,
            statistics.standard_deviation,
            statistics.standard_deviation_spread,
            statistics.minimum,
            statistics.maximum,
        ]
        values += statistics.damage_equivalent_range.values()
        shown = ("-" if value is None else f"{value:.4g}" if abs(value) > 1e-9 else "0" for value in values)
        rows.append((f"{channel} ({statistics.unit})", *shown))
    if results.runs.done:
        heads = ("Channel", "Mean", "Standard deviation", "Spread over seeds", "Minimum", "Maximum")
        exponents = next(iter(results.lifetime.values())).damage_equivalent_range
        table("Over the life", (*heads, *(f"Equivalent range m = {m}" for m in exponents)), rows)
    if results.runs.failed:
        missing = results.probability_without_runs
        share = f"; cases of which no run is left have {missing:.2%} of the life" if missing else ""
        complain(f"{results.runs.failed} of {results.runs.total} runs failed{share}")
        listed, others = results.failures[:MAX_PRINTED_FAILURES], results.failures[MAX_PRINTED_FAILURES:]
        for failure in listed:
            complain(f"{runs_in_words(State.of(failure), failure.headings, failure.seeds)}: {failure.reason}")
        if others:
            complain(f"and {sum(failure.runs for failure in others)} more: see sweep.json")
