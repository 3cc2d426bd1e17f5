"""What a diagnosis says of the models before and after: parameters, every test, effects with their evidence."""

from __future__ import annotations

from typing import TYPE_CHECKING

import jax.numpy as jnp
import numpy as np

from calibration.campaign import Campaign
from calibration.discovery.catalogue import Candidate
from calibration.discovery.evidence import Frame, decay_residuals, sea_residual
from calibration.discovery.linear import predict
from calibration.discovery.result import Effect, Evidence
from calibration.result import BandError, Calibration, Estimate, Series, TestFit
from calibration.seas_results import bands_of
from jaxhydro.analysis import band_weights
from jaxhydro.environment import DOFS
from jaxhydro.model import Model

if TYPE_CHECKING:
    from calibration.discovery.search import Search, State


def augmented_model(search: Search, state: State) -> Model:
    """The declared model with what was found, every parameter as fitted."""
    from calibration.discovery.catalogue import with_effects

    x = state.reached.look.place.x
    labels = [label for one in state.chosen for label in (*one.amplitudes, *one.shapes)]
    moved = [search.study.names[i] for i in search.active(state.chosen)]
    free = search.study.space.free
    values = {}
    for i, one in enumerate(free):
        nuisance = any(name in moved for name in (one.label,)) or one.label.startswith("mooring.")
        if nuisance or one.label in labels or one.label in search.posed.base:
            values[one.label] = float(one.transform.forward(x[i]))
    model = with_effects(search.posed.declared, values)
    return model.with_values(values)


def estimates_of(search: Search, state: State, names: list[str]) -> dict[str, Estimate]:
    """Parameters with standard deviations, of those directions that are one parameter each."""
    look, study = state.reached.look, search.study
    prior = search.prior(state.chosen)
    found = predict(study, look, range(len(look.active)), search.used, prior)
    values = {}
    for name in names:
        i = study.names.index(name)
        if i not in look.active:
            continue
        deviation = float(found.deviation[look.active.index(i)])
        if name in study.labels:
            k = study.labels.index(name)
            free = study.space.free[k]
            x = look.place.x[k]
            value = float(free.transform.forward(x))
            slope = (float(free.transform.forward(x + 1e-4)) - float(free.transform.forward(x - 1e-4))) / 2e-4
            about = search.study.model.about(name)
            known = deviation < 0.5 * prior.width[i]
            bound = free.transform.at_bound(float(x))
            size = abs(slope) * deviation * float(study.directions[i, k])
            values[name] = Estimate(name, value, size if known else None, about.unit, about.meaning, free.start, bound, known)
    return values


def calibration_of(campaign: Campaign, search: Search, state: State, before: State | None) -> Calibration:
    """A fit in the form of a calibration: all tests, errors, bands. `before` gives the motions to compare with."""
    effects = [label for one in state.chosen for label in (*one.amplitudes, *one.shapes)]
    names = [
        *search.posed.base,
        *[n for n in search.posed.nuisances if n in search.study.labels and n not in effects],
        *effects,
    ]
    parameters = {**estimates_of(search, state, names), **_lines(search, state)}
    tests = tests_of(campaign, search, state)
    if before is not None:
        earlier = {test.id: test for test in tests_of(campaign, search, before)}
        tests = [_with_start(test, earlier[test.id]) for test in tests]
    return Calibration(
        campaign.manifest.name, augmented_model(search, state), parameters, tuple(tests),
        state.reached.settled, state.reached.iterations, 0.0, (), (), campaign.platform.name, None,
    )  # fmt: skip


def _lines(search: Search, state: State) -> dict[str, Estimate]:
    """Mooring lines, which are only nearly known, and move together: values, without deviations of their own."""
    found, x = {}, state.reached.look.place.x
    for i, one in enumerate(search.study.space.free):
        if one.label.startswith("mooring."):
            about = search.study.model.about(one.label)
            value = float(one.transform.forward(x[i]))
            found[one.label] = Estimate(one.label, value, None, about.unit, about.meaning, one.start, False, False)
    return found


def _with_start(test: TestFit, before: TestFit) -> TestFit:
    from dataclasses import replace

    start = {}
    for mine, other in zip(test.series, before.series):
        start[mine.channel] = other.simulated - other.offset + mine.offset if test.kind != "decay" else other.simulated
    bands = {
        name: {k: BandError(one.after, before.bands[name][k].after, one.low, one.high) for k, one in row.items()}
        for name, row in test.bands.items()
    }
    return replace(test, start=start, bands=bands)


def tests_of(campaign: Campaign, search: Search, state: State) -> list[TestFit]:
    """Every test with the motions of a fit."""
    study, place = search.study, state.reached.look.place
    frame = Frame(jnp.asarray(place.x), jnp.zeros((len(place.x), study.width)))
    found = {}
    motions = search.posed.motions
    if study.decays is not None:
        data = study.decays.problem.data
        ends = jnp.array([record.time[-1] for record in study.decay_records])
        residuals = np.asarray(decay_residuals(study.decays, frame, jnp.asarray(place.own), ends))
        offsets = place.own.reshape(len(study.decay_records), 3, -1)[:, 2] * np.asarray(data.unit)
        for i, record in enumerate(study.decay_records):
            n, rows = len(record.time), []
            for j, dof in enumerate(data.dofs):
                channel = DOFS[dof]
                if channel in record.values:
                    off = float(offsets[i, j])
                    measured = record.values[channel] - off
                    rows.append(Series(channel, measured, measured + residuals[i, j, :n], off, record.noise[channel],
                                       channel == record.degree_of_freedom))  # fmt: skip
            dof_name, time = record.degree_of_freedom, record.time
            found[record.id] = TestFit(record.id, record.use, "decay", dof_name, time, tuple(rows), {}, record.file)
    by_id = {r.id: r for r in campaign.records}
    for sea in study.seas:
        residuals, _ = (np.asarray(x) for x in sea_residual(sea, jnp.asarray(place.x)))
        for w, begin in enumerate(sea.begins):
            record = by_id[sea.tests[w]]
            measured = np.asarray(sea.measured[w])
            n = measured.shape[1]
            series = tuple(
                Series(
                    DOFS[dof], measured[c], measured[c] + residuals[w, c], 0.0, record.noise[DOFS[dof]], DOFS[dof] in motions
                )
                for c, dof in enumerate(sea.dofs)
            )
            time = np.asarray(sea.times[begin : begin + n])
            bands = _bands(series, float(time[1] - time[0]), record, campaign) if record.kind == "irregular" else {}
            found[record.id] = TestFit(record.id, record.use, record.kind, None, time, series, {}, record.file, bands)
    return [found[r.id] for r in campaign.records if r.id in found]


def _bands(series, step: float, record, campaign: Campaign) -> dict[str, dict[str, BandError]]:
    """Relative errors of energies in bands, as the paper's."""
    period = (record.test.peak_period or 10.0) * campaign.manifest.scale**0.5
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


def effect_of(search: Search, one: Candidate, before: State, after: State) -> Effect:
    """An effect that is in the model at the end, with its evidence."""
    (bic, held, clear, _), score, earlier = search.verdicts[one.name]
    later = search.verdicts.get((one.name, "after"), None)
    left, now = float(earlier.left[search.used].sum()), float((later or after).left[search.used].sum())
    parameters = estimates_of(search, after, [*one.amplitudes, *one.shapes])
    share = max(0.0, 1 - now / left) if left > 0 else 0.0
    about = search.study.model.about(one.amplitudes[0])
    return Effect(
        one.effect, one.dof, about.meaning, one.source, parameters,
        Evidence(score, bic, held if (~search.used).any() else float("nan"), clear),
        share, search.alike.get(one.name, ()), one.telling or None,
    )  # fmt: skip
