"""Answers of a method in JSON: per campaign a verdict, effects with motion and probability, errors, minutes."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field

from jaxhydro.errors import InputError, Problem, suggest_path
from jaxhydro.input_schema import Consistent, NonNegative, Number, Schema, Text, validate

Probability = Annotated[Number, Field(ge=0, le=1)]
Motion = Literal["surge", "sway", "heave", "roll", "pitch", "yaw"]


class ClaimedEffect(Schema):
    """An effect that a method says is missing, or that it considered.

    Attributes:
        effect: Its name, as docs/discovery-benchmark.md lists them.
        motion: The motion it acts in, or None.
        probability: Probability that it is missing in the model (0 to 1), or None.
        indistinguishable_from: Effects that the records cannot tell from it.
    """

    effect: Text
    motion: Motion | None = None
    probability: Probability | None = None
    indistinguishable_from: list[Text] = Field(default_factory=list)


class HeldOutErrors(Schema):
    """Errors of the tests marked `holdout`: sum over tests and scored motions of RMSE / standard deviation.

    Attributes:
        baseline: Error of the baseline.
        final: Error with the named effects.
    """

    baseline: NonNegative
    final: NonNegative


class Answer(Consistent):
    """What a method says of one campaign.

    Attributes:
        verdict: `found`, `nothing_missing`, or `unexplained`: something is missing that the method cannot name.
        effects: Named effects, the most certain first.
        considered: Effects that are not named, with their probabilities.
        held_out_error: Errors of the tests that were not fitted, or None.
        minutes: Wall time (min), or None.
    """

    verdict: Literal["found", "nothing_missing", "unexplained"]
    effects: list[ClaimedEffect] = Field(default_factory=list)
    considered: list[ClaimedEffect] = Field(default_factory=list)
    held_out_error: HeldOutErrors | None = None
    minutes: NonNegative | None = None

    def _faults(self) -> Iterator[Problem]:
        if self.verdict == "found" and not self.effects:
            yield Problem("effects", "one effect or more with the verdict `found`", "none")
        if self.verdict == "nothing_missing" and self.effects:
            yield Problem("effects", "none with the verdict `nothing_missing`", self.effects[0].effect)


class AnswerFile(Schema):
    """Answers of one method.

    Attributes:
        method: Name and version of the method.
        campaigns: Answers by name of the campaign's folder.
    """

    method: Text
    campaigns: dict[str, Answer]


def read_json(path: Path, kind: str) -> Any:
    """Contents of a JSON file.

    Args:
        path: The file.
        kind: What it is, for the message.

    Raises:
        InputError: The file cannot be read or is no JSON.
    """
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise InputError(str(path), [Problem("", kind, "no such file", suggest_path(path))]) from None
    except (OSError, ValueError) as error:
        raise InputError(str(path), [Problem("", f"{kind} that can be read", str(error))]) from None


def read_answers(path: Path) -> AnswerFile:
    """Answers of a method. Raises InputError with all mistakes."""
    return validate(AnswerFile, read_json(path, "a JSON file of answers"), str(path))
