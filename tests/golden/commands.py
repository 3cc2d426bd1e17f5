"""The golden set: commands, and the numbers that their result files held before the code was moved.

    python -m tests.golden.commands            # compare every command with its numbers
    python -m tests.golden.commands demo       # ... one
    python -m tests.golden.commands demo --write    # keep new numbers: the commit says why they moved
"""

import argparse
import json
import math
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
MEASURED = ROOT.parent / "shared" / "measured"
NUMBERS = HERE / "numbers"

SAME_MACHINE = 1e-9  # relative: moved code does the same arithmetic
OTHER_MACHINE = {"simulation": 1e-7, "fit": 1e-3}  # another processor rounds otherwise, and an iteration amplifies that
HEADLINE = re.compile(r"objective\.|\.rmse$|verdict$|effects\[\d+\]\.effect$|converged$")  # of a fit, on another processor
ZERO = 1e-12  # a difference below is rounding, of what is zero
VOLATILE = re.compile(r"seconds|history|evaluations|version|jaxhydro$|created|source$|figures|notes|warnings|file$|platform$")
NAMES = re.compile(r"verdict$|effect$|motion$|(^|\.)name$|label$|\.use$|outcome$")  # texts that are results, not wording


@dataclass(frozen=True)
class Case:
    """A command: what is run, the JSON file to read, and whether a fit amplifies rounding. `slow`: over 20 s."""

    arguments: Callable[[Path], list[str]]
    result: str
    kind: str = "fit"
    slow: bool = True
    needs: Path | None = None


def _decays_only(folder: Path) -> Path:
    """The campaign `complete` without its sea."""
    copy = folder / "complete-decays"
    shutil.copytree(HERE / "campaigns" / "complete", copy)
    yaml = YAML()
    manifest = yaml.load(copy / "campaign.yaml")
    manifest["tests"] = [test for test in manifest["tests"] if test["kind"] == "decay"]
    del manifest["wave_channel"]
    yaml.dump(manifest, copy / "campaign.yaml")
    return copy


def _sweep(folder: Path) -> Path:
    """A sweep of four seas."""
    document = {
        "platform": "volturnus-s",
        "scatter": [{"hs": 2.0, "tp": 8.0, "probability": 60}, {"hs": 4.0, "tp": 10.0, "probability": 40}],
        "seeds": 2,
        "duration": 150.0,
        "cutoff": 0.2,
    }
    path = folder / "sweep.yaml"
    path.write_text(json.dumps(document))
    return path


def _calibrated(campaign: Path, folder: Path) -> list[str]:
    out = str(folder / "calibrated")
    run(["calibrate", str(campaign), "--no-figures", "--out", out])
    return ["--calibration", out]


COMPLETE, FRICTION = HERE / "campaigns" / "complete", HERE / "campaigns" / "friction"
KVLCC2, FOCAL = MEASURED / "kvlcc2", MEASURED / "focal-c4"
SEA = ["simulate", "volturnus-s", "--hs", "3.1", "--tp", "8.96", "--duration", "300", "--heading", "20"]
CASES = {
    "demo": Case(lambda _: ["demo"], "calibration.json"),
    "calibrate-kvlcc2": Case(lambda _: ["calibrate", str(KVLCC2)], "calibration.json", needs=KVLCC2),
    "calibrate-focal": Case(lambda _: ["calibrate", str(FOCAL)], "calibration.json", needs=FOCAL),
    "uncertainty": Case(
        lambda folder: ["uncertainty", str(KVLCC2), *_calibrated(KVLCC2, folder), "--profile", "*", "--bootstrap", "40"],
        "uncertainty.json",
        needs=KVLCC2,
    ),
    "diagnose-kvlcc2": Case(lambda _: ["diagnose", str(KVLCC2)], "diagnosis.json", needs=KVLCC2),
    "diagnose-complete": Case(lambda folder: ["diagnose", str(_decays_only(folder))], "diagnosis.json"),
    "diagnose-friction": Case(lambda _: ["diagnose", str(FRICTION)], "diagnosis.json"),
    "simulate-sea": Case(lambda _: SEA, "statistics.json", "simulation", slow=False),
    "simulate-campaign": Case(lambda _: ["simulate", str(COMPLETE)], "comparison.json", "simulation", slow=False),
    "calibrate-waves": Case(lambda _: ["calibrate", str(COMPLETE), "--tests", "waves"], "calibration.json"),
    "sweep": Case(lambda folder: ["sweep", str(_sweep(folder)), "--workers", "1"], "sweep.json", "simulation", slow=False),
}


def run(arguments: list[str]) -> None:
    """Run a command of jaxhydro. Raises RuntimeError with what it printed unless it ends with status 0."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])}
    done = subprocess.run(
        [sys.executable, "-m", "jaxhydro", *arguments], capture_output=True, text=True, env=environment, check=False
    )
    if done.returncode:
        said = f"{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
        raise RuntimeError(f"jaxhydro {' '.join(arguments)}: status {done.returncode}\n{said}")


def numbers_of(case: Case) -> dict[str, Any]:
    """What a case's result file holds, by path: numbers, booleans and names."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        out = folder / "out"
        arguments = case.arguments(folder)
        figures = [] if arguments[0] in ("demo", "sweep") else ["--no-figures"]
        run([*arguments, *figures, "--out", str(out)])
        return dict(_flat(json.loads((out / case.result).read_text())))


def _flat(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    if path and VOLATILE.search(path):
        return
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _flat(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list):
        for i, inner in enumerate(value):
            yield from _flat(inner, f"{path}[{i}]")
    elif not isinstance(value, str) or NAMES.search(path):
        yield path, value


def machine() -> str:
    """The processor and the versions that numbers to the last digits belong to."""
    import jax

    info = Path("/proc/cpuinfo")
    found = re.search(r"model name\s*:\s*(.+)", info.read_text()) if info.exists() else None
    return f"{found[1] if found else platform.processor()}, jax {jax.__version__}"


def differences(expected: dict[str, Any], found: dict[str, Any], tolerance: float) -> list[str]:
    """Lines that say where numbers differ; empty where they agree."""
    lines = [f"{path}: expected {expected[path]!r}, found nothing" for path in expected.keys() - found.keys()]
    for path in expected.keys() & found.keys():
        a, b = expected[path], found[path]
        numbers = all(isinstance(x, int | float) and not isinstance(x, bool) for x in (a, b))
        if not numbers and a != b:
            lines.append(f"{path}: expected {a!r}, found {b!r}")
        elif numbers and not math.isclose(a, b, rel_tol=tolerance, abs_tol=ZERO):
            lines.append(f"{path}: expected {a!r}, found {b!r} ({abs(b - a) / max(abs(a), 1e-300):.1e} off)")
    return sorted(lines)


def compare(name: str) -> list[str]:
    """Run a case; lines that say where its numbers differ from those kept."""
    kept = json.loads((NUMBERS / f"{name}.json").read_text())
    expected, found, kind = kept["numbers"], numbers_of(CASES[name]), CASES[name].kind
    if kept["machine"] == machine():
        return differences(expected, found, SAME_MACHINE)
    if kind == "fit":
        expected = {path: value for path, value in expected.items() if HEADLINE.search(path)}
    return differences(expected, found, OTHER_MACHINE[kind])


def write(name: str) -> None:
    """Keep the numbers of a case."""
    NUMBERS.mkdir(exist_ok=True)
    kept = {"machine": machine(), "numbers": numbers_of(CASES[name])}
    (NUMBERS / f"{name}.json").write_text(json.dumps(kept, indent=1) + "\n")


def main() -> int:
    """Compare, or write, the cases that are named; all without a name."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("name", nargs="*", help=", ".join(CASES))
    parser.add_argument("--write", action="store_true", help="keep the numbers found")
    asked = parser.parse_args()
    worst = 0
    for name in asked.name or CASES:
        needs = CASES[name].needs
        if needs is not None and not needs.exists():
            print(f"{name}: skipped, {needs} is not there")
        elif asked.write:
            write(name)
            print(f"{name}: written", flush=True)
        else:
            lines = compare(name)
            worst = max(worst, bool(lines))
            print(f"{name}: {'the same' if not lines else f'{len(lines)} differ'}", *lines[:20], sep="\n  ", flush=True)
    return worst


if __name__ == "__main__":
    sys.exit(main())
