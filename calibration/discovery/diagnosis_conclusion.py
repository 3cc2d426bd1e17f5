"""Conclusion of a search: fits before and after, effects with evidence, verdict."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.runs import runs
from calibration.discovery.diagnosis import Diagnosis, Finding, Outcome
from calibration.discovery.doubts import doubted_effects, doubts_of
from calibration.discovery.effects.candidates import Candidate, with_candidates, with_effects
from calibration.discovery.effects.effect_names import effect_in_words
from calibration.discovery.eliminated_least_squares import predict_gain
from calibration.discovery.latent_force.recover_force import latent_of
from calibration.discovery.predictions import predictions_of
from calibration.discovery.reported_effects import IMPLAUSIBLE_SIZE, Effect, Evidence, PlausibleRange
from calibration.discovery.residual_anatomy import anatomy, signature
from calibration.fitting.fit_conclusion import records_not_followed
from calibration.residuals.measured_seas import peak_period
from calibration.result import BandError, Calibration, Estimate, Series, TestFit
from jaxhydro.analysis.sea_statistics import bands_of
from jaxhydro.analysis.spectral import band_weights
from jaxhydro.dynamics.model import Model
from jaxhydro.environment import DOFS

if TYPE_CHECKING:
    from calibration.discovery.fit_state import FitState
    from calibration.discovery.linearisations import Point
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
        before: Fit of the declared model.
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


def augmented_model(search: Search, state: FitState) -> Model:
    """The declared model with the effects found, all parameters as fitted."""
    active = search.active(state.chosen)
    moved = np.abs(search.study.directions[active]).sum(axis=0) > 0
    values = {label: search.study.value(label, state.look.place.x) for label, m in zip(search.study.labels, moved) if m}
    values |= {label: search.study.value(label, state.look.place.x) for one in state.chosen for label in one.choices}
    own = [one for one in state.chosen if one.load is not None]
    return with_effects(with_candidates(search.setup.declared, own), values).at_values(values)


def estimates_of(search: Search, state: FitState, names: Sequence[str]) -> dict[str, Estimate]:
    """Estimates with standard deviations of directions that are one parameter each."""
    look, study = state.look, search.study
    prior = search.prior(state.chosen)
    deviations = predict_gain(study, look, prior).deviation
    values = {}
    for name in names:
        i = study.names.index(name)
        if i not in look.active or name not in study.labels:
            continue
        k = study.labels.index(name)
        free, x, deviation = study.space.free[k], look.place.x[k], float(deviations[look.active.index(i)])
        slope = (float(free.transform.forward(x + 1e-4)) - float(free.transform.forward(x - 1e-4))) / 2e-4
        about = study.model.about(name)
        known = bool(deviation < 0.5 * prior.width[i])
        size = abs(slope) * deviation * float(study.directions[i, k])
        value = study.value(name, look.place.x)
        ends = np.array([about.lower, about.upper])
        bound = free.transform.at_bound(float(x)) or bool(np.isclose(value, ends, rtol=1e-6, atol=0.0).any())
        values[name] = Estimate(name, value, size if known else None, about.unit, about.meaning, free.start, bound, known)
    return values


def calibration_of(campaign: Campaign, search: Search, state: FitState, before: Calibration | None) -> Calibration:
    """A fit as a calibration result: parameters, tests, errors in bands.

    Args:
        campaign: The campaign.
        search: The search.
        state: The fit.
        before: An earlier fit whose motions are compared with, or None.
    """
    effects = [label for one in state.chosen for label in one.labels]
    nuisances = [name for name in search.setup.nuisances if name in search.study.labels and name not in effects]
    names = [*search.setup.base, *nuisances, *effects]
    lines = [one.label for one in search.study.space.free if one.label.startswith("mooring.")]
    choices = [label for one in state.chosen for label in one.choices]
    parameters = estimates_of(search, state, names) | _as_given(search, state, lines, False) | _as_given(search, state, choices)
    tests = test_fits_at(campaign, search, state.look.place)
    if before is not None:
        earlier = {test.id: test for test in before.tests}
        tests = [_with_start(test, earlier[test.id]) for test in tests]
    return Calibration(
        campaign.manifest.name,
        augmented_model(search, state),
        parameters,
        tuple(tests),
        state.settled,
        state.iterations,
        0.0,
        (),
        (),
        campaign.platform.name,
        None,
    )


def _as_given(search: Search, state: FitState, labels: Sequence[str], known: bool = True) -> dict[str, Estimate]:
    """Values without standard deviations: of discrete choices, and of mooring lines that move together."""
    found = {}
    for label in labels:
        about, start = search.study.model.about(label), search.study.space.free[search.study.labels.index(label)].start
        value = search.study.value(label, state.look.place.x)
        found[label] = Estimate(label, value, None, about.unit, about.meaning, start, False, known)
    return found


def _with_start(test: TestFit, before: TestFit) -> TestFit:
    """A test with the motions and errors of an earlier fit as its start."""
    start = {}
    for mine, other in zip(test.series, before.series):
        start[mine.channel] = other.simulated - other.offset + mine.offset if test.kind != "decay" else other.simulated
    bands = {
        name: {k: BandError(one.after, before.bands[name][k].after, one.low, one.high) for k, one in row.items()}
        for name, row in test.bands.items()
    }
    return replace(test, start=start, bands=bands)


def test_fits_at(campaign: Campaign, search: Search, place: Point) -> list[TestFit]:
    """Measured and simulated motions of every test at a point."""
    study = search.study
    motions = study.motions(place)
    found = {}
    if study.decays is not None:
        data = study.decays.data
        in_decays = np.asarray(motions.pop(0)).reshape(len(study.decay_records), len(data.dofs), -1)
        offsets = place.own.reshape(len(study.decay_records), 3, -1)[:, 2] * np.asarray(data.unit)
        for record, residual, offset in zip(study.decay_records, in_decays, offsets):
            rows = []
            for j, dof in enumerate(data.dofs):
                channel = DOFS[dof]
                if channel in record.values:
                    off = float(offset[j])
                    measured = record.values[channel] - off
                    simulated = measured + residual[j, : len(measured)]
                    scored = channel == record.degree_of_freedom
                    rows.append(Series(channel, measured, simulated, off, record.noise[channel], scored))
            dof_name = record.degree_of_freedom
            found[record.id] = TestFit(record.id, record.use, "decay", dof_name, record.time, tuple(rows), {}, record.file)
    by_id = {r.id: r for r in campaign.records}
    all_runs = runs(campaign) if study.seas else ()
    peaks = {record.id: peak_period(run, record, campaign.manifest.scale) for run in all_runs for record in run.records}
    for sea, residuals in zip(study.seas, motions):
        n = sea.measured.shape[-1]
        every = np.asarray(residuals).reshape(len(sea.tests), -1, n)
        for test, begin, values, residual in zip(sea.tests, sea.begins, np.asarray(sea.measured), every):
            record = by_id[test]
            series = tuple(
                Series(DOFS[dof], m, m + r, 0.0, record.noise[DOFS[dof]], DOFS[dof] in search.setup.motions)
                for dof, m, r in zip(sea.dofs, values, residual)
            )
            time = np.asarray(sea.times[begin : begin + n])
            bands = _bands(series, float(time[1] - time[0]), peaks[test]) if record.kind == "irregular" else {}
            found[test] = TestFit(test, record.use, record.kind, None, time, series, {}, record.file, bands)
    return [found[r.id] for r in campaign.records if r.id in found]


def _bands(series: Sequence[Series], step: float, period: float) -> dict[str, dict[str, BandError]]:
    """Relative errors of energy in frequency bands, for a sea of this peak period (s)."""
    found: dict[str, dict[str, BandError]] = {}
    for one in series:
        if not one.scored:
            continue
        row = {}
        for name, (low, high) in bands_of(one.channel, period).items():
            weights = band_weights(len(one.measured), step, low, high)
            measured, simulated = weights.integral(one.measured), weights.integral(one.simulated)
            row[name] = BandError(float(simulated / measured - 1), float("nan"), low, high)
        found[one.channel] = row
    return found


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
    parameters = estimates_of(search, after, one.labels) | _as_given(search, after, one.choices)
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
    found = {}
    for label in one.amplitudes:
        size, value = search.setup.plausible[label], search.study.value(label, state.look.place.x)
        null = search.study.space.free[search.study.labels.index(label)].start
        near = END_SHARE * (size.upper - size.lower)
        at_end = any(abs(value - end) < near < abs(end - null) for end in (size.lower, size.upper))
        found[label] = PlausibleRange(size.lower, size.upper, size.source, at_end)
    return found
