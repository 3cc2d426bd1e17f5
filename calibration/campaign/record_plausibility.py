"""Plausibility of records: motions and periods compared with those of the platform."""

from collections.abc import Iterator, Sequence

import numpy as np

from calibration.campaign.campaign_hints import SAME_SCALE, Hint, campaign_hints
from calibration.campaign.finding import Finding, Severity
from calibration.campaign.manifest_sections import IN_WAVES
from calibration.campaign.records import Record
from calibration.campaign.signals import dominant_period, wave_height
from jaxhydro.analysis.sea_statistics import record_peak_period
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.rest_remarks import unrestored_motions
from jaxhydro.dynamics.statics import characteristic_length, equilibrium, natural_modes, widths
from jaxhydro.environment import DOFS
from jaxhydro.units import for_people, unit_of

# natural periods, measured against the model's: a second is 1000 milliseconds, a minute 60
UNUSUAL_PERIOD_RATIO, WRONG_PERIOD_RATIO = 3.0, 20.0
HEAVE_LIMITS = (0.5, 3.0)  # motions that are odd or wrong: of the radius of gyration
HORIZONTAL_LIMITS = (3.0, 6.0)  # ... in surge and sway, where moorings may be slack
ANGLE_LIMITS = (np.radians(60.0), np.radians(180.0))
# of the radius of gyration, rad: what nobody would release a platform from
SMALLEST_RELEASE, SMALLEST_RELEASE_ANGLE = 1e-3, 4e-3
SCALE_TOLERANCE = 0.15  # of a logarithm: a ratio that is the square root of the scale
MAX_REST_OFFSET = 0.02  # of the radius of gyration, or rad: where a platform is at rest
STEEPNESS_LIMITS = (1 / 7, 1.0)  # height over length: beyond 1/7 no wave stands (Michell 1893, Phil. Mag. 36)
FULL_SCALE, UNIT_OR_SCALE = "(full scale)", "a unit, or the scale?"
MAX_NOISE_SHARE = 0.5  # of a motion's deviation
EXPECTED_AGREEMENT = "records that agree with the manifest and the platform file"


class CampaignFinding(Finding):
    """A finding that all records of a campaign make together; its test and channel are the first."""


def check_plausible(records: Sequence[Record], model: Model, zeroed: bool, scale: float = 1.0) -> tuple[Finding, ...]:
    """Findings on the records that are used, at full scale, against the platform file's model.

    Args:
        records: Records of the campaign.
        model: Model of the platform file.
        zeroed: Whether a zero was subtracted from the records.
        scale: The manifest's scale.
    """
    used = [record for record in records if record.use != "ignore"]
    decays = [record for record in used if record.kind == "decay"]
    length, gravity = characteristic_length(model), float(model.environment.gravity)
    periods: dict[str, float] = {}
    findings: list[Finding] = []
    hints: tuple[Hint, ...] = ()
    if decays:
        rest = equilibrium(model)
        modes = natural_modes(model, rest)
        periods = {dof: modes.of(dof) for dof in DOFS if np.isfinite(modes.of(dof))}
        hints = campaign_hints(decays, modes, widths(model), length, scale)
        findings += [
            CampaignFinding("warning", h.record.file, h.record.id, h.channel, None, h.message, EXPECTED_AGREEMENT)
            for h in hints
        ]
        findings += [] if zeroed else _rest_findings(decays, dict(zip(DOFS, map(float, rest))), length)
    told = any(hint.channel == "time" for hint in hints)
    return (
        *findings,
        *(finding for record in used for finding in _record_findings(record, length, gravity, periods, scale, told)),
    )


def restoring_findings(records: Sequence[Record], model: Model) -> Iterator[Finding]:
    """Measured heave, roll or pitch of a platform without members that nothing in its file restores.

    A fit may then lean or sink the hull at the start of a record, to follow the other motions more closely.

    Args:
        records: Records of the campaign.
        model: Model of the platform file.
    """
    for name, key in unrestored_motions(model, equilibrium(model)).items():
        decays = [r for r in records if r.kind == "decay" and r.use != "ignore" and name in r.values]
        if decays:
            way_out = f"give hydrostatics.{key}"
            if not any(record.degree_of_freedom == name for record in decays):
                way_out += f", or take {name} out of `channels`"
            message = f"no members and no {key}: nothing restores {name}, and a fit may lean or sink the hull: {way_out}"
            yield CampaignFinding("warning", decays[0].file, decays[0].id, name, None, message)


def _rest_findings(decays: Sequence[Record], rest: dict[str, float], length: float) -> Iterator[Finding]:
    """Where nobody took a zero: do decays end where the platform floats?"""
    for name in DOFS:
        ends = [float(np.mean(record.values[name][len(record.time) // 2 :])) for record in decays if name in record.values]
        limit = MAX_REST_OFFSET * (1.0 if name in DOFS[3:] else length)
        if ends and abs(offset := float(np.median(ends)) - rest[name]) > limit:
            message = (
                f"decays end {_in_words(name, offset)} from the equilibrium of the platform file. `zero` would say where still "
                "water is: without it the difference is taken for ballast or a force"
            )
            yield Finding("warning", decays[0].file, decays[0].id, name, None, message)


def _record_findings(
    record: Record, length: float, gravity: float, periods: dict[str, float], scale: float, told: bool
) -> Iterator[Finding]:
    """Findings on one record. `told`: that all periods are off is said of the campaign."""

    def beyond(limits: tuple[float, float], ratio: float, channel: str, message: str, expected: str) -> Iterator[Finding]:
        if ratio > limits[0]:
            severity: Severity = "error" if ratio > limits[1] else "warning"
            yield Finding(severity, record.file, record.id, channel, None, message, expected)

    if record.kind == "decay" and record.degree_of_freedom in periods:
        name, model_period = record.degree_of_freedom, periods[record.degree_of_freedom]
        period = dominant_period(record.time, record.values[name])
        if period is not None:
            why, by_scale = _period_reason(period / model_period, scale)
            message = f"a period of {period:.3g} s {FULL_SCALE}, the model's is {model_period:.3g} s: {why}"
            limits, ratio = (
                (WRONG_PERIOD_RATIO if told else 1.0 if by_scale else UNUSUAL_PERIOD_RATIO, WRONG_PERIOD_RATIO),
                max(period / model_period, model_period / period),
            )
            yield from beyond(limits, ratio, name, message, f"a period of about {model_period:.3g} s")
    for name, values in record.values.items():
        size = float(np.percentile(np.abs(values - np.median(values)), 99))
        turns = name in DOFS[3:]
        if name == record.degree_of_freedom and size < (SMALLEST_RELEASE_ANGLE if turns else SMALLEST_RELEASE * length):
            hint = "degrees or radians?" if turns else UNIT_OR_SCALE
            yield Finding("warning", record.file, record.id, name, None, f"moves by {_in_words(name, size)} only: {hint}")
        if turns:
            message = f"an angle of {_in_words(name, size)}: degrees or radians?"
            yield from beyond(ANGLE_LIMITS, size, name, message, "an angle that a platform may have")
        else:
            gyration = f"the platform's radius of gyration is {length:.3g} m: {UNIT_OR_SCALE}"
            message = f"a motion of {size:.3g} m {FULL_SCALE}, and {gyration}"
            limits = HEAVE_LIMITS if name == "heave" else HORIZONTAL_LIMITS
            yield from beyond(limits, size / length, name, message, "a motion that a platform may have")
    if record.noise_declared and record.degree_of_freedom is not None:
        name = record.degree_of_freedom
        spread, noise = float(np.std(record.values[name])), record.noise[name]
        message = f"noise is stated as {_in_words(name, noise)}, where the motion's own deviation is {_in_words(name, spread)}"
        yield from beyond((MAX_NOISE_SHARE, np.inf), noise / spread, name, message, "")
    if record.wave is not None and record.kind in IN_WAVES:
        step = float(np.median(np.diff(record.time)))
        height = wave_height(record.wave, record.kind == "irregular")
        wavelength = gravity / (2 * np.pi) * record_peak_period(record.wave, step) ** 2
        message = f"waves {height:.3g} m high and {wavelength:.3g} m long {FULL_SCALE}: {UNIT_OR_SCALE}"
        yield from beyond(
            STEEPNESS_LIMITS, height / wavelength, "wave", message, "waves that do not break, less than 1/7 as high as long"
        )


def _period_reason(ratio: float, scale: float) -> tuple[str, bool]:
    """What may explain a measured period over the model's, and whether `scale` does."""
    if scale != 1 and abs(np.log(ratio / scale**0.5)) < SCALE_TOLERANCE:
        return f"longer by the square root of `scale`, {scale**0.5:.3g}. {SAME_SCALE}", True
    if scale != 1 and abs(np.log(ratio * scale**0.5)) < SCALE_TOLERANCE:
        return f"shorter by the square root of `scale`, {scale**0.5:.3g}. Were times scaled down before?", True
    if scale == 1 and 1 / WRONG_PERIOD_RATIO < ratio < 1 / UNUSUAL_PERIOD_RATIO:
        return f"a unit of time, or a `scale` of about {float(f'{ratio**-2:.2g}'):g}, as of a model?", False
    return "a unit of time, or the scale?", False


def _in_words(dof: str, value: float) -> str:
    return f"{float(for_people(dof, value)):.3g} {unit_of(dof)}"
