"""Outcome of an answer: what it says against what is missing, for the validation page and the public score alike."""

from collections.abc import Mapping, Sequence
from enum import StrEnum
from itertools import pairwise
from typing import NamedTuple

from benchmarks.discovery.answer_file import Answer, ClaimedEffect
from benchmarks.discovery.cases import EFFECTS, MOTION_OF, OUTSIDE, PAIRS, Case

MAX_ERROR_RATIO = 1.3  # a goal: held-out error over that of the campaign with nothing missing
PROBABILITY_BINS = (0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0)  # edges


class Outcome(StrEnum):
    """Outcome of an answer.

    Attributes:
        NAMED: The missing effect is named first, or both of two are named.
        IN_SET: It is named later, or is among those that cannot be told from what is named.
        PART: One of two is named.
        ANOTHER: Other effects are named.
        NOTHING: Nothing is said to be missing.
        UNEXPLAINED: Something is said to be missing that cannot be named.
        FALSE_ALARM: An effect is named where nothing is missing.
        NO_ANSWER: The campaign was not answered.
    """

    NAMED = "named"
    IN_SET = "in the set"
    PART = "part"
    ANOTHER = "another"
    NOTHING = "nothing"
    UNEXPLAINED = "unexplained"
    FALSE_ALARM = "false alarm"
    NO_ANSWER = "no answer"


def full_name(claim: ClaimedEffect) -> str:
    """Name of an effect; in another motion than the benchmark's it is another effect, and named with its motion."""
    same = claim.motion in (None, MOTION_OF.get(claim.effect, claim.motion))
    return claim.effect if same else f"{claim.effect} in {claim.motion}"


def named_effects(answer: Answer) -> list[str]:
    """Full names of the effects that an answer names, in its order."""
    return [full_name(claim) for claim in answer.effects]


def outcome(case: Case, answer: Answer | None) -> Outcome:
    """Outcome of an answer to a case; None: there is no answer."""
    if answer is None:
        return Outcome.NO_ANSWER
    if answer.verdict != "found":
        return Outcome.NOTHING if answer.verdict == "nothing_missing" else Outcome.UNEXPLAINED
    if not case.effect:
        return Outcome.FALSE_ALARM
    effects, sets = named_effects(answer), [claim.indistinguishable_from for claim in answer.effects]
    if len(case.effects) == 2:
        named = sum(effect in effects for effect in case.effects)
        if named == 2:
            return Outcome.NAMED
        if set(case.effects) <= {name for names in sets for name in names} | set(effects):
            return Outcome.IN_SET
        return Outcome.PART if named else Outcome.ANOTHER
    if effects[0] == case.effect:
        return Outcome.NAMED
    return Outcome.IN_SET if case.effect in [*sets[0], *effects] else Outcome.ANOTHER


class Share(NamedTuple):
    """So many of so many."""

    count: int
    of: int

    def __str__(self) -> str:
        return f"{self.count} of {self.of}"


def outside_answers(outcomes: Mapping[Case, Outcome], answers: Mapping[Case, Answer], strength: int) -> dict[str, int]:
    """Numbers of campaigns with a law from outside the catalogue, of a strength, by how they are answered.

    Returns:
        `not seen`, `unexplained`, and named effects that lower the held-out error (`lower`) or do not (`not lower`).
    """
    outside = [case for case in outcomes if case.effect in OUTSIDE and case.strength == strength]
    named = [case for case in outside if outcomes[case] == Outcome.ANOTHER]
    errors = [answers[case].held_out_error for case in named]
    lower = sum(error is not None and error.final < error.baseline for error in errors)
    return {
        "not seen": sum(outcomes[case] in (Outcome.NOTHING, Outcome.NO_ANSWER) for case in outside),
        "unexplained": sum(outcomes[case] == Outcome.UNEXPLAINED for case in outside),
        "lower": lower,
        "not lower": len(named) - lower,
    }


class Tally(NamedTuple):
    """Counts of outcomes at one strength.

    Attributes:
        named: The missing effect is named first.
        listed: It is named, or is among those that cannot be told from what is named first.
        right: The same, of the campaigns where an effect is named.
        near: The held-out error is within `MAX_ERROR_RATIO` times that with nothing missing.
        near_or_exact: The same, or exactly the missing effects are named.
        alarms: Something is said to be missing where nothing is (all such campaigns).
        both_named: Both effects of a pair are named (all pairs).
        in_sets: Each effect of a pair is named, or is among those that cannot be told from what is named.
        unexplained: A law from outside the catalogue is said to be unexplained.
        lower: It is answered with effects that lower the held-out error.
    """

    named: Share
    listed: Share
    right: Share
    near: Share
    near_or_exact: Share
    alarms: Share
    both_named: Share
    in_sets: Share
    unexplained: Share
    lower: Share

    @classmethod
    def of(
        cls, outcomes: Mapping[Case, Outcome], answers: Mapping[Case, Answer], ratios: Mapping[Case, float], strength: int = 2
    ) -> "Tally":
        """Counts over cases.

        Args:
            outcomes: Outcomes by case.
            answers: Answers by case.
            ratios: Held-out errors over those with nothing missing, by case. See `error_ratios`.
            strength: The strength.
        """
        catalogued = [case for case in outcomes if case.effect in EFFECTS and case.strength == strength]
        nothing_missing = [case for case in outcomes if not case.effect]
        pairs = [case for case in outcomes if case.effect in PAIRS]
        outside = outside_answers(outcomes, answers, strength)

        def counted(cases: Sequence[Case], *which: Outcome) -> Share:
            return Share(sum(outcomes[case] in which for case in cases), len(cases))

        speaking = [case for case in catalogued if outcomes[case] in (Outcome.NAMED, Outcome.IN_SET, Outcome.ANOTHER)]
        held = [case for case in catalogued if case in ratios]
        near = {case for case in held if ratios[case] <= MAX_ERROR_RATIO}
        exact = {case for case in held if set(named_effects(answers[case])) == set(case.effects)}
        return cls(
            counted(catalogued, Outcome.NAMED),
            counted(catalogued, Outcome.NAMED, Outcome.IN_SET),
            counted(speaking, Outcome.NAMED, Outcome.IN_SET),
            Share(len(near), len(held)),
            Share(len(near | exact), len(held)),
            counted(nothing_missing, Outcome.FALSE_ALARM, Outcome.UNEXPLAINED, Outcome.NO_ANSWER),
            counted(pairs, Outcome.NAMED),
            counted(pairs, Outcome.NAMED, Outcome.IN_SET),
            Share(outside["unexplained"], sum(outside.values())),
            Share(outside["lower"], sum(outside.values())),
        )


def error_ratios(answers: Mapping[Case, Answer], floors: Mapping[Case, float] | None = None) -> dict[Case, float]:
    """Held-out errors over that of the campaign with nothing missing and the same platform and waves, by case.

    Args:
        answers: Answers by case.
        floors: Errors with nothing missing to take instead, by case.
    """
    errors = {case: answer.held_out_error.final for case, answer in answers.items() if answer.held_out_error is not None}
    floor = {case.seed: error for case, error in errors.items() if not case.effect}
    floor_of = {case: floor[case.seed] for case in errors if case.seed in floor} | dict(floors or {})
    return {case: errors[case] / floor_of[case] for case in errors if case.effect and floor_of.get(case, 0.0) > 0}


class ReliabilityBin(NamedTuple):
    """Claims whose probability is between two edges (the lower one included, and 1).

    Attributes:
        lower: Lower edge.
        upper: Upper edge.
        mean: Mean probability; None without claims.
        missing: Claims whose effect is missing, of all.
    """

    lower: float
    upper: float
    mean: float | None
    missing: Share


def reliability(answers: Mapping[Case, Answer]) -> list[ReliabilityBin]:
    """How often effects of a probability are missing, in bins; effects named and considered count alike."""
    claims = [
        (claim.probability, full_name(claim) in case.effects)
        for case, answer in answers.items()
        for claim in (*answer.effects, *answer.considered)
        if claim.probability is not None
    ]
    bins = []
    for lower, upper in pairwise(PROBABILITY_BINS):
        inside = [(p, missing) for p, missing in claims if lower <= p < upper or p == upper == 1.0]
        mean = sum(p for p, _ in inside) / len(inside) if inside else None
        bins.append(ReliabilityBin(lower, upper, mean, Share(sum(missing for _, missing in inside), len(inside))))
    return bins
