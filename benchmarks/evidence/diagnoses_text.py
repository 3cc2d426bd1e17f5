"""Text of the section on diagnoses: tables, counts in sentences, what falls short of a goal."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from benchmarks.discovery.answer_file import Answer
from benchmarks.discovery.cases import EFFECTS, OUTSIDE, PAIRS, STRENGTHS, Case, cases
from benchmarks.discovery.outcomes import (
    MAX_ERROR_RATIO,
    Outcome,
    Share,
    Tally,
    error_ratios,
    named_effects,
    outcome,
    outside_answers,
    reliability,
)
from benchmarks.discovery.score import COLUMNS, lines_of, table_of
from benchmarks.evidence.common import Section, table
from benchmarks.evidence.stored_diagnoses import answer_of, floors_of

TITLE = "What is missing: diagnoses of campaigns from an independent tank"
# goals, as fractions; false alarms at most, the others at least
NAMED_MIDDLE, NAMED_STRONG, IN_SET, RIGHT_WEAK, BOTH, OUTSIDE_ANSWERED, SURE = 0.92, 0.95, 0.97, 0.95, 0.85, 0.90, 0.90
FALSE_ALARMS = 1 / 40
SEARCHED = (
    "\n\nSources before 2026-11-27 also tried seas of simpler second order, which campaigns now state. Their thresholds were "
    "set by both halves of the campaigns."
)
REPORTED = (
    "Half of the campaigns are there to set thresholds by, the other half to report. This is the half to report, as the "
    "[public benchmark](discovery-benchmark.md) counts it:"
)
LAWS = (
    "Two laws of drag are not the same in both programs, so that no values of one follow the other:\n\n"
    "- Drag that changes with amplitude: in a sea the tank's goes with the surface's Keulegan-Carpenter number in all strips. "
    "The package's goes with every strip's own speed.\n"
    "- Drag that is apart for slow motion: the tank filters the flow relative to the strips, as HydroDyn does. The package "
    "filters the platform's motion."
)
OUTSIDE_WORDS = {
    "not seen": "not seen",
    "unexplained": "unexplained",
    "lower": "answered with a law that lowers the held-out error",
    "not lower": "with one that does not",
}


def tally_sentences(tally: Tally) -> str:
    """Counts at the middle strength, in sentences."""
    two = (
        (
            f"\n- Two effects at once: both were found in {tally.both_named}. With those that they cannot be told from, both "
            f"were found in {tally.in_sets}."
        )
        if tally.both_named.of
        else ""
    )
    from_outside = (
        (
            f"\n- Effects of this strength that no candidate has the law of: {tally.unexplained} are said to be unexplained. "
            f"{tally.lower} are answered with a law that lowers the held-out error."
        )
        if tally.lower.of
        else ""
    )
    return (
        f"At the middle strength:\n\n"
        f"- The right effect is named first in {tally.named}. It is named first, named after another, or cannot be told from "
        f"what is named first, in {tally.listed}.\n"
        f"- Nothing missing: {tally.alarms} raised a false alarm, an effect or something unexplained.{two}\n"
        "- The error of tests that were not fitted (held-out error) is compared with its value for the same platform and waves "
        f"with nothing missing. It is within {MAX_ERROR_RATIO} times that value in {tally.near}. In {tally.near_or_exact} it "
        "is, or exactly what is missing was found. A model that was told the truth then has the same error."
        f"{from_outside}\n\n"
    )


def shortfalls(outcomes: Mapping[Case, Outcome], answers: Mapping[Case, Answer], ratios: Mapping[Case, float]) -> Iterator[str]:
    """Goals that are not reached."""
    weak, tally, strong = (Tally.of(outcomes, answers, ratios, strength) for strength in (1, 2, 3))
    answered = Share(tally.unexplained.count + tally.lower.count, tally.lower.of)
    goals = (
        (tally.named, NAMED_MIDDLE, "named first"),
        (strong.named, NAMED_STRONG, "strong effects named first"),
        (tally.listed, IN_SET, "in the set"),
        (weak.right, RIGHT_WEAK, "weak effects right where one is named"),
        (tally.both_named, BOTH, "both of two found"),
        (tally.near_or_exact, 1.0, f"held-out error within {MAX_ERROR_RATIO} times that of a model that was told the truth"),
        (answered, OUTSIDE_ANSWERED, "outside the catalogue unexplained, or answered with a law that helps"),
        (reliability(answers)[-1].missing, SURE, "effects of a probability from 0.9 that are missing"),
    )
    for share, goal, words in goals:
        if share.count < goal * share.of:
            yield f"diagnosis: {words} in {share}, goal {100 * goal:.0f} %"
    called = sum(
        answered == Outcome.ANOTHER for case, answered in outcomes.items() if case.effect in EFFECTS and case.strength > 1
    )
    if called:
        yield f"diagnosis: middle and strong effects called by another name in {called}, goal none"
    if tally.alarms.count > FALSE_ALARMS * tally.alarms.of:
        yield f"diagnosis: false alarms in {tally.alarms}, goal 1 of 40"


def other_strengths(outcomes: Mapping[Case, Outcome], answers: Mapping[Case, Answer]) -> str:
    """What is said of strong and of weak effects, and of laws from outside, in sentences."""
    words = {
        "named": "{} named first",
        "in the set": "{} among others alike",
        "nothing": "{} not seen",
        "unexplained": "{} unexplained",
        "another": "{} called by another name",
    }
    sentences = []
    for strength in (3, 1):
        strength_outcomes = [
            answered for case, answered in outcomes.items() if case.effect in EFFECTS and case.strength == strength
        ]
        counted = ", ".join(
            text.format(strength_outcomes.count(kind)) for kind, text in words.items() if kind in strength_outcomes
        )
        sentences += [f"Of {len(strength_outcomes)} {STRENGTHS[strength]} effects: {counted}."] if strength_outcomes else []
        counts = outside_answers(outcomes, answers, strength)
        counted = ", ".join(f"{count} {OUTSIDE_WORDS[key]}" for key, count in counts.items() if count)
        sentences += [f"Of {sum(counts.values())} {STRENGTHS[strength]} laws from outside: {counted}."] if counted else []
    return " ".join(sentences)


def half_to_report(outcomes: Mapping[Case, Outcome], answers: Mapping[Case, Answer]) -> dict[str, dict[str, Any]]:
    """Table of the public score, of the cases that no threshold is set by."""
    reported = {case: answered for case, answered in outcomes.items() if case.half == "report"}
    return table_of(reported, {case: answers[case] for case in reported})


def conclude(results: dict[Case, dict[str, Any]], earlier: int, figure: Path) -> Section:
    """The tables and what falls short; so many results are of `earlier` sources."""
    answers = {case: answer_of(result) for case, result in results.items()}
    outcomes = {case: outcome(case, answer) for case, answer in answers.items()}
    ratio = error_ratios(answers, floors_of(results))
    rows = []
    for effect in (*EFFECTS, *OUTSIDE, *PAIRS):
        cells = []
        for strength in STRENGTHS:
            cell_cases = [case for case in outcomes if (case.effect, case.strength) == (effect, strength)]
            cells.append(
                "; ".join(_words(case, outcomes[case], answers[case], results[case], ratio.get(case)) for case in cell_cases)
                or "–"
            )
        rows.append(
            (" + ".join(f"`{name}`" for name in effect.split("+")) + (" (outside)" if effect in OUTSIDE else ""), *cells)
        )
    tally, total = Tally.of(outcomes, answers, ratio), sum(1 for _ in cases())
    by = f", {earlier} of them by earlier sources" if earlier else ""
    text = (
        f"{tally_sentences(tally)}{other_strengths(outcomes, answers)}\n\n"
        "Each campaign has nine decays and two seas of 1600 s each. They come from `benchmarks/tank.py`, a plain NumPy tank "
        "that shares no code with the package. It has noise, imperfect releases, and mass and mooring not quite as in the "
        f"platform file. {len(results)} of {total} campaigns were run{by}.{SEARCHED if earlier else ''}\n\n"
        f"{REPORTED}\n\n{table(('', *COLUMNS), lines_of(half_to_report(outcomes, answers)))}\n{LAWS}\n\n"
        "What was said, seed by seed:\n\n"
        "- *nothing*: nothing missing\n"
        "- a name: that effect instead\n"
        "- in brackets: what else was added\n"
        "- the number: the held-out error, over that of the same platform in the same waves with nothing missing, by sources "
        "of its time\n"
        "- a force: the law proposed for what is unexplained, and the share of what was not fitted that it gives\n"
        "- in doubt: what helps, and is outdone by something that is refused\n\n"
        + table(("effect in the tank", *STRENGTHS.values()), rows)
    )
    nulls = {case: result for case, result in results.items() if not case.effect}
    if nulls:
        cells = [_words(case, outcomes[case], answers[case], results[case]) for case in nulls]
        text += f"\nOf nothing missing: {', '.join(cells)}.\n"
    incomplete = [f"diagnosis: {len(results)} of {total} campaigns run"] if len(results) < total else []
    return Section(TITLE, text + thresholds(nulls), (figure,), (*shortfalls(outcomes, answers, ratio), *incomplete))


def thresholds(nulls: dict[Case, dict[str, Any]]) -> str:
    """What candidates reach where nothing is missing, rule by rule, and how many campaigns would be told of an effect by the
    other rules alone; "" where there are no such campaigns."""
    from calibration.discovery import acceptance as by

    rules = {
        "bic": ("fall of BIC in the fitted tests", by.MIN_BIC_GAIN),
        "together": ("that fall and the one of -2 ln L in the held-out tests together", by.MIN_LIKELIHOOD_GAIN),
        "held": ("share of the held-out squared error that goes", by.MIN_HELD_OUT_SHARE),
        "net": ("fall of -2 ln L in the held-out tests", by.MIN_HELD_OUT_GAIN),
        "clear": ("standard deviations from none", by.MIN_SIGNIFICANCE),
        "matters": ("fall of an error, over what matters", 1.0),
    }
    by_case = {
        case: [refit | {"together": refit["bic"] + refit["net"]} for refit in result["tried"].values()]
        for case, result in nulls.items()
        if "tried" in result
    }
    refits = [refit for campaign_refits in by_case.values() for refit in campaign_refits]
    if not refits:
        return ""
    rows = []
    for name, (words, least) in rules.items():
        other_rules = {rule: limit for rule, (_, limit) in rules.items() if rule != name}
        passing = {
            case: [refit[name] for refit in campaign_refits if all(refit[rule] >= limit for rule, limit in other_rules.items())]
            for case, campaign_refits in by_case.items()
        }
        highest = max((value for values in passing.values() for value in values), default=None)
        alone = sum(bool(values) for values in passing.values())
        rows.append(
            (
                words,
                f"{least:g}",
                f"{max(refit[name] for refit in refits):.3g}",
                Share(alone, len(by_case)),
                "–" if highest is None else f"{highest:.3g}",
            )
        )
    return (
        f"\nThe table has the threshold that an effect has to reach. {len(refits)} candidates were refitted in {len(by_case)} "
        "campaigns with nothing missing. *At most* is the most that they reached. *Past the others* is the most among those "
        "that pass all the other rules. A threshold has to be above that:\n\n"
        + table(("rule", "threshold", "at most", "told of an effect without the rule", "at most, past the others"), rows)
    )


def _words(case: Case, answered: Outcome, answer: Answer, result: Mapping[str, Any], ratio: float | None = None) -> str:
    """An outcome in a cell."""
    effects = named_effects(answer)
    number = f" {ratio:.2f}" if ratio is not None else ""
    if not effects or answered == "unexplained":
        number = f" [in doubt: {', '.join(effects)}]{number}" if effects else number
        laws = result.get("laws", {}).items()
        words = "; ".join(f"{motion} by {', '.join(terms)} ({100 * part:.0f} %)" for motion, (terms, part) in laws if terms)
        return f"*{answered}*{number}" + (f", a force in {words}" if words else "")
    right = [effect for effect in effects if effect in case.effects]
    first, remaining = effects[0], effects[1:]
    if len(case.effects) == 2 and right:
        remaining = [effect for effect in effects if effect not in right]
        first = "both" if len(right) == 2 else f"{right[0]} alone"
        if answered == "in the set":  # the other is among those that one of these cannot be told from
            (missing,) = set(case.effects) - set(right)
            sets = [claim.indistinguishable_from for claim in answer.effects]
            partner = next(name for name, alike in zip(effects, sets, strict=True) if missing in alike)
            first = f"{right[0]}, {partner} or {missing}"
            remaining = [effect for effect in remaining if effect != partner]
    elif answered in ("named", "in the set"):
        first = "named" if answered == "named" else f"{first} or it"
    return first + (f" [{', '.join(remaining)}]" if remaining else "") + number
