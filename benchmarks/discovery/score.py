"""Score of answers: one table of what is named, false alarms, reliability of probabilities, errors and minutes."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

from benchmarks.discovery.answer_file import Answer, AnswerFile, read_answers
from benchmarks.discovery.cases import EFFECTS, OUTSIDE, STRENGTHS, Case
from benchmarks.discovery.make_campaigns import cases_in, read_index
from benchmarks.discovery.outcomes import (
    Outcome,
    ReliabilityBin,
    Share,
    Tally,
    error_ratios,
    outcome,
    outside_answers,
    reliability,
)
from jaxhydro.errors import InputError, Problem, suggest

COLUMNS = (*STRENGTHS.values(), "all")


class Row(NamedTuple):
    """A row of the table.

    Attributes:
        key: Its key in JSON.
        measure: What it counts.
        cells: Values by column: weak, middle, strong, all.
    """

    key: str
    measure: str
    cells: dict[str, Share | float]


def score(folder: Path, path: Path, half: str | None = None, answered_only: bool = False) -> dict[str, Any]:
    """Score the answers of a method.

    Args:
        folder: The benchmark's folder.
        path: The file of answers.
        half: Half of the cases to score (`set`, `report`), or None for both.
        answered_only: Whether campaigns without an answer are left out, not counted as wrong.

    Returns:
        Content of the JSON: `tank`, `method`, `half`, counts, `table`, `reliability` and `outcomes` by campaign.

    Raises:
        InputError: The folder or the file has mistakes, or an answer is to no campaign of the folder.
    """
    index, file = read_index(folder), read_answers(path)
    cases = {case.public_name: case for case in cases_in(folder)}
    answers = answers_by_case(file, cases, path)
    chosen = [case for case in cases.values() if half in (None, case.half) and (case in answers or not answered_only)]
    if not any(case in answers for case in chosen):
        none = f"none for a campaign{f' of the half {half!r}' if half else ''}"
        raise InputError(str(path), [Problem("campaigns", "answers", none)])
    answers = {case: answers[case] for case in chosen if case in answers}
    outcomes = {case: outcome(case, answers.get(case)) for case in chosen}
    return {
        "tank": index.tank,
        "method": file.method,
        "half": half,
        "campaigns": len(chosen),
        "answered": len(answers),
        "table": table_of(outcomes, answers),
        "reliability": [
            {"from": row.lower, "to": row.upper, "mean": row.mean, "there": row.missing.count, "of": row.missing.of}
            for row in reliability(answers)
        ],
        "outcomes": {case.public_name: str(outcomes[case]) for case in sorted(chosen, key=lambda case: case.public_name)},
    }


def answers_by_case(file: AnswerFile, cases: Mapping[str, Case], path: Path) -> dict[Case, Answer]:
    """Answers by case. Raises InputError for names that are no campaign of the folder."""
    problems = [
        Problem(f"campaigns.{name}", "the name of a campaign folder", repr(name), suggest(name, cases))
        for name in file.campaigns
        if name not in cases
    ]
    if problems:
        raise InputError(str(path), problems)
    return {cases[name]: answer for name, answer in file.campaigns.items()}


def rows(outcomes: Mapping[Case, Outcome], answers: Mapping[Case, Answer]) -> list[Row]:
    """Rows of the table; rows and cells without campaigns are left out."""
    ratios = error_ratios(answers)
    tallies = {name: Tally.of(outcomes, answers, ratios, strength) for strength, name in STRENGTHS.items()}
    outside = {name: outside_answers(outcomes, answers, strength) for strength, name in STRENGTHS.items()}
    tally = tallies["middle"]

    def by_strength(value: Callable[[Tally], Share]) -> dict[str, Share]:
        return with_all({name: value(tally) for name, tally in tallies.items()})

    def with_all(cells: dict[str, Share]) -> dict[str, Share]:
        return cells | {"all": Share(sum(share.count for share in cells.values()), sum(share.of for share in cells.values()))}

    def of_outside(*keys: str) -> dict[str, Share]:
        return with_all({name: Share(sum(n[key] for key in keys), sum(n.values())) for name, n in outside.items()})

    def of_kinds(kinds: Sequence[str], which: Outcome) -> dict[str, Share]:
        by_strength = {name: [c for c in outcomes if c.effect in kinds and c.strength == s] for s, name in STRENGTHS.items()}
        return with_all(
            {name: Share(sum(outcomes[c] == which for c in cases), len(cases)) for name, cases in by_strength.items()}
        )

    minutes = [answer.minutes for answer in answers.values() if answer.minutes is not None]
    quotient = {name: _middle([r for c, r in ratios.items() if c.strength == s]) for s, name in STRENGTHS.items()}
    table: list[Row] = [
        Row("answered", "campaigns answered", {"all": Share(len(answers), len(outcomes))}),
        Row("named_first", "missing effect named first", by_strength(lambda tally: tally.named)),
        Row(
            "named_or_in_set",
            "the same, or named later, or indistinguishable from the first",
            by_strength(lambda tally: tally.listed),
        ),
        Row("right_where_named", "the same, of the campaigns where an effect is named", by_strength(lambda tally: tally.right)),
        Row("called_another", "other effects named instead", of_kinds(EFFECTS, Outcome.ANOTHER)),
        Row("not_seen", "nothing said to be missing", of_kinds(EFFECTS, Outcome.NOTHING)),
        Row("unexplained", "said unexplained", of_kinds(EFFECTS, Outcome.UNEXPLAINED)),
        Row("both_of_two", "two effects: both named", {"middle": tally.both_named}),
        Row("both_or_in_sets", "two effects: each named or indistinguishable", {"middle": tally.in_sets}),
        Row("false_alarms", "nothing missing: something said", {"all": tally.alarms}),
        Row("outside_unexplained", "outside the catalogue: said unexplained", of_outside("unexplained")),
        Row("outside_answered", "the same, or the held-out error falls", of_outside("unexplained", "lower")),
        Row("outside_not_seen", "outside the catalogue: nothing said", of_kinds(OUTSIDE, Outcome.NOTHING)),
        *[_reliability_row(row) for row in reliability(answers)],
        Row("held_out_ratio", "held-out error over that with nothing missing (median)", _present(quotient)),
        Row("minutes_median", "minutes (median)", _present({"all": _middle(minutes)})),
        Row("minutes_largest", "minutes (largest)", _present({"all": max(minutes, default=None)})),
    ]
    filled = [row._replace(cells={k: v for k, v in row.cells.items() if not isinstance(v, Share) or v.of}) for row in table]
    return [row for row in filled if row.cells]


def _reliability_row(row: ReliabilityBin) -> Row:
    text = f"probability {row.lower:g} to {row.upper:g}: effects that are missing"
    return Row(f"probability_{row.lower:g}_{row.upper:g}", text, {"all": row.missing})


def _middle(values: Sequence[float]) -> float | None:
    return median(values) if values else None


def _present(cells: Mapping[str, float | None]) -> dict[str, Share | float]:
    return {name: value for name, value in cells.items() if value is not None}


def _jsonable(cells: Mapping[str, Share | float]) -> dict[str, Any]:
    return {name: cell._asdict() if isinstance(cell, Share) else cell for name, cell in cells.items()}


def table_of(outcomes: Mapping[Case, Outcome], answers: Mapping[Case, Answer]) -> dict[str, dict[str, Any]]:
    """The table as JSON has it: rows by key."""
    return {row.key: {"measure": row.measure} | _jsonable(row.cells) for row in rows(outcomes, answers)}


def lines_of(table: Mapping[str, Mapping[str, Any]]) -> list[list[str]]:
    """The table as rows of text; see COLUMNS for its columns."""
    return [[row["measure"], *(_in_words(row.get(name)) for name in COLUMNS)] for row in table.values()]


def _in_words(cell: Mapping[str, int] | float | None) -> str:
    if cell is None:
        return ""
    return f"{cell:.3g}" if isinstance(cell, float) else f"{cell['count']} of {cell['of']}"
