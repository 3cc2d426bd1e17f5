"""Section of result files on how waves were made and act."""

from typing import Literal

from pydantic import Field, model_validator

from calibration.residuals.wave_options import Options
from jaxhydro.input_schema import NonNegative, Positive
from jaxhydro.result_model import ResultModel
from jaxhydro.waves.irregular_sea import Acting
from jaxhydro.waves.sea import Stretching
from jaxhydro.waves.second_order import Kind


class SeaOptions(ResultModel):
    """How waves were made and act. See `calibration.residuals.wave_options.Options`."""

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
        """The same options, as calibrations take them."""
        return Options(**self.model_dump())
