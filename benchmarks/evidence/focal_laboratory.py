"""Section: gauge and tracked point of FOCAL campaign 2, by linear potential flow in place of strips."""

from pathlib import Path

from benchmarks.evidence import focal_laboratory_runs as runs
from benchmarks.evidence import focal_potential_flow
from benchmarks.evidence.common import Section, cached, fingerprint, require, say
from benchmarks.evidence.focal_laboratory_text import rows_of, words
from benchmarks.evidence.focal_potential_flow import FOLDER

NAME = "focal_laboratory"
TITLE = "The laboratory of FOCAL campaign 2, by other evidence"


def key() -> str:
    """Key of the section's results."""
    modules = (Path(runs.__file__), Path(focal_potential_flow.__file__))
    return fingerprint(FOLDER / "focal-c2", FOLDER / "focal-c4" / "wamit", *modules)


def run(figures: Path) -> Section:
    """The section; it has no figures."""
    require(FOLDER / "focal-c2", "the measured records (../shared/measured) are not on this machine")
    results = cached(NAME, key(), "seas", runs.all_seas)
    say("  " + "; ".join(f"{row[0]}: {row[-1]}" for row in rows_of(results)))
    return Section(TITLE, words(results))
