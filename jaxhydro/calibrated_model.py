"""Model with the parameter values, sea-state laws and effects of a calibration."""

from pathlib import Path
from typing import Any, NamedTuple

from jaxhydro.dynamics.model import Model
from jaxhydro.waves.sea_state import SeaState


class UsedCalibration(NamedTuple):
    """Values of a calibration that a model has.

    Attributes:
        values: Calibrated values, by label.
        reference: Sea state that exponents among the values count from (m, s); None without exponents.
        warnings: Reasons why the values may not be this platform's.
        strips: Conventions of strip loads (`strip_conventions.StripConventions`), where they differ from the platform's; else
            None.
    """

    values: dict[str, float]
    reference: SeaState | None
    warnings: list[str]
    strips: Any


def with_calibration(model: Model, asked: str, name: str, source: Path) -> tuple[Model, UsedCalibration]:
    """Model with the values, laws and effects of a calibration.

    Args:
        model: The model as the platform declares it.
        asked: The platform as it was asked for, a name or a file.
        name: The platform's own name.
        source: A calibration.json or diagnosis.json.

    Returns:
        The model, and the values in it with warnings.

    Raises:
        InputError: The file is no calibration, or has values that the model lacks.
    """
    from calibration.residuals.wave_options import non_default_options
    from calibration.results.applied_calibration import apply_calibration

    used = apply_calibration(source, model, asked, everything=True)
    warnings = []
    if not used.converged:
        warnings.append(f"the fit of {source} did not converge")
    if used.platform and used.platform != name:
        warnings.append(f"{source} is a calibration of {used.platform!r}, and its values are used for {name!r}")
    if options := "" if used.seas is None else non_default_options(used.seas):
        warnings.append(f"in the seas of its campaign {source} has {options}; waves here are as options say")
    if used.undetermined:
        warnings.append(f"among the calibrated values the records did not determine {', '.join(used.undetermined)}")
    return used.model, UsedCalibration(used.values, used.reference, warnings, used.strips)


def calibration_file(path: str) -> Path:
    """Path of the diagnosis.json or calibration.json in a folder, or of the file itself.

    Args:
        path: Folder or file.
    """
    from calibration.results.read_result import file_of

    return file_of(path)
