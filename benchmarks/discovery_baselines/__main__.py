"""Baselines on the discovery benchmark: ensemble SINDy and a Gaussian process, both on the reconstructed force.

    python -m benchmarks.discovery_baselines sindy|grey-box FOLDER [--half set|report] [--out FILE]

They need `pip install jaxhydro[baselines]`. docs/discovery-benchmark.md says how terms are taken for effects.
"""

import argparse
import sys
import time
from collections.abc import Callable
from importlib import metadata
from pathlib import Path

from benchmarks.discovery.answer_file import Answer
from benchmarks.discovery.cases import HALVES
from benchmarks.discovery.make_campaigns import cases_in, read_index
from benchmarks.discovery.run_diagnose import write_answers
from benchmarks.discovery_baselines.law_answer import MotionLaw, answer_of_laws
from benchmarks.discovery_baselines.reconstructed_forces import Reconstruction, reconstructed
from benchmarks.evidence.common import say
from jaxhydro.errors import InputError

METHODS = {"sindy": ("ensemble SINDy", "pysindy"), "grey-box": ("Gaussian process", "scikit-learn")}


def law_of_method(method: str) -> Callable[[Reconstruction, str], MotionLaw]:
    """The function that gives a method's law of a motion."""
    if method == "sindy":
        from benchmarks.discovery_baselines.sindy import sindy_law

        return sindy_law
    from benchmarks.discovery_baselines.grey_box import grey_box_law

    return grey_box_law


def answered(made: Reconstruction, law: Callable[[Reconstruction, str], MotionLaw]) -> Answer:
    """Answer of a method to a campaign whose forces are reconstructed."""
    begun = time.monotonic()
    laws = [law(made, motion) for motion in made.motions()]
    answer = answer_of_laws(made, laws)
    return answer.model_copy(update={"minutes": made.minutes + (time.monotonic() - begun) / 60})


def main(arguments: list[str] | None = None) -> None:
    """Answer the campaigns of a folder; exit status 2 for bad input."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.discovery_baselines", description=__doc__.splitlines()[0])
    parser.add_argument("method", choices=METHODS)
    parser.add_argument("folder", type=Path, help="folder of the benchmark")
    parser.add_argument("--half", choices=HALVES, help="half of the campaigns (default: both)")
    parser.add_argument("--out", type=Path, help="file of answers (default: FOLDER-answers/METHOD.json)")
    options = parser.parse_args(arguments)
    name, package = METHODS[options.method]
    folder = options.folder.resolve()
    try:
        read_index(folder)
        law = law_of_method(options.method)
    except (InputError, ImportError) as error:
        hint = " (pip install jaxhydro[baselines])" if isinstance(error, ImportError) else ""
        print(f"{parser.prog}: {error}{hint}", file=sys.stderr)
        sys.exit(2)
    beside = folder.with_name(f"{folder.name}-answers")
    file, answers = options.out or beside / f"{options.method}.json", {}
    selected = [case for case in cases_in(folder) if options.half in (None, case.half)]
    for done, case in enumerate(selected, 1):
        made = reconstructed(folder / case.public_name, beside / "forces" / f"{case.public_name}.pickle")
        answer = answers[case.public_name] = answered(made, law)
        write_answers(file, answers, f"{name}, {package} {metadata.version(package)}")
        summary = ", ".join(claim.effect for claim in answer.effects) or answer.verdict.replace("_", " ")
        say(f"{done} of {len(selected)}, {case.public_name}: {summary} ({answer.minutes:.1f} min)")
    say(f"{len(answers)} answers are in {file}")


if __name__ == "__main__":
    main()
