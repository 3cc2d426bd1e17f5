"""Frequency bands of records, and Fourier lines as rows of a residual."""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import scipy  # its parts are imported when they are used: that takes a second

BAND_GROWTH = 1.4  # ratio of a band's edge to the one before
MIN_LINES_PER_BAND = 4  # Fourier lines


def step_of(time: np.ndarray) -> float:
    """Mean time step (s) of a record's times (n,)."""
    return float(time[-1] - time[0]) / (len(time) - 1)


class Bands(NamedTuple):
    """Assignment of a record's Fourier lines to frequency bands.

    The line of frequency 0 is a band of its own.

    Attributes:
        member: 1 where a line belongs to a band (b, f).
        lines: Lines of the record's own length in a band (b,); a line is a sine and a cosine, two degrees of freedom.
        low: Lower edges (Hz; b,).
        high: Upper edges (Hz; b,).
    """

    member: np.ndarray
    lines: np.ndarray
    low: np.ndarray
    high: np.ndarray


def cut_into_bands(duration: float, step: float, length: int, count: int, highest: float) -> Bands:
    """Frequency bands of a record, their width growing by `BAND_GROWTH`.

    Args:
        duration: Duration of the record (s).
        step: Time step (s).
        length: Number of samples, with zeros after the record's end.
        count: Number of bands; those not needed are empty.
        highest: Highest frequency (Hz).
    """
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
    """Transformation of time series to one column of rows: real and imaginary parts of Fourier lines.

    Rows are scaled so that sums of their squares are sums over samples (Parseval).

    Attributes:
        members: Number of series, some perhaps without rows.
        take: Numbers of the lines among those of all series, one series after the other (l,).
        scale: Factors of the lines (l,).
        series: Series of every row (2l,).
        band: Band of every row (2l,).
        lines: Number of lines of a series.
        taper: Taper of the series, of mean square 1 (t,).
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
        """Rows for the bands of some series of one length.

        Args:
            cuts: Bands by series.
            samples: Number of samples.
            tapered: Fraction of the record that is tapered, against leakage from peaks.
        """
        lines = max(bands.member.shape[1] for bands in cuts)
        member = np.stack([np.pad(bands.member, ((0, 0), (0, lines - bands.member.shape[1]))) for bands in cuts])
        series, line = np.nonzero(member.any(axis=1))
        scale = np.sqrt(np.where(line == 0, 1.0, 2.0) / samples)
        band = member.argmax(axis=1)[series, line]
        taper = scipy.signal.windows.tukey(samples, tapered)
        taper /= np.sqrt(np.mean(taper**2))
        return cls(len(cuts), series * lines + line, scale, np.repeat(series, 2), np.repeat(band, 2), lines, taper)

    def frequencies(self, duration: float | np.ndarray) -> np.ndarray:
        """Frequency (Hz) of every pair of rows (l,), for series of some duration (s; one, or one each)."""
        return self.take % self.lines / np.broadcast_to(duration, self.members)[self.take // self.lines]

    def __call__(self, values: np.ndarray) -> np.ndarray:
        """Rows (2l, ...) of time series (s, t, ...)."""
        taper = self.taper.reshape(1, -1, *[1] * (values.ndim - 2))
        lines = np.fft.rfft(taper * values, axis=1)[:, : self.lines]
        selected = lines.reshape(lines.shape[0] * lines.shape[1], *values.shape[2:])[self.take]
        selected = selected * self.scale.reshape(-1, *[1] * (values.ndim - 2))
        return np.stack([selected.real, selected.imag], axis=1).reshape(2 * len(selected), *values.shape[2:])


def band_powers(cut: Bands, values: np.ndarray, tapered: float = 0.0) -> np.ndarray:
    """Mean square of a time series (t,) in every band (b,), per degree of freedom."""
    rows = FourierRows.of([cut], len(values), tapered)
    squares = np.bincount(rows.band, rows(values[None]) ** 2, len(cut.lines))
    return np.where(cut.lines > 0, squares / np.where(cut.lines > 0, 2 * cut.lines, 1.0), 0.0)
