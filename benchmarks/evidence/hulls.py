"""Section: natural periods of five public hulls and their motion in one regular wave, by other ways."""

import json
from pathlib import Path

from benchmarks.evidence import hulls_cases, hulls_reference
from benchmarks.evidence import hulls_runs as runs
from benchmarks.evidence.common import Section, cached, fingerprint, say
from benchmarks.evidence.hulls_text import furthest, percent, shortcomings, words

NAME = "hulls"
TITLE = "Five public hulls"
POTENTIAL = hulls_cases.HULLS / "potential-flow.json"


def key() -> str:
    """Key of the section's results."""
    modules = (Path(hulls_cases.__file__), Path(runs.__file__), Path(hulls_reference.__file__))
    return fingerprint(hulls_cases.HULLS, hulls_cases.PLATFORMS, *modules)


def run(figures: Path) -> Section:
    """All hulls, and the two variants of OC4-DeepCwind."""
    sources, cases = key(), hulls_cases.CASES
    results = {name: cached(NAME, sources, name, lambda case=case: runs.worked_out(case)) for name, case in cases.items()}
    for name in cases:
        dof, apart = furthest(name, results)
        say(f"  {name}: {dof} in waves differs most from plain NumPy, {percent(apart)}")
    variants = cached(NAME, sources, "variants", runs.variants)
    panels = json.loads(POTENTIAL.read_text("utf-8"))
    return Section(TITLE, words(results, variants, panels), (), shortcomings(results))
