"""Records cut into frequency bands, so that residuals of any colour are weighed by what they are there."""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.signal.windows import tukey

BAND_GROWTH = 1.4  # of the edge of one band to the next
MIN_LINES_PER_BAND = 4  # Fourier lines in a band at least


def step_of(time: np.ndarray) -> float:
    """Step (s) of a record's times (n,), which need not be quite even."""
    return float(time[-1] - time[0]) / (len(time) - 1)


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
    width = float(MIN_LINES_PER_BAND)
    while edges[-1] < line[-1] + 0.5:
        edges.append(edges[-1] + width)
        width = max(MIN_LINES_PER_BAND, (BAND_GROWTH - 1) * edges[-1])
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


class FourierRows(NamedTuple):
    """How some time series become one column of rows: real and imaginary parts of the Fourier lines that are in a band, scaled
    so that sums of squares over rows are those over samples (Parseval).

    `members` is how many series there are, some perhaps without rows; `take` (l,) are lines among those of all series, one
    series after the other; `scale` (l,) their factor; `series` (2l,) and `band` (2l,) where a row belongs. Series are
    multiplied by `taper` (t,), of mean square 1.
    """

    members: int
    take: np.ndarray
    scale: np.ndarray
    series: np.ndarray
    band: np.ndarray
    lines: int
    taper: np.ndarray

    @classmethod
    def of(cls, cuts: Sequence[Bands], samples: int, tapered: float = 0.0) -> "FourierRows":
        """From the bands of every series, all of one length, of which the share `tapered` rises and falls at the ends: what
        goes on beyond them leaks from where a spectrum has a peak into all that is beside it."""
        lines = max(one.member.shape[1] for one in cuts)
        member = np.stack([np.pad(one.member, ((0, 0), (0, lines - one.member.shape[1]))) for one in cuts])
        series, line = np.nonzero(member.any(axis=1))
        scale = np.sqrt(np.where(line == 0, 1.0, 2.0) / samples)
        band = member.argmax(axis=1)[series, line]
        taper = tukey(samples, tapered)
        taper /= np.sqrt(np.mean(taper**2))
        return cls(len(cuts), series * lines + line, scale, np.repeat(series, 2), np.repeat(band, 2), lines, taper)

    def __call__(self, values: np.ndarray) -> np.ndarray:
        """Rows (2l, ...) of time series (s, t, ...)."""
        taper = self.taper.reshape(1, -1, *[1] * (values.ndim - 2))
        lines = np.fft.rfft(taper * values, axis=1)[:, : self.lines]
        kept = lines.reshape(lines.shape[0] * lines.shape[1], *values.shape[2:])[self.take]
        kept = kept * self.scale.reshape(-1, *[1] * (values.ndim - 2))
        return np.stack([kept.real, kept.imag], axis=1).reshape(2 * len(kept), *values.shape[2:])


def band_powers(cut: Bands, values: np.ndarray, tapered: float = 0.0) -> np.ndarray:
    """Mean square of a time series (t,) in every band (b,), by degree of freedom: of white noise its variance in each."""
    rows = FourierRows.of([cut], len(values), tapered)
    found = np.bincount(rows.band, rows(values[None]) ** 2, len(cut.lines))
    return np.where(cut.lines > 0, found / np.where(cut.lines > 0, 2 * cut.lines, 1.0), 0.0)
