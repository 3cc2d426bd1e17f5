"""Resolution of a recorded channel, and detection of linearly interpolated samples."""

from __future__ import annotations

import numpy as np

from calibration.campaign.signals import resolution

_PLACES = range(-6, 13)  # decimal places that are looked for
_PLACES_QUANTILE = 0.9  # quantile of the places in one decade: trailing zeros are not written
_LONGEST_PIECE = 50.0  # samples: a straight piece that is longer is no sign of interpolation
_ROUNDING_STEPS = 2.5  # steps of the last digit, by which rounding alone bends a straight line
_CORNER_RATIO = 2.0  # times that, at half of the corners at least


def local_resolution(values: np.ndarray) -> np.ndarray:
    """Return the step in which each value was written, (n,).

    No step is less than the `resolution` of all values. A fixed number of significant digits (%.4g) makes this step grow with
    the value by decades, a float32 by octaves.
    """
    step = np.full(len(values), resolution(values))
    size = np.abs(values)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        decade = np.where(size > 0, np.floor(np.log10(size) + 1e-12), -99)
        places = np.full(len(values), np.inf)
        for decimals in reversed(_PLACES):
            scaled = values * 10.0**decimals
            places[np.abs(scaled - np.rint(scaled)) < 1e-9 * np.maximum(np.abs(scaled), 1.0)] = decimals
    for exponent in np.unique(decade[size > 0]):
        usual = float(np.quantile(places[decade == exponent], _PLACES_QUANTILE, method="lower"))
        if np.isfinite(usual):
            step[decade == exponent] = np.maximum(step[decade == exponent], 10.0**-usual)
    if np.array_equal(values, values.astype(np.float32)):
        step = np.maximum(step, np.spacing(np.abs(values).astype(np.float32)).astype(float))
    return step


def straight_piece(values: np.ndarray, step: np.ndarray) -> float:
    """Return the mean length of the straight or level pieces of an interpolated record.

    Args:
        values: (n,) one channel.
        step: (n,) its `local_resolution`.

    Returns:
        The length in samples; 1 for a record that was not interpolated.
    """
    rounding = _ROUNDING_STEPS * step[1:-1] + 1e-12 * np.abs(values).max()
    turn = np.abs(np.diff(values, 2)) / rounding
    bend = turn > 1
    corners = int(np.sum(bend[1:] & ~bend[:-1]))
    if not corners or bend.mean() > 0.5 or np.median(turn[bend]) < _CORNER_RATIO:
        return 1.0
    length = len(values) / corners
    return length if length <= _LONGEST_PIECE else 1.0
