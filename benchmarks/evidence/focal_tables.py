"""Section: FOCAL campaign 2 by its WAMIT tables and by strips, nothing fitted."""

from pathlib import Path

from benchmarks.evidence import focal_tables_runs as runs
from benchmarks.evidence.common import Section, cached, fingerprint, require, say
from benchmarks.evidence.focal_potential_flow import FOLDER
from benchmarks.evidence.focal_tables_text import mean_rows, words

NAME = "focal_tables"
TITLE = "FOCAL campaign 2 by potential flow, nothing fitted"


def key() -> str:
    """Key of the section's results."""
    return fingerprint(FOLDER / "focal-c2", FOLDER / "focal-c4" / "wamit", Path(runs.__file__))


def run(figures: Path) -> Section:
    """The section; it has no figures."""
    require(FOLDER / "focal-c2", "the measured records (../shared/measured) are not on this machine")
    sources = key()
    results = {
        name: cached(NAME, sources, f"variant {i}", lambda lines=lines, name=name: runs.compared(lines, name))
        for i, (name, lines) in enumerate(runs.VARIANTS.items())
    }
    say("  " + "; ".join(f"{row[0]}: {row[-1]}" for row in mean_rows(results)))
    return Section(TITLE, words(results))
