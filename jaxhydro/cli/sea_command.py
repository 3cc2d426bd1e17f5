"""`jaxhydro simulate` in irregular seas: files, tables and figures."""

import time as clock
from collections.abc import Sequence
from typing import Any

import numpy as np

import jaxhydro
from jaxhydro.analysis.sea_statistics import in_order, summary, tables
from jaxhydro.cli.console import complain, say, table
from jaxhydro.cli.model_messages import print_remarks, print_rest
from jaxhydro.cli.sea_options import transient_of, with_band
from jaxhydro.cli.simulate_command import Job, finite, told_of_bed
from jaxhydro.cli.simulation_files import Motion, SeaState, write_motion
from jaxhydro.dynamics.irregular_simulation import CarriedAwayError
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.natural_modes import Modes
from jaxhydro.dynamics.requested_sea import MIN_SAMPLES, TRANSIENT, TRANSIENT_SHARE, RequestedSea
from jaxhydro.dynamics.rest_remarks import wave_remarks
from jaxhydro.dynamics.sea_of_record import impossible
from jaxhydro.dynamics.sea_of_request import build_sea, outside
from jaxhydro.dynamics.simulate import free_decay
from jaxhydro.dynamics.time_steps import largest_step
from jaxhydro.errors import InputError, Problem
from jaxhydro.remarks import Remark
from jaxhydro.units import rounded_up
from jaxhydro.waves.directional_spectrum import WaveSystem
from jaxhydro.waves.sea_limits import sea_limits, shallow_water
from jaxhydro.waves.wave_errors import ShortWavesError

MIN_NATURAL_PERIODS = 10  # that statistics of a motion are over


def run(model: Model, job: Job, asked: RequestedSea) -> bool:
    """Simulate, write and print; False where the motion grows beyond all bounds.

    Raises:
        InputError: The sea cannot be.
        BadParameter: The band or the transient is wrong.
        EquilibriumError: The platform does not rest.
    """
    pace = float(model.pace)
    asked = with_band(asked, pace)
    begin = 0.0 if asked.record is None else float(asked.record.times[0])
    times = begin + job.times
    transient = transient_of(asked, job.duration, pace)
    after_transient = times >= begin + transient
    if after_transient.sum() < MIN_SAMPLES:
        enough = duration_of((MIN_SAMPLES + 1) * job.dt, asked.transient, pace)
        expected = f"{enough:g} s or more, for {MIN_SAMPLES} samples after the transient of {transient:g} s"
        raise InputError("--duration", [Problem("", expected, f"{after_transient.sum()} of them {job.dt:g} s apart")])
    say("Building the sea ...", stderr=True)
    sea, about, target, notes = build_sea(model, asked, job.duration)
    limits = _limits(model, about, job.duration, asked.order, asked.systems)
    print_remarks([*model.remarks, *wave_remarks(model), *outside(model, sea, about), *limits])
    modes = print_rest(model, job.platform)
    print_remarks(_start_up(modes, job.duration - transient, asked.transient, pace))
    step = largest_step(model, asked.band(pace)[1]) if job.step is None else job.step
    about |= {"transient": transient, "step_at_most": step}
    table("Sea", ("Property", "Value"), _about(about), left=2)
    for note in notes:
        say(f"Note: {note}")
    say(f"Simulating {job.duration:g} s in steps of {step:.3g} s, compiled first ...", stderr=True)
    since = clock.perf_counter()
    try:
        position = np.asarray(free_decay(model, job.offset, times, sea=sea, step=step).position)
    except CarriedAwayError as error:
        complain(f"{error}; nothing was written")
        return False
    except ValueError as error:
        raise impossible("--cutoff" if isinstance(error, ShortWavesError) else "--step", error) from None
    if not finite(times, position):
        return False
    told_of_bed(model, times, position)
    say(f"Simulated in {clock.perf_counter() - since:.1f} s", stderr=True)
    motion = Motion.of(times, position, sea.gauge(times))
    first_order = motion.wave if asked.order == 1 else sea.gauge(times, order=1)
    channels = in_order(motion.values, np.asarray(motion.wave))
    results = summary(
        times[after_transient], {name: values[after_transient] for name, values in channels.items()}, about["peak_period"]
    )
    state = SeaState(np.asarray(first_order), target, about, results)
    source = f"jaxhydro {jaxhydro.__version__}"
    write_motion(motion, job.out, job.platform, source, state, job.figures, model.hull, job.inputs, job.formats)
    of_statistics, of_bands = tables(results)
    span = f"from {times[after_transient][0]:g} to {times[-1]:g} s"
    table(f"Statistics, {span}", *of_statistics)
    table("Energy by band", *of_bands)
    height = 4 * results["statistics"]["wave"]["standard_deviation"]
    say(f"Significant wave height, 4 standard deviations, {span}: {height:.3g} m")
    say(f"Results are in {job.out}")
    return True


def duration_of(window: float, transient: float | None, pace: float) -> float:
    """Shortest duration (s) that leaves a window after its transient, rounded up to two digits.

    Args:
        window: Time that statistics are over (s).
        transient: As it was asked for (s); None: the usual one, which depends on the duration.
        pace: Pace of the platform.
    """
    if transient is not None:
        return rounded_up(window + transient)
    return rounded_up(min(window / (1 - TRANSIENT_SHARE), window + TRANSIENT * pace))


def _start_up(modes: Modes, window: float, transient: float | None, pace: float) -> list[Remark]:
    """Warning where statistics are over few natural periods.

    The motion of the start is then still in them.
    """
    if not modes.period.size or window >= MIN_NATURAL_PERIODS * modes.period[0]:
        return []
    sentence = f"statistics over {window:.4g} s are {window / modes.period[0]:.2g} natural periods of {modes.motion[0]}"
    longer = duration_of(MIN_NATURAL_PERIODS * float(modes.period[0]), transient, pace)
    return [Remark(f"{sentence}: the start and chance are in its numbers. Take --duration {longer:g} or more", warning=True)]


def _limits(model: Model, about: dict[str, Any], duration: float, order: int, systems: Sequence[WaveSystem]) -> list[Remark]:
    """Remarks on a sea that comes near the limits of wave theory."""
    height, period = about["significant_wave_height"], about["peak_period"]
    if period is None:
        return []
    remarks = sea_limits(float(height), float(period), model.environment, order, duration / float(period))
    for system in systems if len(systems) > 1 else ():  # a low swell may be too long where the higher system is not
        remark = shallow_water(system.hs, system.tp, model.environment, order, duration / system.tp)
        if remark is not None and system.tp != period:
            remarks.append(remark._replace(text=f"of the system of Tp {system.tp:g} s {remark.text}"))
    return remarks


UNITS = {
    "significant_wave_height": "m",
    "significant_wave_height_of_components": "m",
    "peak_period": "s",
    "lowest_frequency": "Hz",
    "cutoff": "Hz",
    "repeat_period": "s",
    "heading": "deg",
    "mean_heading": "deg",
    "directional_width": "deg",
    "x_bearing": "deg",
    "transient": "s",
    "step_at_most": "s",
    "wave_position": "m",
    "second_wave_position": "m",
    "incident_significant_wave_height": "m",
    "reflected_significant_wave_height": "m",
    "separated_band": "Hz",
}


def _about(about: dict[str, Any]) -> list[tuple[str, str]]:
    rows = []
    for name, value in about.items():
        shown = f"{value:.4g}" if isinstance(value, float) else str(value)
        if name == "mismatch" or name.startswith("share_"):
            shown = f"{value:.2%}"
        if isinstance(value, list):
            shown = ", ".join(x if isinstance(x, str) else f"{x:.4g}" for x in value)
        if value is not None:
            rows.append((name.replace("_", " ").capitalize(), f"{shown} {UNITS.get(name, '')}".strip()))
    return rows
