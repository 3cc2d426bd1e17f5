"""One decay: against plain NumPy, its derivatives, and what has to be waited for before the first."""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import jax
import numpy as np

from benchmarks.bench_cases import PLATFORM, RELEASE, STEPS, Decay, compilations
from benchmarks.bench_timing import Row, contest, three, times
from benchmarks.reference_model import ReferenceModel, rk4

ROOT = Path(__file__).resolve().parents[1]
STEP = STEPS["rk4"]
FINE = 0.125  # s, of the references that errors are measured against
RELEASED = [0, 2, 4]
NOT_RUN = "not run"


def alike(strips: int) -> ReferenceModel:
    """The NumPy model of the platform with the finest spacing that has no more than so many strips."""
    candidates = (ReferenceModel.from_yaml(PLATFORM, column, 4.5) for column in np.arange(1.0, 20.0, 0.125))
    return next(model for model in candidates if model.strips_count <= strips)


def error(path: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Largest difference in surge, heave and pitch over what was released; the coarser of the two says when."""
    stride = (len(reference) - 1) // (len(path) - 1)
    return np.abs(np.asarray(path) - reference[::stride])[:, RELEASED].max(axis=0) / RELEASE[RELEASED]


def against_numpy(decay: Decay, rounds: int) -> tuple[list[Row], list[str]]:
    """The same decay by plain NumPy and by this package's methods."""
    own = len(decay.model.hull.strips.element)
    like, fine = alike(own), ReferenceModel.from_yaml(PLATFORM)
    paths: dict[str, np.ndarray] = {}

    def plain(name, model):
        start = model.equilibrium() + RELEASE

        def call():
            paths[name] = rk4(model, start, np.zeros(6), STEP, decay.duration)[1]

        return call

    def package(name):
        run = decay.compiled(name)

        def call():
            paths[name] = run(decay.arrays, decay.start).block_until_ready()

        return call

    contestants = {"numpy": plain("numpy", like), "numpy, fine": plain("numpy, fine", fine)}
    turns = contest(contestants | {name: package(name) for name in STEPS}, rounds)
    exact = np.asarray(jax.jit(Decay(decay.duration, FINE).cases["tsit5"])(decay.arrays, decay.start))
    plain_exact = rk4(like, like.equilibrium() + RELEASE, np.zeros(6), FINE, decay.duration)[1]
    numpy_turns, steps = turns["numpy"], round(decay.duration / STEP)
    length = f"{decay.duration:g} s"

    def cost(name):
        median = turns[name].median
        count = decay.duration / STEPS.get(name, STEP)
        return f"{1e3 * median:.3g} ms, {1e6 * median / count:.3g} µs per step"

    rows = [
        Row("Decay against NumPy, RK4, 0.5 s", times(numpy_turns.over(turns["rk4"])), "60", "43"),
        Row("... NumPy with its own strips", times(turns["numpy, fine"].over(turns["rk4"]))),
        Row("... Tsit5 at 1 s against NumPy's RK4 at 0.5 s", times(numpy_turns.over(turns["tsit5"]))),
        Row("Decay by NumPy, RK4, 0.5 s", cost("numpy"), "", "1205 µs per step"),
        Row("Decay by RK4, 0.5 s", cost("rk4"), "", "28 µs per step"),
        Row("Decay by Tsit5, 1 s", cost("tsit5")),
        Row("Decay by diffrax's Tsit5, 1 s", cost("diffrax"), "", "50 µs per step"),
        Row("Decay by Tsit5, simulated time over CPU time", f"{decay.duration / turns['tsit5'].median:.0f}"),
        Row("diffrax over this package's loop, Tsit5, 1 s", times(turns["diffrax"].over(turns["tsit5"]))),
        Row("Error of NumPy's RK4, 0.5 s", three(error(paths["numpy"], plain_exact))),
        Row("Error of RK4, 0.5 s", three(error(paths["rk4"], exact)), "", "1e-06 / 1e-04 / 2e-05"),
        Row("Error of Tsit5, 1 s", three(error(paths["tsit5"], exact))),
        Row("Error of diffrax's Tsit5, 1 s", three(error(paths["diffrax"], exact)), "", "2e-06 / 5e-06 / 3e-06"),
        Row("Difference from NumPy with its own strips", three(error(paths["numpy, fine"], exact))),
    ]
    notes = [
        f"A decay is VolturnUS-S of the campaign volturnus-s-decays as declared, {length} ({steps} steps of 0.5 s), "
        "released from 6 m of surge, 2 m of heave and 4 deg of pitch at once; the positions at all steps are returned.",
        f"Strips: {own} in this package; {like.strips_count} in NumPy, except where it is said that it has its own "
        f"({fine.strips_count}, its default). Both integrate all six degrees of freedom in float64.",
        "Errors are the largest differences in surge / heave / pitch over what was released, against the same program "
        f"at steps of {FINE} s; the last line of them is the two programs' physics apart.",
    ]
    return rows, notes


def derivatives(decay: Decay, rounds: int, quick: bool) -> tuple[list[Row], list[str]]:
    """Jacobian and gradient in simulations of the same method and step."""
    names = ["tsit5"] if quick else [name for name in decay.cases if name != "rk4"]
    runs = {name: decay.compiled(name) for name in names}

    def call(run):
        return lambda: run(decay.arrays, decay.start).block_until_ready()

    turns = contest({name: call(run) for name, run in runs.items()}, rounds)

    def memory(name):
        analysis = runs[name].memory_analysis()
        return f"{analysis.temp_size_in_bytes / 1e6:.2g} MB" if analysis is not None else "unknown"

    def simulations(name, of):
        return f"{turns[name].over(turns[of]):.3g} simulations" if name in turns else NOT_RUN

    def sized(name, of):
        return f"{simulations(name, of)}, {memory(name)}" if name in turns else NOT_RUN

    rows = [
        Row("Jacobian of 11 parameters in a decay", simulations("jacobian", "tsit5"), "6", "14-20"),
        Row("Reverse gradient of a decay", sized("gradient", "tsit5"), "3, 50 MB (1 h sea)", "3.2, 55 MB (1 h sea)"),
        Row("Jacobian through diffrax", simulations("jacobian by diffrax", "diffrax")),
        Row("Reverse gradient through diffrax", sized("gradient by diffrax", "diffrax")),
    ]
    notes = [
        "A Jacobian is jax.jacfwd of all positions (t, 6) with respect to the eleven coordinates that a calibration of "
        "this platform frees; finite differences take 12 simulations. A gradient is jax.grad of one number. Both go "
        "through Tsit5 at 1 s, in units of one simulation by the same method; memory is XLA's temporary buffers."
    ]
    return rows, notes


def waiting(duration: float, quick: bool) -> tuple[list[Row], list[str]]:
    """Compilation and the first result in new processes: with an empty compilation cache, then with what that left."""
    with tempfile.TemporaryDirectory() as folder:

        def run(what: str) -> dict[str, float]:
            command = [sys.executable, "-m", "benchmarks.bench_cases", what, str(duration)]
            environment = os.environ | {"JAX_COMPILATION_CACHE_DIR": str(Path(folder) / what.partition(",")[0])}
            done = subprocess.run(command, cwd=ROOT, env=environment, check=True, stdout=subprocess.PIPE, text=True)
            return json.loads(done.stdout)

        def twice(what: str) -> tuple[dict[str, float], dict[str, float]]:
            return ({}, {}) if quick else (run(what), run(what))

        cold, warm = twice("first")
        rows = [
            Row(what, f"{taken['cpu']:.2g} s CPU, {taken['wall']:.2g} s wall" if taken else NOT_RUN, goal)
            for what, taken, goal in (
                ("First result from the cache, import apart", warm, "2 s"),
                ("First result ever, import apart", cold, ""),
            )
        ]
        cold, warm = (compilations(["tsit5"], duration), {}) if quick else twice(",".join(COMPILED))
        for name, prototype in COMPILED.items():
            compiled = f"{cold[name]:.2g} s" if name in cold else NOT_RUN
            cached = f", {warm[name]:.2g} s from the cache" if name in warm else ""
            rows.append(Row(f"Compilation: {name}", compiled + cached, "", prototype))
    notes = [
        "First result: platform file to motion by free_decay in a new process, after the imports. Compilation: CPU "
        "time of tracing, lowering and compiling; from the cache: in another new process, with what the first left in "
        "JAX's persistent cache."
    ]
    return rows, notes


COMPILED = {
    "tsit5": "2-3 s",
    "rk4": "3 s",
    "diffrax": "",
    "jacobian": "7-23 s",
    "gradient": "",
    "jacobian by diffrax": "",
    "gradient by diffrax": "",
}


def measure(quick: bool) -> Iterator[tuple[list[Row], list[str]]]:
    """All of this file but derivatives, part by part."""
    decay = Decay(60.0 if quick else 600.0)
    rounds = 2 if quick else 7
    yield against_numpy(decay, rounds)
    yield waiting(decay.duration, quick)
