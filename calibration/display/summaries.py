"""Short texts of campaigns, calibrations and diagnoses, for `repr`."""

import math
from collections import Counter

from calibration.campaign.grouped_findings import group_findings
from calibration.campaign.load_campaign import Campaign
from calibration.discovery.diagnosis import Diagnosis
from calibration.discovery.effects.effect_names import capitalised, effect_in_words
from calibration.formatting import counted, listed, number, readable_unit
from calibration.report.diagnosis_words import describe_parameter, describe_probability, describe_unexplained, verdict_sentence
from calibration.report.summary import calibration_sentence, summary_of
from calibration.report.tables import value_text
from calibration.result import Calibration
from calibration.results import write_calibration, write_diagnosis
from calibration.results.write_calibration import NotFinite
from calibration.vocabulary import KINDS, USE

MAX_ROWS = 12  # parameters, effects or groups of tests in a text


def calibration_summary(calibration: Calibration) -> str:
    """The result in a sentence, and the parameters with their standard deviations.

    Args:
        calibration: The calibration.
    """
    platform = f" of {calibration.platform}" if calibration.platform else ""
    head = [f"Calibration{platform} to campaign {calibration.campaign}"]
    head.append(verdict_of_calibration(calibration))
    rows = [
        (label, value_text(write_calibration.parameter(parameter)), readable_unit(parameter.unit))
        for label, parameter in calibration.parameters.items()
        if math.isfinite(parameter.value)
    ]
    width = max((len(label) for label, *_ in rows), default=0)
    lines = [f"  {label:<{width}}  {value} {unit}".rstrip() for label, value, unit in rows]
    return "\n".join([*head, *_limited(lines, "parameters")])


def verdict_of_calibration(calibration: Calibration) -> str:
    """Result of a calibration in one sentence."""
    try:
        return calibration_sentence(summary_of(write_calibration.document(calibration, damping=False)))
    except NotFinite as error:
        return f"{capitalised(str(error))}."


def diagnosis_summary(diagnosis: Diagnosis) -> str:
    """The verdict in a sentence, the effects with their sizes, and the unexplained rest.

    Args:
        diagnosis: The diagnosis.
    """
    head = [f"Diagnosis of campaign {diagnosis.campaign}"]
    try:
        saved = write_diagnosis.document(diagnosis, damping=False)
    except NotFinite as error:
        return "\n".join([*head, f"{capitalised(str(error))}."])
    head.append(verdict_sentence(saved))
    lines = [
        f"  {capitalised(effect_in_words(effect.effect, effect.degree_of_freedom))}: "
        f"{listed([describe_parameter(name, value) for name, value in effect.parameters.items()])}"
        f" (probability {describe_probability(effect.evidence.probability)})"
        for effect in saved.missing.effects
    ]
    return "\n".join([*head, *_limited(lines, "effects"), describe_unexplained(saved)])


def campaign_summary(campaign: Campaign) -> str:
    """Tests by kind, use and released motion.

    Args:
        campaign: The campaign.
    """
    manifest, scale = campaign.manifest, campaign.manifest.scale
    scaled = "" if scale == 1 else f", times {scale:g} by Froude"
    head = [f"Campaign {manifest.name}: {counted(len(campaign.records), 'test')} of {campaign.platform.name}{scaled}"]
    lines = []
    for kind in dict.fromkeys(record.kind for record in campaign.records):
        for use in USE:
            mine = [record for record in campaign.records if (record.kind, record.use) == (kind, use)]
            released = Counter(record.degree_of_freedom for record in mine if record.degree_of_freedom)
            motions = f" ({', '.join(f'{dof} {count}' for dof, count in released.items())})" if released else ""
            hours = sum(float(record.time[-1] - record.time[0]) for record in mine) / 3600
            if mine:
                lines.append(f"  {KINDS.get(kind, kind)}: {len(mine)} {USE[use]}{motions}, {number(hours, 2)} h")
    warnings = len(group_findings(campaign.findings))
    lines += [f"  {counted(warnings, 'warning')} about the records (`findings`)"] if warnings else []
    return "\n".join([*head, *lines])


def _limited(lines: list[str], noun: str) -> list[str]:
    """The first lines, and how many there are more."""
    more = len(lines) - MAX_ROWS
    return lines if more <= 0 else [*lines[:MAX_ROWS], f"  ... and {more} more {noun}: `to_dataframe()`"]
