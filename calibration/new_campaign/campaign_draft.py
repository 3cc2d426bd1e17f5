"""Draft of a campaign: its columns and tests, before they are written as campaign.yaml."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from calibration.campaign.manifest_sections import Use
from calibration.new_campaign.column_guesses import ColumnGuess
from calibration.new_campaign.kind_guesses import KindGuess

Columns = Mapping[str, ColumnGuess]


@dataclass(frozen=True)
class TestDraft:
    """One test of a draft.

    Attributes:
        id: Id, from the name of the file.
        file: Name of the file in the campaign's folder.
        guess: What the test is taken for.
        use: Use.
        columns: channel -> column of this file.
        overrides: channel -> column, where it is not the campaign's; None where the file has none.
        repeats: Number of tests of this kind and motion.
        left_out: channel -> column of angles beyond 90 degrees, which are not used.
        still: Time in which the platform rests before it is pushed, in the file's unit.
        window: Longest part without a gap, in the file's unit, where only that part is used.
    """

    __test__ = False  # not for pytest

    id: str
    file: str
    guess: KindGuess
    use: Use = "fit"
    columns: Columns = field(default_factory=dict)
    overrides: Mapping[str, ColumnGuess | None] = field(default_factory=dict)
    repeats: int = 1
    left_out: Columns = field(default_factory=dict)
    still: tuple[float, float] | None = None
    window: tuple[float, float] | None = None


@dataclass(frozen=True)
class CampaignDraft:
    """A campaign as guessed from its data files.

    Attributes:
        name: Name of the campaign.
        platform: Built-in platform or file that was copied.
        own_platform: Whether it is a file of the user's.
        scale: Froude length scale; None where it was not stated.
        columns: channel (time, motions, wave) -> column of the files.
        tests: Tests, in the order of the files.
        from_files: Whether data files were read; otherwise it is an example.
        still: Time in which the platform rests in every file, in the files' unit.
        sizes: Coefficients of the platform that are not 0, by label.
    """

    name: str
    platform: str
    own_platform: bool
    scale: float | None
    columns: Columns
    tests: tuple[TestDraft, ...]
    from_files: bool
    still: tuple[float, float] | None = None
    sizes: Mapping[str, float] = field(default_factory=dict)


def example_draft(name: str, platform: str, own_platform: bool, scale: float | None) -> CampaignDraft:
    """Draft without data files: a decay of surge, heave and pitch each, in files that are to be added."""
    columns = {
        channel: ColumnGuess(f"{channel}_{unit}", unit, "name", "default")
        for channel, unit in (("time", "s"), ("surge", "m"), ("heave", "m"), ("pitch", "deg"))
    }
    tests = (TestDraft(f"{dof}-1", f"{dof}-1.csv", KindGuess("decay", dof)) for dof in ("surge", "heave", "pitch"))
    return CampaignDraft(name, platform, own_platform, scale, columns, tuple(tests), False)
