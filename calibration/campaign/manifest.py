"""Schema of campaign.yaml: tests, channels, units, and the use of each test.

Values are stated as they were recorded: windows, `transient`, noise, wave heights and positions. They are in the units and at
the scale of the files, whatever `scale` is. Bounds and priors of `calibrate`, and `plausible`, are about the model's
parameters and at the scale of the platform file.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from os import PathLike
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, PlainValidator, model_validator

from calibration.campaign.stated_sea import Sea
from calibration.campaign.stated_sizes import check_stated_size, stated_size_problems
from calibration.campaign.tracked_point import missing_angles
from jaxhydro.errors import (
    Faults,
    InputError,
    NonNegative,
    Number,
    Positive,
    Problem,
    Schema,
    Text,
    read_yaml,
    shown,
    suggest,
    validate,
)
from jaxhydro.files import campaign_file
from jaxhydro.units import SI
from jaxhydro.waves import second_order
from jaxhydro.waves.irregular_sea import Acting

DOFS = ("surge", "sway", "heave", "roll", "pitch", "yaw")
CHANNELS = ("time", *DOFS)
WAVE = "wave"  # the wave channel's name among the others


def quantity(channel: str) -> str:
    """What a channel measures: time, length or angle."""
    return "time" if channel == "time" else "angle" if channel in DOFS[3:] else "length"


def _column(value: Any) -> Any:
    if not (isinstance(value, str) and value) and not (type(value) is int and value >= 0):
        raise ValueError("a column's name, or its number, 0 for the first")
    return value


Use = Literal["fit", "holdout", "ignore"]
Kind = Literal["decay", "regular", "irregular", "static", "forced"]
IN_WAVES: tuple[Kind, ...] = ("regular", "irregular")
Motion = Literal["surge", "sway", "heave", "roll", "pitch", "yaw"]
Name = Annotated[Text, BeforeValidator(lambda value: str(value) if type(value) is int else value)]
Column = Annotated[str | int, PlainValidator(_column)]
Unit = Annotated[Text, Field(description="a unit: " + ", ".join(unit for units in SI.values() for unit in units))]
Sign = Annotated[Literal[1, -1], BeforeValidator(lambda value: int(value) if value in (1.0, -1.0) else value)]


Window = tuple[Number, Number]  # on the file's own time axis


def _ordered(value: tuple[float, float]) -> Iterator[Problem]:
    if not value[0] < value[1]:
        yield Problem("", "two numbers, the first less than the second", f"[{value[0]:g}, {value[1]:g}]")


class Channel(Schema):
    """One column of the files."""

    column: Column
    unit: Unit
    sign: Sign = 1


class WaveChannel(Channel):
    """The undisturbed elevation. `position` is where it was measured, m at the scale of the files."""

    position: tuple[Number, Number] | None = None


class Override(Schema):
    """What differs in one test's file."""

    column: Column | None = None
    unit: Unit | None = None
    sign: Sign | None = None


class Zero(Schema):
    """Where still water is: a window of the same file, or a test."""

    window: Window | None = None
    test: Name | None = None

    @model_validator(mode="after")
    def _one_of_them(self) -> Zero:
        if (self.window is None) == (self.test is None):
            raise Faults(Problem("", "either a window or a test", "both" if self.test else "neither"))
        return self


class Test(Schema):
    """One test: a file, or a window of it."""

    __test__ = False  # not for pytest

    id: Name
    kind: Kind
    file: Name
    use: Use = "fit"
    degree_of_freedom: Motion | None = None
    window: Window | None = None
    channels: dict[str, Override | None] = Field(default_factory=dict)
    repeat_of: Name | None = None
    sea: Sea = Sea()
    significant_wave_height: Positive | None = None
    peak_period: Positive | None = None
    wave_height: Positive | None = None
    period: Positive | None = None
    transient: NonNegative = 0.0
    weight: Positive = 1.0


class Recording(Schema):
    """Waves that the records have.

    Attributes:
        order: 1: linear waves; 2: with the bound waves of second order.
        kinds: Pairs of waves that bind others: at sums or differences of their frequencies.
        highest_difference: Highest difference frequency (Hz on the files' time axis) of bound waves; None: all.
        acting: Where bound waves act on the platform.
    """

    order: Literal[1, 2] = 2
    kinds: Annotated[tuple[second_order.Kind, ...], Field(min_length=1)] = second_order.KINDS
    highest_difference: Positive | None = None
    acting: Acting = "everywhere"

    @model_validator(mode="after")
    def _second_order(self) -> Recording:
        if self.order == 1 and (stated := sorted(self.model_fields_set - {"order"})):
            raise Faults(*(Problem(key, "nothing, since linear waves bind none", shown(getattr(self, key))) for key in stated))
        return self


class Period(Schema):
    """A natural period, s, and its standard deviation."""

    value: Positive
    standard_deviation: Positive


class Prior(Schema):
    """A normal prior, in the parameter's own unit."""

    value: Number
    standard_deviation: Positive


class Calibrate(Schema):
    """Parameters to calibrate, as labels or patterns such as `column.*`.

    Without `free`, all parameters that the model declares are calibrated.
    """

    free: tuple[Text, ...] | None = None
    fixed: tuple[Text, ...] = ()
    bounds: dict[str, tuple[Number, Number]] = Field(default_factory=dict)
    priors: dict[str, Prior] = Field(default_factory=dict)
    natural_periods: dict[Text, Period] = Field(default_factory=dict)


StatedQuantity = Annotated[str | float, PlainValidator(check_stated_size)]


class Manifest(Schema):
    """A campaign.yaml."""

    name: Name
    platform: Text
    scale: Annotated[Positive, Field(le=1e5)] = 1.0
    density_ratio: Annotated[Positive, Field(le=100)] = 1.0
    channels: dict[str, Channel]
    wave_channel: WaveChannel | None = None
    wave_band: tuple[Positive, Positive] | None = None  # Hz on the files' time axis
    noise: dict[str, Positive] = Field(default_factory=dict)
    zero: Zero | None = None
    tracked_point: tuple[Number, Number, Number] | None = None  # m at the scale of the files, body axes
    records: Recording = Recording()
    tests: tuple[Test, ...]
    calibrate: Calibrate = Calibrate()
    plausible: dict[Text, StatedQuantity] = Field(default_factory=dict)  # sizes that effects may have

    @model_validator(mode="after")
    def _consistent(self) -> Manifest:
        problems = [*_channel_problems(self), *_test_problems(self), *_other_problems(self)]
        if problems:
            raise Faults(*problems)
        return self

    @property
    def all_channels(self) -> dict[str, Channel]:
        """The channels as declared for all tests, `time` and, where there is one, `wave` among them."""
        return {**self.channels, **({} if self.wave_channel is None else {WAVE: self.wave_channel})}

    def channels_of(self, test: Test) -> dict[str, Channel]:
        """`all_channels` with the test's overrides applied."""
        channels = self.all_channels
        for name, override in test.channels.items():
            if override is None:
                channels.pop(name)
            else:
                channels[name] = channels[name].model_copy(update=override.model_dump(exclude_none=True))
        return channels

    def turned(self, channels: Collection[str]) -> Manifest:
        """With the signs of these channels changed, in tests that have one of their own, too."""

        def reverse(entries: Mapping[str, Any]) -> dict[str, Any]:
            return {
                name: entry.model_copy(update={"sign": -entry.sign}) if name in channels and entry and entry.sign else entry
                for name, entry in entries.items()
            }

        wave = None if self.wave_channel is None else reverse({WAVE: self.wave_channel})[WAVE]
        tests = tuple(test.model_copy(update={"channels": reverse(test.channels)}) for test in self.tests)
        return self.model_copy(update={"channels": reverse(self.channels), "wave_channel": wave, "tests": tests})


def _channel_problems(manifest: Manifest) -> Iterator[Problem]:
    if "time" not in manifest.channels:
        yield Problem("channels", "the channel time", ", ".join(manifest.channels) or "no channels")
    elif len(manifest.channels) < 2:
        yield Problem("channels", "a motion beside time: " + ", ".join(DOFS), "time only")
    units = [(f"channels.{name}", name, channel.unit) for name, channel in manifest.channels.items()]
    units += [("wave_channel", WAVE, manifest.wave_channel.unit)] if manifest.wave_channel is not None else []
    for i, test in enumerate(manifest.tests):
        for name, override in test.channels.items():
            if name not in manifest.all_channels:
                yield _unknown(f"tests[{i}].channels", "a declared channel", name, manifest.all_channels)
            elif override is None and name == "time":
                yield Problem(f"tests[{i}].channels.time", "a column", "nothing")
            elif override is not None and override.unit is not None:
                units.append((f"tests[{i}].channels.{name}", name, override.unit))
    for where, name, unit in units:
        if name not in (*CHANNELS, WAVE) or where == "channels.wave":
            hint = "Waves have their own key, wave_channel." if name == WAVE else suggest(name, CHANNELS)
            yield Problem(where, "one of " + ", ".join(CHANNELS), repr(name), hint)
        elif unit not in (allowed := SI[quantity(name)]):
            yield Problem(
                f"{where}.unit", f"a unit of {quantity(name)}: " + ", ".join(allowed), repr(unit), suggest(unit, allowed)
            )


def _test_problems(manifest: Manifest) -> Iterator[Problem]:
    if not manifest.tests:
        yield Problem("tests", "one test at least", "none")
    ids = [test.id for test in manifest.tests]
    for i, test in enumerate(manifest.tests):
        where = f"tests[{i}]"
        if not re.fullmatch(r"[\w+=][\w .,()+=@-]*", test.id) or test.id[-1] in " ." or len(test.id) > 100:
            yield Problem(f"{where}.id", "a name that can be a file's: letters, digits, - _ . and the like", repr(test.id))
        if test.id.lower() in (name.lower() for name in ids[:i]):
            yield Problem(f"{where}.id", "an id that no other test has", repr(test.id), "Upper and lower case are alike.")
        if test.repeat_of is not None and (test.repeat_of not in ids or test.repeat_of == test.id):
            yield _unknown(f"{where}.repeat_of", "the id of another test", test.repeat_of, set(ids) - {test.id})
        present = [name for name in manifest.channels if name in DOFS and test.channels.get(name, True) is not None]
        if not present:
            yield Problem(f"{where}.channels", "one motion at least", "none that is left")
        if test.kind == "decay" and test.degree_of_freedom is None:
            yield Problem(f"{where}.degree_of_freedom", "the motion that was released: " + ", ".join(DOFS), "nothing")
        elif test.degree_of_freedom is not None and test.degree_of_freedom not in present:
            yield Problem(
                f"{where}.degree_of_freedom", "a motion that has a channel: " + ", ".join(present), repr(test.degree_of_freedom)
            )
        if test.kind in IN_WAVES and test.use != "ignore" and manifest.wave_channel is None:
            yield Problem(f"{where}.kind", "a wave_channel in the manifest, since waves drive this test", "none")
        in_waves = test.kind in IN_WAVES and test.use != "ignore"
        if in_waves and not test.sea.long_crested and manifest.records.order != 1:
            hint = "Second order is not separated from a record of one gauge then."
            yield Problem(f"{where}.sea", "records: {order: 1} with waves of several headings", "order: 2", hint)
        if manifest.tracked_point is not None:
            yield from (
                Problem(f"{where}, {p.where}", p.expected, p.found, p.hint)
                for p in missing_angles(manifest.tracked_point, present)
            )
        for problem in _ordered(test.window) if test.window is not None else ():
            yield Problem(f"{where}.window", problem.expected, problem.found)


def _other_problems(manifest: Manifest) -> Iterator[Problem]:
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


def read_manifest(path: str | PathLike[str]) -> tuple[Manifest, Path]:
    """Read the manifest of a campaign.

    Args:
        path: Folder of the campaign, or path of its manifest.

    Returns:
        The manifest and the campaign's folder.

    Raises:
        InputError: Anything is wrong; it has all mistakes.
    """
    path = campaign_file(path)
    folder = path.parent
    data: Any = read_yaml(path, "campaign")
    manifest = validate(Manifest, data, str(path))
    problems = []
    for i, test in enumerate(manifest.tests):
        if not _there(folder / test.file):
            near = [item.name for item in folder.iterdir() if item.is_file()]
            actual = f"{'a folder' if (folder / test.file).is_dir() else 'no such file'}: {test.file!r}"
            problems.append(Problem(f"tests[{i}].file", f"a file in {folder}", actual, suggest(test.file, near)))
    if _is_path(manifest.platform) and not _there(folder / manifest.platform):
        near = [item.name for item in folder.iterdir() if item.suffix in (".yaml", ".yml")]
        problems.append(
            Problem(
                "platform",
                f"a file in {folder}, or a built-in platform's name",
                f"no such file: {manifest.platform!r}",
                suggest(manifest.platform, near),
            )
        )
    if problems:
        raise InputError(str(path), problems)
    return manifest, folder


def platform_source(manifest: Manifest, folder: Path) -> str:
    """Argument of `load_platform` for a campaign's platform.

    Returns:
        Path of the campaign's own platform file, or the name of a built-in platform.
    """
    path = folder / manifest.platform
    return str(path) if _is_path(manifest.platform) or _there(path) else manifest.platform


def _is_path(platform: str) -> bool:
    return bool(re.search(r"[/\\]|\.[A-Za-z]\w*$", platform))


def _there(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):  # a name that no file can have
        return False
