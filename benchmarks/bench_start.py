"""Start-up of commands and of the README's Python: programs and seconds, on an empty compilation cache and on a full one.

    python -m benchmarks.bench_start [--before FOLDER] [--rounds 3] [--out FILE]

writes benchmarks/results-start.md. With `--before`, the same commands of another checkout take turns with these.
"""

import argparse
import datetime
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from benchmarks.bench import processor, revision

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "benchmarks" / "results-start.md"
EMBEDDED = ROOT / "jaxhydro" / "campaigns" / "volturnus-s-decays"
ROLL_DECAY = ROOT.parent / "shared" / "measured" / "kvlcc2"  # its commands are left out where it is absent
COMMANDS = {
    "statics of VolturnUS-S": ["statics", "volturnus-s-focal"],
    "a decay of 300 s": ["simulate", "volturnus-s", "--release", "surge=5", "--duration", "300", "--out", "{out}"],
    "a sea of 1200 s": ["simulate", "volturnus-s", "--hs", "3", "--tp", "9", "--duration", "1200", "--out", "{out}"],
    "the same without figures": [
        *("simulate", "volturnus-s", "--hs", "3", "--tp", "9", "--duration", "1200", "--out", "{out}", "--no-figures")
    ],
    "init from a data file": ["init", "{out}", str(EMBEDDED / "surge-1.csv")],
    "check of the built-in campaign": ["check", "volturnus-s-decays", "--out", "{out}"],
    "the README's Python up to its decay": ["{decay}"],
    "the README's whole Python": ["{example}"],
    "demo: nine decays calibrated": ["demo", "--out", "{out}"],
}
OF_ROLL_DECAY = {
    "calibrate of one measured roll decay": ["calibrate", str(ROLL_DECAY), "--out", "{out}"],
    "diagnose of the same": ["diagnose", str(ROLL_DECAY), "--out", "{out}"],
}
SKIPPED_BEFORE = ("statics of VolturnUS-S",)  # a command that older sources lack
HEADS = ("command", "cache", "programs", "tracing and lowering (s)", "compiling (s)", "CPU time (s)", "wall time (s)")
PYTHON_BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
AFTER_DECAY = "result = calibrate("  # the README's line that follows its decay


def readme_examples() -> dict[str, str]:
    """Python of the README, up to its decay and whole."""
    block = PYTHON_BLOCK.search((ROOT / "README.md").read_text(encoding="utf-8"))
    if block is None or AFTER_DECAY not in block[1]:
        raise ValueError(f"README.md has no Python block with {AFTER_DECAY!r}")
    return {"decay": block[1].partition(AFTER_DECAY)[0], "example": block[1]}


def measured(words: list[str], sources: Path, cache: Path) -> dict[str, Any]:
    """Counts and seconds of one run of a command, by `start_probe`."""
    with tempfile.TemporaryDirectory() as folder:
        files = {"out": Path(folder) / "out"}
        for name, code in readme_examples().items():
            files[name] = Path(folder) / f"{name}.py"
            files[name].write_text(code, encoding="utf-8")
        given = [word.format(**files) for word in words]
        environment = os.environ | {"PYTHONPATH": str(sources), "JAX_COMPILATION_CACHE_DIR": str(cache)}
        command = [sys.executable, str(ROOT / "benchmarks" / "start_probe.py"), *given]
        begun = time.monotonic()
        done = subprocess.run(command, env=environment, cwd=folder, capture_output=True, text=True, check=True)
        wall = time.monotonic() - begun
    return json.loads(done.stdout.strip().splitlines()[-1]) | {"wall_s": wall}


def rows_of(name: str, words: list[str], sources: dict[str, Path], rounds: int) -> list[tuple[str, ...]]:
    """Medians of a command, for each checkout, with an empty and with a full cache."""
    measurements: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for _ in range(rounds):
        for label, folder in sources.items():
            cache = Path(tempfile.mkdtemp())
            try:
                for state in ("empty", "full"):
                    measurements.setdefault((label, state), []).append(measured(words, folder, cache))
            finally:
                shutil.rmtree(cache)
    rows = []
    for (label, state), runs in measurements.items():
        middle = {key: statistics.median(run[key] for run in runs) for key in runs[0]}
        work = middle["trace_s"] + middle["lower_s"]
        seconds = (work, middle["compile_s"], middle["cpu_s"], middle["wall_s"])
        rows.append((f"{name}{label}", state, f"{middle['programs']:.0f}", *(f"{value:.1f}" for value in seconds)))
    return rows


def main() -> None:
    """Measure all commands and write the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--before", type=Path, help="another checkout, which takes turns with this one")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--out", type=Path, default=RESULTS)
    arguments = parser.parse_args()
    rows = []
    for name, words in (COMMANDS | (OF_ROLL_DECAY if ROLL_DECAY.is_dir() else {})).items():
        sources = {"": ROOT}
        if arguments.before is not None and name not in SKIPPED_BEFORE:
            sources = {", before": arguments.before, ", now": ROOT}
        rows += rows_of(name, words, sources, arguments.rounds)
        print(*rows[-2 * len(sources) :], sep="\n", flush=True)
    when = datetime.date.today().isoformat()
    lines = [
        "# Start-up of commands",
        "",
        f"`python -m benchmarks.bench_start --rounds {arguments.rounds}`, {when}. Seconds are medians of the rounds.",
        "CPU time is that of the whole process, imports included. *Full* is the compilation cache that the first run left.",
        "Programs that come from the cache are counted.",
        "",
        f"Machine: {processor()}, {os.cpu_count()} cores, load average {os.getloadavg()[0]:.1f}; jaxhydro {revision()}.",
        "",
        f"| {' | '.join(HEADS)} |",
        f"| :-- | :-- {'| --: ' * (len(HEADS) - 2)}|",
        *(f"| {' | '.join(row)} |" for row in rows),
        "",
    ]
    arguments.out.write_text("\n".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
