"""Pure analysis of records: spectra, energy in bands, transfer functions, statistics, exceedance. NumPy in and out.

Records are sampled evenly; every function raises ValueError where they are not (gap, jitter above 1 % of a step).
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy import signal

from jaxhydro.environment import DOFS
from jaxhydro.waves.irregular import sampling_interval

SEGMENT = 1000.0  # s: 0.001 Hz between frequencies, so that the lowest band, 0.005 to 0.025 Hz, has twenty of them
FEWEST = 8  # segments' lengths in a record for a transfer function: its coherence is biased by about 1 / number

BANDS = {  # Hz, low and high
    "surge": (0.005, 0.025),
    "heave": (0.02, 0.055),
    "pitch": (0.02, 0.055),
    "wave": (0.06, 0.15),
    "wave, long": (0.05, 0.15),
}
"""Low-frequency bands of surge, heave and pitch, and the wave-frequency bands of a moderate and of a high sea: the paper's."""

LONG = 0.7 / 0.06  # s: from this peak period on a sea has energy below 0.06 Hz (JONSWAP has next to none below 0.7 of its peak)


class PowerSpectrum(NamedTuple):
    """One-sided density over frequency, number of segments averaged, and resolution: the window's noise bandwidth (Hz)."""

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
    """Welch's (1967) mean of the periodograms of windowed segments (s), each less its own mean; `overlap` is a share of one.

    segment None: 1000 s, or the whole of a shorter record. A segment as long as the record or longer: the raw periodogram,
    not windowed, which sums to the variance exactly. What does not fill a segment at the end of the record is not used; what is
    slower than a segment goes with the means. Raises ValueError for uneven times or a segment or overlap out of range.
    """
    step, x = _record(time, x)
    count, shared, window = _segments(len(x), step, segment, overlap, window)
    frequency, density = signal.welch(x, 1 / step, window, count, shared, detrend="constant")
    weight = signal.get_window(window, count)
    resolution = float(np.sum(weight**2) / (np.sum(weight) ** 2 * step))
    return PowerSpectrum(frequency, density, 1 + (len(x) - count) // (count - shared), resolution)


def band_integral(spectrum: PowerSpectrum, low: float, high: float) -> float:
    """Integral of the density from `low` to `high` (Hz), in unit^2; over all frequencies the variance.

    Each value stands for what lies halfway to its neighbours, the first and last for what lies within the ends; of a cell that
    a limit cuts, the share inside counts. Raises ValueError for high <= low or low < 0.
    """
    _in_order(low, high)
    f = spectrum.frequency
    edges = np.concatenate([f[:1], 0.5 * (f[1:] + f[:-1]), f[-1:]])
    # each line holds density times spacing, also the first and the last, whose cells are halves: they are not doubled
    total = np.concatenate([[0.0], np.cumsum(spectrum.density) * (f[1] - f[0])])
    return float(np.interp(high, edges, total) - np.interp(low, edges, total))


def band_pass(time: Float[np.ndarray, " t"], x: Float[np.ndarray, " t"], low: float, high: float) -> Float[np.ndarray, " t"]:
    """What of a record is from `low` to `high` (Hz), both included: its Fourier lines in the band, the others left out, so that
    no phase is changed; the record is taken to repeat itself. From 0 Hz on the mean is kept.

    Raises ValueError for uneven times, values that are no numbers, high <= low or low < 0.
    """
    _in_order(low, high)
    step, x = _record(time, x)
    lines, frequency = np.fft.rfft(x), np.fft.rfftfreq(len(x), step)
    lines[(frequency < low) | (frequency > high)] = 0
    return np.fft.irfft(lines, len(x))


class BandWeights(NamedTuple):
    """`band_integral` of `power_spectrum` as a quadratic form of the record: the mean over segments of sum_f weight |F|^2.

    F is the discrete Fourier transform of a segment less its mean, times `window`; segments begin at the samples `starts`, and
    `weight` is for the frequencies from the index `first` on.
    """

    starts: np.ndarray
    window: Float[np.ndarray, " s"]
    first: int
    weight: Float[np.ndarray, " f"]

    def integral(self, x: Float[np.ndarray, " t"]) -> float:
        """unit^2, of a record as long as that for which the weights were made."""
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
    """For records of `count` samples every `step` (s) and the band from `low` to `high` (Hz); options of `power_spectrum`.

    Raises ValueError for high <= low or low < 0, or a segment or overlap out of range.
    """
    _in_order(low, high)
    size, shared, name = _segments(count, step, segment, overlap, window)
    taper = signal.get_window(name, size)
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
    """`low_frequency` and `wave_frequency` band (Hz) of surge, heave or pitch in a sea of this peak period (s).

    The wave band begins at 0.05 Hz instead of 0.06 from a peak period of 11.7 s on. Sway counts as surge, roll as pitch.
    Raises ValueError for yaw, an unknown name, or a period that is not above 0.
    """
    same = {"sway": "surge", "roll": "pitch"}.get(dof, dof)
    if same not in DOFS or same not in BANDS:
        raise ValueError(f"bands are known for surge, sway, heave, roll and pitch, found {dof!r}")
    if not peak_period > 0:
        raise ValueError(f"peak_period is above 0 s, found {peak_period}")
    return {"low_frequency": BANDS[same], "wave_frequency": BANDS["wave, long" if peak_period >= LONG else "wave"]}


class TransferFunction(NamedTuple):
    """Response per unit of wave: motion = Re sum H a exp(i omega t), H = amplitude exp(i phase); phase > 0 leads the wave.

    Coherence, 0 to 1: the share of the motion's energy that follows the wave linearly; where it is low, H is noise.
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
    """RAO by cross-spectra, H1 = S_wave,motion / S_wave,wave, in which noise on the motion averages out (Bendat and Piersol
    2010, Random Data, chapter 6).

    Segments as in `power_spectrum`, but None: 1000 s or an eighth of the record, the shorter. They must be long against the
    memory of the motion, or resonances come out low and wide. NaN where the wave has no energy at all. Raises ValueError, too,
    where there are fewer than two segments: coherence would be 1 whatever the records.
    """
    step, wave = _record(time, wave)
    _, motion = _record(time, motion)
    segment = min(SEGMENT, len(wave) * step / FEWEST) if segment is None else segment
    count, shared, window = _segments(len(wave), step, segment, overlap, window)
    if len(wave) < 2 * count - shared:
        raise ValueError(f"two segments or more expected, found a record of {len(wave) * step:g} s, segments of {segment:g} s")
    options = {"fs": 1 / step, "window": window, "nperseg": count, "noverlap": shared, "detrend": "constant"}
    frequency, across = signal.csd(wave, motion, **options)
    of_wave, of_motion = (signal.welch(x, **options)[1] for x in (wave, motion))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(of_wave > 0, across / of_wave, np.nan)
        coherence = np.where(of_wave * of_motion > 0, np.abs(across) ** 2 / (of_wave * of_motion), np.nan)
    return TransferFunction(frequency, np.abs(ratio), np.angle(ratio), coherence)


class Statistics(NamedTuple):
    """Of a record: mean, standard deviation, extremes (unit); skewness and kurtosis (0 and 3 for a Gaussian); mean time between
    upward crossings of the mean (s), mean of the highest third of the ranges between them (unit), NaN with fewer than two."""

    mean: float
    standard_deviation: float
    minimum: float
    maximum: float
    skewness: float
    kurtosis: float
    zero_crossing_period: float
    significant_double_amplitude: float


def statistics(time: Float[np.ndarray, " t"], x: Float[np.ndarray, " t"]) -> Statistics:
    """Moments and zero-crossing waves of a record (s, unit). Noise makes crossings of its own: filter it first."""
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
    """Peaks over the mean, ascending (unit), the share of peaks above each, and the same of a narrow-band Gaussian process."""

    amplitude: Float[np.ndarray, " n"]
    probability: Float[np.ndarray, " n"]
    rayleigh: Float[np.ndarray, " n"]


def exceedance(time: Float[np.ndarray, " t"], x: Float[np.ndarray, " t"]) -> Exceedance:
    """The highest value, over the mean, between upward crossings of the mean, one peak each; of troughs: give -x.

    The i-th highest of n is exceeded with probability i / (n + 1) (Weibull's plotting position). Rayleigh: exp(-a^2 / (2 s^2))
    with the record's standard deviation s (Longuet-Higgins 1952). Empty with fewer than two crossings.
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
    """Step (s) and values of a record that can be analysed."""
    step, x = sampling_interval(time), np.asarray(x, float)
    if x.shape != np.shape(time):
        raise ValueError(f"a value for each of {len(time)} times expected, found shape {x.shape}")
    if not np.all(np.isfinite(x)):
        raise ValueError(f"values are numbers, found {np.sum(~np.isfinite(x))} of {len(x)} that are not")
    return step, x


def _segments(count: int, step: float, segment: float | None, overlap: float, window: str) -> tuple[int, int, str]:
    """Samples in a segment and shared with the next, and the window; none where one segment is all."""
    length = SEGMENT if segment is None else segment
    if not (length >= 4 * step and 0 <= overlap < 1):
        raise ValueError(f"a segment of {4 * step:g} s or more, 0 <= overlap < 1 expected, found {length:g} s and {overlap:g}")
    if length >= (count - 0.5) * step:
        return count, 0, "boxcar"
    samples = round(length / step)
    return samples, min(int(overlap * samples), samples - 1), window


def _cycles(time: np.ndarray, centred: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
    """Times of the upward zero crossings, by straight lines, and the samples between successive ones."""
    before = np.flatnonzero((centred[:-1] < 0) & (centred[1:] >= 0))
    share = centred[before] / (centred[before] - centred[before + 1])
    crossing = time[before] + share * (time[before + 1] - time[before])
    return crossing, np.split(centred, before + 1)[1:-1]
