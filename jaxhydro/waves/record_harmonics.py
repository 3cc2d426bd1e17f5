"""Fourier components of measured elevations on even times."""

import math
from collections.abc import Callable, Sequence

import numpy as np
from jaxtyping import Complex, Float

from jaxhydro.waves.continuation import continued
from jaxhydro.waves.irregular import fourier_length, harmonics
from jaxhydro.waves.wave_errors import BandError

MAX_JITTER = 0.01  # of a step, by which times may miss an even grid: what rounding in a file does
MIN_CONTINUATION = 20.0  # of the shortest waves: how far records are continued at least
MAX_LENGTHENING = 1.5  # times a record, that it may have when continued


def measured_harmonics(
    times: Float[np.ndarray, " t"],
    elevations: Sequence[Float[np.ndarray, " t"]],
    low: float,
    cutoff: float,
    together: Callable[[list[np.ndarray], float, int], list[np.ndarray]] | None = None,
) -> tuple[list[Complex[np.ndarray, " w"]], Float[np.ndarray, " w"], int]:
    """Fourier components of records on one clock, continued as in `separated_record`.

    Args:
        times: Sample times (s), (t,), even.
        elevations: Elevation at each gauge (m), (t,) each.
        low: Lowest frequency (Hz).
        cutoff: Highest frequency (Hz).
        together: Continuation of all records at once, where one of them has to be continued: from their elevations without
            mean (m), the sampling interval (s) and a number of samples to elevations of that many samples (m). Several
            gauges need it.

    Returns:
        Complex amplitudes (m) at each gauge, (w,) each, on the clock of `times`; angular frequencies (rad/s), (w,), and the
        number of the first, as harmonic.

    Raises:
        ValueError: As `separated_record`.
    """
    times, elevations = np.asarray(times, float), [np.asarray(elevation, float) for elevation in elevations]
    step = sampling_interval(times)
    for elevation in elevations:
        if elevation.shape != times.shape:
            raise ValueError(f"an elevation for each of {len(times)} times expected, found shape {elevation.shape}")
        if not np.all(np.isfinite(elevation)):
            raise ValueError(
                f"elevations are numbers, found {np.sum(~np.isfinite(elevation))} of {len(elevation)} that are not"
            )
    if cutoff > 0.5 / step:
        raise BandError(f"cutoff is at most half the sampling rate, {0.5 / step:g} Hz, found {cutoff:g} Hz")
    levels = [elevation - elevation.mean() for elevation in elevations]
    if cutoff > 0:
        length = fourier_length(len(times) + MIN_CONTINUATION / (cutoff * step))
        if length <= MAX_LENGTHENING * len(times):
            whole = [continued(level, step, low, cutoff, length) for level in levels]
            if together is not None and any(len(level) > len(times) for level in whole):
                whole = together(levels, step, length)
            levels = whole
    count = len(levels[0])
    period = count * step
    first, last = harmonics(low, cutoff, period)
    last = min(last, (count - 1) // 2)  # at half the sampling rate a phase is not seen
    omega = 2 * math.pi / period * np.arange(first, last + 1)
    clock = np.exp(-1j * omega * times[0])
    measured = [2 / count * np.fft.rfft(level)[first : last + 1] * clock for level in levels]
    if not all(amplitudes.any() for amplitudes in measured):
        raise ValueError(f"the record has no waves from {low:g} to {cutoff:g} Hz")
    return measured, omega, first


def sampling_interval(times: Float[np.ndarray, " t"]) -> float:
    """Sampling interval (s) of even, ascending times.

    Args:
        times: Times (s), (t,), four or more.

    Raises:
        ValueError: Times are uneven by more than 1 % of a step.
    """
    times = np.asarray(times, float)
    if times.ndim != 1 or len(times) < 4 or not np.all(np.isfinite(times)):
        raise ValueError(f"four or more times (s) expected, found an array of shape {times.shape} or with gaps")
    step = (times[-1] - times[0]) / (len(times) - 1)
    worst = int(np.argmax(np.abs(times - times[0] - step * np.arange(len(times)))))
    off = abs(times[worst] - times[0] - step * worst)
    if not (step > 0 and off <= MAX_JITTER * step):
        raise ValueError(f"evenly sampled times expected, found {times[worst]:g} s {off:g} s off an even step of {step:g} s")
    return float(step)
