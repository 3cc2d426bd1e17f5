"""Transfer functions (RAOs) from wave to motion, by cross-spectra."""

from typing import NamedTuple

import numpy as np
import scipy  # scipy.signal is imported when it is used: it takes a second
from jaxtyping import Float

from jaxhydro.analysis.spectral import SEGMENT, checked_record, segment_samples

MIN_TRANSFER_SEGMENTS = 8  # segments' lengths in a record for a transfer function: its coherence is biased by about 1 / number


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
    step, wave = checked_record(time, wave)
    _, motion = checked_record(time, motion)
    segment = min(SEGMENT, len(wave) * step / MIN_TRANSFER_SEGMENTS) if segment is None else segment
    count, shared, window = segment_samples(len(wave), step, segment, overlap, window)
    if len(wave) < 2 * count - int(overlap * count):  # of two that share more, the coherence is near 1 whatever they are
        raise ValueError(f"two segments or more expected, found a record of {len(wave) * step:g} s, segments of {segment:g} s")
    options = {"fs": 1 / step, "window": window, "nperseg": count, "noverlap": shared, "detrend": "constant"}
    frequency, across = scipy.signal.csd(wave, motion, **options)
    of_wave, of_motion = (scipy.signal.welch(x, **options)[1] for x in (wave, motion))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(of_wave > 0, across / of_wave, np.nan)
        coherence = np.where(of_wave * of_motion > 0, np.abs(across) ** 2 / (of_wave * of_motion), np.nan)
    return TransferFunction(frequency, np.abs(ratio), np.angle(ratio), coherence)
