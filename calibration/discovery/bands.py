"""Records cut into frequency bands, so that residuals of any colour are weighed by what they are there."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

GROWTH = 1.4  # of the edge of one band to the next
LINES = 4  # Fourier lines in a band at least
HIGHEST = 0.35  # Hz at full scale: motions of a floating platform are slower; relative to the shortest natural period elsewhere


class Bands(NamedTuple):
    """Which Fourier line of a record belongs to which band.

    `member` (b, f) is 1 where it does; `lines` (b,), how many lines of the record's own length those are (half of that is
    the band's degrees of freedom: a line is a sine and a cosine); `low` and `high` (b,) in Hz. A line of frequency 0 is a band
    of its own.
    """

    member: np.ndarray
    lines: np.ndarray
    low: np.ndarray
    high: np.ndarray


def bands_of(duration: float, step: float, length: int, count: int, highest: float) -> Bands:
    """`count` bands of a record of `duration` (s) among `length` samples `step` (s) apart, zeros after its end; up to
    `highest` (Hz), widths growing by GROWTH. What is not needed of them is empty."""
    frequency = np.fft.rfftfreq(length, step)
    frequency = frequency[frequency <= highest]
    line = frequency * duration
    edges = [0.0, 0.5]
    width = float(LINES)
    while edges[-1] < line[-1] + 0.5:
        edges.append(edges[-1] + width)
        width = max(LINES, (GROWTH - 1) * edges[-1])
    edges = edges[: count + 1]
    edges[-1] = max(edges[-1], line[-1] + 0.5)
    member = np.zeros((count, len(frequency)))
    lines, low, high = np.zeros(count), np.zeros(count), np.zeros(count)
    for i, (begin, end) in enumerate(pairwise(edges)):
        inside = (line >= begin) & (line < end)
        member[i, inside] = 1.0
        number = inside.sum() * duration / (length * step)  # padding makes lines denser, not more
        lines[i] = 0.5 if i == 0 else number
        low[i], high[i] = begin / duration, end / duration
    return Bands(member, lines, low, high)
