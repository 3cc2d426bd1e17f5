"""Number of runs at a time that the cores, GPUs and memory of this machine hold."""

import math
import os
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import psutil

from jaxhydro.dynamics.irregular_simulation import excursion_of
from jaxhydro.errors import InputError, Problem
from jaxhydro.sweep.at_once import power_of_two
from jaxhydro.sweep.batch import Setup
from jaxhydro.waves.dispersion import wavenumber
from jaxhydro.waves.irregular import fourier_length, harmonics, repeat_period
from jaxhydro.waves.supports import MAX_SUPPORTS, Box, supports

MEMORY_COPIES = 2.5  # of a sea's series, while it is made: 2.3 to 2.5 were seen
PROCESS_BYTES = 700e6  # bytes of a worker before its first sea
MEMORY_SHARE = 0.6  # of what is available, that is used
MAX_RUNS_AT_ONCE = 512  # runs: that progress is seen
WORKERS_PER_GPU = 4  # workers: while one makes statistics on its core, the others keep the GPU busy


class Workload(NamedTuple):
    """Processes and batches of a sweep.

    Attributes:
        workers: Number of processes.
        batch: Runs that each takes at a time.
        devices: GPU of each process, as CUDA names it; empty: CPU.
        size: Memory of a run (bytes).
        words: The choice in words.
    """

    workers: int
    batch: int
    devices: tuple[str, ...]
    size: float
    words: str


def supports_of(setup: Setup, source: str = "sweep") -> int:
    """Largest number of support wavenumbers that a heading of the sweep needs.

    They are those of `IrregularSea.prepared`.

    Raises:
        InputError: The waves are too short for the hull; it names `source`.
    """
    plan, environment = setup.plan, setup.model.environment
    depth, gravity, period = float(environment.depth), float(environment.gravity), repeat_period(plan.duration)
    omega = 2 * math.pi / period * harmonics(plan.low, plan.cutoff, period)[1]
    free = float(wavenumber(jnp.asarray(omega), jnp.asarray(depth), jnp.asarray(gravity)))
    points = np.asarray(setup.model.hull.extremities())
    most = 0
    for heading in {math.radians(case.heading) for case in plan.cases}:
        _, box = Box.of(points, heading, depth, excursion_of(setup.model))
        try:
            most = max(most, supports(box, free, 2 * free if plan.order == 2 else 0.0).wavenumber.size)
        except ValueError:
            highest = 2 * (MAX_SUPPORTS - 8) / box.half  # rad/m, that about so many supports do for
            usual = math.sqrt(gravity * highest / plan.order) / (2 * math.pi)
            expected = f"about {usual:.2g} Hz or less at order {plan.order} for so large a hull"
            hint = "Shorter waves need too many support wavenumbers."
            raise InputError(source, [Problem("cutoff", expected, f"{plan.cutoff:g} Hz", hint)]) from None
    return most


def bytes_of_run(setup: Setup) -> float:
    """Largest memory of one run (bytes): the sea's series while they are made, and their spectra."""
    plan, model = setup.plan, setup.model
    period, cylinders = repeat_period(plan.duration), model.cylinders
    steps = fourier_length(period / setup.limit) * plan.duration / period
    radii = 0 if cylinders is None else cylinders.radius.size * (2 if cylinders.ramp else 1)
    rows = 6 + 2 * radii + (0 if (table := model.excitation) is None else len(table.at(jnp.ones(1), jnp.zeros(1))))
    complex_numbers = MEMORY_COPIES * steps + 3 * plan.order * plan.cutoff * period
    return complex_numbers * rows * supports_of(setup) * 16 + len(setup.times) * 50 * 8


def chosen(setup: Setup, runs: int, workers: int | None, batch: int | None) -> Workload:
    """Number of processes and of runs at a time, as given or as fits the machine.

    On the CPU each core takes one run at a time; more at once are no faster. Each GPU has `WORKERS_PER_GPU` processes.
    It takes as many runs as its memory holds, a power of two, at most `MAX_RUNS_AT_ONCE`.

    Args:
        setup: The sweep.
        runs: Number of runs to do.
        workers: Number of processes; None: what fits.
        batch: Runs at a time; None: what fits.
    """
    size = bytes_of_run(setup)
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    gpus = [device for device in jax.local_devices() if device.platform == "gpu"]
    if gpus:
        available = min(float((device.memory_stats() or {}).get("bytes_limit", 8e9)) for device in gpus)
        count = workers or max(len(gpus), min(WORKERS_PER_GPU * len(gpus), cores))
        each = -(-count // len(gpus))  # workers of one GPU
        names = os.environ.get("CUDA_VISIBLE_DEVICES", "").split(",")
        names = names if len(names) == len(gpus) and all(names) else [str(i) for i in range(len(gpus))]
        fits = max(1, min(MAX_RUNS_AT_ONCE, int(MEMORY_SHARE * available / each / size)))
        taken = min(1 << (fits.bit_length() - 1), power_of_two(-(-runs // count))) if batch is None else batch
        count = min(count, -(-runs // taken))
        words = (
            f"{count} process{'es' * (count > 1)} on {len(gpus)} GPU{'s' * (len(gpus) > 1)}, {taken} runs at once each: "
            f"{min(each, count) * taken * size / 1e9:.2g} of {available / 1e9:.0f} GB"
        )
        return Workload(count, taken, tuple(names[i % len(gpus)] for i in range(count)), size, words)
    available = float(psutil.virtual_memory().available)
    taken = 1 if batch is None else batch
    fits = max(1, min(cores, int(MEMORY_SHARE * available / (size + PROCESS_BYTES))))
    count = max(1, min(fits if workers is None else workers, -(-runs // taken)))
    words = (
        f"{count} process{'es' * (count > 1)} on {cores} cores, {taken} run{'s' * (taken > 1)} at a time each: "
        f"{count * (size + PROCESS_BYTES) / 1e9:.2g} of {available / 1e9:.0f} GB"
    )
    return Workload(count, taken, (), size, words)
