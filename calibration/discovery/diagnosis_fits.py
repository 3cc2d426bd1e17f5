"""Fitted models of a diagnosis as calibrations: estimates, and motions of all tests."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.runs import runs
from calibration.discovery.effect_fits import EffectFits
from calibration.discovery.effects.candidates import with_candidates, with_effects
from calibration.discovery.fit_state import FitState
from calibration.discovery.linearisations import Point
from calibration.discovery.score_covariance import deviations_of
from calibration.residuals.measured_seas import peak_period
from calibration.result import BandError, Calibration, Estimate, Series, TestFit
from jaxhydro.analysis.sea_statistics import bands_of
from jaxhydro.analysis.spectral import band_weights
from jaxhydro.dynamics.model import Model
from jaxhydro.environment import DOFS


def augmented_model(fits: EffectFits, state: FitState) -> Model:
    """The baseline with the effects found, all parameters as fitted."""
    active = fits.active(state.chosen)
    moved = np.abs(fits.study.directions[active]).sum(axis=0) > 0
    values = {label: fits.study.value(label, state.linearisation.point.x) for label, m in zip(fits.study.labels, moved) if m}
    values |= {
        label: fits.study.value(label, state.linearisation.point.x) for candidate in state.chosen for label in candidate.choices
    }
    own_candidates = [candidate for candidate in state.chosen if candidate.load is not None]
    return with_effects(with_candidates(fits.setup.baseline, own_candidates), values).at_values(values)


def estimates_of(fits: EffectFits, state: FitState, names: Sequence[str]) -> dict[str, Estimate]:
    """Estimates with standard deviations of directions that are one parameter each."""
    linearisation, study = state.linearisation, fits.study
    prior = fits.prior(state.chosen)
    deviations = deviations_of(study, linearisation, prior)
    values = {}
    for name in names:
        i = study.names.index(name)
        if i not in linearisation.active or name not in study.labels:
            continue
        k = study.labels.index(name)
        free, x, deviation = study.space.free[k], linearisation.point.x[k], float(deviations[linearisation.active.index(i)])
        slope = (float(free.transform.forward(x + 1e-4)) - float(free.transform.forward(x - 1e-4))) / 2e-4
        about = study.model.about(name)
        determined = bool(deviation < 0.5 * prior.width[i])
        size = abs(slope) * deviation * float(study.directions[i, k])
        value = study.value(name, linearisation.point.x)
        ends = np.array([about.lower, about.upper])
        bound = free.transform.at_bound(float(x)) or bool(np.isclose(value, ends, rtol=1e-6, atol=0.0).any())
        values[name] = Estimate(
            name, value, size if determined else None, about.unit, about.meaning, free.start, bound, determined
        )
    return values


def calibration_of(campaign: Campaign, fits: EffectFits, state: FitState, before: Calibration | None) -> Calibration:
    """A fit as a calibration result: parameters, tests, errors in bands.

    Args:
        campaign: The campaign.
        fits: Study, candidates, priors.
        state: The fit.
        before: An earlier fit whose motions are compared with, or None.
    """
    effects = [label for candidate in state.chosen for label in candidate.labels]
    nuisances = [name for name in fits.setup.nuisances if name in fits.study.labels and name not in effects]
    names = [*fits.setup.base, *nuisances, *effects]
    lines = [parameter.label for parameter in fits.study.space.free if parameter.label.startswith("mooring.")]
    choices = [label for candidate in state.chosen for label in candidate.choices]
    parameters = (
        estimates_of(fits, state, names)
        | values_as_estimates(fits, state, lines, False)
        | values_as_estimates(fits, state, choices)
    )
    tests = test_fits_at(campaign, fits, state.linearisation.point)
    if before is not None:
        earlier = {test.id: test for test in before.tests}
        tests = [_with_start(test, earlier[test.id]) for test in tests]
    return Calibration(
        campaign.manifest.name,
        augmented_model(fits, state),
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


def values_as_estimates(
    fits: EffectFits, state: FitState, labels: Sequence[str], determined: bool = True
) -> dict[str, Estimate]:
    """Estimates without standard deviations: of discrete choices, and of mooring lines that move together.

    Args:
        fits: Study, candidates, priors.
        state: The fit.
        labels: Labels of the values.
        determined: Whether the records determine them.
    """
    estimates = {}
    for label in labels:
        about, start = fits.study.model.about(label), fits.study.space.free[fits.study.labels.index(label)].start
        value = fits.study.value(label, state.linearisation.point.x)
        estimates[label] = Estimate(label, value, None, about.unit, about.meaning, start, False, determined)
    return estimates


def _with_start(test: TestFit, before: TestFit) -> TestFit:
    """A test with the motions and errors of an earlier fit as its start."""
    start = {}
    for mine, earlier in zip(test.series, before.series):
        start[mine.channel] = earlier.simulated - earlier.offset + mine.offset if test.kind != "decay" else earlier.simulated
    bands = {
        name: {k: BandError(error.after, before.bands[name][k].after, error.low, error.high) for k, error in row.items()}
        for name, row in test.bands.items()
    }
    return replace(test, start=start, bands=bands)


def test_fits_at(campaign: Campaign, fits: EffectFits, point: Point) -> list[TestFit]:
    """Measured and simulated motions of every test at a point."""
    study = fits.study
    motions = study.motions(point)
    by_name: dict[str, TestFit] = {}
    if study.decays is not None:
        data = study.decays.data
        in_decays = np.asarray(motions.pop(0)).reshape(len(study.decay_records), len(data.dofs), -1)
        offsets = point.own.reshape(len(study.decay_records), 3, -1)[:, 2] * np.asarray(data.unit)
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
            by_name[record.id] = TestFit(record.id, record.use, "decay", dof_name, record.time, tuple(rows), {}, record.file)
    by_id = {r.id: r for r in campaign.records}
    all_runs = runs(campaign) if study.seas else ()
    peaks = {record.id: peak_period(run, record, campaign.manifest.scale) for run in all_runs for record in run.records}
    for sea, residuals in zip(study.seas, motions):
        n = sea.measured.shape[-1]
        every = np.asarray(residuals).reshape(len(sea.tests), -1, n)
        for test, begin, values, residual in zip(sea.tests, sea.begins, np.asarray(sea.measured), every):
            record = by_id[test]
            series = tuple(
                Series(DOFS[dof], m, m + r, 0.0, record.noise[DOFS[dof]], DOFS[dof] in fits.setup.motions)
                for dof, m, r in zip(sea.dofs, values, residual)
            )
            time = np.asarray(sea.times[begin : begin + n])
            bands = _bands(series, float(time[1] - time[0]), peaks[test]) if record.kind == "irregular" else {}
            by_name[test] = TestFit(test, record.use, record.kind, None, time, series, {}, record.file, bands)
    return [by_name[r.id] for r in campaign.records if r.id in by_name]


def _bands(series: Sequence[Series], step: float, period: float) -> dict[str, dict[str, BandError]]:
    """Relative errors of energy in frequency bands, for a sea of this peak period (s)."""
    errors: dict[str, dict[str, BandError]] = {}
    for motion in series:
        if not motion.scored:
            continue
        row = {}
        for name, (low, high) in bands_of(motion.channel, period).items():
            weights = band_weights(len(motion.measured), step, low, high)
            measured, simulated = weights.integral(motion.measured), weights.integral(motion.simulated)
            row[name] = BandError(float(simulated / measured - 1), float("nan"), low, high)
        errors[motion.channel] = row
    return errors
