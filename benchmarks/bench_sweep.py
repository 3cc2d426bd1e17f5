"""Many seas: cores, growth with size, and what has to be waited for before the first."""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from benchmarks.bench_batch import model_of, prepared, seas_of
from benchmarks.bench_sea import CUTOFF, ELEMENTS, HEIGHT, LOW, PERIOD, PLATFORM, STEP
from benchmarks.bench_timing import Row, contest, times
from jaxhydro import State, equilibrium
from jaxhydro.dynamics.integrate import integrate
from jaxhydro.dynamics.model import Model
from jaxhydro.sweep import run_sweep
from jaxhydro.sweep.sweep_schema import Sweep
from jaxhydro.waves.irregular import repeat_period

ROOT = Path(__file__).resolve().parents[1]
OPENFAST = (16, 18)  # times real time: an hour of second order, ../shared/design/performance.md, section "Against others"


def cores(count: int, duration: float) -> tuple[list[Row], list[str]]:
    """The same sweep by one process and by two: seconds between the first run's end and the last's."""
    platform = {"platform": PLATFORM, "scatter": [{"hs": HEIGHT, "tp": PERIOD}], "seeds": count, "duration": duration}
    took = {}
    affinity = os.sched_getaffinity(0)
    os.sched_setaffinity(0, range(os.cpu_count() or 1))
    try:
        with tempfile.TemporaryDirectory() as folder:
            for workers in (1, 2):
                ends: list[tuple[int, float]] = []
                run_sweep(
                    Sweep.model_validate(platform),
                    Path(folder) / str(workers),
                    workers=workers,
                    progress=lambda now, ends=ends: ends.append((now.done, time.perf_counter())),
                )
                first, last = ends[workers - 1], ends[-1]  # every process has compiled by then
                took[workers] = (last[1] - first[1]) / (last[0] - first[0])
    finally:
        os.sched_setaffinity(0, affinity)
    rows = [
        Row("Two cores against one, a sweep", times(took[1] / took[2]), "1.8"),
        Row("A sweep's simulated time over wall time, two cores", f"{duration / took[2]:.0f}"),
        Row(
            "The same over OpenFAST's on one core, second order",
            " to ".join(f"{duration / took[2] / fast:.0f}" for fast in OPENFAST[::-1]) + " times",
            "100 per core",
        ),
    ]
    notes = [
        f"A sweep is {count} seas of {duration:g} s at second order, with statistics, spectra, rainflow counts and writing, by "
        "wall time from the first run's end to the last's: another process on the machine slows it.",
        f"OpenFAST v5.0.0 ran an hour of second order at {OPENFAST[0]} to {OPENFAST[1]} times real time on a core of a machine "
        "of this kind, not in this run, its set-up of a minute or more left out.",
    ]
    return rows, notes


def exponent(sizes: Sequence[float], seconds: Sequence[float]) -> str:
    """Of growth, by least squares of logarithms."""
    return f"{np.polyfit(np.log(sizes), np.log(seconds), 1)[0]:.2f}"


def growth(rounds: int, durations: Sequence[float], elements: Sequence[int]) -> tuple[list[Row], list[str]]:
    """Exponents of CPU time by strips, duration, and components."""
    rows, strips, models = [], [], [model_of(number) for number in elements]
    runs = {}
    for i, model in enumerate(models):
        strips.append(len(model.hull.strips.element))
        runs[f"strips {i}"] = marching(model, durations[0])
    model = model_of()
    for i, duration in enumerate(durations):
        runs[f"duration {i}"] = marching(model, duration)
        sea = seas_of(model, duration, 1, 2)[0]
        runs[f"components {i}"] = lambda sea=sea, duration=duration: prepared(model, sea, duration)  # type: ignore[misc]
    turns = contest(runs, rounds)
    grids = {"strips": strips, "duration": durations, "components": [repeat_period(d) * (CUTOFF - LOW) for d in durations]}
    for name, of in (("strips", "a simulation"), ("duration", "a simulation"), ("components", "second order made ready")):
        medians = [turns[f"{name} {i}"].median for i in range(len(grids[name]))]
        sizes = f"{min(grids[name]):.0f} to {max(grids[name]):.0f}"
        rows.append(Row(f"Growth of {of} with {name}, exponent", f"{exponent(grids[name], medians)} ({sizes})"))
    return rows, ["Growth: CPU time as a power of size, by least squares of logarithms; components grow with the duration."]


def marching(model: Model, duration: float):
    """A simulation in a first-order sea that is ready."""
    sea = prepared(model, seas_of(model, duration, 1, 1)[0], duration)
    start, steps = State(equilibrium(model), jnp.zeros(6), model.rest().memory), round(duration / STEP)

    @eqx.filter_jit
    def run(model, sea, start):
        return integrate(model, sea, start, jnp.zeros(()), jnp.asarray(STEP), steps, "ab4").position

    return lambda: jax.block_until_ready(run(model, sea, start))


FIRST = """
import json, time
import jax, numpy as np
from benchmarks import bench_batch as bench
from benchmarks.bench_sea import STEP
from jaxhydro.simulate import simulate
def hour():
    begun = time.process_time(), time.perf_counter()
    model = bench.model_of()
    sea = bench.seas_of(model, 3600.0, 1, 2)[0]
    jax.block_until_ready(simulate(model, np.arange(0.0, 3600.0, 0.5), sea, step=STEP).position)
    return time.process_time() - begun[0], time.perf_counter() - begun[1]
print(json.dumps([hour(), hour()]))
"""


def waiting() -> tuple[list[Row], list[str]]:
    """The first hour of a sea in a new process: with an empty compilation cache, then with what that left."""
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | {"JAX_COMPILATION_CACHE_DIR": folder, "JAX_ENABLE_COMPILATION_CACHE": "1"}

        def run() -> tuple[str, str]:
            command = [sys.executable, "-c", FIRST]
            done = subprocess.run(command, cwd=ROOT, env=environment, check=True, stdout=subprocess.PIPE, text=True)
            first, second = json.loads(done.stdout)
            apart = [first_time - second_time for first_time, second_time in zip(first, second)]
            return tuple(f"{cpu:.2g} s CPU, {wall:.2g} s wall" for cpu, wall in (first, apart))  # type: ignore[return-value]

        ever, cached = run(), run()
    rows = [
        Row("First hour of sea ever, import apart", ever[0]),
        Row("First hour of sea ever, less what a second one takes", ever[1], "15 s"),
        Row("First hour of sea from the cache, import apart", cached[0]),
        Row("First hour of sea from the cache, less what a second one takes", cached[1], "2 s"),
    ]
    return rows, ["First hour of sea: platform file to motion, second order, in a new process, the simulation itself included."]


def measure() -> Iterator[tuple[list[Row], list[str]]]:
    """All of this file, part by part."""
    yield growth(3, (900.0, 1800.0, 3600.0), (4, ELEMENTS, 30, 80))
    yield waiting()
    yield cores(24, 3600.0)
