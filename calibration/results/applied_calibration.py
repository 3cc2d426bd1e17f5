"""Application of a written calibration to a model."""

import math
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

from calibration.residuals.wave_options import Options
from calibration.results.calibration_file import CalibrationFile, read_saved
from calibration.results.read_result import file_error
from calibration.results.strip_conventions import StripConventions
from jaxhydro.dynamics.model import Model
from jaxhydro.errors import InputError, shown, suggest
from jaxhydro.loads.sea_state_law import EXPONENT_BASES, exponent_label, exponents_of, with_exponents
from jaxhydro.platform.coefficients_schema import HighPass, KeuleganCarpenter
from jaxhydro.platform.drag_laws import DragLaw, drag_laws_of, plain_drag, with_drag_laws
from jaxhydro.waves.sea_state import SeaState

CAMPAIGN_PARAMETERS = (  # first words of labels of what belongs to the installation in one basin, not to the hull
    "mooring.",
    "stiffness.",
    "mooring_nonlinearity.",
    "umbilical.",
    "current.",
    "static_offset.",
    "mass_properties.",
    "guided_masses.",
    "tuned_mass_dampers.",
    "liquid_column_dampers.",
    "rotor.",
    "sensor_reference.",
    "sensor_lag.",
    "wave_gauge_position.",
    "wave_reflection.",
)


class AppliedCalibration(NamedTuple):
    """A model with the values of a written calibration.

    Attributes:
        model: The model.
        values: Calibrated values that are used, by label.
        undetermined: Labels of used values that the calibration's records did not determine.
        not_used: Labels of calibrated values that are not used.
        reference: Sea state that exponents among the values count from (m, s); None without exponents.
        campaign: Name of the calibration's campaign.
        platform: Name of the calibration's platform.
        converged: Whether the calibration converged.
        strips: Conventions of strip loads, where they differ from the model's; else None.
        seas: How waves are made and act, where the calibration says so; else None.
    """

    model: Model
    values: dict[str, float]
    undetermined: tuple[str, ...]
    not_used: tuple[str, ...]
    reference: SeaState | None
    campaign: str
    platform: str
    converged: bool
    strips: StripConventions | None
    seas: Options | None


def apply_calibration(path: str | PathLike[str], model: Model, platform: str, everything: bool = False) -> AppliedCalibration:
    """Apply a written calibration to a model.

    For the calibration's own platform all values are used. For another platform only those of hull and damping are used,
    since moorings and the like belong to a campaign. The strip conventions of the calibration are used too.

    Args:
        path: A calibration.json or diagnosis.json, or a folder with one.
        model: The model.
        platform: Name of the model's platform.
        everything: Whether all values are used in any case.

    Returns:
        The model with the calibrated values.

    Raises:
        InputError: If the file is no calibration, or has values that the model lacks or that are out of range.
    """
    saved = read_saved(path)
    with_strips = model if saved.strips is None else saved.strips.applied_to(model)
    # without drag there is no speed of it
    strips = saved.strips if StripConventions.of(with_strips) != StripConventions.of(model) else None
    model = with_calibrated_loads(saved, with_strips, path)
    use_all = everything or not saved.platform or saved.platform == platform
    values = {k: v for k, v in saved.values().items() if use_all or not k.startswith(CAMPAIGN_PARAMETERS)}
    if not saved.values():
        raise file_error(Path(path), "at least one calibrated parameter", "none", f"{saved.key}.parameters")
    if unknown := [label for label in values if label not in model.values]:
        raise unknown_values_error(saved, unknown, model, platform, path)
    for label, value in values.items():
        about = model.about(label)
        slack = 1e-6 * max(abs(value), abs(about.lower) if about.lower > -math.inf else 0.0)
        if not about.lower - slack <= value <= about.upper + slack:
            expected = f"a number between {about.lower:g} and {about.upper:g}"
            raise file_error(Path(path), expected, f"{value:g}", f"{saved.key}.parameters.{label}.value")
    undetermined = tuple(label for label in values if not saved.best.parameters[label].identifiable)
    not_used = tuple(label for label in saved.values() if label not in values)
    reference = _reference(saved) if exponents_of(model.loads) & values.keys() else None
    model = model.at_values(values)
    of_file = (saved.campaign, saved.platform, saved.best.converged, strips)
    seas = None if saved.seas is None else saved.seas.options()
    return AppliedCalibration(model, values, undetermined, not_used, reference, *of_file, seas)


def unknown_values_error(
    saved: CalibrationFile, unknown: list[str], model: Model, platform: str, path: str | PathLike[str]
) -> InputError:
    """Error for calibrated values that a model does not have."""
    expected = f"parameters of {platform} ({', '.join(sorted(model.values)) or 'it has none'})"
    names, hint = ", ".join(map(shown, unknown)), model.shared_hint(unknown[0])
    return file_error(Path(path), expected, names, f"{saved.key}.parameters", hint or suggest(unknown[0], model.values))


def with_calibrated_loads(saved: CalibrationFile, model: Model, path: str | PathLike[str]) -> Model:
    """Add to a model the loads that calibrated values need and its platform file lacks, at neutral values.

    These are laws of drag, laws over the sea state, and effects that a diagnosis found.
    """
    model = _with_laws(saved, _with_drag(saved, model, path), path)
    added = [label for label in saved.values() if label not in model.values]
    if saved.augmented is None or not added:
        return model
    from calibration.discovery.effects.candidates import with_effects

    try:
        model = with_effects(model, added)
        # files of before that parameter have the law of the envelope
        groups = [label for label in model.values if label.startswith("wave_drift_damping.") and label.endswith(".steady")]
        return model.with_values({label: 0.0 for label in groups if label not in saved.values()})
    except (KeyError, ValueError) as error:
        message = str(error.args[0] if error.args else error)
        expected = "parameters that the platform declares, or of effects that this version knows"
        raise file_error(Path(path), expected, message, "augmented.parameters") from None


def _with_drag(saved: CalibrationFile, model: Model, path: str | PathLike[str]) -> Model:
    """Replace plain drag of a model by the drag laws that were calibrated.

    Raises:
        InputError: The platform has other laws, or no such drag.
    """
    plain, model_laws, laws = plain_drag(model), drag_laws_of(model), saved.best.drag_laws
    where = f"{saved.key}.drag_laws"
    for label, law in laws.items():
        if label not in plain and label not in model_laws:
            coefficients = [*plain, *model_laws]
            expected = f"drag coefficients ({', '.join(coefficients) or 'there are none'})"
            hint = model.shared_hint(label) or suggest(label, coefficients)
            raise file_error(Path(path), expected, repr(label), where, hint)
        if label in model_laws and not _same_law(model_laws[label], law):
            expected = f"the law that the platform declares ({_law_in_words(model_laws[label])})"
            raise file_error(Path(path), expected, _law_in_words(law), f"{where}.{label}")
    for label in saved.values():
        if label in model_laws and label not in laws and not _is_neutral(model_laws[label]):
            expected = f"the law that the platform declares ({_law_in_words(model_laws[label])})"
            raise file_error(Path(path), expected, "plain drag", f"{where}.{label}", "A coefficient goes with its law.")
    return with_drag_laws(model, {label: law for label, law in laws.items() if label in plain})


def _is_neutral(law: DragLaw) -> bool:
    """Whether a law is at its neutral value, plain drag."""
    if isinstance(law, HighPass):
        return (law.low_share == 1 or law.cutoff == 0) and not getattr(law, "suction", None)
    return not (law.exponent if isinstance(law, KeuleganCarpenter) else getattr(law, "suction", 0))


def _same_law(first: DragLaw, second: DragLaw) -> bool:
    """Whether laws differ in nothing but calibrated parameters."""

    def constants(law: DragLaw) -> dict[str, Any]:
        return law.model_dump(include={"law", "reference", "window"})

    return constants(first) == constants(second)


def _law_in_words(law: DragLaw) -> str:
    return ", ".join(f"{key}: {value}" for key, value in law.model_dump(exclude_none=True).items())


def _reference(saved: CalibrationFile) -> SeaState | None:
    stated = saved.best.sea_state_reference
    return None if stated is None else SeaState(stated.significant_height, stated.peak_period)


def _with_laws(saved: CalibrationFile, model: Model, path: str | PathLike[str]) -> Model:
    """Add to a model the laws over the sea state whose exponents were calibrated."""
    exponents = {exponent_label(label, over): (label, over) for label in model.values for over in EXPONENT_BASES}
    labels = [label for label in saved.values() if label in exponents]
    if not labels:
        return model
    reference = _reference(saved)
    if reference is None:
        where, stated = f"{saved.key}.sea_state_reference", "nothing"
        raise file_error(Path(path), f"the sea state that {labels[0]} counts from", stated, where)
    try:
        loads = with_exponents(model.loads, {exponents[label]: 0.0 for label in labels}, reference)
        return replace(model, loads=loads)
    except ValueError as error:
        where = f"{saved.key}.sea_state_reference"
        raise file_error(Path(path), "the reference that the platform declares", str(error), where) from None
