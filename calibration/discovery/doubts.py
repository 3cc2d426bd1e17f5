"""Doubts about a diagnosis: effects that may stand for others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from calibration.discovery.acceptance import Verdict, worsening
from calibration.discovery.diagnosis import MotionResidual
from calibration.discovery.effect_fits import EffectFits
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.effects.effect_names import capitalised, effect_in_words
from calibration.discovery.fit_state import FitState, ResidualSummary
from calibration.discovery.reported_effects import HELD_OUT_ERROR, WAVE_ORDER
from calibration.discovery.search import Search
from calibration.discovery.study import Study
from calibration.formatting import listed, number, percent
from calibration.result import Calibration
from jaxhydro.environment import DOFS

MAX_DECAY_RESIDUAL = 0.1  # of a decay's motion, that a joint fit may leave
MAX_RESIDUAL_RATIO = 3.0  # of a joint fit's residual to that of a fit to decays alone
MAX_RELEASE_SPEED = 0.2  # of a decay's first sample, over release times natural frequency
MEMORY_EFFECTS = ("hidden_oscillator", "radiation_memory", "computed_radiation", "potential_flow", "hysteresis")
SQUARED_WAVE_EFFECTS = ("wave_drift", "wave_drift_damping", "drift_transfer", "slender_body_forces")
# of the held-out error to that of the baseline. True effects increase it to 1.01 times at most in the campaigns of
# docs/validation.md, since likelihoods are not errors
MAX_HELD_OUT_RATIO = 1.05
MAX_COEFFICIENT_RATIO = 3.0  # of a coefficient to its declared value, or the inverse


def doubts_of(fits: EffectFits, state: FitState, fitted: Calibration, more: Sequence[MotionResidual]) -> list[str]:
    """Notes on doubts about the final fit.

    Args:
        fits: Study, candidates, priors.
        state: The final fit.
        fitted: The same as a calibration.
        more: Residuals beyond noise that are left.
    """
    beside = [unexplained_note(state.chosen, more)] if state.chosen and more else []
    return [*moving_release_notes(fits, state), *beside, *far_coefficient_notes(fits, fitted)]


def abandoned_decays(study: Study, alone: ResidualSummary, now: ResidualSummary) -> list[str]:
    """Decays that a fit to decays alone follows and a joint fit to decays and seas does not, in words.

    Args:
        study: The study.
        alone: Residual of the fit to decays alone.
        now: Residual of the joint fit.
    """
    notes = []
    for i, series in enumerate(study.series):
        if series.kind == "decay" and study.used[i] and study.main[i] and series.spread > 0:
            before, after = float(alone.error[i]) / series.spread, float(now.error[i]) / series.spread
            if after > max(MAX_DECAY_RESIDUAL, MAX_RESIDUAL_RATIO * before):
                notes.append(
                    f"fitted together with the seas, the decay {series.test} is given up: {percent(after)} of its motion is "
                    f"left, {percent(before)} where decays are fitted alone. The model cannot follow both, and what is said of "
                    f"{series.channel} is in doubt"
                )
    return notes


def worsened_motions(study: Study, baseline: ResidualSummary, now: ResidualSummary) -> list[str]:
    """Motions that the model with all effects follows worse than the baseline, in words.

    Args:
        study: The study.
        baseline: Residual of the fitted baseline.
        now: Residual of the model with the effects.
    """
    notes = []
    for i in np.flatnonzero(worsening(study, baseline, now) > 1):
        series = study.series[i]
        before, after = (percent(float(summary.error[i]) / series.spread) for summary in (baseline, now))
        notes.append(
            f"{series.channel} of {series.test} is followed worse than by the baseline: {after} of the motion is left, "
            f"{before} before"
        )
    return notes


def outdone_effects(worth: Mapping[str, float], tried: Mapping[str, Verdict]) -> dict[str, str]:
    """Effects that explain less than a rejected effect does with all of them in the model.

    If the law that follows the fitted tests best does not hold in other tests, the true law is in no candidate. A small effect
    may then be its nearest likeness only.

    Args:
        worth: Gain of every effect in fitted and held-out tests, by name.
        tried: Verdicts of removed effects, by name. From earlier searches, the last round's verdicts are included.

    Returns:
        The rejected effect by the name of the effect that it outdoes.
    """
    refused = {name: verdict.bic for name, verdict in tried.items() if verdict.refused}
    if not refused or any(name in worth for name in tried if name not in refused):  # the round let something in: there is more
        return {}
    best = max(refused, key=refused.__getitem__)
    return {name: best for name, gain in worth.items() if refused[best] > gain}


def doubted_effects(search: Search, state: FitState, before: Calibration, after: Calibration) -> dict[str, str]:
    """Effects in doubt at the end of a search, with the reason.

    Reasons, the later overriding the earlier:

    - a rejected effect explains more (`outdone_effects`);
    - the held-out error rose, in all or in the effect's motion;
    - the effect goes with the square of the waves, and the wave records lack the second order that the model is driven with.
    """
    tried = {name: rejected.taken_out for name, rejected in search.record.rejected.items() if rejected.taken_out is not None}
    verdicts = {candidate.name: search.record.accepted[candidate.name].verdict for candidate in state.chosen}
    doubted = outdone_effects({name: verdict.worth for name, verdict in verdicts.items()}, tried)
    every = held_out_error_rose(before.objective("holdout"), after.objective("holdout"))
    worse = [dof for dof in DOFS if held_out_error_rose(before.objective("holdout", dof), after.objective("holdout", dof))]
    doubted |= {candidate.name: HELD_OUT_ERROR for candidate in state.chosen if every or candidate.dof in worse}
    if search.fits.study.order_hint:
        doubted |= {candidate.name: WAVE_ORDER for candidate in state.chosen if candidate.effect in SQUARED_WAVE_EFFECTS}
    return doubted


def held_out_error_rose(before: float | None, after: float | None) -> bool:
    """Whether the held-out objective clearly exceeds that of the baseline; None: no such test."""
    return before is not None and after is not None and after > MAX_HELD_OUT_RATIO * before


def unexplained_note(chosen: Sequence[Candidate], more: Sequence[MotionResidual]) -> str:
    """Note that the effects found do not make the model follow the records."""
    names, worst = [effect_in_words(candidate.effect, candidate.dof) for candidate in chosen], more[0]
    added = names[0] if len(names) == 1 else f"all {len(names)} effects"
    return (
        f"with {added} in the model, {percent(worst.relative)} of {worst.channel} is left in {worst.test}. Something else "
        "acts instead, or as well"
    )


def moving_release_notes(fits: EffectFits, state: FitState) -> list[str]:
    """Note on decays that begin in motion, where an effect with memory was found."""
    names = [
        effect_in_words(candidate.effect, candidate.dof) for candidate in state.chosen if candidate.effect in MEMORY_EFFECTS
    ]
    study, moving = fits.study, []
    if study.decays is None or not names:
        return []
    for record, release in zip(study.decay_records, state.linearisation.point.own.reshape(len(study.decay_records), 3, -1)):
        i = study.decays.data.dofs.index(DOFS.index(str(record.degree_of_freedom)))
        if abs(release[1, i]) > MAX_RELEASE_SPEED * float(np.hypot(*release[:2, i])):
            moving.append(record.id)
    if not moving:
        return []
    begin, have = "begin" if len(moving) > 1 else "begins", "have" if len(names) > 1 else "has"
    return [
        f"{listed(moving)} {begin} in motion. {capitalised(listed(names))} {have} a memory that is taken to be at rest before. "
        "Where it was not, sizes are wrong: let records begin at the release"
    ]


def far_coefficient_notes(fits: EffectFits, fitted: Calibration) -> list[str]:
    """Note on coefficients that end far from their values in the baseline."""
    estimates = [fitted.parameters[label] for label in fits.setup.base if label in fitted.parameters]
    far = [
        estimate
        for estimate in estimates
        if estimate.identifiable
        and estimate.start > 0
        and not 1 / MAX_COEFFICIENT_RATIO < estimate.value / estimate.start < MAX_COEFFICIENT_RATIO
    ]
    if not far:
        return []
    named = ", ".join(f"{estimate.label} {number(estimate.value, 2)} ({number(estimate.start, 2)})" for estimate in far)
    return [f"far from the platform file's values (in brackets): {named}. They may stand for something that the model lacks"]
