"""Spectra and band energies of evenly sampled records.

All functions are pure and take and return NumPy arrays. They raise ValueError for uneven times: a gap, or jitter above 1 % of
a step.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxhydro.analysis.windows import window_weights
from jaxhydro.waves.record_harmonics import sampling_interval

SEGMENT = 1000.0  # s: 0.001 Hz between frequencies, so that the lowest band, 0.005 to 0.025 Hz, has twenty of them


class PowerSpectrum(NamedTuple):
    """One-sided power spectral density of a record.

    Attributes:
        frequency: Frequencies (Hz), (f,).
        density: Spectral density (unit²/Hz), (f,).
        segments: Number of segments averaged.
        resolution: Noise bandwidth of the window (Hz).
    """

    frequency: Float[np.ndarray, " f"]  # Hz
    density: Float[np.ndarray, " f"]  # unit^2/Hz
    segments: int
    resolution: float


def power_spectrum(
    time: Float[np.ndarray, " t"],
    x: Float[np.ndarray, " t"],
    segment: float | None = None,
    overlap: float = 0.5,
    window: str = "hann",
) -> PowerSpectrum:
    """Power spectral density by Welch's method.

    The mean of each segment is removed. Segments overlap by `overlap` or a little more, so that the last one reaches the end of
    the record. A segment as long as the record gives the raw periodogram without a window, whose sum is exactly the variance.

    Args:
        time: Sample times (s), (t,), even.
        x: Record (unit), (t,).
        segment: Length of a segment (s). None: 1000 s, or the whole of a shorter record.
        overlap: Least fraction of a segment shared with the next, from 0 to below 1.
        window: Name of a window of `scipy.signal.get_window`.

    Returns:
        The one-sided spectrum, averaged over all segments.

    Raises:
        ValueError: The times are uneven, values are not finite, or `segment` or `overlap` is out of range.

    References:
        Welch (1967).
    """
    step, x = checked_record(time, x)
    count, shared, window = segment_samples(len(x), step, segment, overlap, window)
    taper = window_weights(window, count)
    parts = np.lib.stride_tricks.sliding_window_view(x, count)[:: count - shared]
    lines = np.fft.rfft((parts - parts.mean(axis=1, keepdims=True)) * taper)
    density = (lines.real**2 + lines.imag**2).mean(axis=0) * _sides(count) * step / np.sum(taper**2)
    resolution = float(np.sum(taper**2) / (np.sum(taper) ** 2 * step))
    return PowerSpectrum(np.fft.rfftfreq(count, step), density, len(parts), resolution)


def band_integral(spectrum: PowerSpectrum, low: float, high: float) -> float:
    """Integral of a spectrum over a frequency band (unit²); over all frequencies, the variance.

    Each value of the density holds halfway to its neighbours on both sides. The first and the last value hold up to the
    ends. Where a limit cuts such a cell, the fraction inside the band counts.

    Args:
        spectrum: Result of `power_spectrum`.
        low: Lower limit (Hz).
        high: Upper limit (Hz).

    Returns:
        Variance within the band (unit²).

    Raises:
        ValueError: Unless 0 <= low < high.
    """
    _in_order(low, high)
    f = spectrum.frequency
    edges = _cell_edges(f)
    # each line holds density times spacing, also the first and the last, whose cells are halves: they are not doubled
    total = np.concatenate([[0.0], np.cumsum(spectrum.density) * (f[1] - f[0])])
    return float(np.interp(high, edges, total) - np.interp(low, edges, total))


def band_pass(time: Float[np.ndarray, " t"], x: Float[np.ndarray, " t"], low: float, high: float) -> Float[np.ndarray, " t"]:
    """Band-passed record, by its Fourier components from `low` to `high`, both included.

    Phases are unchanged. The record is taken as periodic. With `low` = 0 the mean stays in.

    Args:
        time: Sample times (s), (t,), even.
        x: Record (unit), (t,).
        low: Lower limit (Hz).
        high: Upper limit (Hz).

    Returns:
        Filtered record (unit), (t,).

    Raises:
        ValueError: The times are uneven, values are not finite, or not 0 <= low < high.
    """
    _in_order(low, high)
    step, x = checked_record(time, x)
    lines, frequency = np.fft.rfft(x), np.fft.rfftfreq(len(x), step)
    lines[(frequency < low) | (frequency > high)] = 0
    return np.fft.irfft(lines, len(x))


class BandWeights(NamedTuple):
    """`band_integral` of `power_spectrum` as a quadratic form of the record.

    The integral is the mean over segments of sum_f weight |F|². F is the discrete Fourier transform of a segment without its
    mean, times `window`.

    Attributes:
        starts: First sample of each segment, (n,).
        window: Window, (s,).
        first: Index of the first frequency that has a weight.
        weight: Weight of each frequency from `first` on, (f,).
    """

    starts: np.ndarray
    window: Float[np.ndarray, " s"]
    first: int
    weight: Float[np.ndarray, " f"]

    def integral(self, x: Float[np.ndarray, " t"]) -> float:
        """Variance within the band (unit²) of a record as long as that for which the weights were made."""
        parts = x[self.starts[:, None] + np.arange(len(self.window))]
        lines = np.fft.rfft((parts - parts.mean(axis=1, keepdims=True)) * self.window)
        inside = np.abs(lines[:, self.first : self.first + len(self.weight)]) ** 2
        return float((inside @ self.weight).mean())


def band_weights(
    count: int,
    step: float,
    low: float,
    high: float,
    segment: float | None = None,
    overlap: float = 0.5,
    window: str = "hann",
) -> BandWeights:
    """Weights of `band_integral` for all records of one length and sampling interval.

    Args:
        count: Number of samples of the record.
        step: Sampling interval (s).
        low: Lower limit of the band (Hz).
        high: Upper limit of the band (Hz).
        segment: As in `power_spectrum`.
        overlap: As in `power_spectrum`.
        window: As in `power_spectrum`.

    Returns:
        The quadratic form.

    Raises:
        ValueError: Unless 0 <= low < high, or where `segment` or `overlap` is out of range.
    """
    _in_order(low, high)
    size, shared, name = segment_samples(count, step, segment, overlap, window)
    taper = window_weights(name, size)
    f = np.fft.rfftfreq(size, step)
    edges = _cell_edges(f)
    share = np.clip((np.minimum(high, edges[1:]) - np.maximum(low, edges[:-1])) / np.diff(edges), 0.0, 1.0)
    weight = share * (f[1] - f[0]) * _sides(size) * step / np.sum(taper**2)
    inside = np.flatnonzero(weight)
    first, last = (int(inside[0]), int(inside[-1]) + 1) if len(inside) else (0, 1)
    return BandWeights(np.arange(0, count - size + 1, size - shared), taper, first, weight[first:last])


def _sides(count: int) -> Float[np.ndarray, " f"]:
    """Number of frequencies, of both signs, that each line of a one-sided spectrum stands for."""
    return np.where(np.isin(np.arange(count // 2 + 1) * 2, (0, count)), 1.0, 2.0)


def _cell_edges(frequency: Float[np.ndarray, " f"]) -> Float[np.ndarray, " f+1"]:
    """Limits of the cells in which each value of a spectrum holds: halfway to its neighbours, and the ends."""
    return np.concatenate([frequency[:1], 0.5 * (frequency[1:] + frequency[:-1]), frequency[-1:]])


def _in_order(low: float, high: float) -> None:
    if not 0 <= low < high:
        raise ValueError(f"a band has 0 <= low < high, found {low} and {high} Hz")


def checked_record(time: np.ndarray, x: np.ndarray) -> tuple[float, np.ndarray]:
    """Sampling interval (s) and checked values of a record.

    Args:
        time: Sample times (s), (t,), even.
        x: Record (unit), (t,).

    Raises:
        ValueError: The times are uneven, or values are not finite.
    """
    step, x = sampling_interval(time), np.asarray(x, float)
    if x.shape != np.shape(time):
        raise ValueError(f"a value for each of {len(time)} times expected, found shape {x.shape}")
    if not np.all(np.isfinite(x)):
        raise ValueError(f"values are numbers, found {np.sum(~np.isfinite(x))} of {len(x)} that are not")
    return step, x


def segment_samples(count: int, step: float, segment: float | None, overlap: float, window: str) -> tuple[int, int, str]:
    """Samples per segment, samples shared with the next, and window.

    The segments reach the end of the record, but for fewer samples than there are segments. The window is "boxcar" where one
    segment is the whole record.

    Args:
        count: Number of samples of the record.
        step: Sampling interval (s).
        segment: As in `power_spectrum`.
        overlap: As in `power_spectrum`.
        window: As in `power_spectrum`.

    Raises:
        ValueError: `segment` or `overlap` is out of range.
    """
    length = SEGMENT if segment is None else segment
    if not (length >= 4 * step and 0 <= overlap < 1):
        raise ValueError(f"a segment of {4 * step:g} s or more, 0 <= overlap < 1 expected, found {length:g} s and {overlap:g}")
    if length >= (count - 0.5) * step:
        return count, 0, "boxcar"
    samples = round(length / step)
    between = samples - min(int(overlap * samples), samples - 1)  # the starts of two segments, at most
    further = -(-(count - samples) // between)
    return samples, samples - (count - samples) // further if further else 0, window
