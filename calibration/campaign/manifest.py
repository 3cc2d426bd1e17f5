"""Schema of campaign.yaml, and how it is read.

Values are stated as they were recorded: windows, `transient`, noise, wave heights and positions. They are in the units and at
the scale of the files, whatever `scale` is. Bounds and priors of `calibrate`, and `plausible`, are about the model's
parameters and at the scale of the platform file.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from os import PathLike
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, PlainValidator, model_validator

from calibration.campaign.manifest_checks import channel_problems, other_problems, test_problems
from calibration.campaign.manifest_sections import (
    SECOND_WAVE,
    WAVE,
    Calibrate,
    Channel,
    Name,
    Recording,
    Test,
    WaveChannel,
    Zero,
)
from calibration.campaign.stated_sizes import check_stated_size
from jaxhydro.errors import Faults, InputError, Problem, suggest
from jaxhydro.files import campaign_file
from jaxhydro.input_schema import Number, Positive, Schema, Text, read_yaml, validate

StatedQuantity = Annotated[str | float, PlainValidator(check_stated_size)]


class Manifest(Schema):
    """A campaign.yaml."""

    name: Name
    platform: Text
    scale: Annotated[Positive, Field(le=1e5)] = 1.0
    density_ratio: Annotated[Positive, Field(le=100)] = 1.0
    channels: dict[str, Channel]
    wave_channel: WaveChannel | None = None
    second_wave_channel: WaveChannel | None = None  # in line with the waves: tells incident from reflected ones
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
        problems = [*channel_problems(self), *test_problems(self), *other_problems(self)]
        if problems:
            raise Faults(*problems)
        return self

    @property
    def all_channels(self) -> dict[str, Channel]:
        """The channels as declared for all tests, `time` and, where they are, `wave` and `second_wave` among them."""
        gauges = {WAVE: self.wave_channel, SECOND_WAVE: self.second_wave_channel}
        return {**self.channels, **{name: gauge for name, gauge in gauges.items() if gauge is not None}}

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

        gauges = reverse({WAVE: self.wave_channel, SECOND_WAVE: self.second_wave_channel})
        waves = {"wave_channel": gauges[WAVE], "second_wave_channel": gauges[SECOND_WAVE]}
        tests = tuple(test.model_copy(update={"channels": reverse(test.channels)}) for test in self.tests)
        return self.model_copy(update={"channels": reverse(self.channels), "tests": tests, **waves})


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
