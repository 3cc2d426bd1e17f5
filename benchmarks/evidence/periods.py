"""Section: natural periods, balance and volume of the built-in volturnus-s against its published data."""

from pathlib import Path

from benchmarks.evidence import periods_runs as runs
from benchmarks.evidence.common import ROOT, Section, cached, fingerprint, say
from benchmarks.evidence.periods_text import errors_of, shortcomings, words

NAME = "periods"
TITLE = "VolturnUS-S against its published data"


def key() -> str:
    """Key of the section's results."""
    return fingerprint(ROOT / "jaxhydro" / "platforms" / "volturnus-s.yaml", runs.WAMIT, Path(runs.__file__))


def run(figures: Path) -> Section:
    """Periods, balance and volume."""
    sources = key()
    results = cached(NAME, sources, "periods", runs.worked_out)
    wamit = cached(NAME, sources, "wamit", runs.of_wamit)
    joints = cached(NAME, sources, "joints", runs.joints)
    errors = errors_of(results, wamit)
    say(
        f"  as shipped {100 * errors.shipped:.1f} % off, two tuned {100 * errors.two:.2f} %, "
        f"of WAMIT's {100 * errors.wamit:.2f} %"
    )
    return Section(TITLE, words(results, wamit, joints), (), shortcomings(results, wamit))
