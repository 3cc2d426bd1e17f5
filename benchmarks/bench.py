"""Speed as ratios in one run: against plain NumPy, finite differences and population searches.

    python -m benchmarks.bench [--quick] [--only PART] [--budget SECONDS] [--searches DE ...] [--out FILE]

writes benchmarks/results.md, whole or not at all, and prints it. Everything is process CPU time on one core,
contestants in turns, medians; so the machine may be busy. On a GPU, which `--only batch` is for, what it does is wall time.
`--quick` is a smoke run, `--only` a part (decay, sea, mooring, derivatives, batch, sweep, fit); these write only where
`--out` says.
"""

import argparse
import datetime
import importlib
import importlib.metadata
import importlib.util
import os
import platform
import subprocess
from collections.abc import Iterator
from itertools import chain
from pathlib import Path

from rich.console import Console
from rich.table import Table

from benchmarks.bench_timing import Row, pin
from jaxhydro.sweep import worker

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "benchmarks" / "results.md"
HEADINGS = ("what", "result", "goal", "prototype")
PARTS = ("decay", "sea", "mooring", "derivatives", "batch", "sweep", "fit")
SLOW = "sweep"  # is not in a smoke run
SEARCHES = ["DE", "GA", "CMA-ES"]
PACKAGES = ("jax", "jaxlib", "numpy", "scipy", "equinox", "diffrax", "optimistix", "pymoo")


def on_gpu() -> bool:
    """Whether JAX will look for one, as far as can be told before it starts."""
    platforms = os.environ.get("JAX_PLATFORMS", "cuda")
    return "cuda" in platforms and any(importlib.util.find_spec(f"jax_cuda{version}_plugin") for version in (12, 13))


def processor() -> str:
    """The processor's model, as Linux tells it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def revision() -> str:
    """The commit, and whether the tree differs from it."""
    command = ["git", "describe", "--always", "--dirty", "--exclude", "*"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    return done.stdout.strip() or "unknown"


def machine(cores: int, gpu: str | None) -> list[str]:
    """Where and with what it was measured."""
    versions = ", ".join(f"{name} {importlib.metadata.version(name)}" for name in PACKAGES)
    load = " / ".join(f"{value:.1f}" for value in os.getloadavg())
    used = f"{cores} cores, of which one was used" + ("" if gpu is None else f", and {gpu}")
    return [
        f"Machine: {processor()}, {used}; load averages {load}.",
        f"Python {platform.python_version()}, {versions}; jaxhydro {revision()}.",
    ]


def markdown(rows: list[Row], notes: list[str]) -> str:
    """The results as a file."""

    def line(cells):
        return "| " + " | ".join(cells) + " |"

    table = [line(HEADINGS), line(["---"] * len(HEADINGS)), *map(line, rows)]
    return "\n".join(["# Speed", "", *table, "", *(f"- {note}" for note in notes), ""])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="a smoke run of a minute, its numbers worth nothing")
    parser.add_argument("--budget", type=float, help="CPU seconds for each population search (300; quick: 0.3)")
    parser.add_argument("--searches", nargs="+", choices=SEARCHES, default=SEARCHES, help="population searches to compare with")
    parser.add_argument("--only", choices=tuple(PARTS), help="one part of all")
    parser.add_argument("--out", type=Path, help="file to write (benchmarks/results.md; quick or a part: none)")
    arguments = parser.parse_args()
    budget = (0.3 if arguments.quick else 300.0) if arguments.budget is None else arguments.budget
    out = arguments.out or (None if arguments.quick or arguments.only else RESULTS)
    cores = os.cpu_count() or 1
    if on_gpu():
        os.environ |= worker.environment()  # one thread on the CPU, while programs for the GPU are compiled by many
    else:
        pin()
    import jax

    # what compiles in this process is timed too
    jax.config.update("jax_enable_compilation_cache", arguments.quick)
    from jaxhydro.files import write_whole

    device = jax.devices()[0]
    gpu = None if device.platform == "cpu" else device.device_kind
    console = Console(width=None if Console().is_terminal else 160)
    rows, notes = [], []
    parts = [arguments.only] if arguments.only else [name for name in PARTS if not (arguments.quick and name == SLOW)]
    figure = out.with_suffix(".png") if out is not None and not arguments.quick else None

    taken = {"fit": (budget, arguments.quick, arguments.searches), "batch": (arguments.quick, figure), "sweep": ()}

    def of(name: str) -> Iterator[tuple[list[Row], list[str]]]:
        return importlib.import_module(f"benchmarks.bench_{name}").measure(*taken.get(name, (arguments.quick,)))

    for part_rows, part_notes in chain.from_iterable(map(of, parts)):
        rows += part_rows
        notes += part_notes
        for row in part_rows:
            console.print(f"{row.what}: {row.result}", style="dim", highlight=False)
    options = (" --quick" if arguments.quick else "") + (f" --only {arguments.only}" if arguments.only else "")
    if arguments.only in (None, "fit"):
        options += f" --budget {budget:g}"
        options += "" if arguments.searches == SEARCHES else f" --searches {' '.join(arguments.searches)}"
    begun = [
        f"{datetime.date.today().isoformat()}, `python -m benchmarks.bench{options}`. Process CPU time on one core, "
        "contestants in turns, medians; ratios are medians over turns. Compilation is apart everywhere.",
        *machine(cores, gpu),
    ]
    if arguments.quick:
        begun.insert(0, "A smoke run: short decays, one record, few turns. These numbers say nothing.")
    table = Table(*HEADINGS, title="Speed")
    for row in rows:
        table.add_row(*row)
    console.print(table, highlight=False)
    for note in begun + notes:
        console.print(f"- {note}", highlight=False)
    if out is not None:
        write_whole(out.absolute(), markdown(rows, begun + notes))
        console.print(f"Results are in {out}")


if __name__ == "__main__":
    main()
