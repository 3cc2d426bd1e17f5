"""A written calibration.json, read back and checked."""

import json
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import BaseModel, ConfigDict, Field

from calibration.outputs import RESULT
from jaxhydro.loads.sea_state_law import is_exponent, split, with_exponents
from jaxhydro.model import Model
from jaxhydro.problems import InputError, Number, Positive, Problem, shown, suggest, validate
from jaxhydro.waves.sea_state import SeaState


class _Open(BaseModel):
    """Keys that are not known are taken and left alone: results may grow."""

    model_config = ConfigDict(frozen=True, extra="ignore")


class Parameter(_Open):
    """One calibrated parameter."""

    value: Number
    unit: str
    standard_deviation: Number | None = None
    at_bound: bool = False
    identifiable: bool = True
    start: Number | None = None
    meaning: str = ""


class Error(_Open):
    """RMSE of one channel, in m or deg, and over the standard deviation of what was measured."""

    rmse: Number
    unit: str
    relative: Number
    in_objective: bool = True
    before: "Error | None" = None


class Objective(_Open):
    """J over the fitted and over the held-out tests."""

    fit: Number
    holdout: Number | None = None


class Reference(_Open):
    """The sea state (m, s) that exponents count from."""

    significant_height: Positive
    peak_period: Positive


class Fitted(_Open):
    """A model as it was calibrated. `error` has `use`, and channels, by test."""

    parameters: dict[str, Parameter]
    error: dict[str, dict[str, Any]]
    objective: Objective
    converged: bool
    iterations: int | None = None
    seconds: Number | None = None
    notes: list[str] = Field(default_factory=list)
    sea_state_reference: Reference | None = None


class About(_Open):
    """What a test was."""

    use: str = ""
    kind: str = ""
    degree_of_freedom: str | None = None
    file: str = ""
    duration: Number | None = None
    samples: int | None = None


class Drawn(_Open):
    """A figure, its file below the folder, and its caption."""

    file: str
    caption: str = ""


class Saved(_Open):
    """calibration.json."""

    campaign: str
    jaxhydro: str
    baseline: Fitted
    platform: str = ""
    tests: dict[str, About] = Field(default_factory=dict)
    figures: list[Drawn] = Field(default_factory=list)

    def values(self) -> dict[str, float]:
        """The calibrated values by label."""
        return {label: one.value for label, one in self.baseline.parameters.items()}

    def errors(self, source: str) -> dict[str, dict[str, Error]]:
        """Test -> channel -> error. Raises InputError for what is none."""
        return {
            id: {name: validate(Error, value, f"{source}: baseline.error.{id}.{name}")
                 for name, value in row.items() if name not in ("use", "bands", "bands_before")}
            for id, row in self.baseline.error.items()
        }  # fmt: skip


def read_saved(path: str | PathLike[str]) -> Saved:
    """The result in a calibration.json, or in the folder that has one. Raises InputError with all that is wrong."""
    path = Path(path)
    try:
        path = path / RESULT if path.is_dir() else path
        data = json.loads(path.read_bytes().decode("utf-8-sig"))
    except FileNotFoundError:
        raise _wrong(path, f"a {RESULT}, as `jaxhydro calibrate` writes it", "no such file") from None
    except (json.JSONDecodeError, RecursionError) as error:
        place = f"line {error.lineno}, column {error.colno}" if isinstance(error, json.JSONDecodeError) else ""
        raise _wrong(path, "valid JSON", getattr(error, "msg", "lists nested too deeply"), place) from None
    except UnicodeDecodeError:
        raise _wrong(path, "text in UTF-8", "other bytes") from None
    except (OSError, ValueError) as error:
        raise _wrong(path, f"a {RESULT} that can be read", str(getattr(error, "strerror", None) or error)) from None
    if not isinstance(data, dict):
        raise _wrong(path, "a mapping of keys to values", type(data).__name__)
    return validate(Saved, data, str(path))


def read_values(path: str | PathLike[str]) -> dict[str, float]:
    """The calibrated values in a calibration.json, by label. Raises InputError."""
    return read_saved(path).values()


class Applied(NamedTuple):
    """A model with values of a calibration, these values, those of them that its records did not determine, and those that were
    left: moorings are each campaign's own."""

    model: Model
    values: dict[str, float]
    vague: tuple[str, ...]
    left: tuple[str, ...]
    campaign: str


def applied(path: str | PathLike[str], model: Model, platform: str) -> Applied:
    """Calibrated values used for the model of the platform so named: all of its own, else those of hull and damping.

    Raises InputError for a file that is none, and for values that the model has no place for.
    """
    saved = read_saved(path)
    model = _with_laws(saved, model, path)
    own = not saved.platform or saved.platform == platform
    values = {k: v for k, v in saved.values().items() if own or not k.startswith(("mooring.", "stiffness."))}
    if unknown := [label for label in values if label not in model.values]:
        expected = f"parameters of {platform} ({', '.join(sorted(model.values)) or 'it has none'})"
        hint = suggest(unknown[0], model.values)
        raise _wrong(Path(path), expected, ", ".join(map(shown, unknown)), "baseline.parameters", hint)
    vague = tuple(label for label in values if not saved.baseline.parameters[label].identifiable)
    left = tuple(label for label in saved.values() if label not in values)
    return Applied(model.with_values(values), values, vague, left, saved.campaign)


def _with_laws(saved: Saved, model: Model, path: str | PathLike[str]) -> Model:
    """The model with the laws over the sea state that the calibrated values have exponents of."""
    stated = saved.baseline.sea_state_reference
    labels = [label for label in saved.values() if is_exponent(label) and split(label)[0] in model.values]
    if not labels:
        return model
    if stated is None:
        where, found = "baseline.sea_state_reference", "nothing"
        raise _wrong(Path(path), f"the sea state that {labels[0]} counts from", found, where)
    reference = SeaState(stated.significant_height, stated.peak_period)
    try:
        loads = with_exponents(model.loads, dict.fromkeys(labels, 0.0), reference)
        return replace(model, loads=loads)
    except ValueError as error:
        where = "baseline.sea_state_reference"
        raise _wrong(Path(path), "the reference that the platform declares", str(error), where) from None


def _wrong(path: Path, expected: str, found: str, where: str = "", hint: str = "") -> InputError:
    return InputError(str(path), [Problem(where, expected, found, hint)])
