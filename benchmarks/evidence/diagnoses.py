"""Section: what `diagnose` says of campaigns whose missing effect is known, or that miss nothing."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.discovery.cases import Case, cases
from benchmarks.discovery.make_campaigns import TANK_SOURCES, make_in_folders
from benchmarks.discovery.outcomes import named_effects
from benchmarks.evidence import common
from benchmarks.evidence.common import CACHE, Section, cached, fingerprint, keep, parallel, say
from benchmarks.evidence.diagnoses_figure import draw
from benchmarks.evidence.diagnoses_text import conclude
from benchmarks.evidence.stored_diagnoses import answer_of, keep_all, kept, listed, stored

SECTION = "diagnoses"


def key() -> str:
    """Key of the section's results."""
    return fingerprint(*TANK_SOURCES)


def folder_of(name: str) -> Path:
    """Folder of a campaign."""
    return CACHE / "diagnosed-campaigns" / name


def make_missing(names: Sequence[str]) -> None:
    """Make the campaigns that are not there yet."""
    missing = [Case.of(name) for name in names if not (folder_of(name) / "truth.json").exists()]
    for truths in make_in_folders({case: folder_of(case.name) for case in missing}, {}):
        for case, truth in truths.items():
            (folder_of(case.name) / "truth.json").write_text(json.dumps(truth, default=float))
        say(f"  {len(truths)} campaigns made")


def of_case(name: str) -> dict[str, Any]:
    """What a diagnosis says of one campaign."""
    from calibration.campaign.load_campaign import load_campaign
    from calibration.discovery.diagnose import diagnose
    from calibration.results.refusal_sentences import describe_refusal

    campaign = load_campaign(folder_of(name))
    result = diagnose(campaign.model, campaign)
    return {
        "verdict": result.verdict,
        "effects": [effect.effect for effect in result.effects],
        "motions": [effect.degree_of_freedom for effect in result.effects],
        "alike": [[text.split(" ")[0] for text in effect.indistinguishable] for effect in result.effects],
        "evidence": [[e.delta_bic, e.holdout_gain, e.clear] for e in (effect.evidence for effect in result.effects)],
        "probability": [effect.evidence.probability for effect in result.effects],
        "error": [result.baseline.objective("holdout"), result.augmented.objective("holdout")],
        "in_doubt": [effect.in_doubt for effect in result.effects],
        "refused": {
            listed(candidate.effect, candidate.degree_of_freedom): describe_refusal(candidate.reason)
            for candidate in result.rejected
        },
        "left": [
            [series.test, series.use, series.channel, series.rms, series.noise, series.relative, series.bands]
            for series in result.anatomy_after
        ],
        "tried": {
            f"{score.round} {listed(score.effect, score.degree_of_freedom)}": stored(score.verdict)
            for score in result.scores
            if score.verdict is not None
        },
        "taken_out": {
            listed(candidate.effect, candidate.degree_of_freedom): stored(candidate.taken_out)
            for candidate in result.rejected
            if candidate.taken_out is not None
        },
        "laws": {force.motion: [[term.name for term in force.law.terms], force.law.share] for force in result.latent},
        "seconds": result.seconds,
        "sources": key(),
    }


def run(figures: Path, processes: int, most: int) -> Section:
    """The first `most` cases."""
    for name, result in kept().items():
        if not any((CACHE / SECTION).glob(f"*/{name}.json")):
            keep(SECTION, result["sources"], name, result)
    names = [case.name for case in cases() if not common.text_only or case.name in kept()][:most]
    sources = key()
    make_missing([name for name in names if cached(SECTION, sources, name) is None])
    results: dict[str, dict[str, Any]] = {}
    for name, result in parallel(SECTION, sources, names, of_case, processes, go_on=True):
        results[name] = result
        words = ", ".join(named_effects(answer_of(result))) or result["verdict"]
        say(f"  {name}: {words} ({result['seconds']:.0f} s, {len(results)} of {len(names)})")
        keep_all({name: result})
    ordered = {Case.of(name): results[name] for name in names if name in results}
    earlier = sum(result["sources"] != sources for result in ordered.values())
    return conclude(
        ordered, earlier, draw({case: answer_of(result) for case, result in ordered.items()}, figures / "diagnoses.png")
    )
