"""Simulation of tests in their measured waves, compared with the measured motions.

Windows of one file are one continuous run. Its sea is made once, of the whole record, and the platform starts at rest with the
file. Everything is SI at full scale.
"""

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from calibration.campaign.campaign_hints import motion_hints
from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest_sections import WAVE
from calibration.campaign.records import Record
from calibration.campaign.runs import Run, runs
from calibration.campaign.second_order_hint import second_order_hint
from calibration.residuals.moving_channels import moving_channels
from calibration.residuals.run_segments import run_segments, samples_after_transient, simulate_segments
from calibration.residuals.wave_options import Options
from calibration.result import Series, TestFit
from jaxhydro.analysis.sea_statistics import record_peak_period
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.observe import observe
from jaxhydro.dynamics.sea_of_request import share_within
from jaxhydro.dynamics.statics import equilibrium
from jaxhydro.dynamics.table_ranges import heading_fault
from jaxhydro.dynamics.time_steps import largest_step
from jaxhydro.environment import DOFS, Environment
from jaxhydro.errors import InputError, Problem
from jaxhydro.hull.hull import Hull
from jaxhydro.waves.irregular_sea import IrregularSea
from jaxhydro.waves.recorded_waves import separated_record
from jaxhydro.waves.sea_limits import sea_limits

MAX_MISMATCH = 1e-3  # of a wave record, above which first and second order together do not follow it
MIN_BAND_SHARE = 0.95  # of its variance, that should lie in the band
NO_ZERO = "the campaign states no `zero`: motions count from the reference position"


@dataclass(frozen=True, eq=False)
class RunSea:
    """Sea of a run.

    Attributes:
        sea: The sea.
        mismatch: RMS of the simulated less the measured elevation in the band, over that of the measured elevation.
        rounds: Number of iterations that separated the second order.
        inside: Fraction of the record's variance in the band.
        notes: Warnings, as sentences.
    """

    sea: IrregularSea
    mismatch: float
    rounds: int
    inside: float
    notes: tuple[str, ...]


Seas: TypeAlias = tuple[tuple[Run, RunSea], ...]


@dataclass(frozen=True, eq=False)
class SeaTest:
    """Measured and simulated motion of one test in waves, after its transient, with even time steps.

    Attributes:
        fit: Measured and simulated motions; `fit.start` is empty.
        wave: (n,) measured elevation (m).
        simulated_wave: (n,) simulated elevation at the gauge (m).
        peak_period: Peak period (s).
        stated_height: Stated significant height, or height of regular waves (m); None where none is stated.
        heading: Direction that the waves run to (rad).
    """

    fit: TestFit
    wave: np.ndarray
    simulated_wave: np.ndarray
    peak_period: float
    stated_height: float | None  # m: significant, or of regular waves
    heading: float


class Comparison(NamedTuple):
    """Comparison of a model with all tests in waves.

    Attributes:
        tests: Measured and simulated motions, one entry per test.
        seas: Runs and their seas.
        notes: Warnings in words.
        step: Time step of the simulation (s).
        hull: Hull of the model.
    """

    tests: tuple[SeaTest, ...]
    seas: Seas
    notes: tuple[str, ...]
    step: float
    hull: Hull


def sea_of(run: Run, environment: Environment, options: Options) -> RunSea:
    """Sea of a run's whole record.

    Raises:
        InputError: The order, the band or the record is unsuitable.
    """
    if run.directions is not None and options.order != 1:
        raise InputError(run.file, [Problem("order", "1 in a sea of several headings, as its test states", f"{options.order}")])
    inside = share_within(run.wave, run.step, options.low, options.cutoff)
    try:
        separated = separated_record(
            run.time,
            run.wave,
            environment,
            position=run.position,
            heading=run.heading,
            low=options.low,
            cutoff=options.cutoff,
            order=options.order,
            kinds=options.kinds,
            highest_difference=options.highest_difference,
        )
    except ValueError as error:
        expected = f"a wave record for first-order waves from {options.low:g} to {options.cutoff:g} Hz"
        raise InputError(run.file, [Problem(f"{run.file}, channel {WAVE}", expected, str(error))]) from None
    waves, notes = separated.waves, []
    if run.directions is not None:
        waves = run.directions.turned(waves, run.position)
        notes.append(
            f"{run.file}: directions of its waves are drawn from what its test states (seed {run.directions.seed}). The sea is "
            "the record at the gauge; elsewhere only its spectrum is known, and motions agree by spectra, not sample by sample"
        )
    sea = IrregularSea(
        waves,
        environment,
        options.order,
        options.stretching,
        kinds=options.kinds,
        highest_difference=options.highest_difference,
        acting=options.acting,
    )
    band = f"{options.low:g} to {options.cutoff:g} Hz"
    if separated.mismatch > MAX_MISMATCH:
        notes.append(
            f"{run.file}: first and second order miss {100 * separated.mismatch:.2g} % of the wave record from {band} "
            "(root mean square); the nearest found is used. A lower cutoff, or order 1, would follow it"
        )
    if inside < MIN_BAND_SHARE:
        notes.append(
            f"{run.file}: only {100 * inside:.0f} % of the wave record's variance is within {band}; "
            "`wave_band` in campaign.yaml sets another band"
        )
    if run.records and all(record.kind == "irregular" for record in run.records):
        period = record_peak_period(run.wave, run.step, options.low, options.cutoff)
        count = float(run.time[-1] - run.time[0]) / period
        limits = sea_limits(4 * float(np.std(run.wave)), period, environment, options.order, count)
        notes += [f"{run.file}: {limit.text}" for limit in limits]
    return RunSea(sea, separated.mismatch, separated.rounds, inside, tuple(notes))


def with_diffraction(model: Model, options: Options) -> Model:
    """The model with the diffraction asked for."""
    return model if options.diffraction is None else model.with_conventions(diffraction=options.diffraction)


def sea_step(model: Model, options: Options) -> float:
    """The largest time step (s) that follows the platform and the waves."""
    return largest_step(model, options.cutoff)


def seas_of(campaign: Campaign, environment: Environment, options: Options, several_headings: bool = False) -> Seas:
    """The runs of a campaign and their seas, the first with the remark on all wave records.

    Args:
        campaign: The campaign.
        environment: Water depth and gravity.
        options: How waves are made.
        several_headings: Whether seas of several headings will do: they are compared, not fitted.

    Raises:
        InputError: A record makes no sea, or a sea has several headings and may not.
    """
    campaign_runs = runs(campaign)
    spread = [record.id for run in campaign_runs if run.directions is not None for record in run.records]
    if spread and not several_headings:
        expected = "tests in long-crested waves: seas of several headings can be simulated and compared, not fitted"
        remedy = "Mark such tests `use: ignore`, or state the heading alone."
        raise InputError(str(campaign.folder / "campaign.yaml"), [Problem("tests", expected, ", ".join(spread), remedy)])
    made = [(run, sea_of(run, environment, options)) for run in campaign_runs]
    if made and options.order == 2 and not campaign.manifest.records.model_fields_set:
        hint = second_order_hint([(run, run_sea.sea) for run, run_sea in made], (options.low, options.cutoff))
        made[0] = (made[0][0], dataclasses.replace(made[0][1], notes=(*made[0][1].notes, *hint)))
    return tuple(made)


def compare(
    campaign: Campaign,
    model: Model,
    options: Options,
    say: Callable[[str], Any] = lambda _: None,
    made: Seas | None = None,
) -> Comparison:
    """Simulate every run and compare it with the measurement, test by test.

    Args:
        campaign: The campaign.
        model: The model.
        options: Options of the waves.
        say: Function that is called with a line of progress for every run.
        made: Runs and their seas, where they are at hand.

    Raises:
        InputError: A sea cannot be made, or the model does not have its headings.
        Diverged: A motion grows beyond all bounds.
    """
    model = with_diffraction(model, options)
    made = seas_of(campaign, model.environment, options, several_headings=True) if made is None else made
    step = sea_step(model, options)
    from_rest = campaign.manifest.zero is not None
    origin = equilibrium(model) if from_rest else None
    notes = [] if from_rest else [NO_ZERO]
    tests = []
    for run, run_sea in made:
        waves = run_sea.sea.components
        say(f"{run.file}: {waves.omega.size} waves of {run.time[-1] - run.time[0]:.0f} s, order {options.order}; simulating")
        if not run_sea.sea.long_crested and (fault := heading_fault(model, np.asarray(waves.heading))) is not None:
            raise InputError(run.file, [Problem("sea", *fault)])
        parts = run_segments(run, run.records, model, options.low, options.cutoff)
        try:
            for part, simulation, _ in simulate_segments(model, run, parts, run_sea.sea, step):
                motion = np.full((len(run.time), 6), np.nan)
                times = run.time[: part.end + 1]
                readings = _observed(model, simulation.grid, jnp.asarray(times[part.begin :]), origin, in_waves=True)
                motion[part.begin : part.end + 1] = samples = np.asarray(readings)
                if not np.isfinite(samples).all():
                    first = times[part.begin + np.argmin(np.isfinite(samples).all(axis=1))]
                    raise Diverged(f"{run.file}: the motion grows beyond all bounds at {first:.4g} s")
                wave = run_sea.sea.gauge(times[part.begin :], run.position)
                wave = np.concatenate([np.full(part.begin, np.nan), wave])
                tests += [_test(run, record, motion, wave, campaign.manifest.scale) for record in part.records]
        except ValueError as error:
            raise Diverged(f"{run.file}: {error}") from None
        notes += [*run.notes, *run_sea.notes]
    notes += motion_hints(map(_moving, tests))
    order = [record.id for record in campaign.records]
    return Comparison(tuple(sorted(tests, key=lambda t: order.index(t.fit.id))), made, tuple(notes), step, model.hull)


_observed = eqx.filter_jit(observe)


class Diverged(ArithmeticError):
    """A simulated motion that is no result."""


def _moving(test: SeaTest) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Measured and simulated motion by channel, for channels that move in the simulation."""
    large = moving_channels({series.channel: series.simulated for series in test.fit.series})
    return {series.channel: (series.measured, series.simulated) for series in test.fit.series if series.channel in large}


def peak_period(run: Run, record: Record, scale: float) -> float:
    """Stated peak period (s, full scale) of a test, or the period of its regular waves.

    Where none is stated, the period is measured.
    """
    stated = record.test.peak_period if record.kind == "irregular" else record.test.period
    if stated is not None:
        return stated * scale**0.5
    return record_peak_period(run.wave[samples_after_transient(run, record)], run.step)


def _test(run: Run, record: Record, motion: np.ndarray, wave: np.ndarray, scale: float) -> SeaTest:
    """A test's samples after its transient, on the run's even clock."""
    indices, whole = run.samples(record), samples_after_transient(run, record)
    series = tuple(
        Series(
            dof, np.interp(whole, indices, record.values[dof]), motion[whole, DOFS.index(dof)], 0.0, record.noise[dof], False
        )
        for dof in DOFS
        if dof in record.values
    )
    test, time, measured = record.test, run.time[whole], run.wave[whole]
    height = test.significant_wave_height if record.kind == "irregular" else test.wave_height
    fit = TestFit(record.id, record.use, record.kind, None, time, series, {}, record.file)
    stated = None if height is None else height * scale
    return SeaTest(fit, measured, wave[whole], peak_period(run, record, scale), stated, run.heading)
