"""Public benchmark of finding missing effects: make campaigns, answer them, score answers.

    python -m benchmarks.discovery make FOLDER [--cases NAME ... | --half set|report] [--most N] [--truth FILE]
    python -m benchmarks.discovery answers FOLDER [--out FILE] [--half set|report] [--processes N]
    python -m benchmarks.discovery score FOLDER ANSWERS [--half set|report] [--answered-only] [--out FILE]

docs/discovery-benchmark.md says what the files contain and what the rules are.
"""

import argparse
import sys
from pathlib import Path

from benchmarks.discovery.answer_file import Answer
from benchmarks.discovery.cases import HALVES, Case, cases
from benchmarks.discovery.make_campaigns import cases_in, make_benchmark, read_index, write_truth
from benchmarks.discovery.run_diagnose import diagnose_all, write_answers
from benchmarks.discovery.score import COLUMNS, lines_of, score
from benchmarks.evidence.common import say, table
from jaxhydro.errors import InputError, suggest
from jaxhydro.result_model import write_json


def main(arguments: list[str] | None = None) -> None:
    """Run a command of the benchmark; exit status 2 for bad input."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.discovery", description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True)
    make = commands.add_parser("make", help="make campaigns without answers; those that are there stay")
    answers = commands.add_parser("answers", help="run `jaxhydro diagnose` on every campaign; goes on where it was stopped")
    scored = commands.add_parser("score", help="score a file of answers")
    for command in (make, answers, scored):
        command.add_argument("folder", type=Path, help="folder of the benchmark")
        chosen = command.add_mutually_exclusive_group() if command is make else command
        chosen.add_argument("--half", choices=HALVES, help="half to set thresholds by, or half to report (default: both)")
        if command is make:
            chosen.add_argument("--cases", nargs="+", metavar="NAME", help="cases by name, such as coulomb_friction-2-1")
    make.add_argument("--most", type=_count, help="make so many cases at most, the middle strength first")
    make.add_argument("--truth", type=Path, metavar="FILE", help="write what is missing in each campaign, as JSON")
    answers.add_argument("--out", type=Path, help="file of answers (default: FOLDER-answers/diagnose.json)")
    answers.add_argument("--processes", type=_count, default=1, help="campaigns at a time (default 1)")
    scored.add_argument("answers", type=Path, help="file of answers")
    scored.add_argument("--answered-only", action="store_true", help="leave out campaigns without an answer")
    scored.add_argument("--out", type=Path, help="file of the score (default: ANSWERS with .score.json)")
    options = parser.parse_args(arguments)
    try:
        {"make": _make, "answers": _answers, "score": _score}[options.command](options, parser)
    except InputError as error:
        print(f"{parser.prog}: {error}", file=sys.stderr)
        sys.exit(2)


def _count(text: str) -> int:
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"expected a whole number from 1, found {text!r}")
    return int(text)


def _make(options: argparse.Namespace, parser: argparse.ArgumentParser) -> None:
    selectable = {case.name: case for case in cases() if options.half in (None, case.half)}
    for name in options.cases or ():
        if name not in selectable:
            parser.error(f"--cases: expected the name of a case, found {name!r}. {suggest(name, selectable)}".rstrip())
    selected: list[Case] = [selectable[name] for name in dict.fromkeys(options.cases or selectable)][: options.most]
    for complete in make_benchmark(options.folder, selected):
        say(f"{complete} of {len(selected)} campaigns are in {options.folder}")
    if options.truth is not None:
        write_truth(options.folder, options.truth)
        say(f"What is missing in each of them is in {options.truth}")


def _answers(options: argparse.Namespace, parser: argparse.ArgumentParser) -> None:
    read_index(options.folder)
    names = [case.public_name for case in cases_in(options.folder) if options.half in (None, case.half)]
    if not names:
        parser.error(f"{options.folder}: expected campaigns, found none; `make` makes them")
    beside = options.folder.resolve()
    file = options.out or beside.with_name(f"{beside.name}-answers") / "diagnose.json"
    answers_by_name: dict[str, Answer] = {}
    for done, (name, answer) in enumerate(diagnose_all(options.folder, names, file.with_suffix(""), options.processes), 1):
        if isinstance(answer, str):
            say(f"{done} of {len(names)}, {name}: no answer, {answer}")
            continue
        answers_by_name[name] = answer
        write_answers(file, answers_by_name)
        summary = ", ".join(claim.effect for claim in answer.effects) or answer.verdict.replace("_", " ")
        say(f"{done} of {len(names)}, {name}: {summary} ({answer.minutes or 0.0:.1f} min)")
    say(f"{len(answers_by_name)} answers are in {file}" if answers_by_name else "There are no answers")


def _score(options: argparse.Namespace, parser: argparse.ArgumentParser) -> None:
    result = score(options.folder, options.answers, options.half, options.answered_only)
    scores = table(("", *COLUMNS), lines_of(result["table"]))
    say(f"{result['method']}: {result['answered']} of {result['campaigns']} campaigns answered\n\n{scores}")
    file = options.out or options.answers.with_suffix(".score.json")
    write_json(result, file)
    say(f"The score is in {file}")


if __name__ == "__main__":
    main()
