"""Diagnoses of the benchmark's campaigns as the evidence keeps them, and the answers that they are."""

import json
from collections.abc import Mapping
from typing import Any

from benchmarks.discovery.answer_file import Answer, ClaimedEffect, HeldOutErrors
from benchmarks.discovery.cases import Case, cases
from benchmarks.evidence.common import ROOT

# all campaigns take more hours than one machine is lent for: what was said of each, and by which sources, is kept with the page
KEPT = ROOT / "docs" / "diagnoses.jsonl"
UNKEPT = ("refused", "left")  # long, and not on the page


def listed(effect: str, motion: str | None) -> str:
    """An effect as results of campaigns list it."""
    return f"{effect} {motion}" if motion else effect


def stored(verdict: Any) -> dict[str, Any]:
    """A verdict as JSON has it, with its reason in words."""
    from calibration.results.refusal_sentences import describe_refusal

    return verdict._asdict() | {"refused": "" if verdict.refused is None else describe_refusal(verdict.refused)}


def restored(verdict: dict[str, Any]) -> Any:
    """A verdict that was stored, with its reason in words."""
    from calibration.discovery.acceptance import Verdict

    return Verdict(**verdict | {"refused": verdict["refused"] or None})


def kept() -> dict[str, dict[str, Any]]:
    """What earlier runs said, on other machines too, by campaign."""
    results = [json.loads(line) for line in KEPT.read_text().splitlines()] if KEPT.exists() else []
    return {result.pop("name"): result for result in results}


def merged(before: dict[str, dict[str, Any]], results: dict[str, dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """These beside what is kept of others. One of earlier sources keeps, as its `floor`, the error that was its seed's with
    nothing missing, where that is another now."""
    all_results = before | {name: {k: v for k, v in result.items() if k not in UNKEPT} for name, result in results.items()}
    for name, old in before.items():
        nothing = Case("", 2, Case.of(name).seed).name
        if nothing not in before or all_results[name]["sources"] != old["sources"]:
            continue
        floors = [result["error"][1] for result in (before[nothing], all_results[nothing])]
        if "floor" in old or (floors[0] != floors[1] and all_results[nothing]["sources"] != old["sources"]):
            all_results[name] = all_results[name] | {"floor": old.get("floor", floors[0])}
    return all_results


def keep_all(results: dict[str, dict[str, Any]]) -> None:
    """These for later runs, beside what is kept of others, a line each."""
    all_results = merged(kept(), results)
    lines = [json.dumps({"name": case.name} | all_results[case.name]) for case in cases() if case.name in all_results]
    beside = KEPT.with_suffix(".part")
    beside.write_text("".join(f"{line}\n" for line in lines))
    beside.replace(KEPT)


def doubts(result: dict[str, Any]) -> list[str | None]:
    """What each effect found is in doubt for, None where it is for nothing: worked out from errors, and from what was tried
    where a result is from before diagnoses told."""
    from calibration.discovery.doubts import held_out_error_rose, outdone_effects
    from calibration.discovery.reported_effects import HELD_OUT_ERROR

    if held_out_error_rose(*result["error"]):
        return [HELD_OUT_ERROR] * len(result["effects"])
    if "in_doubt" in result:
        return list(result["in_doubt"])
    by_round: dict[int, dict[str, Any]] = {}
    for words, stored_verdict in result["tried"].items():
        number, name = words.split(" ", 1)
        by_round.setdefault(int(number), {})[name] = restored(stored_verdict)
    names = [listed(*pair) for pair in zip(result["effects"], result["motions"], strict=True)]
    let_in = {
        name: verdict
        for verdicts in by_round.values()
        for name, verdict in verdicts.items()
        if name in names and not verdict.refused
    }
    worth = {name: verdict.bic + verdict.net for name, verdict in let_in.items()}
    taken_out = {name: restored(stored_verdict) for name, stored_verdict in result.get("taken_out", {}).items()}
    outdone = outdone_effects(worth, by_round.get(max(by_round, default=0), {}) | taken_out)
    return [outdone.get(name) for name in names]


def in_doubt(result: dict[str, Any]) -> bool:
    """Whether there are effects, and each of them is in doubt: then a diagnosis says that what is missing is unexplained."""
    return bool(result["effects"]) and all(doubts(result))


def answer_of(result: Mapping[str, Any]) -> Answer:
    """The answer that a kept diagnosis is."""
    before, after = result["error"]
    count = len(result["effects"])  # earlier searches had no probabilities
    claims = zip(result["effects"], result["motions"], result["alike"], result.get("probability", [None] * count), strict=True)
    answered = bool(result["effects"]) and not in_doubt(result)
    return Answer(
        verdict="found" if answered else "nothing_missing" if result["verdict"] == "nothing_missing" else "unexplained",
        effects=[
            ClaimedEffect(effect=name, motion=motion, indistinguishable_from=alike, probability=probability)
            for name, motion, alike, probability in claims
        ],
        held_out_error=HeldOutErrors(baseline=before, final=after),
        minutes=result["seconds"] / 60,
    )


def floors_of(results: Mapping[Case, Mapping[str, Any]]) -> dict[Case, float]:
    """Errors with nothing missing by sources of a result's time, by case, where the present ones are others."""
    return {case: result["floor"] for case, result in results.items() if "floor" in result}
