"""The simulate command in irregular seas: from options to files, tables and figures."""

import math
import time as clock
from collections.abc import Callable
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np

import jaxhydro
from jaxhydro.analysis import power_spectrum
from jaxhydro.command import Job, finite, print_remarks, print_rest, told_of_bed
from jaxhydro.console import complain, say, table
from jaxhydro.export import Motion, SeaState, write_motion
from jaxhydro.model import Model
from jaxhydro.problems import InputError, Problem
from jaxhydro.remarks import Remark
from jaxhydro.sea_options import LEAST, Asked, Record
from jaxhydro.sea_results import in_order, summary, tables
from jaxhydro.simulate import free_decay, largest_step
from jaxhydro.table_ranges import outside_tables
from jaxhydro.waves.components import Components
from jaxhydro.waves.irregular import separated_record, spectrum_components
from jaxhydro.waves.irregular_sea import IrregularSea
from jaxhydro.waves.spectra import jonswap, peak_enhancement, pierson_moskowitz, white_noise

MISSED = 0.01  # of a record in the band, that first and second order may miss by root mean square
CUT = 0.95  # share of a spectrum's or a record's variance in the sea, below which a note says so
NEARLY_NONE = 0.05  # share, below which it is a mistake


class Built(NamedTuple):
    """A sea, what is written about it, and the spectrum asked for (Hz -> m2/Hz; None: a record)."""

    sea: IrregularSea
    about: dict[str, Any]
    target: Callable[[np.ndarray], np.ndarray] | None
    notes: list[str]


def run(model: Model, job: Job, asked: Asked) -> bool:
    """Simulate, write and print; False where the motion grows beyond all bounds.

    Raises InputError for a sea that cannot be, BadParameter for a transient, EquilibriumError where the platform does not rest.
    """
    pace = float(model.pace)
    asked = asked.for_platform(pace)
    begin = 0.0 if asked.record is None else float(asked.record.times[0])
    times = begin + job.times
    transient = asked.start(job.duration, pace)
    kept = times >= begin + transient
    if kept.sum() < LEAST:
        expected = f"{LEAST} samples or more after the transient of {transient:g} s"
        raise InputError("--duration", [Problem("", expected, f"{kept.sum()} of them {job.dt:g} s apart")])
    say("Building the sea ...", stderr=True)
    sea, about, target, notes = build_sea(model, asked, job.duration)
    print_remarks([*model.remarks, *outside(model, sea, about)])
    print_rest(model, job.platform)
    step = largest_step(model, asked.band(pace)[1]) if job.step is None else job.step
    about |= {"transient": transient, "step_at_most": step}
    table("Sea", ("Property", "Value"), _about(about), left=2)
    for note in notes:
        say(f"Note: {note}")
    say(f"Simulating {job.duration:g} s in steps of {step:.3g} s, compiled first ...", stderr=True)
    since = clock.perf_counter()
    try:
        position = np.asarray(free_decay(model, job.offset, times, sea=sea, step=step).position)
    except ValueError as error:
        if "is carried" in str(error):
            complain(f"{error}; nothing was written")
            return False
        raise _impossible("--cutoff" if "cut the sea off" in str(error) else "--step", error) from None
    if not finite(times, position):
        return False
    told_of_bed(model, times, position)
    say(f"Simulated in {clock.perf_counter() - since:.1f} s", stderr=True)
    motion = Motion.of(times, position, sea.gauge(times))
    first_order = motion.wave if asked.order == 1 else sea.gauge(times, order=1)
    channels = in_order(motion.values, np.asarray(motion.wave))
    results = summary(times[kept], {name: values[kept] for name, values in channels.items()}, about["peak_period"])
    state = SeaState(np.asarray(first_order), target, about, results)
    write_motion(motion, job.out, job.platform, f"jaxhydro {jaxhydro.__version__}", state, job.figures)
    of_statistics, of_bands = tables(results)
    span = f"from {times[kept][0]:g} to {times[-1]:g} s"
    table(f"Statistics, {span}", *of_statistics)
    table("Energy by band", *of_bands)
    height = 4 * results["statistics"]["wave"]["standard_deviation"]
    say(f"Significant wave height, 4 standard deviations, {span}: {height:.3g} m")
    say(f"Results are in {job.out}")
    return True


def build_sea(model: Model, asked: Asked, duration: float) -> Built:
    """The sea that is asked for. Raises InputError that names the option or the record."""
    notes: list[str] = []
    low, cutoff = asked.band(float(model.pace))
    if asked.record is not None:
        waves, about = _from_record(model, asked, asked.record, notes)
        target = None
    else:
        waves, about, target = _from_spectrum(model, asked, duration, notes)
    energy = float(0.5 * (waves.amplitude**2).sum())
    about |= {
        "lowest_frequency": low,
        "cutoff": cutoff,
        "components": int(waves.omega.size),
        "repeat_period": round(float(waves.period), 6),
        "significant_wave_height_of_components": 4 * math.sqrt(energy),
        "heading": asked.heading,
        "order": asked.order,
        "stretching": asked.stretching,
        "diffraction": "none" if model.cylinders is None else model.diffraction,
    }
    usual = usual_cutoff(4 * math.sqrt(energy), float(model.environment.gravity))
    if asked.order == 2 and cutoff > usual:
        notes.append(
            f"in a sea this high second order is usually cut off at sqrt(2 g / Hs), --cutoff {usual:.2g} (Stansberg): "
            "beyond, short waves bind more than they have"
        )
    if model.cylinders is None and model.diffraction != "none":
        notes.append("no member of this platform diffracts waves: 1 + Ca everywhere")
    sea = IrregularSea(waves, model.environment, 1 if asked.order == 1 else 2, asked.stretching)  # type: ignore[arg-type]
    if asked.record is not None:
        record = asked.record
        left = record.elevation - record.elevation.mean() - sea.gauge(record.times, record.position)
        about["share_of_record"] = 1 - float(np.var(left) / np.var(record.elevation))
        if about["share_of_record"] < CUT:
            notes.append(f"the sea has {about['share_of_record']:.1%} of the record's variance: see --low and --cutoff")
    return Built(sea, about, target, notes)


def outside(model: Model, sea: IrregularSea, about: dict[str, Any]) -> list[Remark]:
    """What is to be said of energy outside the model's tables, which goes into `about` as well."""
    found = outside_tables(model, sea.components)
    about |= {f"share_outside_{one.key}": share for one, share in found.items()}
    return [remark for one, share in found.items() if (remark := one.remark(share)) is not None]


def usual_cutoff(height: float, gravity: float) -> float:
    """sqrt(2 g / Hs) / 2 pi (Hz; m, m/s2): where second order of a sea is usually cut off.

    C. T. Stansberg, Non-Gaussian extremes in numerically generated second-order random waves on deep water, ISOPE 1998.
    """
    return math.sqrt(2 * gravity / height) / (2 * math.pi)


def _from_spectrum(
    model: Model, asked: Asked, duration: float, notes: list[str]
) -> tuple[Components, dict[str, Any], Callable[[np.ndarray], np.ndarray]]:
    hs, tp, gamma = asked.hs or 0.0, asked.tp or 0.0, asked.gamma
    if asked.spectrum == "jonswap" and gamma is None:
        gamma = float(peak_enhancement(hs, tp))
    low, cutoff = asked.band(float(model.pace))
    band = (2 * math.pi * low * (1 - 1e-9), 2 * math.pi * cutoff * (1 + 1e-9))

    def spectrum(omega):
        if asked.spectrum == "white":
            return white_noise(omega, hs, *band)
        return jonswap(omega, hs, tp, gamma) if asked.spectrum == "jonswap" else pierson_moskowitz(omega, hs, tp)

    try:
        waves = spectrum_components(
            spectrum, duration, model.environment, low=low, cutoff=cutoff, seed=asked.seed,
            amplitudes=asked.amplitudes, heading=math.radians(asked.heading),
        )  # fmt: skip
    except ValueError as error:
        if "break" in str(error):
            raise InputError("--hs", [Problem("", "a sea that does not break", f"one too steep ({error})")]) from None
        raise _impossible("--cutoff", error) from None
    share = float(spectrum(waves.omega).sum() * 2 * math.pi / waves.period) / (hs**2 / 16)
    if share < NEARLY_NONE:
        expected = f"a band, here {low:g} to {cutoff:g} Hz, with waves in it"
        raise InputError("--cutoff", [Problem("", expected, f"one with {share:.1%} of the spectrum")])
    if share < CUT:
        notes.append(f"{share:.1%} of the spectrum lies from {low:g} to {cutoff:g} Hz: see --low and --cutoff")
    about = {
        "spectrum": asked.spectrum, "significant_wave_height": hs, "peak_period": asked.tp, "peak_enhancement": gamma,
        "seed": asked.seed, "amplitudes": asked.amplitudes,
    }  # fmt: skip
    return waves, about, lambda f: 2 * math.pi * np.asarray(spectrum(2 * math.pi * jnp.asarray(f)))


def _from_record(model: Model, asked: Asked, record: Record, notes: list[str]) -> tuple[Components, dict[str, Any]]:
    low, cutoff = asked.band(float(model.pace))
    try:
        found = separated_record(
            record.times, record.elevation, model.environment, position=record.position,
            heading=math.radians(asked.heading), low=low, cutoff=cutoff, order=asked.order,
        )  # fmt: skip
    except ValueError as error:
        option = "--cutoff" if "cutoff" in str(error) or "band" in str(error) else f"{record.source}: column {record.column}"
        raise _impossible(option, error) from None
    if found.mismatch > MISSED:
        missed = f"first and second order miss {found.mismatch:.1%} of the record in the band, and the nearest found is used"
        notes.append(f"{missed}: a --cutoff below {cutoff:g}, or --order 1, follows it")
    spectrum = power_spectrum(record.times, record.elevation)
    inside = (spectrum.frequency >= low) & (spectrum.frequency <= cutoff)
    peak = spectrum.frequency[inside][np.argmax(spectrum.density[inside])] if inside.any() else cutoff
    return found.waves, {
        "record": record.source, "record_column": record.column, "wave_position": list(record.position),
        "significant_wave_height": 4 * float(np.std(record.elevation)), "peak_period": 1 / float(peak),
        "mismatch": found.mismatch,
    }  # fmt: skip


def _impossible(option: str, error: ValueError) -> InputError:
    return InputError(option, [Problem("", "a sea that can be simulated", f"none ({error})")])


UNITS = {
    "significant_wave_height": "m", "significant_wave_height_of_components": "m", "peak_period": "s", "lowest_frequency": "Hz",
    "cutoff": "Hz", "repeat_period": "s", "heading": "deg", "transient": "s", "step_at_most": "s", "wave_position": "m",
}  # fmt: skip


def _about(about: dict[str, Any]) -> list[tuple[str, str]]:
    rows = []
    for name, value in about.items():
        shown = f"{value:.4g}" if isinstance(value, float) else str(value)
        if name in ("share_of_record", "mismatch") or name.startswith("share_outside"):
            shown = f"{value:.2%}"
        if isinstance(value, list):
            shown = ", ".join(f"{x:g}" for x in value)
        if value is not None:
            rows.append((name.replace("_", " ").capitalize(), f"{shown} {UNITS.get(name, '')}".strip()))
    return rows
