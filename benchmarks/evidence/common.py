"""Paths, cache of results and tables that the sections of docs/validation.md share."""

import hashlib
import json
import multiprocessing as mp
import os
import signal
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared"
CACHE = Path(os.environ.get("JAXHYDRO_VALIDATE_CACHE", ROOT / ".venv" / "validate-cache"))
EVIDENCE = ROOT / "docs" / "evidence"  # results by section, from which the page's text is made again without a run
MAX_EVIDENCE = 400_000  # bytes of a section's file there; results that are larger stay in the cache
KEPT_ELSEWHERE = ("diagnoses",)  # sections with a file of their own in docs
DEMO = ROOT / "jaxhydro" / "campaigns" / "volturnus-s-decays"
# the edge of the packages, and sweeps, which only that edge knows: no number depends on them
EDGE = {
    *(ROOT / "jaxhydro" / name for name in ("__main__.py", "calibrated_model.py", "files.py", "interrupts.py")),
    *(ROOT / "jaxhydro" / name for name in ("cli", "sweep", "display", "plots")),
    *(
        ROOT / "calibration" / name
        for name in ("display", "plots", "report", "commands", "new_campaign", "formatting.py", "vocabulary.py")
    ),
}
TRUE = {
    "column.Ca_t": 1.50,
    "column.Ca_z": 0.12,
    "column.Cd_t": 2.09,
    "column.Cd_z": 2.23,
    "pontoon.Ca_t": 0.11,
    "pontoon.Ca_z": 1.87,
    "pontoon.Cd_t": 1.84,
    "pontoon.Cd_z": 4.96,
    "linear_damping.B11": 4.4e4,
    "linear_damping.B33": 1.6e5,
    "linear_damping.B55": 3.63e8,
}


class Section(NamedTuple):
    """A section of the page.

    Attributes:
        title: Heading.
        text: Text in Markdown.
        figures: Files of the figures.
        short: What falls short of a goal, a sentence each.
    """

    title: str
    text: str
    figures: tuple[Path, ...] = ()
    short: tuple[str, ...] = ()


class Absent(Exception):
    """What a section needs is not on this machine."""


def require(path: Path, message: str) -> None:
    """Check that data of a run is there; a text that is made of kept results needs none.

    Args:
        path: File or folder of the data.
        message: Sentence for `Absent`.

    Raises:
        Absent: Where the data is missing and `text_only` is not set.
    """
    if not text_only and not path.exists():
        raise Absent(message)


def fingerprint(*inputs: Path | str) -> str:
    """Hash of the packages' sources, `EDGE` left out, and of files, folders and parameters of a run.

    Of a section's own modules only those that run are inputs. A key that covers text of the page would make a run of hours
    stale by a change of wording.
    """
    modules = [path for name in ("jaxhydro", "calibration") for path in (ROOT / name).rglob("*.py")]
    sources = sorted(path for path in modules if not EDGE & {path, *path.parents})
    digest = hashlib.sha256()
    for item in [*sources, *inputs]:
        if isinstance(item, Path):
            for path in sorted(item.rglob("*")) if item.is_dir() else [item]:
                if path.is_file():
                    digest.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
        else:
            digest.update(item.encode() + b"\0")
    return digest.hexdigest()[:16]


stale: list[str] = []  # sections that took a result of other sources
accept_stale = False
text_only = False


def cached(section: str, key: str, name: str, work: Callable[[], Any] | None = None) -> Any:
    """A result (JSON) from the cache, else that of `work`, kept; None where there is neither.

    Where `accept_stale` is set, the latest result of other sources is better than none, and the section is noted in `stale`.
    Where `text_only` is set, results are those in docs/evidence, else the latest in the cache, and nothing is run.

    Raises:
        Absent: Where `text_only` is set and there is no result.
    """
    if text_only and (entry := evidence(section).get(name)) is not None:
        return entry["result"]
    path = CACHE / section / key / f"{name}.json"
    earlier = sorted((CACHE / section).glob(f"*/{name}.json"), key=lambda p: p.stat().st_mtime)
    if not path.exists() and earlier and (accept_stale or text_only):
        path = earlier[-1]
        stale.append(section)
    if path.exists():
        result = json.loads(path.read_text())
        if path.parent.name == key:
            record(section, key, name, result)
        return result
    if text_only:
        raise Absent(f"no result {name!r} to make the text of: `python -m benchmarks.validate --only {section}` runs it")
    if work is None:
        return None
    return keep(section, key, name, work())


def keep(section: str, key: str, name: str, result: Any) -> Any:
    """Write a result into the cache, whole; gives it as JSON gives it back."""
    path = CACHE / section / key / f"{name}.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = path.with_suffix(f".{os.getpid()}")
    beside.write_text(json.dumps(result))
    beside.replace(path)
    result = json.loads(path.read_text())
    record(section, key, name, result)
    return result


def evidence(section: str) -> dict[str, Any]:
    """Results of a section in docs/evidence: name -> `sources`, their hash, and `result`."""
    path = EVIDENCE / f"{section}.json"
    return json.loads(path.read_text()) if path.exists() else {}


def record(section: str, key: str, name: str, result: Any) -> None:
    """Write a result into docs/evidence too, unless the section's results are too many for it."""
    results, entry = evidence(section), {"sources": key, "result": result}
    if section in KEPT_ELSEWHERE or results.get(name) == entry:
        return
    # names are sorted, what is within a result is not: its order is that of the rows of tables
    merged = dict(sorted((results | {name: entry}).items()))
    text = json.dumps(merged, indent=1) + "\n"
    if len(text) > MAX_EVIDENCE:
        say(f"  {section}: {name} is too large for docs/evidence and stays in the cache")
        return
    EVIDENCE.mkdir(parents=True, exist_ok=True)
    (EVIDENCE / f"{section}.json").write_text(text)


def parallel(
    section: str, key: str, names: Sequence[str], work: Callable[[str], Any], processes: int, go_on: bool = False
) -> Iterator[tuple[str, Any]]:
    """Results of `work(name)` for all names.

    Those in the cache come first; the others are worked out by processes of their own.

    Where `accept_stale` is set and there are any, there are no others, unless the section is to `go_on` over many sessions.
    """
    missing = []
    for name in names:
        result = cached(section, key, name)
        if result is None:
            missing.append(name)
        else:
            yield name, result
    if missing and (go_on or not (accept_stale and len(missing) < len(names))):
        with mp.get_context("spawn").Pool(min(processes, len(missing)), _worker) as pool:
            for name, result in pool.imap_unordered(_Named(work), missing):
                yield name, keep(section, key, name, result)


def _worker() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the one that waits for them


class _Named:
    def __init__(self, work: Callable[[str], Any]) -> None:
        self.work = work

    def __call__(self, name: str) -> tuple[str, Any]:
        return name, self.work(name)


def within(x: np.ndarray, low: float, high: float, step: float) -> np.ndarray:
    """`band_pass` of a series in steps (s); samples that are none are left out."""
    from jaxhydro.analysis.spectral import band_pass

    x = x[np.isfinite(x)]
    return band_pass(step * np.arange(len(x)), x, low, high)


def table(head: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """A Markdown table, its first column on the left."""
    lines = [head, [":--", *["--:"] * (len(head) - 1)], *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines) + "\n"


def say(text: str) -> None:
    """One line of progress."""
    print(text, flush=True)
