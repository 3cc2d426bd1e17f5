"""Section: mooring lines at rest against MoorDyn."""

import json
from pathlib import Path

from benchmarks.evidence import mooring_lines_runs as runs
from benchmarks.evidence.common import Section, cached, fingerprint, say
from benchmarks.evidence.mooring_lines_text import compared, largest_differences, shortcomings, words

NAME = "mooring_lines"
TITLE = "Mooring lines at rest against MoorDyn"


def key() -> str:
    """Key of the section's results."""
    return fingerprint(Path(runs.__file__))


def run(figures: Path) -> Section:
    """Statics of the lines by jaxhydro, beside MoorDyn's."""
    results = cached(NAME, key(), "statics", runs.worked_out)
    moordyn = json.loads(runs.MOORDYN.read_text("utf-8"))
    fine, apart = runs.SEGMENTS[-1], compared(results, moordyn)[2]
    worst, finest = largest_differences(apart, fine)["all"], max(abs(x) for x in apart[runs.FINEST_RUN].values())
    say(f"  {100 * worst:.3f} % with {fine} segments, {100 * finest:.3f} % with {runs.FINEST_RUN[1]} at {runs.OFFSETS[-1]:g} m")
    return Section(TITLE, words(results, moordyn), (), shortcomings(results, moordyn))
