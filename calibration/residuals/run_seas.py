"""Seas of the runs of a campaign, made of their wave records."""

import dataclasses
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest_sections import WAVE
from calibration.campaign.runs import Run, runs
from calibration.campaign.second_order_hint import second_order_hint
from calibration.residuals.wave_options import Options
from jaxhydro.analysis.sea_statistics import record_peak_period
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.sea_of_request import share_within
from jaxhydro.dynamics.time_steps import largest_step
from jaxhydro.environment import Environment
from jaxhydro.errors import InputError, Problem
from jaxhydro.waves.irregular_sea import IrregularSea
from jaxhydro.waves.recorded_waves import separated_record
from jaxhydro.waves.sea_limits import sea_limits
from jaxhydro.waves.two_gauges import IncidentAndReflected, incident_and_reflected
from jaxhydro.waves.wave_errors import GaugeSpacingError

MAX_MISMATCH = 1e-3  # of a wave record, above which first and second order together do not follow it
MIN_BAND_SHARE = 0.95  # of its variance, that should lie in the band


@dataclass(frozen=True, eq=False)
class RunSea:
    """Sea of a run.

    Attributes:
        sea: The sea.
        mismatch: RMS of the simulated less the measured elevation in the band, over that of the measured elevation.
        rounds: Number of iterations that separated the second order.
        inside: Fraction of the record's variance in the band.
        notes: Warnings, as sentences.
        order_hint: Remark that the records lack the second-order waves of theory; also among the notes. Empty: none.
    """

    sea: IrregularSea
    mismatch: float
    rounds: int
    inside: float
    notes: tuple[str, ...]
    order_hint: str = ""


Seas: TypeAlias = tuple[tuple[Run, RunSea], ...]


def sea_of(run: Run, environment: Environment, options: Options) -> RunSea:
    """Sea of a run's whole record.

    Raises:
        InputError: The order, the band or the record is unsuitable.
    """
    if run.several_headings and options.order != 1:
        expected = "1 in a sea of several headings" + ("" if run.directions is None else ", as its test states")
        raise InputError(run.file, [Problem("order", expected, f"{options.order}")])
    inside, notes = share_within(run.wave, run.step, options.low, options.cutoff), []
    try:
        if run.second is None:
            waves, mismatch, rounds = separated_record(
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
        else:
            both = incident_and_reflected(
                run.time,
                (run.wave, run.second.wave),
                environment,
                positions=(run.position, run.second.position),
                heading=run.heading,
                low=options.low,
                cutoff=options.cutoff,
            )
            waves, mismatch, rounds = both.waves, both.mismatch, both.rounds
            notes.append(reflection_note(run.file, both))
    except GaugeSpacingError as error:
        raise InputError(run.file, [Problem("second_wave_channel.position", error.expected, error.found)]) from None
    except ValueError as error:
        expected = f"a wave record for first-order waves from {options.low:g} to {options.cutoff:g} Hz"
        raise InputError(run.file, [Problem(f"{run.file}, channel {WAVE}", expected, str(error))]) from None
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
    if mismatch > MAX_MISMATCH:
        notes.append(
            f"{run.file}: first and second order miss {100 * mismatch:.2g} % of the wave record from {band} "
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
    return RunSea(sea, mismatch, rounds, inside, tuple(notes))


def reflection_note(file: str, both: IncidentAndReflected) -> str:
    """Remark on the incident and reflected waves of a run."""
    incident, reflected = both.significant_heights
    low, high = both.band
    return (
        f"{file}: two gauges find incident waves of Hs {incident:.3g} m and reflected ones of {reflected:.2g} m. "
        f"The reflection coefficient is {both.reflection_coefficient:.2g}. {both.share_outside:.1%} of the energy is outside "
        f"{low:.3g} to {high:.3g} Hz, where these gauges separate"
    )


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
    spread = [record.id for run in campaign_runs if run.several_headings for record in run.records]
    if spread and not several_headings:
        expected = "tests in long-crested waves: seas of several headings can be simulated and compared, not fitted"
        remedy = "Mark such tests `use: ignore`, or state the heading alone."
        if any(run.second is not None for run in campaign_runs):
            remedy = "Mark such tests `use: ignore`, or take one gauge: `channels: {second_wave: null}`."
        raise InputError(str(campaign.folder / "campaign.yaml"), [Problem("tests", expected, ", ".join(spread), remedy)])
    made = [(run, sea_of(run, environment, options)) for run in campaign_runs]
    if made and options.order == 2 and not campaign.manifest.records.model_fields_set:
        hint = second_order_hint([(run, run_sea.sea) for run, run_sea in made], (options.low, options.cutoff))
        (run, first), rest = made[0], made[1:]
        made = [(run, dataclasses.replace(first, notes=(*first.notes, *hint), order_hint=" ".join(hint))), *rest]
    return tuple(made)
