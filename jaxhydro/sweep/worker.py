"""Process that simulates runs of a sweep: `python -m jaxhydro.sweep.worker FOLDER`.

Lists of run numbers come in on standard input, one per line. The same numbers go out, one line each, with whether each run
is done. The process ends with its standard input: when the process that started it ends, however it does.
"""

import json
import os
import queue
import sys
import threading
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path

RunsDone = list[tuple[int, bool]]  # numbers of runs, and whether they are done
SINGLE_THREAD_FLAG = "--xla_cpu_multi_thread_eigen=false"


def environment(device: str | None = None) -> dict[str, str]:
    """Environment variables of a worker: one thread of arithmetic, on the GPU `device` if named."""
    variables = dict(os.environ)
    variables["NPROC"] = "1"  # threads of XLA's pool
    if SINGLE_THREAD_FLAG not in (flags := variables.get("XLA_FLAGS", "")):  # once: programs are kept by their flags
        variables["XLA_FLAGS"] = f"{flags} {SINGLE_THREAD_FLAG}".strip()
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        variables[name] = "1"
    variables.setdefault("XLA_PYTHON_CLIENT_PREALLOCATE", "false")  # of GPU memory, which the processes share
    if device is not None:
        variables["CUDA_VISIBLE_DEVICES"] = device
    return variables


def simulate_runs(folder: str, numbers: Sequence[int]) -> RunsDone:
    """Simulate runs and write them to the store, on a GPU all at once; whether each is done."""
    prepare()
    import jax

    from jaxhydro.sweep.batch import run_outcome, run_outcomes, setup_in
    from jaxhydro.sweep.store import INPUTS, Store

    store, setup = Store(Path(folder)), setup_in(Path(folder) / INPUTS)
    runs = [setup.plan.run(number) for number in numbers]
    if jax.default_backend() != "cpu":
        return [(run.number, store.write(run, outcome)) for run, outcome in zip(runs, run_outcomes(setup, runs))]
    return [(run.number, store.write(run, run_outcome(setup, run))) for run in runs]


def fail_runs(folder: str, numbers: Sequence[int], reason: str) -> RunsDone:
    """Write runs as failed, where their process was lost."""
    from jaxhydro.sweep.batch import plan_in
    from jaxhydro.sweep.store import INPUTS, Store

    store, plan = Store(Path(folder)), plan_in(Path(folder) / INPUTS)
    return [(number, store.write(plan.run(number), reason)) for number in numbers]


@lru_cache(maxsize=1)
def prepare() -> None:
    """Limit this process to one thread of arithmetic, unless JAX has already compiled a program."""
    os.environ.update({name: value for name, value in environment().items() if name not in os.environ or name == "XLA_FLAGS"})


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
        answers.write(json.dumps(simulate_runs(folder, json.loads(lines.get()))) + "\n")


if __name__ == "__main__":
    main()
