"""A written calibration.json, or what of a diagnosis.json is a calibrated model, read back and checked."""

import json
import math
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Annotated, Any, NamedTuple, TypeVar

from pydantic import BaseModel, ConfigDict, Field

from calibration.folder import DIAGNOSIS, RESULT
from jaxhydro.body_schema import ConstantDrag, HighPass, HighPassAtEnds, KeuleganCarpenter, SuctionSide
from jaxhydro.drag_laws import DragLaw, drag_laws_of, plain_drag, with_drag_laws
from jaxhydro.loads.sea_state_law import is_exponent, split, with_exponents
from jaxhydro.model import Model
from jaxhydro.problems import InputError, Number, Positive, Problem, shown, suggest, validate
from jaxhydro.waves.sea_state import SeaState

OF_CAMPAIGN = (  # first words of labels of what belongs to the installation in one basin, not to the hull
    "mooring.", "stiffness.", "mooring_nonlinearity.", "umbilical.", "current.", "static_offset.", "mass_properties.",
    "sensor_reference.", "sensor_lag.", "wave_gauge_position.", "wave_reflection.",
)  # fmt: skip


class Open(BaseModel):
    """Keys that are not known are taken and left alone: results may grow."""

    model_config = ConfigDict(frozen=True, extra="ignore")


class Parameter(Open):
    """One calibrated parameter."""

    value: Number
    unit: str
    standard_deviation: Number | None = None
    at_bound: bool = False
    identifiable: bool = True
    start: Number | None = None
    meaning: str = ""


class Error(Open):
    """RMSE of one channel, in m or deg, and over the standard deviation of what was measured."""

    rmse: Number
    unit: str
    relative: Number
    in_objective: bool = True
    before: "Error | None" = None


class InBands(Open):
    """Errors of energy of one test, by motion and band."""

    bands: dict[str, dict[str, Number]]


class Objective(Open):
    """J over the fitted and over the held-out tests."""

    fit: Number
    holdout: Number | None = None


class Reference(Open):
    """The sea state (m, s) that exponents count from."""

    significant_height: Positive
    peak_period: Positive


Law = Annotated[ConstantDrag | HighPassAtEnds | KeuleganCarpenter | SuctionSide, Field(discriminator="law")]


class Fitted(Open):
    """A model as it was calibrated. `error` has `use`, and channels, by test."""

    parameters: dict[str, Parameter]
    error: dict[str, dict[str, Any]]
    objective: Objective
    converged: bool
    iterations: int | None = None
    seconds: Number | None = None
    notes: list[str] = Field(default_factory=list)
    sea_state_reference: Reference | None = None
    drag_laws: dict[str, Law] = Field(default_factory=dict)


class About(Open):
    """What a test was."""

    use: str = ""
    kind: str = ""
    degree_of_freedom: str | None = None
    file: str = ""
    duration: Number | None = None
    samples: int | None = None
    bands_before: dict[str, dict[str, Number]] = Field(default_factory=dict)


class Drawn(Open):
    """A figure, its file below the folder, and its caption."""

    file: str
    caption: str = ""


class Saved(Open):
    """calibration.json; of a diagnosis.json the models before and after, `augmented` the one with what was missing."""

    campaign: str
    jaxhydro: str
    baseline: Fitted
    augmented: Fitted | None = None
    platform: str = ""
    tests: dict[str, About] = Field(default_factory=dict)
    figures: list[Drawn] = Field(default_factory=list)

    @property
    def best(self) -> Fitted:
        """The model to simulate with: what was missing is in it, where it was looked for."""
        return self.augmented or self.baseline

    @property
    def key(self) -> str:
        """Where that model stands in the file."""
        return "baseline" if self.augmented is None else "augmented"

    def values(self) -> dict[str, float]:
        """Its calibrated values by label."""
        return {label: one.value for label, one in self.best.parameters.items()}

    def errors(self, source: str, key: str = "baseline") -> dict[str, dict[str, Error]]:
        """Test -> channel -> error of the baseline or the augmented model. Raises InputError for what is none."""
        fitted: Fitted = getattr(self, key)
        return {
            id: {name: validate(Error, value, f"{source}: {key}.error.{id}.{name}")
                 for name, value in row.items() if name not in ("use", "bands", "bands_before")}
            for id, row in fitted.error.items()
        }  # fmt: skip


    def bands(self, source: str) -> dict[str, dict[str, dict[str, tuple[float | None, float]]]]:
        """Test -> motion -> band -> error of its energy before and after. Raises InputError for what is none."""
        found = {}
        for id, row in self.baseline.error.items():
            after = validate(InBands, {"bands": row.get("bands", {})}, f"{source}: baseline.error.{id}").bands
            before = self.tests[id].bands_before if id in self.tests else {}
            found[id] = {
                channel: {band: (before.get(channel, {}).get(band), value) for band, value in bands.items()}
                for channel, bands in after.items()
            }
        return found


S = TypeVar("S", bound=Open)


def read_saved(path: str | PathLike[str]) -> Saved:
    """The result in a calibration.json or diagnosis.json, or in the folder that has one. Raises InputError with all that is
    wrong."""
    return read_as(Saved, path)


def read_as(kind: type[S], path: str | PathLike[str]) -> S:
    """`read_saved`, as what holds more of the file than the calibrated models."""
    path = Path(path)
    try:
        if path.is_dir():
            path = path / (DIAGNOSIS if (path / DIAGNOSIS).is_file() else RESULT)
        data = json.loads(path.read_bytes().decode("utf-8-sig"))
    except FileNotFoundError:
        raise _wrong(path, f"a {RESULT}, as `jaxhydro calibrate` writes it", "no such file") from None
    except (json.JSONDecodeError, RecursionError) as error:
        place = f"line {error.lineno}, column {error.colno}" if isinstance(error, json.JSONDecodeError) else ""
        raise _wrong(path, "valid JSON", getattr(error, "msg", "lists nested too deeply"), place) from None
    except UnicodeDecodeError:
        raise _wrong(path, "text in UTF-8", "other bytes") from None
    except (OSError, ValueError) as error:
        raise _wrong(path, "a file that can be read", str(getattr(error, "strerror", None) or error)) from None
    if not isinstance(data, dict):
        raise _wrong(path, "a mapping of keys to values", type(data).__name__)
    return validate(kind, data, str(path))


def read_values(path: str | PathLike[str]) -> dict[str, float]:
    """The calibrated values in a calibration.json or diagnosis.json, by label. Raises InputError."""
    return read_saved(path).values()


class Applied(NamedTuple):
    """A model with values of a calibration, these values, those of them that its records did not determine, and those that were
    left: moorings and the like are each campaign's own."""

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
    model = fitting(saved, model, path)
    own = not saved.platform or saved.platform == platform
    values = {k: v for k, v in saved.values().items() if own or not k.startswith(OF_CAMPAIGN)}
    if not saved.values():
        raise _wrong(Path(path), "at least one calibrated parameter", "none", f"{saved.key}.parameters")
    if unknown := [label for label in values if label not in model.values]:
        raise no_place(saved, unknown, model, platform, path)
    for label, value in values.items():
        about = model.about(label)
        slack = 1e-6 * max(abs(value), abs(about.lower) if about.lower > -math.inf else 0.0)
        if not about.lower - slack <= value <= about.upper + slack:
            expected = f"a number between {about.lower:g} and {about.upper:g}"
            raise _wrong(Path(path), expected, f"{value:g}", f"{saved.key}.parameters.{label}.value")
    vague = tuple(label for label in values if not saved.best.parameters[label].identifiable)
    left = tuple(label for label in saved.values() if label not in values)
    return Applied(model.with_values(values), values, vague, left, saved.campaign)


def no_place(saved: Saved, unknown: list[str], model: Model, platform: str, path: str | PathLike[str]) -> InputError:
    """The error of calibrated values that a model has no place for."""
    expected = f"parameters of {platform} ({', '.join(sorted(model.values)) or 'it has none'})"
    found, hint = ", ".join(map(shown, unknown)), suggest(unknown[0], model.values)
    return _wrong(Path(path), expected, found, f"{saved.key}.parameters", hint)


def fitting(saved: Saved, model: Model, path: str | PathLike[str]) -> Model:
    """The model with what calibrated values need beyond what is declared: laws of drag and over the sea state, and the effects
    that a diagnosis found, at their null."""
    model = _with_laws(saved, _with_drag(saved, model, path), path)
    added = [label for label in saved.values() if label not in model.values]
    if saved.augmented is None or not added:
        return model
    from calibration.discovery.catalogue import with_effects

    try:
        return with_effects(model, added)
    except (KeyError, ValueError) as error:
        said = str(error.args[0] if error.args else error)
        raise _wrong(Path(path), "parameters of effects that this version knows", said, "augmented.parameters") from None


def _with_drag(saved: Saved, model: Model, path: str | PathLike[str]) -> Model:
    """The model with the drag laws that were calibrated. Raises InputError where it declares others, or has no such drag."""
    plain, there, laws = plain_drag(model), drag_laws_of(model), saved.best.drag_laws
    where = f"{saved.key}.drag_laws"
    for label, law in laws.items():
        if label not in plain and label not in there:
            known = [*plain, *there]
            expected, hint = f"drag coefficients ({', '.join(known) or 'there are none'})", suggest(label, known)
            raise _wrong(Path(path), expected, repr(label), where, hint)
        if label in there and not _alike(there[label], law):
            expected = f"the law that the platform declares ({_said(there[label])})"
            raise _wrong(Path(path), expected, _said(law), f"{where}.{label}")
    for label in saved.values():
        if label in there and label not in laws and not _silent(there[label]):
            expected = f"the law that the platform declares ({_said(there[label])})"
            raise _wrong(Path(path), expected, "plain drag", f"{where}.{label}", "A coefficient goes with its law.")
    return with_drag_laws(model, {label: law for label, law in laws.items() if label in plain})


def _silent(law: DragLaw) -> bool:
    """Whether a law is at its null, plain drag."""
    if isinstance(law, HighPass):
        return (law.low_share == 1 or law.cutoff == 0) and not getattr(law, "suction", None)
    return not (law.exponent if isinstance(law, KeuleganCarpenter) else getattr(law, "suction", 0))


def _alike(one: DragLaw, other: DragLaw) -> bool:
    """Whether laws differ in nothing but parameters, which are the calibration's."""
    def constants(law: DragLaw) -> dict[str, Any]:
        return law.model_dump(include={"law", "reference", "window"})

    return constants(one) == constants(other)


def _said(law: DragLaw) -> str:
    return ", ".join(f"{key}: {value}" for key, value in law.model_dump(exclude_none=True).items())


def _with_laws(saved: Saved, model: Model, path: str | PathLike[str]) -> Model:
    """The model with the laws over the sea state that the calibrated values have exponents of."""
    stated = saved.best.sea_state_reference
    labels = [label for label in saved.values() if is_exponent(label) and split(label)[0] in model.values]
    if not labels:
        return model
    if stated is None:
        where, found = f"{saved.key}.sea_state_reference", "nothing"
        raise _wrong(Path(path), f"the sea state that {labels[0]} counts from", found, where)
    reference = SeaState(stated.significant_height, stated.peak_period)
    try:
        loads = with_exponents(model.loads, dict.fromkeys(labels, 0.0), reference)
        return replace(model, loads=loads)
    except ValueError as error:
        where = f"{saved.key}.sea_state_reference"
        raise _wrong(Path(path), "the reference that the platform declares", str(error), where) from None


def _wrong(path: Path, expected: str, found: str, where: str = "", hint: str = "") -> InputError:
    return InputError(str(path), [Problem(where, expected, found, hint)])
