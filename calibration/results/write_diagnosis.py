"""Writing of a diagnosis: diagnosis.json, simulated.nc, figures."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict, replace
from os import PathLike
from pathlib import Path

import numpy as np
import xarray as xr

from calibration.discovery.diagnosis import Diagnosis, Finding, Prediction, Rejected, Score
from calibration.discovery.refusal import RefusalKind
from calibration.discovery.reported_effects import Effect
from calibration.discovery.reported_forces import LatentForce
from calibration.result import BandError, Calibration, Series, TestFit
from calibration.results import write_calibration as outputs
from calibration.results.diagnosis_file import (
    Anatomy,
    DiagnosisFile,
    EffectScore,
    Evidence,
    ForceLaw,
    ForceRelation,
    ForceTerm,
    FoundEffect,
    MissingEffects,
    PlausibleSizeRange,
    PredictedMotion,
    RejectedEffect,
    Residual,
    ResidualBand,
    SavedLatentForce,
    Unexplained,
)
from calibration.results.refusal_sentences import describe_refusal
from calibration.results.result_folder import DIAGNOSIS_FILE, draw, outdated, write_motion
from calibration.results.tests_dataset import dataset
from jaxhydro.files import staged
from jaxhydro.result_model import finite_or_null, stated
from jaxhydro.units import for_people, unit_of

PROBABILITY_KINDS = (RefusalKind.IMPROBABLE, RefusalKind.UNSETTLED)
PROBABILITY_DIGITS = 3


def write_diagnosis(diagnosis: Diagnosis, folder: str | PathLike[str], figures: bool = True) -> Path:
    """Write all results into `folder` (made where absent); gives the folder.

    The results of an earlier diagnosis there are replaced when the new ones are complete, its report page taken away; other
    files stay. Angles are in degrees. Raises NotFinite, and InputError where the folder cannot be written.
    """
    folder, compared = Path(folder), paired(diagnosis)
    with staged(folder, lambda temporary: outdated(folder, temporary, DIAGNOSIS_FILE)) as temporary:
        content, drawn = document(diagnosis), []
        if figures:
            from calibration.plots import diagnosis_figures as plots

            drawn = draw(plots.figures(diagnosis, compared), temporary)
        content.model_copy(update={"figures": drawn}).write(temporary / DIAGNOSIS_FILE)
        write_motion(motions(diagnosis, compared), temporary)
    return folder


def motions(diagnosis: Diagnosis, compared: Calibration) -> xr.Dataset:
    """Content of simulated.nc: motions measured, and simulated without and with what was found missing, in m and deg.

    Args:
        diagnosis: The diagnosis.
        compared: The two fits, `paired`.
    """
    motion = dataset(compared)
    motion.attrs["title"] = f"Diagnosis of {diagnosis.campaign}"
    motion["simulated"].attrs["long_name"] = "motion of the model with what was found missing"
    motion["before"].attrs["long_name"] = "motion of the baseline"
    return with_bands(motion, diagnosis) if diagnosis.predictions else motion


def document(diagnosis: Diagnosis, damping: bool = True) -> DiagnosisFile:
    """Content of diagnosis.json without figures.

    Args:
        diagnosis: The diagnosis.
        damping: Whether decays are analysed for linear and quadratic damping, which takes most of the time.

    Raises:
        NotFinite: A parameter or the objective of the fitted tests is not finite.
    """
    augmented = outputs.document(paired(diagnosis), damping)
    return DiagnosisFile(
        campaign=diagnosis.campaign,
        platform=diagnosis.baseline.platform,
        **stated(seas=diagnosis.seas and asdict(diagnosis.seas)),
        jaxhydro=augmented.jaxhydro,
        complete=diagnosis.complete,
        baseline=outputs.fitted_model(diagnosis.baseline),
        missing=MissingEffects(
            verdict=diagnosis.verdict,
            effects=[_effect(one) for one in diagnosis.effects],
            rejected=[
                RejectedEffect(
                    effect=one.effect,
                    degree_of_freedom=one.degree_of_freedom,
                    reason=describe_refusal(one.reason),
                    **stated(probability=_probability(one)),
                )
                for one in diagnosis.rejected
            ],
            unexplained=Unexplained(
                share=_share(diagnosis.unexplained_share),
                signature=diagnosis.signature,
                **stated(forces=[_latent(one) for one in diagnosis.latent]),
            ),
        ),
        augmented=augmented.baseline,
        tests=augmented.tests,
        scores=[_score(one) for one in diagnosis.scores],
        anatomy=Anatomy(
            before=[_residual(one) for one in diagnosis.anatomy_before],
            after=[_residual(one) for one in diagnosis.anatomy_after],
        ),
        predictions=[_prediction(one) for one in diagnosis.predictions],
        next_test=diagnosis.next_test,
        notes=list(diagnosis.notes),
        seconds=finite_or_null(diagnosis.seconds),
    )


def _effect(one: Effect) -> FoundEffect:
    def short(label: str) -> str:  # `force` of `coulomb_friction.surge.force`
        return label.removeprefix(f"{one.effect}.").removeprefix(f"{one.degree_of_freedom}.")

    return FoundEffect(
        effect=one.effect,
        degree_of_freedom=one.degree_of_freedom,
        meaning=one.meaning,
        source=one.source,
        parameters={short(label): outputs.parameter(value, label=value.label) for label, value in one.parameters.items()},
        evidence=Evidence(**_finite(asdict(one.evidence) | {"probability": _rounded(one.evidence.probability)})),
        share_of_residual_explained=_share(one.share),
        indistinguishable_from=list(one.indistinguishable),
        test_that_would_tell=one.telling_test,
        **stated(in_doubt=one.in_doubt),
        plausible={short(label): PlausibleSizeRange(**asdict(size)) for label, size in one.plausible.items()},
    )


def _probability(one: Rejected) -> float | None:
    """Probability of an effect that is rejected for it."""
    return _rounded(one.reason.values[0]) if one.reason.kind in PROBABILITY_KINDS else None


def _rounded(probability: float) -> float:
    """A probability to the digits that resampling gives."""
    return round(probability, PROBABILITY_DIGITS)


def _latent(one: LatentForce) -> SavedLatentForce:
    law = one.law
    return SavedLatentForce(
        degree_of_freedom=one.motion,
        unit=one.unit,
        rms=_finite(one.rms),
        bands={kind: _finite(row) for kind, row in one.shares.items()},
        follows={
            kind: {name: ForceRelation(**_finite(asdict(relation))) for name, relation in row.items()}
            for kind, row in one.coherence.items()
        },
        grows_as_power_of=_finite(one.growth),
        law=ForceLaw(
            terms=[
                ForceTerm(term=term.name, coefficient=finite_or_null(term.coefficient), unit=term.unit) for term in law.terms
            ],
            share=finite_or_null(law.share),
            share_of=law.checked,
            share_fitted=finite_or_null(law.fitted),
            v0=finite_or_null(law.v0),
            omega=finite_or_null(law.pace),
        ),
        words=one.words,
    )


def _finite(values: Mapping[str, float]) -> dict[str, float | None]:
    return {name: finite_or_null(value) for name, value in values.items()}


def _share(value: float) -> float:
    """A share as JSON has it; of nothing at all (0/0) it is 0."""
    return 0.0 if math.isnan(value) else float(np.clip(value, -1e9, 1e9))


def _score(one: Score) -> EffectScore:
    return EffectScore(
        round=one.round,
        effect=one.effect,
        degree_of_freedom=one.degree_of_freedom,
        gain=finite_or_null(one.gain),
        parameters=one.size,
        holdout_gain=finite_or_null(one.holdout),
        refitted_gain=finite_or_null(one.refitted),
        refitted_holdout_gain=finite_or_null(one.refitted_holdout),
    )


def _prediction(one: Prediction) -> PredictedMotion:
    def shown(value: float) -> float | None:
        return finite_or_null(float(for_people(one.channel, value)))

    return PredictedMotion(
        test=one.test,
        channel=one.channel,
        unit=unit_of(one.channel),
        samples=len(one.half_width),
        inside=one.inside,
        half_width=shown(float(np.sqrt(np.mean(one.half_width**2)))),
        parameter_error=shown(one.parameter_error),
        model_error=shown(one.model_error),
    )


def with_bands(motion: xr.Dataset, diagnosis: Diagnosis) -> xr.Dataset:
    """Motions of the tests, with half the widths of the predictions' bands beside them."""
    widths = xr.full_like(motion["simulated"], np.nan)
    times = {test.id: test.time for test in diagnosis.augmented.tests}
    for one in diagnosis.predictions:
        time = times[one.test]
        half_width = for_people(one.channel, one.half_width)
        widths.loc[{"test": one.test, "channel": one.channel}] = np.interp(
            motion["time"], time - time[0], half_width, left=np.nan, right=np.nan
        )
    widths.attrs["long_name"] = "half the width of the band in which 95 % of a held-out test's samples are expected"
    return motion.assign(half_width=widths)


def _residual(one: Finding) -> Residual:
    return Residual(
        test=one.test,
        use=one.use,
        channel=one.channel,
        unit=unit_of(one.channel),
        rms=finite_or_null(float(for_people(one.channel, one.rms))),
        noise=finite_or_null(float(for_people(one.channel, one.noise))),
        relative=finite_or_null(one.relative),
        bands=[
            ResidualBand(low=float(low), high=float(high), rms_over_noise=finite_or_null(ratio))
            for low, high, ratio in one.bands
        ],
        words=one.words,
    )


def paired(diagnosis: Diagnosis) -> Calibration:
    """The augmented model's calibration, the baseline's motion and band errors in it as those before."""
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
    """The baseline's motions on the sensor offsets of the augmented fit, so that residuals stay what they were."""
    there = {series.channel: series for series in before}
    for series in after:
        other = there.get(series.channel)
        if other is not None and len(other.simulated) == len(series.measured):
            yield series.channel, other.simulated + (series.measured - other.measured)


def _band(before: TestFit, channel: str, band: str, one: BandError) -> float:
    found = before.bands.get(channel, {}).get(band)
    return one.before if found is None else found.after
