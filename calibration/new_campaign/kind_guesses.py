"""Guesses of the kind of a recorded test: decay of a motion, regular or irregular waves, or none."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy import ndimage, stats

from calibration.campaign.checked_series import GAP_STEPS
from calibration.campaign.manifest_sections import Kind, quantity
from calibration.campaign.release import free_motion
from calibration.campaign.series import valid_values
from calibration.campaign.signals import noise_level

SMOOTHING_SHARE = 0.01  # of a record, over which velocities are averaged
MAX_OFFSET_WEIGHT = 3.0  # standard deviations: a decay that begins further out is no clearer
MIN_OFFSET = 1.0  # standard deviations: a decay begins at least as far from its later mean
MAX_LATE_SHARE = 0.8  # standard deviation of a decay's last quarter over that of its first
STILL_WAVE_NOISE = 3.0  # standard deviations of the noise: waves that are no larger are still water
STILL_WAVE_SHARE = 0.05  # of the largest displacement's standard deviation
MAX_LATE_WAVE_SHARE = 0.3  # last quarter over first half: waves that the platform itself has made
MAX_REGULAR_KURTOSIS = 2.1  # 1.5 of a sine, 3 of an irregular sea
MIN_ROWS = 40


@dataclass(frozen=True)
class KindGuess:
    """What a test is taken for.

    Attributes:
        kind: Kind; static where neither waves nor a decay are seen.
        degree_of_freedom: Motion that was released, of a decay.
        by_name: Whether the motion is from the name of the file, and the record shows another motion more.
        still_wave: Whether the file has a wave column, and no waves come in.
        window: Times (s) of the longest part without a gap, where a decay is seen in that part only.
    """

    kind: Kind
    degree_of_freedom: str | None = None
    by_name: bool = False
    still_wave: bool = False
    window: tuple[float, float] | None = None


def guess_kind(
    time: np.ndarray,
    motions: Mapping[str, np.ndarray],
    wave: np.ndarray | None,
    length: float,
    named: str | None = None,
) -> KindGuess:
    """Guess the kind of a test, and of a decay the motion that was released.

    Args:
        time: (n,) s.
        motions: motion -> (n,) m or rad.
        wave: (n,) elevation, m, or None.
        length: Length (m) by which angles are multiplied to compare them with displacements.
        named: Motion that the name of the file has.
    """
    good = valid_values(time)
    for values in motions.values():
        good = good & (valid_values(values) if np.isfinite(values).any() else True)
    rows = np.flatnonzero(good)
    rows = rows[np.diff(np.maximum.accumulate(time[rows]), prepend=-np.inf) > 0]
    time = time[rows]
    motions = {name: values[rows] for name, values in motions.items() if np.isfinite(values[rows]).all()}
    whole = _guess(time, motions, None if wave is None else wave[rows], length, named)
    steps = np.diff(time)
    if (
        whole.kind != "static"
        or len(time) < MIN_ROWS
        or not (gaps := np.flatnonzero(steps > GAP_STEPS * np.median(steps))).size
    ):
        return whole
    ends = [0, *(gaps + 1), len(time)]
    part = max((slice(*ends[i : i + 2]) for i in range(len(ends) - 1)), key=lambda part: part.stop - part.start)
    guess = _guess(
        time[part],
        {name: values[part] for name, values in motions.items()},
        None if wave is None else wave[rows][part],
        length,
        named,
    )
    return replace(guess, window=(float(time[part][0]), float(time[part][-1]))) if guess.kind == "decay" else whole


def _guess(
    time: np.ndarray, motions: Mapping[str, np.ndarray], wave: np.ndarray | None, length: float, named: str | None
) -> KindGuess:
    """The kind of a test from valid rows. See `guess_kind`."""
    if len(time) < MIN_ROWS or not motions:
        return KindGuess("static")
    released, dying = _released(time, motions, length)
    dies_out = released in dying
    if wave is not None:
        valid = valid_values(wave)
        wave = np.where(valid, wave, float(np.mean(wave[valid])) if valid.any() else 0.0)
        if not _is_still(time, wave, motions, dies_out):
            middle = wave[len(wave) // 4 : 3 * len(wave) // 4]
            regular = float(stats.kurtosis(middle, fisher=False)) < MAX_REGULAR_KURTOSIS
            return KindGuess("regular" if regular else "irregular")
    still = wave is not None
    if named in dying:
        return KindGuess("decay", named, named != released, still)
    return KindGuess("decay", released, False, still) if dies_out else KindGuess("static", still_wave=still)


def _released(time: np.ndarray, motions: Mapping[str, np.ndarray], length: float) -> tuple[str, set[str]]:
    """The motion that is fastest and begins furthest from its later mean, and all motions that die out.

    Velocities are compared, angles times a length, since a slow drift beside a decay may be larger than the decay.
    """
    width = max(round(SMOOTHING_SHARE * len(time)), 1)
    weights: dict[str, float] = {}
    dying: set[str] = set()
    for name, values in motions.items():
        free = free_motion(time, values)
        part = values[free.first : free.last]
        quarter, spread = len(part) // 4, float(np.std(part))
        offset = abs(float(part[0] - np.mean(part[2 * quarter :]))) / spread if spread else 0.0
        late, early = float(np.std(part[3 * quarter :])), float(np.std(part[:quarter]))
        speed = float(np.std(np.gradient(ndimage.uniform_filter1d(values, width, mode="nearest"), time)))
        size = speed * (length if quantity(name) == "angle" else 1.0)
        weights[name] = size * min(offset, MAX_OFFSET_WEIGHT)
        if offset > MIN_OFFSET and late < MAX_LATE_SHARE * early:
            dying.add(name)
    return max(weights, key=lambda name: weights[name]), dying


def _is_still(time: np.ndarray, wave: np.ndarray, motions: Mapping[str, np.ndarray], dies_out: bool) -> bool:
    """Whether no waves come in: none at all, noise, or waves that a decaying platform sends out itself."""
    size = float(np.std(wave))
    largest = max((float(np.std(values)) for name, values in motions.items() if quantity(name) == "length"), default=0.0)
    if size <= max(STILL_WAVE_NOISE * noise_level(time, wave), STILL_WAVE_SHARE * largest * dies_out):
        return True
    late, early = float(np.std(wave[3 * len(wave) // 4 :])), float(np.std(wave[: len(wave) // 2]))
    return dies_out and late < MAX_LATE_WAVE_SHARE * early
