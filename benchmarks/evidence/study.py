"""Section: the paper's four cases in irregular seas, and what explains the differences from the paper."""

from pathlib import Path
from typing import Any

from benchmarks.evidence import study_figures, study_reasons_runs
from benchmarks.evidence import study_runs as runs
from benchmarks.evidence.common import ROOT, Section, cached, fingerprint, keep, say
from benchmarks.evidence.study_text import shortcomings, words

NAME = "study"
TITLE = "The paper's four cases in irregular seas"


def key() -> str:
    """Key of the section's results."""
    modules = (Path(runs.__file__), Path(study_reasons_runs.__file__))
    return fingerprint(ROOT / "jaxhydro" / "platforms" / f"{runs.PLATFORM}.yaml", *modules)


def run(figures: Path) -> Section:
    """Four cases, two seas, ten seeds; what explains the differences; pontoon elements."""
    sources = key()
    results: dict[str, list[dict[str, Any]]] = {}
    for sea in runs.SEAS:
        results[sea] = []
        for seed in range(1, runs.SEEDS + 1):
            name = f"{sea}-{seed}"
            result = cached(NAME, sources, name)
            if result is None:
                result = keep(NAME, sources, name, runs.of_seed(sea, seed))
                say(f"  {name}")
            results[sea].append(result)
    variants, elements = study_reasons_runs.run(sources)
    drawn = (
        study_figures.elevation(results, runs.SEAS, runs.CUTOFF, figures / "study-elevation.png"),
        study_figures.densities(results, runs.SEAS, figures / "study-spectra.png"),
        study_figures.bars(results, runs.SEAS, figures / "study-bands.png"),
    )
    return Section(TITLE, words(results, variants, elements), drawn, shortcomings(results))
