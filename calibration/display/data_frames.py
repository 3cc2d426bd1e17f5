"""Campaigns, calibrations and diagnoses as pandas data frames, and as HTML tables for notebooks."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from calibration.campaign.load_campaign import Campaign
from calibration.discovery.diagnosis import Diagnosis
from calibration.display.summaries import campaign_summary, diagnosis_summary, verdict_of_calibration
from calibration.result import Calibration
from jaxhydro.display.data_frames import html


def parameters_frame(calibration: Calibration) -> pd.DataFrame:
    """Data frame of `Calibration.to_dataframe`."""
    rows = {
        label: (
            parameter.value,
            _number(parameter.standard_deviation),
            parameter.unit,
            parameter.start,
            parameter.identifiable,
            parameter.at_bound,
            parameter.meaning,
        )
        for label, parameter in calibration.parameters.items()
    }
    columns = ["value", "standard_deviation", "unit", "start", "identifiable", "at_bound", "meaning"]
    return _frame(rows, columns, "parameter")


def effects_frame(diagnosis: Diagnosis) -> pd.DataFrame:
    """Data frame of `Diagnosis.to_dataframe`."""
    rows: dict[str, tuple[Any, ...]] = {}
    for effect in diagnosis.effects:
        evidence = effect.evidence
        about = (evidence.probability, evidence.delta_bic, evidence.holdout_gain, effect.share, effect.in_doubt is not None)
        for label, parameter in effect.parameters.items():
            size = effect.plausible.get(label)
            plausible = (np.nan, np.nan) if size is None else (size.lower, size.upper)
            estimate = (parameter.value, _number(parameter.standard_deviation), parameter.unit)
            rows[label] = (effect.effect, effect.degree_of_freedom, *estimate, *plausible, *about)
    columns = ["effect", "motion", "value", "standard_deviation", "unit", "lower", "upper"]
    columns += ["probability", "delta_bic", "holdout_gain", "explained", "in_doubt"]
    return _frame(rows, columns, "parameter")


def tests_frame(campaign: Campaign) -> pd.DataFrame:
    """Data frame of `Campaign.to_dataframe`."""
    rows = {
        record.id: (
            record.kind,
            record.use,
            record.degree_of_freedom,
            float(record.time[-1] - record.time[0]),
            float(np.median(np.diff(record.time))),
            len(record.time),
            record.file,
        )
        for record in campaign.records
    }
    return _frame(rows, ["kind", "use", "released", "duration_s", "step_s", "samples", "file"], "test")


def _frame(rows: Mapping[str, Sequence[Any]], columns: list[str], name: str) -> pd.DataFrame:
    """A data frame of rows by label; `name` is that of its index."""
    return pd.DataFrame(list(rows.values()), columns=columns, index=pd.Index(list(rows), name=name, dtype=object))


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
