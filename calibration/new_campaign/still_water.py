"""Guesses when nothing moves in a recorded test, so that its readings then are those of still water."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from calibration.campaign.release import free_motion
from calibration.campaign.series import valid_values
from calibration.new_campaign.campaign_draft import TestDraft

USED_SHARE = 0.9  # of the time before a push: its end may move already
MIN_STILL_SAMPLES = 40
MAX_STILL_SHARE = 0.05  # of a motion's later range, by which it may move in still water


def still_time(time: np.ndarray, motions: Mapping[str, np.ndarray], released: str | None) -> tuple[float, float] | None:
    """The time before a platform at rest is pushed; None where the record does not begin at rest.

    A platform that is held away from rest and let go does not begin at rest.

    Args:
        time: (n,) times, in any unit.
        motions: motion -> (n,) values.
        released: Motion that dies out; None: the test is no decay.
    """
    if released is None:
        return None
    good = valid_values(time) & valid_values(motions[released])
    when, values = time[good], motions[released][good]
    free = free_motion(when, values)
    if free.start != "push":
        return None
    begin, end = float(when[0]), float(when[0] + USED_SHARE * (free.held_until - when[0]))
    before, after = (time >= begin) & (time <= end), time > free.held_until
    if before.sum() < MIN_STILL_SAMPLES:
        return None
    moves = motions[released]
    if np.ptp(moves[before & good]) > MAX_STILL_SHARE * np.ptp(moves[after & good]):
        return None
    return begin, end


def common_still_time(tests: Sequence[TestDraft]) -> tuple[float, float] | None:
    """The time in which the platform rests in every file, to three digits; None where there is none."""
    times = [test.still for test in tests]
    intervals = [interval for interval in times if interval is not None]
    if not intervals or len(intervals) < len(times):
        return None
    begin, end = max(interval[0] for interval in intervals), min(interval[1] for interval in intervals)
    if not end > begin:
        return None
    digit = 10.0 ** np.floor(np.log10(end - begin) - 2)
    return float(f"{np.ceil(begin / digit) * digit:.10g}"), float(f"{np.floor(end / digit) * digit:.10g}")
