"""Warnings on the start and end of a record: held or pushed models, late waves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from calibration.campaign.manifest_sections import IN_WAVES, WAVE
from calibration.campaign.series import Series
from calibration.campaign.wave_bounds import AVERAGING_CYCLES, begun_before, wave_span, waves_left, waves_of_others

_WINDOW_HINT = "a `window` that begins later overrides this"
ExtentWarning = tuple[str, float | None, str]  # channel, time, message


def extent_warnings(
    series: Series, time: np.ndarray, values: Mapping[str, np.ndarray], compared: np.ndarray, period: float | None
) -> Iterator[ExtentWarning]:
    """Yield warnings on where a decay or a sea begins and ends.

    Args:
        series: the test.
        time: (n,) times of its good rows.
        values: channel -> (n,) values of these rows.
        compared: (n,) bool, rows after the transient.
        period: of the released motion or of the waves, in the unit of `time`; None where it is not clear.
    """
    if series.test.kind == "decay":
        yield from _free_motion_warnings(series, time)
        yield from _wave_in_decay_warnings(series, time, values, period)
    elif series.test.kind in IN_WAVES and WAVE in values and period is not None and compared.any():
        yield from _wave_span_warnings(series, time, values[WAVE], compared, period)


def _at(series: Series, time: float) -> str:
    return f"{time:.6g} {series.channels['time'].unit}"


def _free_motion_warnings(series: Series, time: np.ndarray) -> Iterator[ExtentWarning]:
    """Warn of the parts of a decay that are left out, since the model was held or pushed."""
    free, channel = series.free, str(series.test.degree_of_freedom)
    if free is None:
        return
    begin, until, ended = (_at(series, float(moment)) for moment in (time[0], free.held_until, free.ended_at))
    still = f"stands still at {free.level:.4g} {series.channels[channel].unit} until {until}"
    if free.start == "release":
        yield channel, free.held_until, f"{still}: the decay begins at this release, {begin} ({_WINDOW_HINT})"
    elif free.start == "push":
        message = f"{still}, and is pushed or pulled then: the decay begins where it turns, {begin} ({_WINDOW_HINT})"
        yield channel, free.held_until, message
    if free.end != "record":
        disturbance = "pushed or pulled" if free.end == "push" else "held"
        done = "`window` includes this" if series.test.window else "the decay ends there (`window` overrides this)"
        yield channel, free.ended_at, f"is {disturbance} again after {ended}: {done}"


def _wave_in_decay_warnings(
    series: Series, time: np.ndarray, values: Mapping[str, np.ndarray], period: float | None
) -> Iterator[ExtentWarning]:
    """Is a decay in still water?"""
    channel = str(series.test.degree_of_freedom)
    if WAVE in values and (waves := waves_of_others(time, values[WAVE], period)) is not None:
        height = f"{2 * waves[1]:.2g} {series.channels[WAVE].unit} high"
        yield WAVE, None, f"waves of {_at(series, waves[0])}, {height}, where a decay should be in still water"
    elif period is not None and channel in values and (oscillation := waves_left(time, values[channel], period)) is not None:
        size = f"{oscillation[1]:.2g} {series.channels[channel].unit}"
        yield (
            channel,
            None,
            f"its last third oscillates by {size} in {_at(series, oscillation[0])}: are waves left in the basin?",
        )


def _wave_span_warnings(
    series: Series, time: np.ndarray, wave: np.ndarray, compared: np.ndarray, period: float
) -> Iterator[ExtentWarning]:
    """Do the waves begin and end in the record?"""
    transient = series.test.transient
    if series.rows[0] == 0 and transient < AVERAGING_CYCLES / 2 * period and begun_before(time, wave, period):
        told = "the waves have begun before the record, and the platform is simulated from rest: leave the first cycles out"
        yield WAVE, float(time[0]), f"{told} (`transient` is {_at(series, transient)})"
    time, wave = time[compared], wave[compared]
    first, last = wave_span(time, wave, period)
    if first > time[0]:
        yield WAVE, first, f"the waves begin at {_at(series, first)} only: leave out what is before, by `transient` or `window`"
    if last < time[-1]:
        yield WAVE, last, f"the waves die down after {_at(series, last)}: `window` should end there"
