"""Model with the parameter values, sea-state laws and effects of a calibration."""

from pathlib import Path
from typing import Any, NamedTuple

from jaxhydro.dynamics.model import Model
from jaxhydro.waves.sea_state import SeaState


class UsedCalibration(NamedTuple):
    """Values of a calibration in a model, by label; the sea state (m, s) that exponents among them count from; why they may not
    be this platform's; how strips are taken with them (`strip_conventions.StripConventions`), where the platform says
    otherwise."""

    values: dict[str, float]
    reference: SeaState | None
    warnings: list[str]
    strips: Any


def with_calibration(model: Model, asked: str, name: str, source: Path) -> tuple[Model, UsedCalibration]:
    """`calibrated`, with what is to be known, and nothing is printed."""
    from calibration.residuals.measured_seas import non_default_options
    from calibration.results.applied_calibration import apply_calibration

    used = apply_calibration(source, model, asked, everything=True)
    warnings = []
    if not used.converged:
        warnings.append(f"the fit of {source} did not converge")
    if used.platform and used.platform != name:
        warnings.append(f"{source} is a calibration of {used.platform!r}, and its values are used for {name!r}")
    if said := "" if used.seas is None else non_default_options(used.seas):
        warnings.append(f"in the seas of its campaign {source} has {said}; waves here are as options say")
    if used.undetermined:
        warnings.append(f"among the calibrated values the records did not determine {', '.join(used.undetermined)}")
    return used.model, UsedCalibration(used.values, used.reference, warnings, used.strips)


def calibration_file(path: str) -> Path:
    """The diagnosis.json or calibration.json of a folder, or the file itself."""
    from calibration.results.calibration_file import file_of

    return file_of(path)
