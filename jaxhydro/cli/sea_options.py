"""Irregular sea from the command-line options."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from jaxhydro.analysis.sea_statistics import record_peak_period
from jaxhydro.cli.options import finite, positive, wrong
from jaxhydro.dynamics.requested_sea import Record, RequestedSea, SecondGauge, usual_transient
from jaxhydro.errors import InputError, Problem, suggest
from jaxhydro.units import SI
from jaxhydro.waves.record_harmonics import sampling_interval

ORDER, SEED = 2, 0
MAX_ORDER = 30  # Fourier components of a regular wave
DEFAULTS = {"--heading": 0.0, "--dt": 0.1}
OF_SPECTRUM = ("--hs", "--tp", "--gamma", "--spectrum", "--seed", "--amplitudes")
OF_DIRECTIONS = ("--sea", "--sea-file", "--sea-time", "--x-bearing", "--spreading")
OF_SEA = (*OF_SPECTRUM, *OF_DIRECTIONS, "--low", "--cutoff", "--order", "--transient")
OF_SECOND_GAUGE = ("--second-wave-column", "--second-wave-position")
OF_RECORD = ("--wave-column", "--wave-unit", "--wave-time-column", "--wave-position", *OF_SECOND_GAUGE)
NOT_OF_CAMPAIGNS = ("--wave", "--wave-height", "--wave-period", "--release", "--duration", "--elements", "--step")
UNITS = SI["length"]  # of a wave record
MAX_DURATION = 5e5  # s: six days, as many samples as fit into memory at the usual --dt
MAX_STEEPNESS = 1 / 7  # height over length: beyond it no wave stands (Michell 1893, Phil. Mag. 36)
TIME_COLUMN, WAVE_COLUMN = "time_s", "wave_m"  # those of motion.csv


def with_band(sea: RequestedSea, pace: float) -> RequestedSea:
    """Sea with its band of frequencies filled in, for a platform of a `pace` (`jaxhydro.scales`).

    Raises:
        BadParameter: The cut-off is not above the lowest frequency.
    """
    low, cutoff = sea.band(pace)
    if cutoff <= low:
        raise wrong("--cutoff", f"a number above --low, {low:g} Hz, expected, found {cutoff:g}")
    return replace(sea, low=low, cutoff=cutoff)


def transient_of(sea: RequestedSea, duration: float, pace: float = 1.0) -> float:
    """Time (s) after the beginning from which on statistics are taken.

    Raises:
        BadParameter: Nothing of the duration is left.
    """
    if sea.transient is None:
        return usual_transient(duration, pace)
    if not 0 <= sea.transient < duration:
        limits = f"from 0 to less than the duration, {duration:g} s, expected"
        raise wrong("--transient", f"{limits}; found {sea.transient:g}")
    return sea.transient


def by_option(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """Parameters of the command that are given, by the names of their options."""
    return {f"--{name.replace('_', '-')}": value for name, value in parameters.items() if value not in (None, (), [])}


def of_campaign(options: Mapping[str, Any]) -> dict[str, Any]:
    """Order, stretching, diffraction and cut-off (Hz) of a campaign's seas, where they are asked for.

    Raises:
        BadParameter: An option does not go with a campaign.
    """
    unused = [name for name in OF_SEA + OF_RECORD + NOT_OF_CAMPAIGNS if name not in ("--order", "--cutoff")]
    for name in options:
        if name in unused or options[name] != DEFAULTS.get(name, options[name]):
            raise wrong(name, "it goes with a platform, not with a campaign, whose files say it: name its platform file")
    order_of_sea(options)
    if "--cutoff" in options:
        positive(options["--cutoff"], "--cutoff")
    how = {name: options.get(f"--{name}") for name in ("order", "stretching", "diffraction", "cutoff")}
    return {name: value if isinstance(value, int | float) else str(value) for name, value in how.items() if value is not None}


def order_of_sea(options: Mapping[str, Any]) -> None:
    """Raise BadParameter for an order of irregular waves above 2."""
    if options.get("--order", 1) > ORDER:
        raise wrong("--order", f"1 or 2 expected in irregular waves, found {options['--order']}: more is of regular waves")


def stretching(options: Mapping[str, Any]) -> Any:
    """The stretching asked for."""
    return str(options.get("--stretching", "vertical"))


def asked(options: Mapping[str, Any], heading: float) -> RequestedSea | None:
    """Irregular sea of the options; None without one.

    The record of `--wave` is not in it yet: see `with_record`.

    Args:
        options: Options that are given, by name.
        heading: Direction that the waves travel to (deg).

    Raises:
        BadParameter: An option is wrong or missing, or does not go with another.
    """
    named = {name: options[name] for name in OF_SEA if name in options}
    complete_sea = any(name in options for name in ("--sea", "--sea-file"))
    record, of_spectrum = "--wave" in options, [name for name in named if name in OF_SPECTRUM]
    if record and not complete_sea and (turned := [name for name in OF_DIRECTIONS if name in options]):
        raise wrong(turned[0], "--wave takes the sea from a record of one gauge, which does not tell directions: not both")
    if record and of_spectrum and not complete_sea:
        raise wrong(of_spectrum[0], "--wave takes the sea from a record: not both")
    if not record and (of_gauge := [name for name in OF_RECORD if name in options]):
        raise wrong(of_gauge[0], "a record expected with it, --wave FILE")
    if not record and not complete_sea and "--hs" not in named:
        if "--wave-height" in options and set(named) == {"--order"}:
            return None
        if named:
            expected = "a significant wave height expected with it" if of_spectrum else "a sea expected with it"
            raise wrong(next(iter(named)), f"{expected}: --hs 3.1 --tp 8.96" + ("" if of_spectrum else ", or --wave FILE"))
        return None
    second = [name for name in OF_SECOND_GAUGE if name in options]
    if len(second) == 1:
        absent = next(name for name in OF_SECOND_GAUGE if name not in options)
        raise wrong(absent, f"expected with {second[0]}: a second gauge has a column and a position")
    order_of_sea(options)
    kind = str(named.get("--spectrum", "jonswap"))
    hs, tp, gamma = (named.get(name) for name in ("--hs", "--tp", "--gamma"))
    if not record and not complete_sea:
        positive(named["--hs"], "--hs")
        _spectrum(kind, tp, gamma)
    low, cutoff = (finite(named[name], name) if name in named else None for name in ("--low", "--cutoff"))
    if low is not None and low < 0:
        raise wrong("--low", f"a number from 0 on expected, found {low:g}")
    if low is not None and cutoff is not None and cutoff <= low:
        raise wrong("--cutoff", f"a number above --low, {low:g} Hz, expected, found {cutoff:g}")
    seed, amplitudes = named.get("--seed", SEED), str(named.get("--amplitudes", "deterministic"))
    how: dict[str, Any] = {"seed": seed, "amplitudes": amplitudes, "low": low, "cutoff": cutoff}
    how |= {"stretching": stretching(options), "transient": named.get("--transient")}
    if any(name in options for name in OF_DIRECTIONS):
        from jaxhydro.cli import directional_options

        return directional_options.asked(options, heading, how)
    return RequestedSea(hs, tp, gamma, kind, order=named.get("--order", 1 if second else ORDER), heading=heading, **how)


def duration(requested: float | None, sea: RequestedSea | None) -> float:
    """Duration (s), requested or chosen. Raises BadParameter for one that is longer than the record."""
    record = None if sea is None else sea.record
    if record is None:
        if requested is not None and positive(requested, "--duration") > MAX_DURATION:
            raise wrong("--duration", f"at most {MAX_DURATION:g} s expected, found {requested:g}")
        return requested if requested is not None else 600.0 if sea is None else 3600.0
    whole = float(record.times[-1] - record.times[0])
    if requested is not None and positive(requested, "--duration") > whole * (1 + 1e-9):
        raise wrong("--duration", f"at most the record's length, {whole:g} s, expected, found {requested:g}")
    return whole if requested is None else requested


def _spectrum(kind: str, tp: float | None, gamma: float | None) -> None:
    if kind == "white" and tp is not None:
        raise wrong("--tp", "white noise has no peak: leave it out")
    if kind != "white":
        if tp is None:
            raise wrong("--tp", "a peak period expected with --hs, as --tp 8.96")
        positive(tp, "--tp")
    if gamma is not None and kind != "jonswap":
        raise wrong("--gamma", f"a JONSWAP spectrum expected with it, found {kind}")
    if gamma is not None and not 1 <= gamma <= 7:
        raise wrong("--gamma", f"from 1 to 7 expected, found {gamma:g}")


def with_record(sea: RequestedSea, file: Path, table: Any, options: Mapping[str, Any]) -> RequestedSea:
    """The sea with the record in a file's table (pandas).

    Raises:
        InputError: A column is missing, has gaps, uneven times or another unit, or the waves are too steep.
        BadParameter: The unit or the gauge's position is wrong.
    """

    def wrong_file(where: str, expected: str, found: str, hint: str = "") -> InputError:
        return InputError(str(file), [Problem(where, expected, found, hint)])

    def pick(option: str, default: str) -> tuple[str, np.ndarray]:
        names, name = [str(column) for column in table.columns], str(options.get(option, default))
        if name not in names and name.isdigit() and int(name) < len(names):
            name = names[int(name)]
        if name not in names:
            hint = suggest(name, names) or f"{option} says which."
            raise wrong_file("", f"a column {name!r}", ", ".join(names[:12]), hint)
        values = table.iloc[:, names.index(name)].to_numpy()
        if values.dtype.kind != "f":
            raise wrong_file(f"column {name}", "numbers", f"text such as {values[0]!r}")
        if gaps := int(np.sum(~np.isfinite(values))):
            raise wrong_file(f"column {name}", "numbers without gaps", f"{gaps} of {len(values)} that are none")
        return name, values

    time_name, times = pick("--wave-time-column", TIME_COLUMN)
    try:
        step = sampling_interval(times)
    except ValueError as error:
        hint = "Interpolate to even times, or make it a campaign, which takes such records."
        raise wrong_file(f"column {time_name}", "even sampling", f"none ({error})", hint) from None
    stated = table.attrs.get("stated", {})
    if stated.get(time_name, "s") != "s":
        raise wrong_file(f"column {time_name}", "times in s", f"{stated[time_name]}, as the file states")
    unit = str(options.get("--wave-unit", "m"))
    if unit not in UNITS:
        raise wrong("--wave-unit", f"one of {', '.join(UNITS)} expected, found {unit}")

    def gauge(column_option: str, position_option: str) -> tuple[str, np.ndarray, tuple[float, float]]:
        name, elevation = pick(column_option, WAVE_COLUMN)
        if name in stated and stated[name] != unit:
            found = f"{stated[name]}, as the file states"
            raise wrong_file(f"column {name}", f"a unit of {unit}", found, "--wave-unit says which.")
        elevation = elevation * UNITS[unit]
        if not np.ptp(elevation):
            raise wrong_file(f"column {name}", "an elevation that changes", f"{elevation[0]:g} m throughout")
        height = 4 * float(np.std(elevation))
        # of waves in deep water: no other makes them longer
        length = 9.80665 / (2 * np.pi) * record_peak_period(elevation, step) ** 2
        if height > MAX_STEEPNESS * length:
            found = f"waves {height:.3g} m high and {length:.3g} m long"
            expected = "waves less than 1/7 as high as long, at full scale"
            raise wrong_file(f"column {name}", expected, found, "--wave-unit: mm or cm?")
        x, y = (finite(float(value), position_option) for value in options.get(position_option, (0.0, 0.0)))
        return name, elevation, (x, y)

    first = gauge("--wave-column", "--wave-position")
    if "--second-wave-column" not in options:
        return replace(sea, record=Record(str(file), first[0], times, *first[1:]))
    second = SecondGauge(*gauge(*OF_SECOND_GAUGE))
    if second.column == first[0]:
        raise wrong("--second-wave-column", f"another column than that of --wave-column expected, found {second.column}")
    return replace(sea, record=Record(str(file), first[0], times, *first[1:], second))
