"""Base class of the models of result files, which are JSON without NaN or infinity."""

import json
import math
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict

from jaxhydro.input_schema import Positive


class ResultModel(BaseModel):
    """Base class of everything in a result file: immutable; keys of later versions are ignored."""

    model_config = ConfigDict(frozen=True, extra="ignore")

    def write(self, path: Path) -> None:
        """Write as JSON; fields that were not set are left out.

        Args:
            path: The file.

        Raises:
            ValueError: A number is not finite.
        """
        write_json(self.model_dump(mode="json", exclude_unset=True), path)


class ReferenceSeaState(ResultModel):
    """Sea state (m, s) that the exponents of coefficients refer to."""

    significant_height: Positive
    peak_period: Positive


def write_json(content: dict[str, Any], path: Path) -> None:
    """Write a result file. Raises ValueError for numbers that JSON does not have."""
    path.write_text(json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8")


def stated(**values: Any) -> dict[str, Any]:
    """The values that are not None or empty: a file has no keys for the others."""
    return {name: value for name, value in values.items() if value not in (None, {}, [])}


def finite_or_null(value: float | None) -> float | None:
    """A number as JSON has it: None where it is not finite."""
    return float(value) if value is not None and math.isfinite(value) else None
