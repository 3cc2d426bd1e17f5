"""Model and reading of diagnosis.json."""

from os import PathLike

from pydantic import Field

from calibration.discovery.diagnosis import Outcome
from calibration.results.calibration_file import CalibrationFile, FittedModel, Parameter
from calibration.results.latent_force_file import Unexplained
from calibration.results.read_result import read_as
from jaxhydro.input_schema import Number
from jaxhydro.result_model import ResultModel


class Evidence(ResultModel):
    """Evidence for an effect. See `calibration.discovery.reported_effects.Evidence`."""

    score: Number | None
    delta_bic: Number | None
    holdout_gain: Number | None
    clear: Number | None = None
    probability: Number | None = None
    left_out: Number | None = None
    left_out_better: Number | None = None


class PlausibleSizeRange(ResultModel):
    """Sizes (SI) that a parameter can plausibly have.

    See `calibration.discovery.reported_effects.PlausibleRange`.
    """

    lower: Number
    upper: Number
    source: str
    at_end: bool = False


class FoundEffect(ResultModel):
    """An effect that was found. See `calibration.discovery.reported_effects.Effect`."""

    effect: str
    degree_of_freedom: str | None = None
    meaning: str = ""
    source: str = ""
    parameters: dict[str, Parameter]
    evidence: Evidence
    share_of_residual_explained: Number
    indistinguishable_from: list[str]
    test_that_would_tell: str | None = None
    in_doubt: str | None = None
    plausible: dict[str, PlausibleSizeRange] = Field(default_factory=dict)
    trades_against: dict[str, Number] = Field(default_factory=dict)


class DetectionLimit(ResultModel):
    """Size from which an effect would have been named; None: at no size that was tried.

    See `calibration.discovery.diagnosis.DetectionLimit`.
    """

    smallest: Number | None
    largest: Number | None
    plausible: Number
    told: Number
    unit: str = ""

    @property
    def observable(self) -> bool:
        """Whether the records show the effect at a plausible size."""
        return self.smallest is not None and self.smallest <= self.plausible


class RejectedEffect(ResultModel):
    """An effect that was tried and is not in the model, and why."""

    effect: str
    degree_of_freedom: str | None = None
    reason: str
    probability: Number | None = None
    detection_limits: dict[str, DetectionLimit] = Field(default_factory=dict)

    @property
    def observable(self) -> bool:
        """Whether the records would show it at a plausible size, as far as that was computed."""
        limits = self.detection_limits.values()
        return not limits or any(limit.observable for limit in limits)


class MissingEffects(ResultModel):
    """What the baseline lacks."""

    verdict: Outcome
    effects: list[FoundEffect]
    rejected: list[RejectedEffect]
    unexplained: Unexplained


class EffectScore(ResultModel):
    """Score of a candidate in one round. See `calibration.discovery.diagnosis.Score`."""

    round: int
    effect: str
    degree_of_freedom: str | None = None
    gain: Number | None = None
    parameters: int
    holdout_gain: Number | None = None
    refitted_gain: Number | None = None
    refitted_holdout_gain: Number | None = None


class ResidualBand(ResultModel):
    """Frequency band (Hz) of a residual: its rms over that of the noise."""

    low: Number
    high: Number
    rms_over_noise: Number | None = None


class Residual(ResultModel):
    """Residual of one motion of one test, in `unit` (m or deg).

    Attributes:
        test: Name of the test.
        use: Use of the test.
        channel: The motion.
        unit: m or deg.
        rms: Root mean square.
        noise: Standard deviation of the measurement noise.
        relative: RMS over the standard deviation of the motion.
        bands: RMS over the noise, by frequency band.
        words: Description.
    """

    test: str
    use: str = ""
    channel: str
    unit: str = ""
    rms: Number | None = None
    noise: Number | None = None
    relative: Number | None = None
    bands: list[ResidualBand] = Field(default_factory=list)
    words: str = ""

    @property
    def over_noise(self) -> float | None:
        """The residual over the noise."""
        return self.rms / self.noise if self.rms is not None and self.noise else None


class Anatomy(ResultModel):
    """Residuals of the fitted baseline, and of the model with the effects found."""

    before: list[Residual] = Field(default_factory=list)
    after: list[Residual] = Field(default_factory=list)


class PredictedMotion(ResultModel):
    """Predicted motion of a held-out test, in `unit` (m or deg), and the samples within its band.

    The band itself is in simulated.nc.

    Attributes:
        test: Name of the test.
        channel: The motion.
        unit: m or deg.
        samples: Number of samples.
        inside: Fraction of the samples in the band, in which 95 % are expected.
        half_width: Half the width of the band, root mean square.
        parameter_error: Standard deviation due to that of the parameters, root mean square.
        model_error: Standard deviation of noise and of what the model leaves, from the fitted tests.
    """

    test: str
    channel: str
    unit: str = ""
    samples: int
    inside: Number
    half_width: Number | None = None
    parameter_error: Number | None = None
    model_error: Number | None = None


class DiagnosisFile(CalibrationFile):
    """Content of diagnosis.json.

    Attributes:
        complete: False where the search was stopped before its end.
        missing: What the baseline lacks.
        augmented: The calibrated model with the effects that were found.
        scores: Scores of all candidates in all rounds.
        anatomy: Residuals before and after.
        predictions: Predicted motions of the held-out tests.
        next_test: The test to do next.
        notes: Notes and doubts, as sentences.
        seconds: Computing time (s).
    """

    complete: bool = True
    missing: MissingEffects
    augmented: FittedModel
    scores: list[EffectScore] = Field(default_factory=list)
    anatomy: Anatomy = Field(default_factory=Anatomy)
    predictions: list[PredictedMotion] = Field(default_factory=list)
    next_test: str = ""
    notes: list[str] = Field(default_factory=list)
    seconds: Number | None = None

    @property
    def converged(self) -> bool:
        """Whether both fits converged."""
        return self.baseline.converged and self.augmented.converged


def read_diagnosis(path: str | PathLike[str]) -> DiagnosisFile:
    """Read a diagnosis.json, or that of a folder. Raises InputError, which lists all faults."""
    return read_as(DiagnosisFile, path)
