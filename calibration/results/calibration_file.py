"""Model and reading of calibration.json."""

from os import PathLike
from typing import Annotated

from pydantic import ConfigDict, Field

from calibration.campaign.manifest_sections import Use
from calibration.notes import NoteKind
from calibration.results.read_result import read_as
from calibration.results.result_folder import Figure
from calibration.results.sea_options_section import SeaOptions
from calibration.results.strip_conventions import StripConventions
from jaxhydro.input_schema import Number
from jaxhydro.platform.coefficients_schema import ConstantDrag, HighPassAtEnds, KeuleganCarpenter, SuctionSide
from jaxhydro.result_model import ReferenceSeaState, ResultModel

EnergyErrors = dict[str, dict[str, Number]]  # relative error of the energy, by motion and band


class Parameter(ResultModel):
    """A calibrated parameter.

    Attributes:
        value: Value, in `unit`.
        standard_deviation: Standard deviation, in `unit`; None where the records do not determine the parameter.
        unit: SI unit; angles in rad.
        at_bound: Whether the value is at one of its bounds.
        identifiable: Whether the records determine the parameter.
        start: Value where the fit began.
        label: Label in the model, where the key is shorter than that.
        meaning: Description of the parameter.
    """

    value: Number
    standard_deviation: Number | None = None
    unit: str
    at_bound: bool = False
    identifiable: bool = True
    start: Number | None = None
    label: str = ""
    meaning: str = ""


class MotionError(ResultModel):
    """RMSE of a simulated motion.

    Attributes:
        rmse: RMSE, in `unit`.
        unit: m or deg.
        relative: RMSE over the standard deviation of the measured motion.
    """

    rmse: Number
    unit: str
    relative: Number


class ChannelError(MotionError):
    """Error of a motion after calibration and before it.

    Attributes:
        in_objective: Whether the motion counts in the objective.
        before: Error of the model that the calibration started from.
    """

    in_objective: bool = True
    before: MotionError | None = None


class TestErrors(ResultModel):
    """Errors of a test: of its motions, each by the name of its channel, and of energies.

    Attributes:
        use: Use of the test.
        bands: (simulated - measured) / measured energy, by motion and band; of tests in irregular waves only.
    """

    model_config = ConfigDict(frozen=True, extra="allow")
    __pydantic_extra__: dict[str, ChannelError] = Field(init=False)

    use: Use
    bands: EnergyErrors = Field(default_factory=dict)

    @property
    def channels(self) -> dict[str, ChannelError]:
        """Errors of the motions, by channel."""
        return self.__pydantic_extra__


class Objective(ResultModel):
    """Sum of RMSE over standard deviation, over the fitted and over the held-out tests."""

    fit: Number
    holdout: Number | None = None


Law = Annotated[ConstantDrag | HighPassAtEnds | KeuleganCarpenter | SuctionSide, Field(discriminator="law")]


class FittedModel(ResultModel):
    """A calibrated model.

    Attributes:
        parameters: Calibrated parameters, by label.
        error: Errors by test.
        objective: Objective J.
        converged: Whether the fit converged and follows its records.
        iterations: Number of iterations.
        seconds: Duration of the calibration (s).
        history: Objective at each accepted iteration.
        notes: Findings, as sentences.
        notes_about: What each of the notes is about.
        sea_state_reference: Sea state that exponents refer to.
        drag_laws: Laws of drag that is not plain, by coefficient.
    """

    parameters: dict[str, Parameter]
    error: dict[str, TestErrors]
    objective: Objective
    converged: bool
    iterations: int | None = None
    seconds: Number | None = None
    history: list[Number | None] = Field(default_factory=list)
    notes: list[str] = Field(default_factory=list)
    notes_about: list[NoteKind] = Field(default_factory=list)
    sea_state_reference: ReferenceSeaState | None = None
    drag_laws: dict[str, Law] = Field(default_factory=dict)


class DampingTerm(ResultModel):
    """A damping term of a decay: measured with half the width of its 95 % interval, and simulated."""

    measured: Number
    half_width: Number
    simulated: Number


class LinearQuadraticDamping(ResultModel):
    """Classical analysis of a decay. See `calibration.decay_analysis.linear_quadratic`.

    Attributes:
        period: Period (s).
        unit: m or rad.
        linear: p (1/s).
        quadratic: q (1/`unit`).
    """

    period: Number
    unit: str
    linear: DampingTerm
    quadratic: DampingTerm


class TestDescription(ResultModel):
    """Description of a test.

    Attributes:
        use: Use of the test.
        kind: Kind of the test, such as `decay`.
        degree_of_freedom: Degree of freedom that was released; None for tests in waves.
        file: Path of the data file.
        duration: Duration (s).
        samples: Number of samples.
        bands_before: Errors of energy before the calibration.
        linear_quadratic: Classical analysis of a decay.
    """

    use: str = ""
    kind: str = ""
    degree_of_freedom: str | None = None
    file: str = ""
    duration: Number | None = None
    samples: int | None = None
    bands_before: EnergyErrors = Field(default_factory=dict)
    linear_quadratic: LinearQuadraticDamping | None = None


class CalibrationFile(ResultModel):
    """Content of calibration.json, and the part of diagnosis.json that both files have.

    Attributes:
        campaign: Name of the campaign.
        platform: Name of the platform.
        strips: Conventions of strip loads, where the platform file does not state them.
        seas: Options of the waves, where they are not the campaign's.
        jaxhydro: Version of jaxhydro.
        baseline: The calibrated model.
        augmented: In a diagnosis.json, the calibrated model with the effects that were found.
        tests: Descriptions of the tests.
        truth: True coefficients of a synthetic campaign, by label.
        figures: Figures.
    """

    campaign: str
    platform: str = ""
    strips: StripConventions | None = None
    seas: SeaOptions | None = None
    jaxhydro: str
    baseline: FittedModel
    augmented: FittedModel | None = None
    tests: dict[str, TestDescription] = Field(default_factory=dict)
    truth: dict[str, Number] = Field(default_factory=dict)
    figures: list[Figure] = Field(default_factory=list)

    @property
    def best(self) -> FittedModel:
        """Model to simulate with: the augmented model, or the baseline where there is none."""
        return self.augmented or self.baseline

    @property
    def key(self) -> str:
        """Key of the `best` model in the file."""
        return "baseline" if self.augmented is None else "augmented"

    def values(self) -> dict[str, float]:
        """Calibrated values of the `best` model, by label."""
        return {label: parameter.value for label, parameter in self.best.parameters.items()}

    def bands(self) -> dict[str, dict[str, dict[str, tuple[float | None, float]]]]:
        """Errors of energy of the baseline before and after the calibration, by test, motion and band."""
        errors = {}
        for id, row in self.baseline.error.items():
            before = self.tests[id].bands_before if id in self.tests else {}
            errors[id] = {
                channel: {band: (before.get(channel, {}).get(band), value) for band, value in bands.items()}
                for channel, bands in row.bands.items()
            }
        return errors


def read_saved(path: str | PathLike[str]) -> CalibrationFile:
    """Read a calibration.json or diagnosis.json, or the one in a folder.

    Raises:
        InputError: The file cannot be read or is invalid; the error lists all faults.
    """
    return read_as(CalibrationFile, path)


def read_values(path: str | PathLike[str]) -> dict[str, float]:
    """The calibrated values in a calibration.json or diagnosis.json, by label. Raises InputError."""
    return read_saved(path).values()
