"""Conclusion of a search: effects with evidence, verdict, next test."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.discovery.diagnosis import Diagnosis, MotionResidual, Outcome
from calibration.discovery.diagnosis_fits import calibration_of, estimates_of, values_as_estimates
from calibration.discovery.doubts import doubted_effects, doubts_of
from calibration.discovery.effect_fits import EffectFits
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.effects.effect_names import effect_in_words
from calibration.discovery.fit_state import FitState
from calibration.discovery.latent_force.recover_force import latent_of
from calibration.discovery.predictions import predictions_of
from calibration.discovery.reported_effects import IMPLAUSIBLE_SIZE, WAVE_ORDER, Effect, Evidence, PlausibleRange
from calibration.discovery.residual_anatomy import anatomy, signature
from calibration.discovery.score_covariance import parameter_covariance
from calibration.discovery.search import Search
from calibration.fitting.fit_conclusion import records_not_followed

# of a motion: a larger residual, above twice the noise, is unexplained. Fitted seas of synthetic campaigns with nothing missing
# leave up to 0.04
MAX_RESIDUAL_SHARE = {"decay": 0.03, "waves": 0.05}
MIN_CORRELATION = 0.9  # of two effects' sizes that trade against each other
END_SHARE = 0.005  # of a plausible range: a size that is nearer to an end is at the end


def conclude(
    campaign: Campaign,
    search: Search,
    before: FitState,
    after: FitState,
    notes: Sequence[str],
    seconds: float,
    first: Sequence[Effect] = (),
) -> Diagnosis:
    """Assemble the diagnosis from a finished or stopped search.

    Args:
        campaign: The campaign.
        search: The search.
        before: Fit of the baseline.
        after: Fit of the last model.
        notes: Notes to report, in words.
        seconds: Computing time (s).
        first: Effects found before the search began.
    """
    fits, record = search
    baseline = calibration_of(campaign, fits, before, None)
    augmented = calibration_of(campaign, fits, after, baseline)
    at_end = {
        candidate.name: IMPLAUSIBLE_SIZE
        for candidate in after.chosen
        if any(size.at_end for size in plausible_ranges(fits, candidate, after).values())
    }
    doubted = at_end | doubted_effects(search, after, baseline, augmented)
    effects = (*first, *(accepted_effect(search, candidate, after, doubted.get(candidate.name)) for candidate in after.chosen))
    share, words = signature(fits, before, after)
    residuals = anatomy(fits, after)
    more = unexplained_motions(fits, residuals)
    sure = [effect for effect in effects if effect.in_doubt is None]
    verdict = Outcome.FOUND if sure else (Outcome.UNEXPLAINED if effects or more else Outcome.NOTHING_MISSING)
    lost = records_not_followed([test for test in augmented.tests if test.kind == "decay"], fits.setup.baseline)
    latent = latent_of(fits, augmented) if verdict == Outcome.UNEXPLAINED else ()
    return Diagnosis(
        campaign.manifest.name,
        verdict,
        baseline,
        augmented,
        effects,
        tuple(replace(rejected, limits=record.limits.get(name, ())) for name, rejected in record.rejected.items()),
        tuple(record.scores),
        anatomy(fits, before),
        residuals,
        share,
        words,
        "" if WAVE_ORDER in doubted.values() else next_test(search, after, verdict),  # `records` has to be stated first
        (*lost, *doubts_of(fits, after, augmented, more), *notes),
        seconds,
        latent,
        fits.study.options if fits.study.seas else None,
        predictions=predictions_of(fits, after, augmented.tests),
    )


def unexplained_motions(fits: EffectFits, residuals: Sequence[MotionResidual]) -> list[MotionResidual]:
    """Residuals of fitted tests that exceed both noise and the usual error of a model, the largest first.

    Only motions that a test is about count.
    """
    kinds = {series.test: "decay" if series.kind == "decay" else "waves" for series in fits.study.series}
    main = {(series.test, series.channel) for series, is_main in zip(fits.study.series, fits.study.main) if is_main}
    told = [finding for finding in residuals if finding.use == "fit" and (finding.test, finding.channel) in main]
    more = [
        finding
        for finding in told
        if finding.rms > 2 * finding.noise and finding.relative > MAX_RESIDUAL_SHARE[kinds[finding.test]]
    ]
    return sorted(more, key=lambda finding: -finding.relative)


def next_test(search: Search, after: FitState, verdict: Outcome) -> str:
    """The test that would tell the effects found from others; without any, that of the best rejected one."""
    fits, record = search
    if verdict == Outcome.UNEXPLAINED:
        last = [score for score in record.scores if score.round == record.scores[-1].round]
        best = max(last, key=lambda score: score.gain, default=None)
        name = None if best is None else (best.effect, best.degree_of_freedom)
        mine = [candidate for candidate in fits.setup.candidates if (candidate.effect, candidate.dof) == name]
        return "; ".join(
            f"{candidate.telling} (of what was tried, {effect_in_words(candidate.name)} came nearest)"
            for candidate in mine
            if candidate.telling
        )
    return next((candidate.telling for candidate in after.chosen if candidate.telling), "")


def accepted_effect(search: Search, candidate: Candidate, after: FitState, doubt: str | None) -> Effect:
    """An effect of the final model, with its evidence.

    Args:
        search: The search.
        candidate: The effect.
        after: Fit of the final model.
        doubt: Why it is in doubt (see `Effect.in_doubt`), or None.
    """
    fits, accepted = search.fits, search.record.accepted[candidate.name]
    used = fits.study.used
    before, now = float(accepted.before.summary.squares[used].sum()), float(accepted.after.summary.squares[used].sum())
    meanings = dict.fromkeys(fits.study.model.about(label).meaning for label in candidate.amplitudes)
    held = accepted.verdict.held if accepted.verdict.unseen else float("nan")
    parameters = estimates_of(fits, after, candidate.labels) | values_as_estimates(fits, after, candidate.choices)
    left_out = accepted.held_out[np.abs(accepted.held_out) > 0]
    evidence = Evidence(
        accepted.score,
        accepted.verdict.bic,
        held,
        accepted.verdict.clear,
        accepted.probability,
        float(left_out.sum()) if len(left_out) else math.nan,
        float((left_out > 0).mean()) if len(left_out) else math.nan,
    )
    return Effect(
        candidate.effect,
        candidate.dof,
        "; ".join(meanings),
        candidate.source,
        parameters,
        evidence,
        max(0.0, 1 - now / before) if before > 0 else 0.0,
        accepted.alike,
        candidate.telling or None,
        doubt,
        plausible_ranges(fits, candidate, after),
        correlated_effects(fits, candidate, after),
    )


def correlated_effects(fits: EffectFits, candidate: Candidate, state: FitState) -> dict[str, float]:
    """Other effects in a fit whose sizes trade against an effect's, with the correlation of the two amplitudes that do most.

    Args:
        fits: Study, candidates, priors.
        candidate: The effect.
        state: The fit.
    """
    covariance = parameter_covariance(fits.study, state.linearisation, fits.prior(state.chosen))
    deviation = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    correlation = covariance / np.outer(deviation, deviation)

    def columns(effect: Candidate) -> list[int]:
        return [state.linearisation.active.index(i) for i in fits.study.index(effect.amplitudes)]

    trades = {}
    for other in state.chosen:
        between = correlation[np.ix_(columns(candidate), columns(other))].ravel()
        most = float(between[np.argmax(np.abs(between))])
        if other is not candidate and abs(most) > MIN_CORRELATION:
            trades[other.name] = round(most, 3)
    return trades


def plausible_ranges(fits: EffectFits, candidate: Candidate, state: FitState) -> dict[str, PlausibleRange]:
    """Plausible ranges of an effect's amplitudes, and which sizes in a fit are at an end."""
    ranges = {}
    for label in candidate.amplitudes:
        size, value = fits.setup.plausible[label], fits.study.value(label, state.linearisation.point.x)
        null = fits.study.space.free[fits.study.labels.index(label)].start
        near = END_SHARE * (size.upper - size.lower)
        at_end = any(abs(value - end) < near < abs(end - null) for end in (size.lower, size.upper))
        ranges[label] = PlausibleRange(size.lower, size.upper, size.source, at_end)
    return ranges
