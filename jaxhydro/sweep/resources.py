"""How many runs at a time: what the cores, the GPUs and the memory of this machine hold."""

import os
from typing import NamedTuple

import jax
import psutil

from jaxhydro.sweep.batch import Setup
from jaxhydro.waves.irregular import fourier_length, repeat_period

WAVENUMBERS = 26  # supports of a sea, at most
COPIES = 6  # of a sea's series, while it is made
PROCESS = 700e6  # bytes of a worker before its first sea
SHARE = 0.6  # of what is available, that is used
MOST = 512  # runs at once: beyond, a GPU gains nothing


class Chosen(NamedTuple):
    """Worker processes, runs that each takes at a time, GPUs by number (none: the cores), bytes of a run, and all that in
    words."""

    workers: int
    batch: int
    devices: tuple[str, ...]
    size: float
    words: str


def bytes_of_run(setup: Setup) -> float:
    """Of one run at its largest: its sea's series, and at second order the pairs of its components."""
    plan = setup.plan
    period = repeat_period(plan.duration)
    steps = fourier_length(period / setup.limit) * plan.duration / period
    cylinders = setup.model.cylinders
    radii = 0 if cylinders is None else cylinders.radius.size * (2 if cylinders.ramp else 1)
    series = steps * (6 + 2 * radii) * 2 * WAVENUMBERS * 8
    pairs = (plan.cutoff * period) ** 2 * 200 if plan.order == 2 else 0.0
    return COPIES * series + pairs + len(setup.times) * 50 * 8


def chosen(setup: Setup, runs: int, workers: int | None, batch: int | None) -> Chosen:
    """Workers and batch as given, else those that fit: on the CPU one run per core at a time (more at once are no faster), on
    GPUs as many as their memory holds, at most `MOST`."""
    size = bytes_of_run(setup)
    gpus = [device for device in jax.local_devices() if device.platform == "gpu"]
    if gpus:
        available = min(float((device.memory_stats() or {}).get("bytes_limit", 8e9)) for device in gpus)
        count = min(workers or len(gpus), len(gpus))
        fits = max(1, min(MOST, int(SHARE * available / size), -(-runs // count)))
        taken = fits if batch is None else batch
        words = f"{count} GPU{'s' * (count > 1)}, {taken} runs at once: {taken * size / 1e9:.2g} of {available / 1e9:.0f} GB"
        return Chosen(count, taken, tuple(str(i) for i in range(count)), size, words)
    available = float(psutil.virtual_memory().available)
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    taken = 1 if batch is None else batch
    fits = max(1, min(cores, int(SHARE * available / (size + PROCESS))))
    count = max(1, min(fits if workers is None else workers, -(-runs // taken)))
    words = (
        f"{count} process{'es' * (count > 1)} on {cores} cores, {taken} run{'s' * (taken > 1)} at a time each: "
        f"{count * (size + PROCESS) / 1e9:.2g} of {available / 1e9:.0f} GB"
    )
    return Chosen(count, taken, (), size, words)
