"""Writing of a diagnosis: diagnosis.json, simulated.nc, figures."""

import math
from collections.abc import Mapping
from dataclasses import asdict
from os import PathLike
from pathlib import Path

import numpy as np

from calibration.discovery.diagnosis import Diagnosis, MotionResidual, Prediction, Rejected, Score
from calibration.discovery.refusal import RefusalKind
from calibration.discovery.reported_effects import Effect
from calibration.discovery.reported_forces import LatentForce
from calibration.results import write_calibration as outputs
from calibration.results.diagnosis_file import (
    Anatomy,
    DetectionLimit,
    DiagnosisFile,
    EffectScore,
    Evidence,
    FoundEffect,
    MissingEffects,
    PlausibleSizeRange,
    PredictedMotion,
    RejectedEffect,
    Residual,
    ResidualBand,
)
from calibration.results.diagnosis_motions import motions_with_effects, paired
from calibration.results.latent_force_file import ForceLaw, ForceRelation, ForceTerm, SavedLatentForce, Unexplained
from calibration.results.refusal_sentences import describe_refusal
from calibration.results.result_folder import DIAGNOSIS_FILE, draw, outdated, write_motion
from jaxhydro.files import staged
from jaxhydro.result_model import finite_or_null, stated
from jaxhydro.units import for_people, unit_of

PROBABILITY_KINDS = (RefusalKind.IMPROBABLE, RefusalKind.UNSETTLED)
PROBABILITY_DIGITS = 3


def write_diagnosis(diagnosis: Diagnosis, folder: str | PathLike[str], figures: bool = True) -> Path:
    """Write all results of a diagnosis into a folder.

    The results of an earlier diagnosis there are replaced when the new ones are complete. Its report page is removed; other
    files stay. Angles are in degrees.

    Args:
        diagnosis: The diagnosis.
        folder: The folder, made where absent.
        figures: Whether figures are drawn.

    Returns:
        The folder.

    Raises:
        NotFinite: A parameter or the objective of the fitted tests is not finite.
        InputError: The folder cannot be written.
    """
    folder, compared = Path(folder), paired(diagnosis)
    with staged(folder, lambda temporary: outdated(folder, temporary, DIAGNOSIS_FILE)) as temporary:
        content, drawn = document(diagnosis), []
        if figures:
            from calibration.plots import diagnosis_figures as plots

            drawn = draw(plots.figures(diagnosis, compared), temporary)
        content.model_copy(update={"figures": drawn}).write(temporary / DIAGNOSIS_FILE)
        write_motion(motions_with_effects(diagnosis, compared), temporary)
    return folder


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
            effects=[_effect(effect) for effect in diagnosis.effects],
            rejected=[_rejected(rejected) for rejected in diagnosis.rejected],
            unexplained=Unexplained(
                share=_share(diagnosis.unexplained_share),
                signature=diagnosis.signature,
                **stated(forces=[_latent(force) for force in diagnosis.latent]),
            ),
        ),
        augmented=augmented.baseline,
        tests=augmented.tests,
        scores=[_score(score) for score in diagnosis.scores],
        anatomy=Anatomy(
            before=[_residual(finding) for finding in diagnosis.anatomy_before],
            after=[_residual(finding) for finding in diagnosis.anatomy_after],
        ),
        predictions=[_prediction(prediction) for prediction in diagnosis.predictions],
        next_test=diagnosis.next_test,
        notes=list(diagnosis.notes),
        seconds=finite_or_null(diagnosis.seconds),
    )


def _short(label: str, effect: Effect | Rejected) -> str:
    """`force` of `coulomb_friction.surge.force`."""
    return label.removeprefix(f"{effect.effect}.").removeprefix(f"{effect.degree_of_freedom}.")


def _rejected(rejected: Rejected) -> RejectedEffect:
    limits = {
        _short(limit.label, rejected): DetectionLimit(
            smallest=finite_or_null(limit.smallest),
            largest=finite_or_null(limit.largest),
            plausible=float(limit.plausible),
            told=float(limit.told),
            unit=limit.unit,
        )
        for limit in rejected.limits
    }
    return RejectedEffect(
        effect=rejected.effect,
        degree_of_freedom=rejected.degree_of_freedom,
        reason=describe_refusal(rejected.reason),
        **stated(probability=_probability(rejected), detection_limits=limits),
    )


def _effect(effect: Effect) -> FoundEffect:
    return FoundEffect(
        effect=effect.effect,
        degree_of_freedom=effect.degree_of_freedom,
        meaning=effect.meaning,
        source=effect.source,
        parameters={
            _short(label, effect): outputs.parameter(value, label=value.label) for label, value in effect.parameters.items()
        },
        evidence=Evidence(**_finite(asdict(effect.evidence) | {"probability": _rounded(effect.evidence.probability)})),
        share_of_residual_explained=_share(effect.share),
        indistinguishable_from=list(effect.indistinguishable),
        test_that_would_tell=effect.telling_test,
        **stated(in_doubt=effect.in_doubt),
        plausible={_short(label, effect): PlausibleSizeRange(**asdict(size)) for label, size in effect.plausible.items()},
        trades_against=dict(effect.trades_against),
    )


def _probability(rejected: Rejected) -> float | None:
    """Probability of an effect that is rejected for it."""
    return _rounded(rejected.reason.values[0]) if rejected.reason.kind in PROBABILITY_KINDS else None


def _rounded(probability: float) -> float:
    """A probability to the digits that resampling gives."""
    return round(probability, PROBABILITY_DIGITS)


def _latent(force: LatentForce) -> SavedLatentForce:
    law = force.law
    return SavedLatentForce(
        degree_of_freedom=force.motion,
        unit=force.unit,
        rms=_finite(force.rms),
        bands={kind: _finite(row) for kind, row in force.shares.items()},
        follows={
            kind: {name: ForceRelation(**_finite(asdict(relation))) for name, relation in row.items()}
            for kind, row in force.coherence.items()
        },
        grows_as_power_of=_finite(force.growth),
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
        words=force.words,
    )


def _finite(values: Mapping[str, float]) -> dict[str, float | None]:
    return {name: finite_or_null(value) for name, value in values.items()}


def _share(value: float) -> float:
    """A share as JSON has it; 0 in place of 0/0."""
    return 0.0 if math.isnan(value) else float(np.clip(value, -1e9, 1e9))


def _score(score: Score) -> EffectScore:
    return EffectScore(
        round=score.round,
        effect=score.effect,
        degree_of_freedom=score.degree_of_freedom,
        gain=finite_or_null(score.gain),
        parameters=score.size,
        holdout_gain=finite_or_null(score.holdout),
        refitted_gain=finite_or_null(score.refitted),
        refitted_holdout_gain=finite_or_null(score.refitted_holdout),
    )


def _prediction(prediction: Prediction) -> PredictedMotion:
    def shown(value: float) -> float | None:
        return finite_or_null(float(for_people(prediction.channel, value)))

    return PredictedMotion(
        test=prediction.test,
        channel=prediction.channel,
        unit=unit_of(prediction.channel),
        samples=len(prediction.half_width),
        inside=prediction.inside,
        half_width=shown(float(np.sqrt(np.mean(prediction.half_width**2)))),
        parameter_error=shown(prediction.parameter_error),
        model_error=shown(prediction.model_error),
    )


def _residual(finding: MotionResidual) -> Residual:
    return Residual(
        test=finding.test,
        use=finding.use,
        channel=finding.channel,
        unit=unit_of(finding.channel),
        rms=finite_or_null(float(for_people(finding.channel, finding.rms))),
        noise=finite_or_null(float(for_people(finding.channel, finding.noise))),
        relative=finite_or_null(finding.relative),
        bands=[
            ResidualBand(low=float(low), high=float(high), rms_over_noise=finite_or_null(ratio))
            for low, high, ratio in finding.bands
        ],
        words=finding.words,
    )
