"""Generation of outputs.schema.json, the contract of the result files, from their models.

python -m calibration.results.schema
"""

import json
from pathlib import Path
from typing import Any

from pydantic.json_schema import models_json_schema

from calibration.results.calibration_file import CalibrationFile
from calibration.results.comparison_file import ComparisonFile
from calibration.results.diagnosis_file import DiagnosisFile
from calibration.results.uncertainty_file import UncertaintyFile
from jaxhydro.sweep.sweep_results import SweepResults

SCHEMA_FILE = Path(__file__).parent.parent / "outputs.schema.json"
DESCRIPTION = (
    "A calibration.json, or a diagnosis.json, which has `missing`; keys may be added anywhere. Other files: comparison.json "
    "is #/$defs/ComparisonFile, uncertainty.json is #/$defs/UncertaintyFile, sweep.json is #/$defs/SweepResults."
)


def schema() -> dict[str, Any]:
    """JSON schema of all result files. The document itself is that of calibration.json and diagnosis.json."""
    models = (CalibrationFile, DiagnosisFile, ComparisonFile, UncertaintyFile, SweepResults)
    definitions = models_json_schema([(model, "validation") for model in models])[1]["$defs"]
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "calibration.json and diagnosis.json",
        "description": DESCRIPTION,
        "if": {"required": ["missing"]},
        "then": {"$ref": "#/$defs/DiagnosisFile"},
        "else": {"$ref": "#/$defs/CalibrationFile"},
        "$defs": {name: _without_titles(definitions[name]) for name in sorted(definitions)},
    }


def _without_titles(part: Any) -> Any:
    """A schema without the titles that pydantic makes of the names, which say nothing more."""
    if isinstance(part, list):
        return [_without_titles(value) for value in part]
    if not isinstance(part, dict):
        return part
    return {key: _without_titles(value) for key, value in part.items() if not (key == "title" and isinstance(value, str))}


def text() -> str:
    """The content of outputs.schema.json."""
    return json.dumps(schema(), indent=2, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    SCHEMA_FILE.write_text(text(), encoding="utf-8")
