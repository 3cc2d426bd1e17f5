"""Campaigns, calibrations and diagnoses as pandas data frames, and as HTML tables for notebooks."""

import numpy as np
import pandas as pd

from calibration.campaign.load_campaign import Campaign
from calibration.discovery.diagnosis import Diagnosis
from calibration.display.summaries import campaign_summary, diagnosis_summary, verdict_of_calibration
from calibration.result import Calibration
from jaxhydro.display.data_frames import html


def parameters_frame(calibration: Calibration) -> pd.DataFrame:
    """Calibrated parameters, in their own units.

    Args:
        calibration: The calibration.

    Returns:
        Columns `value`, `standard_deviation` (NaN where the records do not determine the parameter), `unit`, `start`,
        `identifiable`, `at_bound` and `meaning`; index `parameter`.
    """
    rows = {
        label: {
            "value": one.value,
            "standard_deviation": _number(one.standard_deviation),
            "unit": one.unit,
            "start": one.start,
            "identifiable": one.identifiable,
            "at_bound": one.at_bound,
            "meaning": one.meaning,
        }
        for label, one in calibration.parameters.items()
    }
    columns = ["value", "standard_deviation", "unit", "start", "identifiable", "at_bound", "meaning"]
    return pd.DataFrame(list(rows.values()), columns=columns, index=pd.Index(list(rows), name="parameter", dtype=object))


def effects_frame(diagnosis: Diagnosis) -> pd.DataFrame:
    """Effects found, a row for each of their parameters, in SI units.

    Args:
        diagnosis: The diagnosis.

    Returns:
        Columns `effect`, `motion`, `value`, `standard_deviation`, `unit`, `lower` and `upper` (plausible range),
        `probability`, `delta_bic`, `holdout_gain`, `explained` (fraction of the unexplained error of the fitted tests) and
        `in_doubt`; index `parameter`.
    """
    rows = {}
    for effect in diagnosis.effects:
        for label, one in effect.parameters.items():
            size = effect.plausible.get(label)
            rows[label] = {
                "effect": effect.effect,
                "motion": effect.degree_of_freedom,
                "value": one.value,
                "standard_deviation": _number(one.standard_deviation),
                "unit": one.unit,
                "lower": np.nan if size is None else size.lower,
                "upper": np.nan if size is None else size.upper,
                "probability": effect.evidence.probability,
                "delta_bic": effect.evidence.delta_bic,
                "holdout_gain": effect.evidence.holdout_gain,
                "explained": effect.share,
                "in_doubt": effect.in_doubt is not None,
            }
    columns = ["effect", "motion", "value", "standard_deviation", "unit", "lower", "upper"]
    columns += ["probability", "delta_bic", "holdout_gain", "explained", "in_doubt"]
    return pd.DataFrame(list(rows.values()), columns=columns, index=pd.Index(list(rows), name="parameter", dtype=object))


def tests_frame(campaign: Campaign) -> pd.DataFrame:
    """Tests of a campaign, at full scale.

    Args:
        campaign: The campaign.

    Returns:
        Columns `kind`, `use`, `released` (motion of a decay), `duration_s`, `step_s`, `samples` and `file`; index `test`.
    """
    rows = [
        (
            record.kind,
            record.use,
            record.degree_of_freedom,
            float(record.time[-1] - record.time[0]),
            float(np.median(np.diff(record.time))),
            len(record.time),
            record.file,
        )
        for record in campaign.records
    ]
    columns = ["kind", "use", "released", "duration_s", "step_s", "samples", "file"]
    index = pd.Index([record.id for record in campaign.records], name="test", dtype=object)
    return pd.DataFrame(rows, columns=columns, index=index)


def calibration_html(calibration: Calibration) -> str:
    """The result in a sentence, and a table of the parameters."""
    heading = f"Calibration to campaign {calibration.campaign}\n{verdict_of_calibration(calibration)}"
    return html(heading, parameters_frame(calibration), index=True)


def diagnosis_html(diagnosis: Diagnosis) -> str:
    """The verdict in a sentence, and a table of the effects."""
    return html(diagnosis_summary(diagnosis), effects_frame(diagnosis), index=True)


def campaign_html(campaign: Campaign) -> str:
    """Tests by kind and use, and a table of all tests."""
    return html(campaign_summary(campaign), tests_frame(campaign), index=True)


def _number(value: float | None) -> float:
    return np.nan if value is None else value
