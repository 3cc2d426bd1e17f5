"""Spectra, band energies, transfer functions, statistics and exceedance of evenly sampled records.

All functions are pure and take and return NumPy arrays. They raise ValueError for uneven times: a gap, or jitter above 1 % of
a step.
"""

from typing import NamedTuple

import numpy as np
import scipy  # scipy.signal is imported when it is used: it takes a second
from jaxtyping import Float

from jaxhydro.environment import DOFS
from jaxhydro.waves.irregular import sampling_interval

SEGMENT = 1000.0  # s: 0.001 Hz between frequencies, so that the lowest band, 0.005 to 0.025 Hz, has twenty of them
MIN_TRANSFER_SEGMENTS = 8  # segments' lengths in a record for a transfer function: its coherence is biased by about 1 / number

BANDS = {  # Hz, low and high
    "surge": (0.005, 0.025),
    "heave": (0.02, 0.055),
    "pitch": (0.02, 0.055),
    "wave": (0.06, 0.15),
    "wave, long": (0.05, 0.15),
}
"""Low-frequency bands of surge, heave and pitch, and the wave-frequency bands of a moderate and of a high sea: the paper's."""

LONG_PEAK_PERIOD = (
    0.7 / 0.06
)  # s: from this peak period on a sea has energy below 0.06 Hz (JONSWAP has next to none below 0.7 of its peak)


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
    step, x = _record(time, x)
    count, shared, window = _segments(len(x), step, segment, overlap, window)
    frequency, density = scipy.signal.welch(x, 1 / step, window, count, shared, detrend="constant")
    weight = scipy.signal.get_window(window, count)
    resolution = float(np.sum(weight**2) / (np.sum(weight) ** 2 * step))
    return PowerSpectrum(frequency, density, 1 + (len(x) - count) // (count - shared), resolution)


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
    edges = np.concatenate([f[:1], 0.5 * (f[1:] + f[:-1]), f[-1:]])
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
    step, x = _record(time, x)
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
    size, shared, name = _segments(count, step, segment, overlap, window)
    taper = scipy.signal.get_window(name, size)
    f = np.fft.rfftfreq(size, step)
    edges = np.concatenate([f[:1], 0.5 * (f[1:] + f[:-1]), f[-1:]])
    share = np.clip((np.minimum(high, edges[1:]) - np.maximum(low, edges[:-1])) / np.diff(edges), 0.0, 1.0)
    sides = np.full(len(f), 2.0)
    sides[[0, *([-1] if size % 2 == 0 else [])]] = 1.0
    weight = share * (f[1] - f[0]) * sides * step / np.sum(taper**2)
    inside = np.flatnonzero(weight)
    first, last = (int(inside[0]), int(inside[-1]) + 1) if len(inside) else (0, 1)
    return BandWeights(np.arange(0, count - size + 1, size - shared), taper, first, weight[first:last])


def bands(dof: str, peak_period: float) -> dict[str, tuple[float, float]]:
    """Low-frequency and wave-frequency band of a motion in a sea.

    From a peak period of 11.7 s on, the wave band begins at 0.05 Hz instead of 0.06 Hz. Sway has the bands of surge, and
    roll those of pitch.

    Args:
        dof: Name of a degree of freedom other than yaw.
        peak_period: Peak period of the sea (s).

    Returns:
        Limits (Hz) of `low_frequency` and `wave_frequency`.

    Raises:
        ValueError: For yaw, an unknown name, or a period that is not above 0.
    """
    same = {"sway": "surge", "roll": "pitch"}.get(dof, dof)
    if same not in DOFS or same not in BANDS:
        raise ValueError(f"bands are known for surge, sway, heave, roll and pitch, found {dof!r}")
    if not peak_period > 0:
        raise ValueError(f"peak_period is above 0 s, found {peak_period}")
    return {"low_frequency": BANDS[same], "wave_frequency": BANDS["wave, long" if peak_period >= LONG_PEAK_PERIOD else "wave"]}


class TransferFunction(NamedTuple):
    """Motion per unit of wave (RAO) over frequency.

    motion = Re sum H a exp(i omega t), with H = amplitude exp(i phase) and a the complex amplitudes of the wave.

    Attributes:
        frequency: Frequencies (Hz), (f,).
        amplitude: |H| (unit of the motion per unit of the wave), (f,).
        phase: Phase of H (rad, -pi to pi), (f,); above 0 the motion leads the wave.
        coherence: Fraction (0 to 1) of the motion's energy that is linear in the wave, (f,). Where it is low, H is noise.
    """

    frequency: Float[np.ndarray, " f"]  # Hz
    amplitude: Float[np.ndarray, " f"]  # unit of motion per unit of wave
    phase: Float[np.ndarray, " f"]  # rad, -pi to pi
    coherence: Float[np.ndarray, " f"]


def transfer_function(
    time: Float[np.ndarray, " t"],
    wave: Float[np.ndarray, " t"],
    motion: Float[np.ndarray, " t"],
    segment: float | None = None,
    overlap: float = 0.5,
    window: str = "hann",
) -> TransferFunction:
    """Transfer function (RAO) from wave to motion by cross-spectra.

    The estimate is H1 = S_wave,motion / S_wave,wave, in which noise on the motion averages out. Segments must be long
    against the decay time of the motion; otherwise resonances come out too low and too wide. Frequencies without wave energy
    give NaN.

    Args:
        time: Sample times (s), (t,), even.
        wave: Wave elevation (m), (t,).
        motion: Motion (unit), (t,).
        segment: Length of a segment (s). None: 1000 s, or an eighth of a record shorter than 8000 s.
        overlap: As in `power_spectrum`.
        window: As in `power_spectrum`.

    Returns:
        Amplitude, phase and coherence over frequency.

    Raises:
        ValueError: As `power_spectrum`, and for fewer than two segments, whose coherence would always be 1.

    References:
        Bendat and Piersol (2010), Random Data, chapter 6.
    """
    step, wave = _record(time, wave)
    _, motion = _record(time, motion)
    segment = min(SEGMENT, len(wave) * step / MIN_TRANSFER_SEGMENTS) if segment is None else segment
    count, shared, window = _segments(len(wave), step, segment, overlap, window)
    if len(wave) < 2 * count - int(overlap * count):  # of two that share more, the coherence is near 1 whatever they are
        raise ValueError(f"two segments or more expected, found a record of {len(wave) * step:g} s, segments of {segment:g} s")
    options = {"fs": 1 / step, "window": window, "nperseg": count, "noverlap": shared, "detrend": "constant"}
    frequency, across = scipy.signal.csd(wave, motion, **options)
    of_wave, of_motion = (scipy.signal.welch(x, **options)[1] for x in (wave, motion))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(of_wave > 0, across / of_wave, np.nan)
        coherence = np.where(of_wave * of_motion > 0, np.abs(across) ** 2 / (of_wave * of_motion), np.nan)
    return TransferFunction(frequency, np.abs(ratio), np.angle(ratio), coherence)


class Statistics(NamedTuple):
    """Statistics of a record.

    Attributes:
        mean: Mean (unit).
        standard_deviation: Standard deviation (unit).
        minimum: Smallest value (unit).
        maximum: Largest value (unit).
        skewness: Third standardised moment (-); 0 for a Gaussian process.
        kurtosis: Fourth standardised moment (-); 3 for a Gaussian process.
        zero_crossing_period: Mean time (s) between upward crossings of the mean; NaN with fewer than two.
        significant_double_amplitude: Mean of the highest third of the ranges between these crossings (unit); NaN as above.
    """

    mean: float
    standard_deviation: float
    minimum: float
    maximum: float
    skewness: float
    kurtosis: float
    zero_crossing_period: float
    significant_double_amplitude: float


def statistics(time: Float[np.ndarray, " t"], x: Float[np.ndarray, " t"]) -> Statistics:
    """Moments, extremes and zero-crossing statistics of a record.

    Noise adds crossings of its own: filter it out first.

    Args:
        time: Sample times (s), (t,), even.
        x: Record (unit), (t,).

    Returns:
        Statistics in the unit of the record; skewness, kurtosis and zero-crossing statistics are NaN where undefined.

    Raises:
        ValueError: The times are uneven, or values are not finite.
    """
    _, x = _record(time, x)
    centred = x - x.mean()
    deviation = float(centred.std())
    scaled = centred / deviation if deviation > 0 else np.full(len(x), np.nan)
    crossing, cycles = _cycles(np.asarray(time, float), centred)
    ranges = np.sort([float(np.ptp(cycle)) for cycle in cycles])[::-1]
    highest = ranges[: max(round(len(ranges) / 3), 1)]
    return Statistics(
        float(x.mean()),
        deviation,
        float(x.min()),
        float(x.max()),
        float(np.mean(scaled**3)),
        float(np.mean(scaled**4)),
        float((crossing[-1] - crossing[0]) / len(cycles)) if cycles else float("nan"),
        float(highest.mean()) if cycles else float("nan"),
    )


class Exceedance(NamedTuple):
    """Peaks of a record and how often they are exceeded.

    Attributes:
        amplitude: Peaks above the mean (unit), ascending, (n,).
        probability: Fraction of peaks above each, (n,).
        rayleigh: The same for a narrow-band Gaussian process of the record's standard deviation, (n,).
    """

    amplitude: Float[np.ndarray, " n"]
    probability: Float[np.ndarray, " n"]
    rayleigh: Float[np.ndarray, " n"]


def exceedance(time: Float[np.ndarray, " t"], x: Float[np.ndarray, " t"]) -> Exceedance:
    """Exceedance probability of the peaks of a record.

    A peak is the highest value above the mean between two upward crossings of the mean. For troughs, give -x. The i-th
    highest of n peaks is exceeded with probability i / (n + 1) (Weibull's plotting position).

    Args:
        time: Sample times (s), (t,), even.
        x: Record (unit), (t,).

    Returns:
        Peaks and probabilities; empty with fewer than two crossings.

    Raises:
        ValueError: The times are uneven, or values are not finite.

    References:
        Longuet-Higgins (1952): Rayleigh distribution exp(-a² / (2 s²)), s the standard deviation.
    """
    _, x = _record(time, x)
    centred = x - x.mean()
    _, cycles = _cycles(np.asarray(time, float), centred)
    peaks = np.sort([float(cycle.max()) for cycle in cycles])
    probability = np.arange(len(peaks), 0, -1) / (len(peaks) + 1)
    return Exceedance(peaks, probability, np.exp(-0.5 * peaks**2 / max(centred.var(), 1e-300)))


def _in_order(low: float, high: float) -> None:
    if not 0 <= low < high:
        raise ValueError(f"a band has 0 <= low < high, found {low} and {high} Hz")


def _record(time: np.ndarray, x: np.ndarray) -> tuple[float, np.ndarray]:
    """Sampling interval (s) and checked values of a record."""
    step, x = sampling_interval(time), np.asarray(x, float)
    if x.shape != np.shape(time):
        raise ValueError(f"a value for each of {len(time)} times expected, found shape {x.shape}")
    if not np.all(np.isfinite(x)):
        raise ValueError(f"values are numbers, found {np.sum(~np.isfinite(x))} of {len(x)} that are not")
    return step, x


def _segments(count: int, step: float, segment: float | None, overlap: float, window: str) -> tuple[int, int, str]:
    """Samples per segment, samples shared with the next, and window.

    The segments reach the end of the record, but for fewer samples than there are segments. The window is "boxcar" where one
    segment is the whole record.
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


def _cycles(time: np.ndarray, centred: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
    """Times of the upward zero crossings (linear interpolation), and the samples between them."""
    before = np.flatnonzero((centred[:-1] < 0) & (centred[1:] >= 0))
    share = centred[before] / (centred[before] - centred[before + 1])
    crossing = time[before] + share * (time[before + 1] - time[before])
    return crossing, np.split(centred, before + 1)[1:-1]
