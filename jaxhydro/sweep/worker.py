"""A process that simulates runs of a sweep and writes them to its store: `python -m jaxhydro.sweep.worker FOLDER`.

Lists of run numbers come in on standard input, one line each; the same with what became of them goes out, one line each. It
ends with its standard input: when the process that started it ends, however it does.
"""

import json
import os
import queue
import sys
import threading
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path

from jaxhydro.start import start

FLAG = "--xla_cpu_multi_thread_eigen=false"


def environment(device: str | None = None) -> dict[str, str]:
    """Environment variables of a worker: one thread of arithmetic, on the GPU `device` where one is named."""
    found = dict(os.environ)
    found["NPROC"] = "1"  # threads of XLA's pool
    if FLAG not in (flags := found.get("XLA_FLAGS", "")):  # once: programs are kept by their flags
        found["XLA_FLAGS"] = f"{flags} {FLAG}".strip()
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        found[name] = "1"
    if device is not None:
        found["CUDA_VISIBLE_DEVICES"] = device
    return found


def simulate_runs(folder: str, numbers: Sequence[int], at_once: bool = False) -> list[tuple[int, bool]]:
    """Simulate runs and write them; each with whether it is done. What is done already is left alone."""
    prepare()
    from jaxhydro.sweep.batch import outcome, outcomes, setup_in
    from jaxhydro.sweep.store import INPUTS

    store, setup = _store(Path(folder)), setup_in(Path(folder) / INPUTS)
    runs = [setup.plan.run(number) for number in numbers]
    if at_once:
        return [(run.number, store.write(run, found)) for run, found in zip(runs, outcomes(setup, runs))]
    return [(run.number, store.write(run, outcome(setup, run))) for run in runs]


def fail_runs(folder: str, numbers: Sequence[int], reason: str) -> list[tuple[int, bool]]:
    """Write that runs failed; for those whose process was lost."""
    from jaxhydro.sweep.batch import setup_in
    from jaxhydro.sweep.store import INPUTS

    store, plan = _store(Path(folder)), setup_in(Path(folder) / INPUTS).plan
    return [(number, store.write(plan.run(number), reason)) for number in numbers]


@lru_cache(maxsize=1)
def prepare() -> None:
    """Set JAX up, once in a process, and to one thread where it has not begun yet."""
    os.environ.update({name: value for name, value in environment().items() if name not in os.environ or name == "XLA_FLAGS"})
    start()


@lru_cache(maxsize=1)
def _store(folder: Path):
    from jaxhydro.sweep.store import Store

    return Store(folder)


def main() -> None:
    """Serve one sweep."""
    folder = sys.argv[1]
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)  # whatever is printed on the way is no answer
    lines: queue.SimpleQueue[str] = queue.SimpleQueue()

    def listen() -> None:
        for line in sys.stdin:
            lines.put(line)
        os._exit(0)

    threading.Thread(target=listen, daemon=True).start()
    while True:
        asked = json.loads(lines.get())
        found = simulate_runs(folder, asked["numbers"], asked["at_once"])
        answers.write(json.dumps(found) + "\n")


if __name__ == "__main__":
    main()
