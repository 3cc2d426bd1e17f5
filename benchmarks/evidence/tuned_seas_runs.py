"""Coefficients calibrated to the two lower seas of FOCAL campaign 2, from two starts and by laws."""

from typing import Any

from benchmarks.evidence.common import SHARED, TRUE, cached

NAME = "tuned_seas"
FOLDER = SHARED / "measured"
DECAY, PUBLISHED = "focal-c4", "table-1"  # starts: fitted to campaign 4's decay, and the paper's Table 1
STARTS = (DECAY, PUBLISHED)
LAWS = ("significant_height", "keulegan_carpenter", "high_pass")  # begun from PUBLISHED
ALONE, SEAS = "-alone", ("sea-3m", "sea-6m", "sea-8m")


def decays() -> dict[str, float]:
    """Values of the coefficients calibrated to campaign 4's surge decay, by label."""
    from calibration import calibrate, load_campaign

    return {label: p.value for label, p in calibrate(load_campaign(FOLDER / "focal-c4")).parameters.items()}


def start_of(key: str, name: str) -> dict[str, float]:
    """Coefficients that a calibration begins from."""
    sideways = {"linear_damping.B22": TRUE["linear_damping.B11"], "linear_damping.B44": TRUE["linear_damping.B55"]}
    return cached(NAME, key, "decays") if name == DECAY else TRUE | sideways


def band_errors(result: Any) -> dict[str, Any]:
    """Use of each test, and errors of its energies before and after, by channel and band."""
    return {
        test.id: {"use": test.use}
        | {channel: {band: [error.before, error.after] for band, error in row.items()} for channel, row in test.bands.items()}
        for test in result.tests
    }


def tuned(key: str, name: str) -> dict[str, Any]:
    """One calibration in waves.

    Args:
        key: Key of the section's results.
        name: A start; a law; or a sea and `ALONE`, a calibration to that sea from where the constants ended.
    """
    from dataclasses import replace

    from calibration import calibrate_in_waves, load_campaign
    from calibration.fitting.law_parameters import LAWS as OF_LAW

    campaign, law, start = load_campaign(FOLDER / "focal-c2"), name if name in LAWS else "constant", {}
    if name.endswith(ALONE):
        ended = cached(NAME, key, PUBLISHED)["parameters"]
        start = {label: parameter["value"] for label, parameter in ended.items()}
        only = name.removesuffix(ALONE)
        records = [replace(r, use="fit" if r.id == only else "ignore") for r in campaign.records]
        campaign = replace(campaign, records=tuple(records))
    else:
        start = start_of(key, PUBLISHED if name in LAWS else name)
    over, drag = OF_LAW[law]
    result = calibrate_in_waves(campaign, start=start, over=over, drag=drag)
    assert result.identifiability is not None
    return {
        "parameters": {
            label: {"start": p.start, "value": p.value, "deviation": p.standard_deviation, "unit": p.unit}
            for label, p in result.parameters.items()
        },
        "bands": band_errors(result),
        "relative": {test.id: {s.channel: s.relative for s in test.series if s.scored} for test in result.tests},
        "said": list(result.identifiability.sentences()),
        "history": list(result.history),
        "converged": result.converged,
        "seconds": result.seconds,
    }
