"""What the evidence counts of diagnoses of campaigns whose missing effect is known."""

from pathlib import Path

from benchmarks.discovery.cases import Case
from benchmarks.discovery.outcomes import Share, Tally, error_ratios, outcome
from benchmarks.evidence.diagnoses_text import conclude
from benchmarks.evidence.stored_diagnoses import answer_of, doubts, floors_of, merged
from calibration.discovery.acceptance import Verdict


def said(effects, error, alike=None, verdict="found", sources="now", motions=None, tried=None):
    """What is kept of one diagnosis."""
    return {
        "verdict": verdict,
        "effects": effects,
        "motions": motions or [None] * len(effects),
        "alike": alike or [[] for _ in effects],
        "error": [0.5, error],
        "sources": sources,
        "seconds": 1.0,
        "tried": {
            words: Verdict(bic, 0.5, True, net, 5.0, 2.0, "" if in_it else "no")._asdict()
            for words, (bic, net, in_it) in (tried or {}).items()
        },
    }


RESULTS = {
    Case("", 2, 1): said([], 0.1, verdict="nothing_missing"),
    Case("", 2, 2): said(["current"], 0.1),
    Case("", 2, 3): said([], 0.1, verdict="unexplained"),
    Case("current", 2, 1): said(["current"], 0.12),
    Case("hysteresis", 2, 1): said(["hysteresis"], 0.2),  # its law is not the tank's: far, but what a told model has
    Case("hysteresis", 2, 2): said(["hysteresis"], 0.3, motions=["pitch"]),  # in surge it is: another effect
    Case("sensor_lag", 2, 1): said(["sensor_lag", "current"], 0.2),  # more than there is: another model than a told one
    Case("umbilical", 2, 1): said(["static_offset"], 0.1, [["umbilical"]]),
    Case("wave_drift", 2, 1): said(["hysteresis"], 0.3),
    Case("wave_drift", 1, 1): said([], 0.1, verdict="unexplained"),  # weak ones are not counted
    Case("end_stop", 2, 1): said([], 0.5, verdict="unexplained"),
    Case("cogging", 2, 1): said(["hysteresis"], 0.4),
    Case("current+wave_drift", 2, 1): said(["wave_drift", "current"], 0.1),
    Case("radiation_memory+sensor_lag", 2, 1): said(["sensor_lag"], 0.1),
}


def test_what_is_outdone_by_something_refused_is_said_to_be_unexplained():
    """As a diagnosis says it: by what the last round tried; not where that let an effect in, or where one gains as much."""
    case, tried = Case("cogging", 2, 2), {"1 hysteresis surge": (60.0, 90.0, True), "1 current": (300.0, -40.0, False)}
    let_in = said(["hysteresis"], 0.4, motions=["surge"], tried=tried)
    assert doubts(let_in) == [None] and outcome(case, answer_of(let_in)) == "another"
    for bic, doubt, words in ((149.0, None, "another"), (151.0, "current", "unexplained")):
        ended = said(["hysteresis"], 0.4, motions=["surge"], tried=tried | {"2 current": (bic, -40.0, False)})
        assert doubts(ended) == [doubt] and outcome(case, answer_of(ended)) == words
    text = conclude({Case("", 2, 2): RESULTS[Case("", 2, 1)], case: ended}, 0, Path("none.png")).text
    assert "*unexplained* [in doubt: hysteresis] 4.00" in text


def test_outcomes_are_counted_by_what_is_in_the_tank():
    answers = {case: answer_of(result) for case, result in RESULTS.items()}
    outcomes = {case: outcome(case, answer) for case, answer in answers.items()}
    tally = Tally.of(outcomes, answers, error_ratios(answers))
    assert tally == Tally(
        named=Share(3, 6),
        listed=Share(4, 6),
        right=Share(4, 6),
        near=Share(2, 6),
        near_or_exact=Share(3, 6),
        alarms=Share(2, 3),
        both_named=Share(1, 2),
        in_sets=Share(1, 2),
        unexplained=Share(1, 2),
        lower=Share(1, 2),
    )


def test_a_page_of_them_says_what_falls_short():
    section = conclude(RESULTS, 0, Path("none.png"))
    for words in (
        "named first in 3 of 6",
        "that value in 2 of 6. In 3 of 6",
        "named [current] 2.00",
        "static_offset or it 1.00",
        "Of 1 weak effects: 1 unexplained.",
    ):
        assert words in section.text, words
    assert [line.split(",")[0] for line in section.short] == [
        "diagnosis: named first in 3 of 6",
        "diagnosis: in the set in 4 of 6",
        "diagnosis: both of two found in 1 of 2",
        "diagnosis: held-out error within 1.3 times that of a model that was told the truth in 3 of 6",
        "diagnosis: middle and strong effects called by another name in 2",
        "diagnosis: false alarms in 2 of 3",
        "diagnosis: 14 of 244 campaigns run",
    ]


def test_errors_are_over_those_with_nothing_missing_of_their_time():
    """A campaign with nothing missing is run again by other sources; of two effects one is, too."""
    before = {
        "nothing-1": said([], 0.2, sources="then"),
        "nothing-2": said([], 0.3, sources="then"),
        "current-2-1": said(["current"], 0.3, sources="then"),
        "umbilical-2-1": said(["umbilical"], 0.3, sources="then"),
        "umbilical-2-2": said(["umbilical"], 0.3, sources="then"),
    }
    after = merged(merged(before, {"nothing-1": said([], 0.1)}), {"current-2-1": said(["current"], 0.15)})
    assert {name for name, result in after.items() if "floor" in result} == {"umbilical-2-1"} and merged(after, after) == after
    results = {Case.of(name): result for name, result in after.items()}
    ratio = error_ratios({case: answer_of(result) for case, result in results.items()}, floors_of(results))
    assert [round(ratio[Case.of(name)], 12) for name in ("current-2-1", "umbilical-2-1", "umbilical-2-2")] == [1.5, 1.5, 1.0]
