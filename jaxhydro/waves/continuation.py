"""A record of waves beyond its end, so that its Fourier components do not ring where its end does not meet its start."""

import numpy as np
from jaxtyping import Float

PERIODS = 20.0  # of the shortest waves: how long the least continuation is
RIDGE = 1e-4  # share of the continuation's energy that counts beside what is outside the band
RINGS = 2.0  # times what the components of a continued record miss near the ends: a record whose own miss more is continued


def continued(record: Float[np.ndarray, " t"], step: float, low: float, cutoff: float) -> Float[np.ndarray, " n"]:
    """A record (m) at even steps (s), of mean 0, and what most likely follows, from where it begins anew; the record alone
    where that gains nothing.

    Of all continuations p it is the one with the least energy outside the band from `low` to `cutoff` (Hz), and little of its
    own, |(1 - B)(x, p)|^2 + `RIDGE` |p|^2 with B the band-pass over record and continuation. Its equations are Toeplitz:
    (1 - B)_pp p + RIDGE p = B_px x. Without a ridge it is the limit of Papoulis 1975 (IEEE Transactions on Circuits and Systems
    22, 735-742): band-limited extrapolation, of a record whose noise and bound waves outside the band are left as they are.
    """
    from scipy.fft import next_fast_len
    from scipy.linalg import solve_toeplitz

    count = len(record)
    length = next_fast_len(count + int(np.ceil(PERIODS / (cutoff * step))), real=True)
    if length > 1.5 * count:
        return record
    inside = _inside(length, step, low, cutoff)
    there = np.fft.irfft(inside * np.fft.rfft(record, length), length)[count:]
    column = -np.fft.irfft(inside, length)[: length - count]
    column[0] += 1 + RIDGE
    whole = np.concatenate([record, solve_toeplitz(column, there)])
    ends = np.r_[: length - count, 2 * count - length : count]
    missed = [float(np.linalg.norm((x - _passed(x, step, low, cutoff))[ends])) for x in (record, whole)]
    return whole if missed[0] > RINGS * missed[1] else record


def _inside(count: int, step: float, low: float, cutoff: float) -> np.ndarray:
    frequency = np.fft.rfftfreq(count, step)
    rounding = 1e-6 / (count * step)
    return ((frequency >= low - rounding) & (frequency <= cutoff + rounding)).astype(float)


def _passed(values: np.ndarray, step: float, low: float, cutoff: float) -> np.ndarray:
    return np.fft.irfft(_inside(len(values), step, low, cutoff) * np.fft.rfft(values), len(values))
