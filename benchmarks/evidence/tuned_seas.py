"""Section: coefficients tuned to the two lower seas of FOCAL campaign 2 and judged on the third."""

from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.evidence import tuned_seas_runs as runs
from benchmarks.evidence.common import Section, cached, fingerprint, parallel, require, say
from benchmarks.evidence.tuned_seas_text import shortcomings, words

TITLE = "Coefficients tuned to seas, and what tuning cannot mend"


def key() -> str:
    """Key of the section's results."""
    return fingerprint(runs.FOLDER / "focal-c4", runs.FOLDER / "focal-c2", Path(runs.__file__))


def run(figures: Path, processes: int) -> Section:
    """Both starts and the laws, side by side; then every sea alone."""
    require(runs.FOLDER / "focal-c2", "../shared/measured has no focal-c2")
    sources = key()
    cached(runs.NAME, sources, "decays", runs.decays)
    results: dict[str, dict[str, Any]] = {}
    for names in ((*runs.STARTS, *runs.LAWS), tuple(f"{sea}{runs.ALONE}" for sea in runs.SEAS)):
        for name, result in parallel(runs.NAME, sources, names, partial(runs.tuned, sources), processes):
            say(f"  {name}: {len(result['history'])} iterations, {result['seconds']:.0f} s")
            results[name] = result
    return Section(TITLE, words(results), (), shortcomings(results))
