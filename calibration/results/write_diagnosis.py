"""Writing of a diagnosis: diagnosis.json, simulated.nc, figures."""

import math
from collections.abc import Iterable
from dataclasses import asdict, replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from calibration.discovery.diagnosis import Diagnosis, Effect, Finding, LatentForce, Score
from calibration.result import BandError, Calibration, Estimate, Series, TestFit
from calibration.results import write_calibration as outputs
from calibration.results.result_folder import DIAGNOSIS_FILE, draw, finite_or_null, outdated, write_json, write_motion
from calibration.results.write_calibration import NotFinite, dataset
from jaxhydro.files import staged
from jaxhydro.units import for_people, unit_of


def write_diagnosis(diagnosis: Diagnosis, folder: str | PathLike[str], figures: bool = True) -> Path:
    """Write all results into `folder` (made where absent); gives the folder.

    The results of an earlier diagnosis there are replaced when the new ones are complete, its report page taken away; other
    files stay. Angles are in degrees. Raises NotFinite, and InputError where the folder cannot be written.
    """
    folder, compared = Path(folder), paired(diagnosis)
    with staged(folder, lambda temporary: outdated(folder, temporary, DIAGNOSIS_FILE)) as temporary:
        content = document(diagnosis)
        drawn = []
        if figures:
            from calibration.plots import diagnosis_figures as plots

            drawn = draw(plots.figures(diagnosis, compared), temporary)
        write_json({**content, "figures": drawn}, temporary / DIAGNOSIS_FILE)
        motion = dataset(compared)
        motion.attrs["title"] = f"Diagnosis of {diagnosis.campaign}"
        motion["simulated"].attrs["long_name"] = "motion of the model with what was found missing"
        motion["before"].attrs["long_name"] = "motion of the declared model, calibrated"
        write_motion(motion, temporary)
    return folder


def document(diagnosis: Diagnosis) -> dict[str, Any]:
    """The content of diagnosis.json. See outputs.schema.json; what goes beyond it is for reports. Raises NotFinite."""
    before, after = outputs.document(diagnosis.baseline), outputs.document(paired(diagnosis))
    return {
        "campaign": diagnosis.campaign,
        "platform": before["platform"],
        **({} if diagnosis.seas is None else {"seas": asdict(diagnosis.seas)}),
        "jaxhydro": before["jaxhydro"],
        "complete": diagnosis.complete,
        "baseline": before["baseline"],
        "missing": {
            "verdict": diagnosis.verdict,
            "effects": [_effect(one) for one in diagnosis.effects],
            "rejected": [
                {"effect": one.effect, "degree_of_freedom": one.degree_of_freedom, "reason": one.reason}
                for one in diagnosis.rejected
            ],
            "unexplained": {
                "share": _share(diagnosis.unexplained_share),
                "signature": diagnosis.signature,
                **({"forces": [_latent(one) for one in diagnosis.latent]} if diagnosis.latent else {}),
            },
        },
        "augmented": after["baseline"],
        "tests": after["tests"],
        "scores": [_score(one) for one in diagnosis.scores],
        "anatomy": {
            "before": [_finding(one) for one in diagnosis.anatomy_before],
            "after": [_finding(one) for one in diagnosis.anatomy_after],
        },
        "next_test": diagnosis.next_test,
        "notes": list(diagnosis.notes),
        "seconds": finite_or_null(diagnosis.seconds),
    }


def _effect(one: Effect) -> dict[str, Any]:
    evidence = one.evidence
    return {
        "effect": one.effect,
        "degree_of_freedom": one.degree_of_freedom,
        "meaning": one.meaning,
        "source": one.source,
        "parameters": {_short(one, name): _parameter(name, value) for name, value in one.parameters.items()},
        "evidence": {
            "score": finite_or_null(evidence.score),
            "delta_bic": finite_or_null(evidence.delta_bic),
            "holdout_gain": finite_or_null(evidence.holdout_gain),
            "clear": finite_or_null(evidence.clear),
        },
        "share_of_residual_explained": _share(one.share),
        "indistinguishable_from": list(one.indistinguishable),
        "test_that_would_tell": one.telling_test,
        **({} if one.in_doubt is None else {"in_doubt": one.in_doubt}),
    }


def _short(one: Effect, name: str) -> str:
    """A parameter's name within its effect: `force` of `coulomb_friction.surge.force`."""
    return name.removeprefix(f"{one.effect}.").removeprefix(f"{one.degree_of_freedom}.")


def _parameter(name: str, one: Estimate) -> dict[str, Any]:
    if not math.isfinite(one.value):
        raise NotFinite(f"the parameter {name} of what was found is not finite")
    return {
        "value": float(one.value),
        "standard_deviation": finite_or_null(one.standard_deviation),
        "unit": one.unit,
        "at_bound": one.at_bound,
        "identifiable": one.identifiable,
        "label": one.label,
        "meaning": one.meaning,
    }


def _latent(one: LatentForce) -> dict[str, Any]:
    """A latent force: SI, rad."""
    law = one.law
    return {
        "degree_of_freedom": one.motion,
        "unit": one.unit,
        "rms": {kind: finite_or_null(value) for kind, value in one.rms.items()},
        "bands": {kind: {band: finite_or_null(share) for band, share in row.items()} for kind, row in one.shares.items()},
        "follows": {
            kind: {
                name: {
                    "coherence": finite_or_null(f.coherence),
                    "phase": finite_or_null(f.phase),
                    "correlation": finite_or_null(f.correlation),
                }
                for name, f in row.items()
            }
            for kind, row in one.coherence.items()
        },
        "grows_as_power_of": {name: finite_or_null(power) for name, power in one.growth.items()},
        "law": {
            "terms": [
                {"term": term.name, "coefficient": finite_or_null(term.coefficient), "unit": term.unit} for term in law.terms
            ],
            "share": finite_or_null(law.share),
            "share_of": law.checked,
            "share_fitted": finite_or_null(law.fitted),
            "v0": finite_or_null(law.v0),
            "omega": finite_or_null(law.pace),
        },
        "words": one.words,
    }


def _share(value: float) -> float:
    """A share as JSON has it; of nothing at all (0/0) it is 0."""
    return 0.0 if math.isnan(value) else float(np.clip(value, -1e9, 1e9))


def _score(one: Score) -> dict[str, Any]:
    return {
        "round": one.round,
        "effect": one.effect,
        "degree_of_freedom": one.degree_of_freedom,
        "gain": finite_or_null(one.gain),
        "parameters": one.size,
        "holdout_gain": finite_or_null(one.holdout),
        "refitted_gain": finite_or_null(one.refitted),
        "refitted_holdout_gain": finite_or_null(one.refitted_holdout),
    }


def _finding(one: Finding) -> dict[str, Any]:
    return {
        "test": one.test,
        "use": one.use,
        "channel": one.channel,
        "unit": unit_of(one.channel),
        "rms": finite_or_null(float(for_people(one.channel, one.rms))),
        "noise": finite_or_null(float(for_people(one.channel, one.noise))),
        "relative": finite_or_null(one.relative),
        "bands": [
            {"low": float(low), "high": float(high), "rms_over_noise": finite_or_null(ratio)} for low, high, ratio in one.bands
        ],
        "words": one.words,
    }


def paired(diagnosis: Diagnosis) -> Calibration:
    """The augmented model's calibration, the calibrated declared model's motion and band errors in it as those before."""
    first = {test.id: test for test in diagnosis.baseline.tests}
    tests = tuple(_paired(first[test.id], test) if test.id in first else test for test in diagnosis.augmented.tests)
    return replace(diagnosis.augmented, tests=tests)


def _paired(before: TestFit, after: TestFit) -> TestFit:
    return replace(
        after,
        start=dict(_motions(before.series, after.series)),
        bands={
            channel: {band: one._replace(before=_band(before, channel, band, one)) for band, one in row.items()}
            for channel, row in after.bands.items()
        },
    )


def _motions(before: Iterable[Series], after: Iterable[Series]) -> Iterable[tuple[str, np.ndarray]]:
    """The declared model's motions on the sensor offsets of the augmented fit, so that residuals stay what they were."""
    there = {series.channel: series for series in before}
    for series in after:
        other = there.get(series.channel)
        if other is not None and len(other.simulated) == len(series.measured):
            yield series.channel, other.simulated + (series.measured - other.measured)


def _band(before: TestFit, channel: str, band: str, one: BandError) -> float:
    found = before.bands.get(channel, {}).get(band)
    return one.before if found is None else found.after
