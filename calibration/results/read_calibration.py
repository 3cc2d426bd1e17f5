"""Schema and reading of calibration.json."""

import json
from os import PathLike
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

from pydantic import BaseModel, ConfigDict, Field, model_validator

from calibration.residuals.measured_seas import Options
from calibration.results.result_folder import DIAGNOSIS_FILE, RESULT_FILE
from calibration.results.strip_conventions import StripConventions
from jaxhydro.errors import InputError, NonNegative, Number, Positive, Problem, suggest_path, validate
from jaxhydro.platform.body import ConstantDrag, HighPassAtEnds, KeuleganCarpenter, SuctionSide
from jaxhydro.waves.irregular_sea import Acting
from jaxhydro.waves.sea import Stretching
from jaxhydro.waves.second_order import Kind


class ResultModel(BaseModel):
    """Keys that are not known are taken and left alone: results may grow."""

    model_config = ConfigDict(frozen=True, extra="ignore")


class Parameter(ResultModel):
    """One calibrated parameter."""

    value: Number
    unit: str
    standard_deviation: Number | None = None
    at_bound: bool = False
    identifiable: bool = True
    start: Number | None = None
    meaning: str = ""


class ChannelError(ResultModel):
    """RMSE of one channel, in m or deg, and over the standard deviation of what was measured."""

    rmse: Number
    unit: str
    relative: Number
    in_objective: bool = True
    before: "ChannelError | None" = None


class EnergyErrors(ResultModel):
    """Errors of energy of one test, by motion and band."""

    bands: dict[str, dict[str, Number]]


class Objective(ResultModel):
    """J over the fitted and over the held-out tests."""

    fit: Number
    holdout: Number | None = None


class ReferenceSeaState(ResultModel):
    """The sea state (m, s) that exponents count from."""

    significant_height: Positive
    peak_period: Positive


Law = Annotated[ConstantDrag | HighPassAtEnds | KeuleganCarpenter | SuctionSide, Field(discriminator="law")]


class FittedModel(ResultModel):
    """A model as it was calibrated. `error` has `use`, and channels, by test."""

    parameters: dict[str, Parameter]
    error: dict[str, dict[str, Any]]
    objective: Objective
    converged: bool
    iterations: int | None = None
    seconds: Number | None = None
    notes: list[str] = Field(default_factory=list)
    sea_state_reference: ReferenceSeaState | None = None
    drag_laws: dict[str, Law] = Field(default_factory=dict)


class DampingTerm(ResultModel):
    """A damping term of a decay: measured with half the width of its 95 % interval, and simulated."""

    measured: Number
    half_width: Number
    simulated: Number


class LinearQuadraticDamping(ResultModel):
    """Classical analysis of a decay: period (s), p (1/s), q (1/`unit`). See `calibration.decay_analysis.linear_quadratic`."""

    period: Number
    unit: str
    linear: DampingTerm
    quadratic: DampingTerm


class TestDescription(ResultModel):
    """What a test was."""

    use: str = ""
    kind: str = ""
    degree_of_freedom: str | None = None
    file: str = ""
    duration: Number | None = None
    samples: int | None = None
    bands_before: dict[str, dict[str, Number]] = Field(default_factory=dict)
    linear_quadratic: LinearQuadraticDamping | None = None


class Figure(ResultModel):
    """A figure, its file below the folder, and its caption."""

    file: str
    caption: str = ""


class SeaOptions(ResultModel):
    """How waves were made and act. See `calibration.residuals.measured_seas.Options`."""

    order: Literal[1, 2]
    stretching: Stretching
    diffraction: Literal["maccamy_fuchs", "ramp", "none"] | None
    low: NonNegative
    cutoff: Positive
    kinds: tuple[Kind, ...] = Field(min_length=1)
    highest_difference: Positive | None
    acting: Acting

    @model_validator(mode="after")
    def _band(self) -> "SeaOptions":
        if not self.low < self.cutoff:
            raise ValueError(f"`cutoff` above `low`, {self.low:g} Hz")
        return self

    def options(self) -> Options:
        """The same, as calibrations take it."""
        return Options(**self.model_dump())


class SavedCalibration(ResultModel):
    """calibration.json; of a diagnosis.json the models before and after, `augmented` the one with what was missing; `strips` is
    how these are taken where a platform file does not say so, `seas` how waves are. `truth`
    are the coefficients that a synthetic campaign was made with, by label."""

    campaign: str
    jaxhydro: str
    baseline: FittedModel
    augmented: FittedModel | None = None
    platform: str = ""
    strips: StripConventions | None = None
    seas: SeaOptions | None = None
    tests: dict[str, TestDescription] = Field(default_factory=dict)
    truth: dict[str, Number] = Field(default_factory=dict)
    figures: list[Figure] = Field(default_factory=list)

    @property
    def best(self) -> FittedModel:
        """The model to simulate with: what was missing is in it, where it was looked for."""
        return self.augmented or self.baseline

    @property
    def key(self) -> str:
        """Where that model stands in the file."""
        return "baseline" if self.augmented is None else "augmented"

    def values(self) -> dict[str, float]:
        """Its calibrated values by label."""
        return {label: one.value for label, one in self.best.parameters.items()}

    def errors(self, source: str, key: str = "baseline") -> dict[str, dict[str, ChannelError]]:
        """Test -> channel -> error of the baseline or the augmented model. Raises InputError for what is none."""
        fitted: FittedModel = getattr(self, key)
        return {
            id: {
                name: validate(ChannelError, value, f"{source}: {key}.error.{id}.{name}")
                for name, value in row.items()
                if name not in ("use", "bands", "bands_before")
            }
            for id, row in fitted.error.items()
        }

    def bands(self, source: str) -> dict[str, dict[str, dict[str, tuple[float | None, float]]]]:
        """Test -> motion -> band -> error of its energy before and after. Raises InputError for what is none."""
        found = {}
        for id, row in self.baseline.error.items():
            after = validate(EnergyErrors, {"bands": row.get("bands", {})}, f"{source}: baseline.error.{id}").bands
            before = self.tests[id].bands_before if id in self.tests else {}
            found[id] = {
                channel: {band: (before.get(channel, {}).get(band), value) for band, value in bands.items()}
                for channel, bands in after.items()
            }
        return found


S = TypeVar("S", bound=ResultModel)


def read_saved(path: str | PathLike[str]) -> SavedCalibration:
    """The result in a calibration.json or diagnosis.json, or in the folder that has one. Raises InputError with all that is
    wrong."""
    return read_as(SavedCalibration, path)


def file_of(path: str | PathLike[str]) -> Path:
    """The diagnosis.json or calibration.json of a folder, or the file itself."""
    path = Path(path)
    try:
        return path / (DIAGNOSIS_FILE if (path / DIAGNOSIS_FILE).is_file() else RESULT_FILE) if path.is_dir() else path
    except (OSError, ValueError):
        return path  # reading it says what is wrong


def read_as(kind: type[S], path: str | PathLike[str]) -> S:
    """`read_saved`, as what holds more of the file than the calibrated models."""
    path = file_of(path)
    try:
        data = json.loads(path.read_bytes().decode("utf-8-sig"))
    except FileNotFoundError:
        found = "no such file" if path.suffix else "no such folder"
        raise file_error(path, f"a {RESULT_FILE}, as `jaxhydro calibrate` writes it", found, hint=suggest_path(path)) from None
    except (json.JSONDecodeError, RecursionError) as error:
        place = f"line {error.lineno}, column {error.colno}" if isinstance(error, json.JSONDecodeError) else ""
        found = f"a mistake in it ({getattr(error, 'msg', 'lists nested too deeply')})"
        raise file_error(path, "valid JSON, as jaxhydro writes it", found, place) from None
    except UnicodeDecodeError:
        raise file_error(path, "text in UTF-8", "other bytes") from None
    except (OSError, ValueError) as error:
        raise file_error(path, "a file that can be read", str(getattr(error, "strerror", None) or error)) from None
    if not isinstance(data, dict):
        raise file_error(path, "a mapping of keys to values", type(data).__name__)
    return validate(kind, data, str(path))


def read_values(path: str | PathLike[str]) -> dict[str, float]:
    """The calibrated values in a calibration.json or diagnosis.json, by label. Raises InputError."""
    return read_saved(path).values()


def file_error(path: Path, expected: str, found: str, where: str = "", hint: str = "") -> InputError:
    """The error of one thing in a written result."""
    return InputError(str(path), [Problem(where, expected, found, hint)])
