"""Checks that the sections of campaign.yaml fit together."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from calibration.campaign.manifest_sections import CHANNELS, DOFS, GAUGES, IN_WAVES, SECOND_WAVE, WAVE, quantity
from calibration.campaign.stated_sizes import stated_size_problems
from calibration.campaign.tracked_point import missing_angles
from jaxhydro.errors import Problem, suggest
from jaxhydro.units import SI

if TYPE_CHECKING:
    from calibration.campaign.manifest import Manifest


def _ordered(value: tuple[float, float]) -> Iterator[Problem]:
    if not value[0] < value[1]:
        yield Problem("", "two numbers, the first less than the second", f"[{value[0]:g}, {value[1]:g}]")


def channel_problems(manifest: Manifest) -> Iterator[Problem]:
    """Channels that are unknown or missing, and units that do not suit them."""
    if "time" not in manifest.channels:
        yield Problem("channels", "the channel time", ", ".join(manifest.channels) or "no channels")
    elif len(manifest.channels) < 2:
        yield Problem("channels", "a motion beside time: " + ", ".join(DOFS), "time only")
    units = [(f"channels.{name}", name, channel.unit) for name, channel in manifest.channels.items()]
    gauges = (("wave_channel", WAVE, manifest.wave_channel), ("second_wave_channel", SECOND_WAVE, manifest.second_wave_channel))
    units += [(key, name, gauge.unit) for key, name, gauge in gauges if gauge is not None]
    if manifest.second_wave_channel is not None:
        for key, _, gauge in gauges:
            if gauge is None:
                yield Problem(key, "a first gauge, beside second_wave_channel", "none")
            elif gauge.position is None:
                yield Problem(f"{key}.position", "the position of each of two gauges, m", "none")
    for i, test in enumerate(manifest.tests):
        for name, override in test.channels.items():
            if name not in manifest.all_channels:
                yield _unknown(f"tests[{i}].channels", "a declared channel", name, manifest.all_channels)
            elif override is None and name == "time":
                yield Problem(f"tests[{i}].channels.time", "a column", "nothing")
            elif override is not None and override.unit is not None:
                units.append((f"tests[{i}].channels.{name}", name, override.unit))
    for where, name, unit in units:
        if name not in (*CHANNELS, *GAUGES) or where in ("channels.wave", "channels.second_wave"):
            hint = f"Waves have their own key, {name}_channel." if name in GAUGES else suggest(name, CHANNELS)
            yield Problem(where, "one of " + ", ".join(CHANNELS), repr(name), hint)
        elif unit not in (allowed := SI[quantity(name)]):
            yield Problem(
                f"{where}.unit", f"a unit of {quantity(name)}: " + ", ".join(allowed), repr(unit), suggest(unit, allowed)
            )


def test_problems(manifest: Manifest) -> Iterator[Problem]:
    """Tests whose names, channels, kinds or windows do not suit the campaign."""
    if not manifest.tests:
        yield Problem("tests", "one test at least", "none")
    ids = [test.id for test in manifest.tests]
    misspelt = any(name not in CHANNELS for name in manifest.channels)  # told already; which motion was meant is not known
    for i, test in enumerate(manifest.tests):
        where = f"tests[{i}]"
        if not re.fullmatch(r"[\w+=][\w .,()+=@-]*", test.id) or test.id[-1] in " ." or len(test.id) > 100:
            yield Problem(f"{where}.id", "a name that can be a file's: letters, digits, - _ . and the like", repr(test.id))
        if test.id.lower() in (name.lower() for name in ids[:i]):
            yield Problem(f"{where}.id", "an id that no other test has", repr(test.id), "Upper and lower case are alike.")
        if test.repeat_of is not None and (test.repeat_of not in ids or test.repeat_of == test.id):
            yield _unknown(f"{where}.repeat_of", "the id of another test", test.repeat_of, set(ids) - {test.id})
        present = [name for name in manifest.channels if name in DOFS and test.channels.get(name, True) is not None]
        if not present and not misspelt:
            yield Problem(f"{where}.channels", "one motion at least", "none that is left")
        if test.kind == "decay" and test.degree_of_freedom is None:
            yield Problem(f"{where}.degree_of_freedom", "the motion that was released: " + ", ".join(DOFS), "nothing")
        elif present and not misspelt and test.degree_of_freedom is not None and test.degree_of_freedom not in present:
            yield Problem(
                f"{where}.degree_of_freedom", "a motion that has a channel: " + ", ".join(present), repr(test.degree_of_freedom)
            )
        if test.kind in IN_WAVES and test.use != "ignore" and manifest.wave_channel is None:
            yield Problem(f"{where}.kind", "a wave_channel in the manifest, since waves drive this test", "none")
        in_waves = test.kind in IN_WAVES and test.use != "ignore"
        if in_waves and not test.sea.long_crested and manifest.records.order != 1:
            hint = "Second order is not separated from a record of one gauge then."
            yield Problem(f"{where}.sea", "records: {order: 1} with waves of several headings", "order: 2", hint)
        if in_waves and SECOND_WAVE in manifest.channels_of(test):
            hint = "`channels: {second_wave: null}` takes the first gauge alone."
            if not test.sea.long_crested:
                yield Problem(
                    f"{where}.sea", "a heading alone, since two gauges tell incident from reflected waves", "more", hint
                )
            elif manifest.records.order != 1:
                yield Problem(where, "records: {order: 1} with two wave gauges", "order: 2", hint)
        if manifest.tracked_point is not None:
            yield from (
                Problem(f"{where}, {p.where}", p.expected, p.found, p.hint)
                for p in missing_angles(manifest.tracked_point, present)
            )
        for problem in _ordered(test.window) if test.window is not None else ():
            yield Problem(f"{where}.window", problem.expected, problem.found)


def other_problems(manifest: Manifest) -> Iterator[Problem]:
    """Noise, natural periods, plausible sizes, zero and bands that do not suit the campaign."""
    measured = [name for name in manifest.channels if name != "time"] + [WAVE] * (manifest.wave_channel is not None)
    for name in manifest.noise:
        if name not in measured:
            yield _unknown("noise", "a declared channel", name, measured)
    for name in manifest.calibrate.natural_periods:
        if name not in DOFS:
            yield _unknown("calibrate.natural_periods", "a motion", name, DOFS)
    yield from stated_size_problems(manifest.plausible)
    zero, ids = manifest.zero, [test.id for test in manifest.tests]
    if zero is not None and zero.test is not None and zero.test not in ids:
        yield _unknown("zero.test", "the id of a test", zero.test, ids)
    pairs = {f"calibrate.bounds.{label}": pair for label, pair in manifest.calibrate.bounds.items()}
    if zero is not None and zero.window is not None:
        pairs["zero.window"] = zero.window
    if manifest.wave_band is not None:
        pairs["wave_band"] = manifest.wave_band
    for where, pair in pairs.items():
        for problem in _ordered(pair):
            yield Problem(where, problem.expected, problem.found)


def _unknown(where: str, expected: str, name: str, names: Iterable[str]) -> Problem:
    names = sorted(names)
    return Problem(
        where, f"{expected}: {', '.join(names[:12])}{', ...' if len(names) > 12 else ''}", repr(name), suggest(name, names)
    )
