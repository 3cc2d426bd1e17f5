"""Draft of a campaign from data files: columns, units and kinds of tests are guessed."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pandas as pd

from calibration.campaign.manifest_sections import DOFS, IN_WAVES, WAVE, Use
from calibration.new_campaign.campaign_draft import CampaignDraft, Columns, TestDraft
from calibration.new_campaign.column_guesses import (
    ColumnGuess,
    are_radians,
    guess_columns,
    left_out,
    ranges_without_unit,
    values_of,
)
from calibration.new_campaign.column_names import channel_of, motion_in
from calibration.new_campaign.kind_guesses import guess_kind
from calibration.new_campaign.still_water import common_still_time, still_time
from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.data_files import read_table
from jaxhydro.units import SI

_EMPTY_CELL = "Leave the cell empty where nothing was measured, or delete the row."


def draft_of_files(
    name: str, platform: str, own_platform: bool, scale: float | None, files: Sequence[Path], length: float
) -> CampaignDraft:
    """Read data files and guess what is in them.

    Args:
        name: Name of the campaign.
        platform: Built-in platform or file that is copied.
        own_platform: Whether it is a file of the user's.
        scale: Froude length scale, or None where it is not stated.
        files: Data files, one per test.
        length: Length of the platform (m, full scale) by which angles are compared with displacements.

    Raises:
        InputError: A file cannot be read, two files have one name, or a file has no time column or no motion.
    """
    tables = _read(files)
    columns = [guess_columns(table) for table in tables]
    _check_columns(files, tables, columns)
    ranges: dict[str, float] = {}
    for table, guesses in zip(tables, columns):
        for column, size in ranges_without_unit(table, guesses).items():
            ranges[column] = max(size, ranges.get(column, 0.0))
    length /= scale or 1.0
    drafts = None
    if are_radians(ranges):
        drafts = _drafts(files, tables, [_in_radians(guesses) for guesses in columns], length)
        if not any(_angle_of_size(test) for test in drafts):
            drafts = None  # no angle was released: small ones may as well be degrees
    drafts = drafts or _drafts(files, tables, columns, length)
    if bare := [test.file for test in drafts if not set(test.columns) & set(DOFS)]:
        expected = "a motion with angles below 90 deg"
        raise InputError("data files", [Problem(file, expected, "none", "Is the unit in the header right?") for file in bare])
    shared = _shared_columns(drafts)
    tests = [replace(test, overrides=_overrides(shared, test)) for test in drafts]
    return CampaignDraft(name, platform, own_platform, scale, shared, _with_uses(tests), True, common_still_time(tests))


def _drafts(
    files: Sequence[Path], tables: Sequence[pd.DataFrame], columns: Sequence[Columns], length: float
) -> list[TestDraft]:
    """Tests with their kinds, before they are compared with each other."""
    tests: list[TestDraft] = []
    for file, table, guesses in zip(files, tables, columns):
        out = left_out(table, guesses)
        used = {channel: guess for channel, guess in guesses.items() if channel not in out}
        values = {channel: values_of(table, guess) for channel, guess in used.items()}
        motions = {dof: values[dof] for dof in DOFS if dof in values}
        guess = guess_kind(values["time"], motions, values.get(WAVE), length, motion_in(file.stem))
        unit = SI["time"][used["time"].unit]
        window = None if guess.window is None else (guess.window[0] / unit, guess.window[1] / unit)
        id = _id(file.stem, [test.id for test in tests])
        out_of_range = {name: guesses[name] for name in out}
        still = still_time(values["time"] / unit, motions, guess.degree_of_freedom)
        tests.append(TestDraft(id, file.name, guess, "fit", used, left_out=out_of_range, still=still, window=window))
    return tests


def _angle_of_size(test: TestDraft) -> bool:
    """Whether the released motion is an angle whose unit is taken from its size."""
    guess = test.columns.get(test.guess.degree_of_freedom or "")
    return guess is not None and guess.unit_by == "size"


def _read(files: Sequence[Path]) -> list[pd.DataFrame]:
    names = Counter(file.name.lower() for file in files)
    twice = [file for file in files if names[file.name.lower()] > 1]
    if twice:
        actual = ", ".join(map(str, twice))
        raise InputError("data files", [Problem("", "files of different names, since all go into one folder", actual)])
    tables: list[pd.DataFrame] = []
    errors: list[InputError] = []
    for file in files:
        try:
            tables.append(_with_numbers(file, read_table(file, keep_text=True)))
        except InputError as error:
            errors.append(error)
    if len(errors) == 1:
        raise errors[0]
    if errors:
        problems = [replace(p, where=f"{error.source}, {p.where}".rstrip(", ")) for error in errors for p in error.problems]
        raise InputError("data files", problems)
    return tables


def _with_numbers(file: Path, table: pd.DataFrame) -> pd.DataFrame:
    """The table. Raises InputError where a column that may be a channel has text among its numbers."""
    names = [str(name) for name in table.columns]
    unnamed = names == [str(i) for i in range(len(names))]
    mistakes = {
        number: faults
        for number, faults in table.attrs.get("not_numbers", {}).items()
        if unnamed or channel_of(names[number]) is not None
    }
    if mistakes:
        raise InputError(str(file), [replace(fault, hint=_EMPTY_CELL) for faults in mistakes.values() for fault in faults])
    return table


def _check_columns(files: Sequence[Path], tables: Sequence[pd.DataFrame], guesses: Sequence[Columns]) -> None:
    problems: list[Problem] = []
    for file, table, columns in zip(files, tables, guesses):
        names = list(map(str, table.columns))
        actual = ", ".join(names[:12])
        if names == [str(i) for i in range(len(names))]:
            actual = f"{len(names)} columns without names"
        if "time" not in columns:
            problems.append(Problem(str(file), "a time column, such as time_s", actual))
        if not set(columns) & set(DOFS):
            expected = f"a column of a motion ({', '.join(DOFS)}), such as surge_m, PtfmPitch_deg or phi"
            problems.append(
                Problem(
                    str(file),
                    expected,
                    actual,
                    "Name the columns in the first row of the file, or number them from 0 in campaign.yaml.",
                )
            )
    if problems:
        raise InputError("data files", problems)


def _in_radians(columns: Columns) -> dict[str, ColumnGuess]:
    return {
        channel: replace(guess, unit="rad", unit_by="size") if channel in DOFS[3:] and guess.unit_by == "default" else guess
        for channel, guess in columns.items()
    }


def _shared_columns(tests: Sequence[TestDraft]) -> dict[str, ColumnGuess]:
    """channel -> the column that most files have for it, the first of these where there is a tie."""
    shared: dict[str, ColumnGuess] = {}
    for channel in ("time", *DOFS, WAVE):
        users = [test for test in tests if channel != WAVE or test.guess.kind in IN_WAVES]
        guesses = [test.columns[channel] for test in users if channel in test.columns]
        if guesses:
            most = Counter((guess.column, guess.unit) for guess in guesses).most_common(1)[0][0]
            shared[channel] = next(guess for guess in guesses if (guess.column, guess.unit) == most)
    return shared


def _overrides(shared: Columns, test: TestDraft) -> dict[str, ColumnGuess | None]:
    """Columns of one file that are not the shared ones; None for a channel that is not to be read."""
    overrides: dict[str, ColumnGuess | None] = {}
    for channel, usual in shared.items():
        guess = test.columns.get(channel)
        if channel == WAVE and test.guess.kind not in IN_WAVES:
            if guess is not None:
                overrides[WAVE] = None  # still water
        elif guess is None or (guess.column, guess.unit) != (usual.column, usual.unit):
            overrides[channel] = guess
    return overrides


def _with_uses(tests: Sequence[TestDraft]) -> tuple[TestDraft, ...]:
    """Set the use of each test.

    The last of several tests of a kind and motion is held out. A test that is neither a decay nor in waves is ignored.
    """
    groups = [(test.guess.kind, test.guess.degree_of_freedom) for test in tests]
    counts = Counter(groups)
    used: list[TestDraft] = []
    for i, (test, group) in enumerate(zip(tests, groups)):
        last = counts[group] > 1 and group not in groups[i + 1 :]
        use: Use = "ignore" if test.guess.kind == "static" else "holdout" if last else "fit"
        used.append(replace(test, use=use, repeats=counts[group]))
    return tuple(used)


def _id(stem: str, taken: Sequence[str]) -> str:
    """An id that a manifest takes, from the name of a file."""
    clean = re.sub(r"[^\w .,()+=@-]", "_", stem)[:90].strip(" .-,()@") or "test"
    id, number = clean, 2
    while id.lower() in (name.lower() for name in taken):
        id, number = f"{clean}-{number}", number + 1
    return id
