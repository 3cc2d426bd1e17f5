"""Schema and reading of diagnosis.json."""

from os import PathLike
from typing import Literal

from pydantic import Field

from calibration.results.read_calibration import FittedModel, Parameter, ResultModel, SavedCalibration, read_as
from jaxhydro.errors import Number


class SavedEvidence(ResultModel):
    """Why an effect is believed. See `calibration.discovery.diagnosis.Evidence`."""

    score: Number | None = None
    delta_bic: Number | None = None
    holdout_gain: Number | None = None
    clear: Number | None = None


class SavedEffect(ResultModel):
    """An effect that was found."""

    effect: str
    degree_of_freedom: str | None = None
    meaning: str = ""
    source: str = ""
    parameters: dict[str, Parameter]
    evidence: SavedEvidence
    share_of_residual_explained: Number
    indistinguishable_from: list[str] = Field(default_factory=list)
    test_that_would_tell: str | None = None
    in_doubt: str | None = None


class SavedRejection(ResultModel):
    """An effect that was tried and is not in the model."""

    effect: str
    reason: str
    degree_of_freedom: str | None = None


class SavedLatentForce(ResultModel):
    """The force that would make the model follow the records, of one motion."""

    degree_of_freedom: str
    words: str


class Unexplained(ResultModel):
    """What is left: its share of the error's energy, what is known of it, and the forces that are behind it."""

    share: Number
    signature: str
    forces: list[SavedLatentForce] = Field(default_factory=list)


class MissingEffects(ResultModel):
    """What the declared model lacks."""

    verdict: Literal["found", "nothing_missing", "unexplained"]
    effects: list[SavedEffect]
    rejected: list[SavedRejection]
    unexplained: Unexplained


class SavedResidual(ResultModel):
    """What is left of one motion of one test, in m or deg."""

    test: str
    channel: str
    use: str = ""
    unit: str = ""
    rms: Number | None = None
    noise: Number | None = None
    relative: Number | None = None
    words: str = ""

    @property
    def over_noise(self) -> float | None:
        """The residual over the noise."""
        return self.rms / self.noise if self.rms is not None and self.noise else None


class Anatomy(ResultModel):
    """Residuals of the declared model, fitted, and of that with what was found."""

    before: list[SavedResidual] = Field(default_factory=list)
    after: list[SavedResidual] = Field(default_factory=list)


class SavedDiagnosis(SavedCalibration):
    """diagnosis.json."""

    augmented: FittedModel
    missing: MissingEffects
    complete: bool = True
    anatomy: Anatomy = Field(default_factory=Anatomy)
    next_test: str = ""
    notes: list[str] = Field(default_factory=list)
    seconds: Number | None = None

    @property
    def converged(self) -> bool:
        """Whether both fits did."""
        return self.baseline.converged and self.augmented.converged


def read_diagnosis(path: str | PathLike[str]) -> SavedDiagnosis:
    """A diagnosis.json, or that of a folder. Raises InputError with all that is wrong."""
    return read_as(SavedDiagnosis, path)
