"""Section: coefficients that nine decays determine, and nine decays with one sea."""

from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.evidence import identified_runs as runs
from benchmarks.evidence.common import Section, cached, fingerprint, parallel, require, say
from benchmarks.evidence.identified_text import words

NAME = "identified"
TITLE = "What nine decays tell of eleven coefficients, and a sea beside them"


def key() -> str:
    """Key of the section's results."""
    return fingerprint(runs.FOLDER, Path(runs.__file__))


def run(figures: Path, processes: int) -> Section:
    """All cases, side by side."""
    require(runs.FOLDER, "../shared/campaigns has no nothing-missing")
    sources = key()
    facts = cached(NAME, sources, "campaign", runs.facts)
    results: dict[str, dict[str, Any]] = {}
    for name, result in parallel(NAME, sources, tuple(runs.CASES), partial(runs.of_case, facts["sea"]), processes):
        say(f"  {name}: {result['seconds']:.0f} s")
        results[name] = result
    return Section(TITLE, words(results, facts))
