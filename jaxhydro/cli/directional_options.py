"""Seas of several headings from the command-line options."""

import math
from collections.abc import Mapping
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import Any

from jaxhydro.cli.options import finite, positive, wrong
from jaxhydro.dynamics.requested_sea import MeasuredDirections, RequestedSea
from jaxhydro.errors import suggest
from jaxhydro.interop.directional_file import read_sea_file
from jaxhydro.waves.directional_spectrum import SHAPES, WaveSystem
from jaxhydro.waves.spectra import MAX_ENHANCEMENT
from jaxhydro.waves.tabulated_sea import TabulatedFrequencies

EXAMPLE = '--sea "hs=2 tp=14 heading=30"'
KEYS = ("hs", "tp", "gamma", "heading", "spreading", "spectrum")
OTHERS = ("--hs", "--tp", "--gamma", "--spectrum", "--wave")  # options that `--sea` and `--sea-file` replace
TIMES = ("%Y-%m-%dT%H:%M", "%Y-%m-%d %H:%M", "%Y-%m-%dT%H:%M:%S")  # of --sea-time


def check_exponent(value: float, option: str, key: str = "") -> float:
    """An exponent s of a spreading. Raises BadParameter."""
    if not 0 <= finite(value, option) <= 1e4:
        raise wrong(option, f"{key}a number from 0 to 10000 expected, found {value:g}")
    return value


def system(text: str) -> WaveSystem:
    """Wave system of a text such as `hs=2 tp=14 heading=30`. Raises BadParameter."""
    fields: dict[str, Any] = {}
    for word in text.replace(",", " ").split():
        key, equals, value = word.partition("=")
        if key not in KEYS or not equals:
            raise wrong("--sea", f"{', '.join(KEYS)} expected, as {EXAMPLE}; found {word!r}. {suggest(key, KEYS)}".strip())
        if key in fields:
            raise wrong("--sea", f"{key} is given twice in {text!r}")
        if key == "spectrum":
            if value not in SHAPES:
                raise wrong("--sea", f"spectrum={' or '.join(SHAPES)} expected, found {value!r}")
            fields[key] = value
            continue
        try:
            fields[key] = finite(float(value), "--sea")
        except ValueError:
            raise wrong("--sea", f"a number after {key}= expected, found {value!r}") from None
    for key in ("hs", "tp"):
        if key not in fields:
            raise wrong("--sea", f"{key} expected, as {EXAMPLE}; found {text!r}")
        positive(fields[key], "--sea", f"{key}: ")
    if "gamma" in fields and fields.get("spectrum", SHAPES[0]) != SHAPES[0]:
        raise wrong("--sea", f"gamma: a JONSWAP spectrum expected with it, found {fields['spectrum']}")
    if "gamma" in fields and not 1 <= fields["gamma"] <= MAX_ENHANCEMENT:
        raise wrong("--sea", f"gamma: from 1 to {MAX_ENHANCEMENT:g} expected, found {fields['gamma']:g}")
    if "spreading" in fields:
        check_exponent(fields["spreading"], "--sea", "spreading: ")
    return WaveSystem(**fields)


def asked(options: Mapping[str, Any], heading: float, common: dict[str, Any]) -> RequestedSea | None:
    """Sea of `--sea`, `--sea-file` or `--spreading`; None without any of them.

    Args:
        options: Options that are given, by name.
        heading: Direction that the waves travel to (deg), of `--heading`.
        common: Fields of `RequestedSea` that all seas have, but for the order.

    Raises:
        BadParameter: An option is wrong, or does not go with another.
        InputError: The file of the directional spectrum cannot be used.
    """
    many, file = options.get("--sea"), options.get("--sea-file")
    if many and file:
        raise wrong("--sea-file", "--sea says what the sea is: not both")
    if (alone := [name for name in ("--x-bearing", "--sea-time") if name in options]) and not file:
        raise wrong(alone[0], "a spectrum expected with it, --sea-file FILE")
    others = OTHERS if file else (*OTHERS, "--spreading")
    if name := next((option for option in others if option in options and (many or file)), None):
        raise wrong(name, f"{'--sea' if many else '--sea-file'} says what the sea is: not both")
    if many and heading != 0.0:
        raise wrong("--heading", "the sea has its own: heading= of --sea")
    if file:
        return _of_file(Path(file), options, heading, common)
    if many:
        systems = tuple(system(text) for text in many)
    elif "--spreading" in options:
        systems = (_spread(options, heading),)
    else:
        return None
    sea = RequestedSea.of_systems(systems, order=options.get("--order", 1), **common)
    return RequestedSea.of_systems(systems, order=options.get("--order", 2), **common) if sea.long_crested else sea


def _of_file(file: Path, options: Mapping[str, Any], heading: float, common: dict[str, Any]) -> RequestedSea:
    """Sea of `--sea-file`. Without directions in the file `--heading` and `--spreading` say them."""
    bearing = finite(options.get("--x-bearing", 0.0), "--x-bearing")
    spectrum = read_sea_file(file, bearing, _time(options.get("--sea-time")))
    if isinstance(spectrum, TabulatedFrequencies):
        if "--x-bearing" in options:
            raise wrong("--x-bearing", "the file has no directions: --heading says where the waves travel to")
        exponent = check_exponent(options["--spreading"], "--spreading") if "--spreading" in options else None
        spectrum = replace(spectrum, mean_heading=math.radians(heading), spreading=exponent)
    elif "--spreading" in options:
        raise wrong("--spreading", "--sea-file says what the sea is: not both")
    elif heading != 0.0:
        raise wrong("--heading", "the sea has its own: --x-bearing")
    measured = MeasuredDirections(str(file), spectrum, bearing, str(options.get("--sea-time", "")))
    hs, tp, mean = measured.summary()
    order = options.get("--order", 2 if spectrum.long_crested else 1)
    return RequestedSea(hs, tp, None, "measured", heading=mean, measured=measured, order=order, **common)


def _time(text: str | None) -> datetime | None:
    """Time of `--sea-time`. Raises BadParameter."""
    for form in TIMES if text is not None else ():
        try:
            return datetime.strptime(str(text), form)
        except ValueError:
            continue
    if text is None:
        return None
    raise wrong("--sea-time", f"a time as 2019-02-06T00:40 expected, found {text!r}")


def _spread(options: Mapping[str, Any], heading: float) -> WaveSystem:
    """Wave system of `--hs`, `--tp` and `--spreading`, which were checked but for the last."""
    if "--hs" not in options:
        raise wrong("--spreading", "a sea expected with it: --hs 3.1 --tp 8.96")
    shape = str(options.get("--spectrum", SHAPES[0]))
    if shape not in SHAPES:
        raise wrong("--spreading", f"a spectrum with a peak expected with it, found {shape}")
    exponent = check_exponent(options["--spreading"], "--spreading")
    return WaveSystem(positive(options["--hs"], "--hs"), options["--tp"], options.get("--gamma"), heading, exponent, shape)
