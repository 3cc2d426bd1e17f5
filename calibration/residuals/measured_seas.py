"""Simulation of tests in their measured waves, compared with the measured motions.

Windows of one file are one continuous run. Its sea is made once, of the whole record, and the platform starts at rest with the
file. Everything is SI at full scale.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.motion_hints import motion_hints
from calibration.campaign.records import Record
from calibration.campaign.runs import Run
from calibration.residuals.moving_channels import moving_channels
from calibration.residuals.run_seas import Seas, sea_step, seas_of, with_diffraction
from calibration.residuals.run_segments import run_segments, samples_after_transient, simulate_segments
from calibration.residuals.wave_options import Options
from calibration.result import Series, TestFit
from jaxhydro.analysis.sea_statistics import record_peak_period
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.observe import observe
from jaxhydro.dynamics.statics import equilibrium
from jaxhydro.dynamics.table_ranges import heading_fault
from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError, Problem
from jaxhydro.exported_programs import exported_jit
from jaxhydro.hull.hull import Hull

NO_ZERO = "the campaign states no `zero`: motions count from the reference position"


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


_observed = exported_jit(observe)


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
