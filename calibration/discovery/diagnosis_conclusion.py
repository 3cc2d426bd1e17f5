"""Conclusion of a search: effects with evidence, verdict, next test."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.discovery.diagnosis import Diagnosis, Finding, Outcome
from calibration.discovery.diagnosis_fits import calibration_of, estimates_of, values_as_estimates
from calibration.discovery.doubts import doubted_effects, doubts_of
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.effects.effect_names import effect_in_words
from calibration.discovery.latent_force.recover_force import latent_of
from calibration.discovery.predictions import predictions_of
from calibration.discovery.reported_effects import IMPLAUSIBLE_SIZE, Effect, Evidence, PlausibleRange
from calibration.discovery.residual_anatomy import anatomy, signature
from calibration.fitting.fit_conclusion import records_not_followed

if TYPE_CHECKING:
    from calibration.discovery.fit_state import FitState
    from calibration.discovery.search import Search

# of a motion: a larger residual, above twice the noise, is unexplained. Fitted seas of synthetic campaigns with nothing missing
# leave up to 0.04
MAX_RESIDUAL_SHARE = {"decay": 0.03, "waves": 0.05}
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
    baseline = calibration_of(campaign, search, before, None)
    augmented = calibration_of(campaign, search, after, baseline)
    at_end = {
        one.name: IMPLAUSIBLE_SIZE
        for one in after.chosen
        if any(size.at_end for size in plausible_ranges(search, one, after).values())
    }
    doubted = at_end | doubted_effects(search, after, baseline, augmented)
    effects = (*first, *(accepted_effect(search, one, after, doubted.get(one.name)) for one in after.chosen))
    share, words = signature(search, before, after)
    left = anatomy(search, after)
    more = unexplained_motions(search, left)
    sure = [one for one in effects if one.in_doubt is None]
    verdict = Outcome.FOUND if sure else (Outcome.UNEXPLAINED if effects or more else Outcome.NOTHING_MISSING)
    lost = records_not_followed([test for test in augmented.tests if test.kind == "decay"], search.setup.declared)
    latent = latent_of(search, augmented) if verdict == Outcome.UNEXPLAINED else ()
    return Diagnosis(
        campaign.manifest.name,
        verdict,
        baseline,
        augmented,
        effects,
        tuple(search.rejected.values()),
        tuple(search.scores),
        anatomy(search, before),
        left,
        share,
        words,
        next_test(search, after, verdict),
        (*lost, *doubts_of(search, after, augmented, more), *notes),
        seconds,
        latent,
        search.study.options if search.study.seas else None,
        predictions=predictions_of(search, after, augmented.tests),
    )


def unexplained_motions(search: Search, left: Sequence[Finding]) -> list[Finding]:
    """Residuals of fitted tests that exceed both noise and the usual error of a model, the largest first.

    Only motions that a test is about count.
    """
    kinds = {one.test: "decay" if one.kind == "decay" else "waves" for one in search.study.series}
    main = {(one.test, one.channel) for one, own in zip(search.study.series, search.study.main) if own}
    told = [one for one in left if one.use == "fit" and (one.test, one.channel) in main]
    more = [one for one in told if one.rms > 2 * one.noise and one.relative > MAX_RESIDUAL_SHARE[kinds[one.test]]]
    return sorted(more, key=lambda one: -one.relative)


def next_test(search: Search, after: FitState, verdict: Outcome) -> str:
    """The test that would tell the effects found from others; without any, that of the best rejected one."""
    if verdict == Outcome.UNEXPLAINED:
        last = [one for one in search.scores if one.round == search.scores[-1].round]
        best = max(last, key=lambda one: one.gain, default=None)
        name = None if best is None else (best.effect, best.degree_of_freedom)
        mine = [one for one in search.setup.candidates if (one.effect, one.dof) == name]
        return "; ".join(
            f"{one.telling} (of what was tried, {effect_in_words(one.name)} came nearest)" for one in mine if one.telling
        )
    return next((one.telling for one in after.chosen if one.telling), "")


def accepted_effect(search: Search, one: Candidate, after: FitState, doubt: str | None) -> Effect:
    """An effect of the final model, with its evidence.

    Args:
        search: The search.
        one: The effect.
        after: Fit of the final model.
        doubt: Why it is in doubt (see `Effect.in_doubt`), or None.
    """
    found, used = search.found[one.name], search.study.used
    left, now = float(found.before.left.squares[used].sum()), float(found.after.left.squares[used].sum())
    meanings = dict.fromkeys(search.study.model.about(label).meaning for label in one.amplitudes)
    held = found.verdict.held if found.verdict.unseen else float("nan")
    parameters = estimates_of(search, after, one.labels) | values_as_estimates(search, after, one.choices)
    left_out = found.held_out[np.abs(found.held_out) > 0]
    evidence = Evidence(
        found.score,
        found.verdict.bic,
        held,
        found.verdict.clear,
        found.probability,
        float(left_out.sum()) if len(left_out) else math.nan,
        float((left_out > 0).mean()) if len(left_out) else math.nan,
    )
    return Effect(
        one.effect,
        one.dof,
        "; ".join(meanings),
        one.source,
        parameters,
        evidence,
        max(0.0, 1 - now / left) if left > 0 else 0.0,
        found.alike,
        one.telling or None,
        doubt,
        plausible_ranges(search, one, after),
    )


def plausible_ranges(search: Search, one: Candidate, state: FitState) -> dict[str, PlausibleRange]:
    """Plausible ranges of an effect's amplitudes, and which sizes in a fit are at an end."""
    ranges = {}
    for label in one.amplitudes:
        size, value = search.setup.plausible[label], search.study.value(label, state.look.place.x)
        null = search.study.space.free[search.study.labels.index(label)].start
        near = END_SHARE * (size.upper - size.lower)
        at_end = any(abs(value - end) < near < abs(end - null) for end in (size.lower, size.upper))
        ranges[label] = PlausibleRange(size.lower, size.upper, size.source, at_end)
    return ranges
