"""Guesses which columns of a data file are time, motions and the wave elevation, and their units."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
import pandas as pd

from calibration.campaign.manifest_sections import CHANNELS, DOFS, WAVE, quantity
from calibration.campaign.series import valid_values
from calibration.new_campaign.column_names import channel_of, is_greek
from jaxhydro.units import SI

DEFAULT_UNITS = {"time": "s", "length": "m", "angle": "deg"}
MAX_ANGLE = np.pi / 2  # rad: larger angles are refused by `check_records`
MAX_RADIAN_RANGE = 0.6  # peak to peak: angles named phi, theta, psi that stay within it are taken for radians


@dataclass(frozen=True)
class ColumnGuess:
    """A column of a file that is taken for a channel.

    Attributes:
        column: Its name, or its number from 0 where the name is not the only one of its kind.
        unit: Unit as a manifest writes it.
        by: What the column is recognised by.
        unit_by: Where the unit is from: the file, the size of the values, or the default unit.
        others: Further columns whose names fit the channel.
    """

    column: str | int
    unit: str
    by: Literal["name", "rising values"]
    unit_by: Literal["file", "size", "default"]
    others: tuple[str, ...] = ()


def guess_columns(table: pd.DataFrame) -> dict[str, ColumnGuess]:
    """Guess the channels of a table by the names of its columns.

    Args:
        table: As `read_table` returns it.

    Returns:
        channel (time, motions, wave) -> its column, for those that are recognised.
    """
    names = [str(name) for name in table.columns]
    candidates: dict[str, list[tuple[int, int]]] = {}  # channel -> ranks and numbers of columns
    for number, name in enumerate(names):
        match = channel_of(name) if table.iloc[:, number].dtype.kind == "f" else None
        if match is not None and _may_be(match[0], name, table):
            candidates.setdefault(match[0], []).append((-match[1], number))
    guesses: dict[str, ColumnGuess] = {}
    for channel in (*CHANNELS, WAVE):
        ordered = sorted(candidates.get(channel, []))
        by: Literal["name", "rising values"] = "name"
        if not ordered and channel == "time":
            taken = {number for ranked in candidates.values() for _, number in ranked}
            ordered, by = [(0, number) for number in _rising(table, taken)][:1], "rising values"
        if ordered:
            number = ordered[0][1]
            stated = table.attrs.get("stated", {}).get(names[number])
            unit = stated or DEFAULT_UNITS[quantity(channel)]
            if names[number] in table.attrs.get("times", ()):
                unit = stated = "s"  # written as times of day, read as seconds
            column = names[number] if names.count(names[number]) == 1 and names[number] else number
            others = tuple(names[index] for _, index in ordered[1:])
            guesses[channel] = ColumnGuess(column, unit, by, "file" if stated else "default", others)
    return guesses


def values_of(table: pd.DataFrame, guess: ColumnGuess) -> np.ndarray:
    """Values of a guessed column, in SI."""
    names = [str(name) for name in table.columns]
    number = guess.column if isinstance(guess.column, int) else names.index(guess.column)
    return table.iloc[:, number].to_numpy() * next(units[guess.unit] for units in SI.values() if guess.unit in units)


def left_out(table: pd.DataFrame, guesses: Mapping[str, ColumnGuess]) -> set[str]:
    """Return motions with angles beyond 90 degrees, which no model follows.

    Such a motion is a heading that was not zeroed.
    """
    angles = {channel: values_of(table, guess) for channel, guess in guesses.items() if channel in DOFS[3:]}
    return {channel for channel, values in angles.items() if np.abs(values[valid_values(values)]).max(initial=0.0) > MAX_ANGLE}


def are_radians(ranges: Mapping[str, float]) -> bool:
    """Tell whether angles without a unit are radians, by their sizes in all files.

    Args:
        ranges: column -> largest less smallest value, of motions that are angles and have no unit.
    """
    return bool(ranges) and all(map(is_greek, ranges)) and 0 < max(ranges.values()) < MAX_RADIAN_RANGE


def ranges_without_unit(table: pd.DataFrame, guesses: Mapping[str, ColumnGuess]) -> dict[str, float]:
    """Return column -> largest less smallest value, of angles for which the file states no unit."""
    ranges: dict[str, float] = {}
    for channel in DOFS[3:]:
        guess = guesses.get(channel)
        if guess is not None and guess.unit_by == "default":
            values = values_of(table, guess) / SI["angle"][guess.unit]
            values = values[valid_values(values)]
            ranges[str(guess.column)] = float(np.ptp(values)) if len(values) else 0.0
    return ranges


def _may_be(channel: str, name: str, table: pd.DataFrame) -> bool:
    """Whether the unit that the file states for a column leaves the channel possible."""
    stated = table.attrs.get("stated", {}).get(name)
    if stated is not None:
        return stated in SI[quantity(channel)]
    return not set(str(table.attrs.get("units", {}).get(name, ""))) & set("/^²N")


def _rising(table: pd.DataFrame, taken: Collection[int]) -> Iterator[int]:
    """Numbers of columns whose values rise from row to row."""
    for number in range(table.shape[1]):
        if number not in taken and table.iloc[:, number].dtype.kind == "f":
            values = table.iloc[:, number].to_numpy()
            if len(values) > 2 and np.isfinite(values).all() and (np.diff(values) > 0).all():
                yield number
