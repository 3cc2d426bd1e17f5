"""The paper's eleven coefficients calibrated to nine decays, and to nine decays with one sea."""

from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.evidence.common import SHARED

FOLDER = SHARED / "campaigns" / "nothing-missing"
CASES = {  # kinds of tests that are fitted, and what of the sea
    "decays": (("decays",), "bands"),
    "energies": (("decays", "waves"), "bands"),
    "motion": (("decays", "waves"), "motion"),
}


def facts() -> dict[str, Any]:
    """Number of decays; name, wave height (m), peak period (s) and duration (s) of the sea."""
    from calibration import load_campaign

    records = load_campaign(FOLDER).records
    sea = next(r for r in records if r.kind == "irregular")
    return {
        "decays": sum(r.kind == "decay" for r in records),
        "sea": sea.id,
        "height": float(sea.test.significant_wave_height),
        "period": float(sea.test.peak_period),
        "duration": float(np.ptp(sea.time)),
    }


def of_case(sea: str, name: str) -> dict[str, Any]:
    """One calibration, and what it determines.

    Args:
        sea: Name of the test in irregular waves.
        name: A case of `CASES`.
    """
    from calibration import calibrate_jointly, load_campaign
    from calibration.campaign.manifest_sections import Recording

    campaign, (kinds, objective) = load_campaign(FOLDER), CASES[name]
    linear = campaign.manifest.model_copy(update={"records": Recording(order=1)})  # as the README of the campaigns says
    records = tuple(
        replace(r, use="fit" if r.kind == "decay" or (r.id == sea and "waves" in kinds) else "ignore") for r in campaign.records
    )
    result = calibrate_jointly(replace(campaign, manifest=linear, records=records), kinds=kinds, objective=objective)  # type: ignore[arg-type]
    statement = result.identifiability
    assert statement is not None
    deviation = np.sqrt(np.diag(statement.covariance)) * np.abs(statement.parameters.relative())
    return {
        "deviation": dict(zip(statement.parameters.labels, map(float, deviation), strict=True)),
        "value": {label: estimate.value for label, estimate in result.parameters.items()},
        "spectrum": np.sort(statement.spectrum).tolist(),
        "said": list(statement.sentences()),
        "seconds": result.seconds,
    }
