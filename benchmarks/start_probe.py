"""One command of `jaxhydro`, or a Python file, with its compilations counted: JSON on the last line of standard output.

    python benchmarks/start_probe.py simulate volturnus-s --release surge=5 --out /tmp/decay
    python benchmarks/start_probe.py example.py

Run as a file, so that it measures the packages that PYTHONPATH names, of another checkout too.
"""

import collections
import json
import runpy
import sys
import time


def main(words: list[str]) -> None:
    """Run the command or file; print programs, their seconds by stage, and seconds of CPU of the whole process."""
    import jax.monitoring

    seconds: dict[str, float] = collections.defaultdict(float)
    counts: dict[str, int] = collections.defaultdict(int)

    def measured(name: str, duration: float, **_: object) -> None:
        seconds[name.rsplit("/", 1)[-1]] += duration
        counts[name.rsplit("/", 1)[-1]] += 1

    jax.monitoring.register_event_duration_secs_listener(measured)
    from jaxhydro.cli.app import main as command_line

    imported = time.process_time()
    sys.argv = ["jaxhydro", *words]
    try:
        if words[0].endswith(".py"):
            runpy.run_path(words[0])
        else:
            command_line()
    except SystemExit as stop:
        if stop.code:
            raise
    summary = {
        "programs": counts["backend_compile_duration"],
        "trace_s": seconds["jaxpr_trace_duration"],
        "lower_s": seconds["jaxpr_to_mlir_module_duration"],
        "compile_s": seconds["backend_compile_duration"],
        "import_cpu_s": imported,
        "cpu_s": time.process_time(),
    }
    print(json.dumps(summary))


if __name__ == "__main__":
    main(sys.argv[1:])
